// The division of a run into shards, which machines compute separately: item k of a run belongs to shard (k mod N) + 1
// of N. Items are numbered from 0.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tyndall/result.hpp"

namespace tyndall::cli {

struct Shard {
  std::uint32_t index = 0;  // from 0
  std::uint32_t count = 1;

  [[nodiscard]] bool takes(std::uint64_t item) const { return item % count == index; }
  // Returns the items of this shard among `total` items, in order.
  [[nodiscard]] std::vector<std::uint64_t> items(std::uint64_t total) const;
  // Returns "2/4" for the second of four shards.
  [[nodiscard]] std::string text() const;

  friend bool operator==(const Shard&, const Shard&) = default;
};

constexpr std::uint32_t kMaxShards = 1000000;

// Parses "I/N" with 1 <= I <= N. `option` is the source for the error message.
[[nodiscard]] Result<Shard> parse_shard(std::string_view text, std::string_view option);

}  // namespace tyndall::cli
