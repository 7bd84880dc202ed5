// The images and buffers of the effect. A resource has the same name in C++, in memory reports and debuggers, and as a
// binding in GLSL, where buffer blocks append "_block". resources.def is the list. The sizes of buffers are pure
// functions of the settings.
#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "tyndall/effect.hpp"

namespace tyndall {

// The kind of device for which a variant of the passes of a frame is written
// (docs/adr/0011-constants-on-cpu-devices.md).
enum class Target : std::uint8_t { cpu, gpu };

enum class Resource : std::uint8_t {
#define RESOURCE(name, lifetime, format, resolution) name,
#define FRAME_BUFFER(name, format, resolution, cause) name,
#include "effect/resources.def"
#undef RESOURCE
#undef FRAME_BUFFER
  none
};
constexpr std::size_t kResources = static_cast<std::size_t>(Resource::none);
[[nodiscard]] constexpr std::size_t index_of(Resource resource) { return static_cast<std::size_t>(resource); }

// The owner of a resource, and how long its contents are valid.
enum class Lifetime : std::uint8_t {
  constants,  // written by the host
  caller,     // an input or the output of a frame
  tables,     // filled by a build, read by frames
  frame,      // written and read within one frame; the next frame reuses the memory
  probe,      // written by updates of a sky probe, whose coefficients the caller reads
  build,      // written and read within one build of the tables, and freed when it is complete
  chosen      // a placeholder for a resource that the step chooses
};

struct ResourceInfo {
  const char* name;
  Lifetime lifetime;
  const char* format;      // of a texel or an element, for the documentation
  const char* resolution;  // number of texels or elements, for the documentation
  const char* cause;       // of frame buffers: the settings that determine the size, for messages
};

inline constexpr ResourceInfo kResourceInfo[kResources] = {
#define RESOURCE(name, lifetime, format, resolution) {#name, Lifetime::lifetime, format, resolution, ""},
#define FRAME_BUFFER(name, format, resolution, cause) {#name, Lifetime::frame, format, resolution, cause},
#include "effect/resources.def"
#undef RESOURCE
#undef FRAME_BUFFER
};
[[nodiscard]] constexpr const ResourceInfo& info_of(Resource resource) { return kResourceInfo[index_of(resource)]; }
[[nodiscard]] constexpr const char* name_of(Resource resource) { return info_of(resource).name; }

// The buffers of epipolar sampling, which the effect allocates one by one.
constexpr std::size_t kFirstFrameBuffer = index_of(Resource::slices);
constexpr std::size_t kFrameBuffers = index_of(Resource::downscaled_inscattering) + 1 - kFirstFrameBuffer;
[[nodiscard]] constexpr Resource frame_buffer(std::size_t i) { return static_cast<Resource>(kFirstFrameBuffer + i); }
constexpr VkBufferUsageFlags kFrameBufferUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

// The size of each frame buffer in the order of resources.def [bytes]. 0: no step uses it with these settings.
struct FrameBufferSizes {
  std::array<VkDeviceSize, kFrameBuffers> bytes = {};
  [[nodiscard]] VkDeviceSize operator[](Resource resource) const {
    return bytes[index_of(resource) - kFirstFrameBuffer];
  }
};
[[nodiscard]] FrameBufferSizes frame_buffer_sizes(const EffectDesc& desc, const Params& params);

// Returns the capacity of correction_list in pixels.
[[nodiscard]] std::uint32_t correction_capacity(const EffectDesc& desc, const Params& params);
// Returns the maximum number of cells of a slice line in the min/max tree. Other texels of a map are read directly.
[[nodiscard]] std::uint32_t tree_cells(const EffectDesc& desc);

// Returns the number of slices, or of samples per slice, for the resolution at which in-scattering is computed.
[[nodiscard]] std::uint32_t downscaled_count(std::uint32_t count, const Params& params);
[[nodiscard]] VkExtent2D downscaled_extent(VkExtent2D extent, const Params& params);
// Returns the number of blocks of unwarp.comp along both axes of a picture.
[[nodiscard]] VkExtent2D unwarp_blocks(VkExtent2D extent, Target target);

}  // namespace tyndall
