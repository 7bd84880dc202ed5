// The effects that share tables.
#include <algorithm>

#include "effect/tables.hpp"
#include "gpu/try.hpp"

namespace tyndall {

void TableUsers::remove(const FrameRing* ring) noexcept {
  std::erase_if(users_, [&](const Entry& entry) { return entry.user.ring == ring; });
}

Result<void> TableUsers::check_between(const char* where) const {
  for (const Entry& entry : users_) TYNDALL_TRY(entry.user.parts->check_between(where));
  return {};
}

void TableUsers::begin_frame(const FrameRing* ring) {
  for (Entry& entry : users_) entry.begun = entry.begun || entry.user.ring == ring;
}

bool TableUsers::end_round() {
  const bool over = std::all_of(users_.begin(), users_.end(),
                                [](const Entry& entry) { return entry.begun || !entry.user.ring->unfinished(); });
  if (!over) return false;
  for (Entry& entry : users_) entry.begun = false;
  return true;
}

std::uint32_t TableUsers::rounds(std::uint32_t least) const {
  std::uint32_t out = least;
  // One of several effects may already have begun a frame that the others have not.
  for (const Entry& entry : users_) out = std::max(out, entry.user.slots + (users_.size() > 1 ? 2 : 1));
  return out;
}

}  // namespace tyndall
