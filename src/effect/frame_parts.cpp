#include "effect/frame_parts.hpp"
#include "effect/invalid.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <string>

namespace tyndall {
namespace {

bool same(const Texture& a, const Texture& b) {
  return a.view == b.view && a.layout == b.layout && a.offset.x == b.offset.x && a.offset.y == b.offset.y;
}

// Compares structures of floats, which have no padding.
template <typename T>
bool same_bytes(const T& a, const T& b) {
  static_assert(sizeof(T) % sizeof(float) == 0 && alignof(T) == alignof(float));
  return std::memcmp(&a, &b, sizeof a) == 0;
}

bool same(std::span<const Cascade> a, std::span<const Cascade> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_bytes<Cascade>);
}

// Returns the name of the first member in which the inputs of two parts differ; null if all are equal. The structured
// bindings do not compile while a member is missing here.
const char* difference(const FrameInputs& a, std::span<const Cascade> cascades_of_a, const FrameInputs& b) {
  const auto& [extent, color, depth, shadow_maps, shadow_colors, shadow_color_depths, shadow_resolution, cascades,
               first_marched_cascade, camera, sun, output, frame_index, view, lowest_ground_m, clouds] = b;
  struct Member {
    const char* name;
    bool equal;
  };
  const Member members[] = {
      {"frame_index", a.frame_index == frame_index},
      {"view", a.view == view},
      {"extent", a.extent.width == extent.width && a.extent.height == extent.height},
      {"color", same(a.color, color)},
      {"depth", same(a.depth, depth)},
      {"shadow_maps", same(a.shadow_maps, shadow_maps)},
      {"shadow_colors", same(a.shadow_colors, shadow_colors)},
      {"shadow_color_depths", a.shadow_color_depths == shadow_color_depths},
      {"shadow_resolution", a.shadow_resolution == shadow_resolution},
      {"cascades", same(cascades_of_a, cascades)},
      {"first_marched_cascade", a.first_marched_cascade == first_marched_cascade},
      {"camera", same_bytes(a.camera, camera)},
      {"sun", same_bytes(a.sun, sun)},
      {"output", same(a.output, output)},
      {"lowest_ground_m", a.lowest_ground_m == lowest_ground_m},
      {"clouds", same(a.clouds.map, clouds.map) && same_bytes(a.clouds.map_from_world, clouds.map_from_world)},
  };
  for (const Member& member : members) {
    if (!member.equal) return member.name;
  }
  return nullptr;
}

std::string frame_of(const FrameInputs& inputs) {
  return "frame_index " + std::to_string(inputs.frame_index) + ", view " + std::to_string(inputs.view);
}

}  // namespace

Result<void> FrameParts::check(const FrameInputs& inputs, FramePart part) const {
  if (part > FramePart::drop) {
    return invalid("the part of the frame is " + std::to_string(static_cast<std::uint32_t>(part)) +
                   "; expected FramePart::whole, first, second or drop");
  }
  const bool ends = part == FramePart::second || part == FramePart::drop;
  if (!ends) {
    if (!open_) return {};
    return invalid("the first part of " + frame_of(inputs_) +
                   " has been recorded, but not the second; expected FramePart::second or drop of this frame before "
                   "any other frame or view");
  }
  if (!open_) {
    return invalid(std::string(part == FramePart::drop ? "FramePart::drop of " : "FramePart::second of ") +
                   frame_of(inputs) + " has no first part; expected FramePart::first with the same inputs before it");
  }
  if (part == FramePart::drop) {  // needs no other inputs: an engine may have lost them
    if (inputs.frame_index == inputs_.frame_index && inputs.view == inputs_.view) return {};
    return invalid("FramePart::drop of " + frame_of(inputs) + " follows the first part of " + frame_of(inputs_) +
                   "; expected the same frame_index and view");
  }
  if (const char* member = difference(inputs_, {cascades_.data(), cascade_count_}, inputs); member != nullptr) {
    return invalid("FrameInputs::" + std::string(member) +
                   " of FramePart::second differs from that of the first part, " + frame_of(inputs_) +
                   "; expected the same inputs for both parts");
  }
  return {};
}

Result<void> FrameParts::check_between(const char* where) const {
  if (!open_) return {};
  return invalid(std::string(where) + ": the first part of " + frame_of(inputs_) +
                 " has been recorded, but not the second; expected FramePart::second or drop before this call, which "
                 "changes what it reads");
}

void FrameParts::recorded(const FrameInputs& inputs, FramePart part) {
  open_ = part == FramePart::first;
  if (!open_) return;
  inputs_ = inputs;
  inputs_.cascades = {};
  cascade_count_ = inputs.cascades.size();
  std::copy(inputs.cascades.begin(), inputs.cascades.end(), cascades_.begin());
}

}  // namespace tyndall
