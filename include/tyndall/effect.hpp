// Tyndall records outdoor light scattering into your command buffer: sky, aerial perspective and light
// shafts, from your colour, depth and shadow cascades, as compute dispatches.
//
// Conventions: SI units; right-handed world, x east, y up, z south; y = 0 at sea level below the origin,
// planet centre at (0, -planet.radius_m, 0); matrices are column-major; directions to the sun point
// TOWARDS it. Radiance is in the caller's unit: that of sun.irradiance, per steradian.
// Ownership: everything in DeviceInfo and FrameInputs is borrowed. The effect transitions none of the
// caller's images, allocates nothing while recording, starts no threads and keeps no global state.
// Threads: one Effect, one thread at a time; different Effects are independent.
// Errors come back as Result; nothing throws, prints or exits, and no callback of DeviceInfo may throw. A function that
// returns an error has changed nothing: frames are drawn as before, memory() and the progress of the tables are what
// they were, and the same call can be repeated.
//
// A frame:   effect.set_params(params);                       // when they changed
//            effect.record_precompute(cmd);                   // until progress is complete
//            ... draw shadow cascades and the opaque scene ...
//            effect.record(cmd, inputs);                      // output = scene seen through the air
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "tyndall/params.hpp"
#include "tyndall/result.hpp"
#include "tyndall/types.hpp"

namespace tyndall {

constexpr std::uint32_t kMaxCascades = 8;
constexpr std::uint32_t kMaxViews = 8;

enum class Severity : std::uint32_t { info, warning };

// The device that the effect works on, borrowed for the effect's whole life.
struct DeviceInfo {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
  const VkAllocationCallbacks* allocator = nullptr;
  VkPipelineCache pipeline_cache = VK_NULL_HANDLE;
  // Plain-language remarks about suspicious inputs; see EffectDesc::check_inputs.
  void (*message)(void* user, Severity severity, std::string_view text) = nullptr;
  void* message_user = nullptr;
  // For work on the shaders while a program runs: SPIR-V to use in place of the built-in shader of that name, valid
  // until the pipelines are made, or an empty span. Its bindings must be those of the built-in one. Tables that
  // other shaders made do not belong under table_key().
  std::span<const std::uint32_t> (*replace_shader)(void* user, std::string_view name) = nullptr;
  void* replace_shader_user = nullptr;
};

// What a device must have been created with: Vulkan 1.3 and these extensions, no optional feature.
struct Requirements {
  std::uint32_t api_version;
  std::span<const char* const> device_extensions;
};
[[nodiscard]] Requirements requirements();

enum class OutputFormat : std::uint32_t { rgba16f, rgba32f };

// What is fixed when the effect is created.
struct EffectDesc {
  VkExtent2D max_extent = {1920, 1080};  // [1; 16384] px - largest extent that record() will be given
  std::uint32_t frames_in_flight = 2;    // [1; 8] - frames recorded before the first has completed
  // [1; 8] - pictures of one frame: the eyes of a stereo pair, halves of a split screen, a reflection. Each has
  // constants of its own, so that all may be recorded before any has completed; they share the rest, and commands run
  // one after the other.
  std::uint32_t views = 1;
  OutputFormat output_format = OutputFormat::rgba16f;
  float sky_depth = 0.0F;  // 0 or 1 - device depth where nothing was drawn; 0 with reversed Z
  // Format of FrameInputs::depth, for check_inputs alone: with 16 bits distant ground reads as sky. UNDEFINED: not
  // stated.
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  bool shadow_depth_reversed = false;  // shadow maps hold 1 nearest to the sun
  // With technique = epipolar: cascades that the air is marched through [1; 8], and texels of a shadow map's side
  // that the trees have room for [1; 16384]; wider maps work, but what is beyond is read texel by texel.
  std::uint32_t max_cascades = 4;
  std::uint32_t max_shadow_resolution = 1024;
  bool shadow_colors = false;  // frames may have FrameInputs::shadow_colors: pipelines for these are made as well
  bool timings = false;        // measure each pass with timestamps
  bool counters = false;       // count what the passes do; see Effect::counters()
  // Says through DeviceInfo::message what is suspicious in the inputs of a frame: once, and again only after it was
  // right.
  bool check_inputs = true;
};

// Bytes. `persistent` is there for the effect's whole life; `transient` is freed when tables have been built
// and the frames that were in flight then are done (until it is, a rebuild also keeps the tables that are in
// use); `host` is host-visible. Equal to what create() allocates.
struct MemoryUsage {
  VkDeviceSize persistent = 0;
  VkDeviceSize transient = 0;
  VkDeviceSize host = 0;
};
// Memory that an effect would take, asked before it is created. Allocates nothing.
[[nodiscard]] Result<MemoryUsage> query_memory(const DeviceInfo& device, const EffectDesc& desc,
                                               const Params& params = {});

// An image of the caller's and the layout that it is in while the effect runs.
struct Texture {
  VkImageView view = VK_NULL_HANDLE;
  VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL;  // one in which it can be sampled
  // [>= 0] px - where the rectangle of FrameInputs::extent begins, for color, depth and output: each may be larger than
  // the rectangle, and only the rectangle is read or written. Shadow maps are used whole: theirs must be 0.
  VkOffset2D offset = {0, 0};
};

// One orthographic shadow map, a layer of FrameInputs::shadow_maps.
struct Cascade {
  Mat4 shadow_from_world;  // affine, to (u, v, depth), each 0 to 1 inside the map; along the sun's direction
  float near_m = 0.0F;     // [m] - view-space depths that this cascade is meant for
  float far_m = 0.0F;
};

// Perspective only. What would draw garbage is an error: a world_from_view that is transposed, scaled or sheared, a
// projection that is orthographic, looks down +z or contradicts EffectDesc::sky_depth.
struct Camera {
  Mat4 world_from_view;  // rigid; the view looks down -z, x right, y up
  Mat4 clip_from_view;   // Vulkan clip space, depth 0 to 1; infinite and reversed projections welcome
};

struct Sun {
  Vec3 direction_to_sun = {0.0F, 1.0F, 0.0F};  // unit length
  Vec3 irradiance = Vec3(10.0F);  // [>= 0] - above the atmosphere, at normal incidence; times scattering.scale
  float angular_radius_rad = 0.004655F;
};

// What one frame is made from. All images must be visible to compute shaders when the commands execute.
struct FrameInputs {
  VkExtent2D extent = {
      0, 0};      // [1; max_extent] px - of the picture, a rectangle of color, depth and output from their offsets on
  Texture color;  // linear radiance of the opaque scene and what is behind the air (disc, stars)
  Texture depth;  // device depth; sampled as float
  Texture shadow_maps;  // 2D array of depth images, one layer per cascade; null without cascades
  // 2D array like shadow_maps, same size and layers: what glass leaves of the sun's light, linear, 1 = clear; with
  // EffectDesc::shadow_colors. Filtered like the shadow comparison and by itself, so that glass should go on for a
  // texel under its frame; deeper in shadow its colour does not matter. Null: no colour.
  Texture shadow_colors;
  // Alpha of shadow_colors is the depth of the glass nearest to the sun, as shadow_maps would have it, in half floats
  // or better: the air between sun and glass is not coloured. Without, the colour holds along the whole lit path.
  bool shadow_color_depths = false;
  std::uint32_t shadow_resolution = 0;      // texels - width and height of a layer
  std::span<const Cascade> cascades;        // at most kMaxCascades, from near to far
  std::uint32_t first_marched_cascade = 0;  // the air is marched from this one on; it must start at the camera
  Camera camera;
  Sun sun;
  Texture output;  // written; its layout must be GENERAL; not the same view as color or depth
  // Consecutive; selects the in-flight slot. The same index and view again is an error until the commands that were
  // recorded first have completed: both would be drawn with the second camera.
  std::uint64_t frame_index = 0;
  std::uint32_t view = 0;  // below EffectDesc::views
};

struct Progress {
  std::uint32_t done = 0;
  std::uint32_t total = 0;
  [[nodiscard]] bool complete() const { return done == total; }
};

// Device memory of one resource of the effect.
struct ResourceMemory {
  const char* name;
  VkDeviceSize bytes;
};

// What the passes of a frame have done.
struct Counters {
  std::uint64_t samples_marched = 0;  // rays: epipolar samples, or pixels with brute force
  std::uint64_t march_steps = 0;      // stretches of rays that were found lit or dark
  std::uint64_t tree_nodes_visited = 0;
  std::uint64_t shadow_map_fetches = 0;  // comparisons, of four texels each; without those that build trees
  std::uint64_t pixels_corrected = 0;
};

struct PassTiming {
  const char* name;
  double gpu_ms;
};

// Small tables for shading the opaque scene by the light that the air leaves and sends: RGBA16F images
// in GENERAL layout, to be sampled linearly and clamped at light_table_uv() of tyndall/light_tables.glsl.
// Multiply by sun.irradiance * scattering.scale. Valid once record_precompute() is complete; its commands
// write them in COMPUTE_SHADER / SHADER_WRITE.
struct LightTables {
  VkImageView sun_transmittance = VK_NULL_HANDLE;  // of the sun's light to a point, 0 below the horizon
  VkImageView sky_irradiance = VK_NULL_HANDLE;     // on a horizontal surface under an open sky
};

// A scattering table: a 3D image, RGBA16F in GENERAL layout, with tables.size as its extent: altitude, view zenith
// angle, and sun zenith angle (fast) with the angle between view and sun (slow) along the third axis.
struct Table {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkExtent3D extent = {0, 0, 0};
};
// What the texels hold is told in shaders/lib/table_values.glsl, where they lie in shaders/lib/table_mapping.glsl.
struct ScatteringTables {
  Table single_rayleigh;
  Table single_mie;
  Table high_orders;
};

class Effect {
 public:
  // Creates all memory, and the pipelines that `params` need. The tables are not built yet: see record_precompute().
  static Result<Effect> create(const DeviceInfo& device, const EffectDesc& desc, const Params& params);
  // An Effect that was moved from can be destroyed or assigned to. Its functions return an error, or, where they return
  // no Result, default values: null handles, zeros, empty strings and spans.
  Effect(Effect&&) noexcept;
  Effect& operator=(Effect&&) noexcept;
  // Destroys everything at once. All commands that the effect recorded must have completed before; the same holds for
  // the effect that is assigned to. With check_inputs, DeviceInfo::message reports it when those of record() have not.
  ~Effect();

  // Checks and takes over new parameters: an error names the first that is out of range. Tables that become stale are
  // rebuilt by record_precompute(), for which memory is allocated here; the finished ones stay in use until then. Views
  // of light_tables() and scattering_tables() change when record_precompute() reports the build complete.
  // Pipelines that were not needed before are made here, which takes about 0.1 s each on a CPU device, unless
  // prepare_pipelines() has made them. record() makes none.
  Result<void> set_params(const Params& params);
  [[nodiscard]] const Params& params() const;
  // Makes at most `budget` of the pipelines that other parameters would need, so that switching costs nothing. What one
  // set of parameters needs at once (unwarping in a medium, scaling up) counts as one.
  Result<Progress> prepare_pipelines(std::uint32_t budget = UINT32_MAX);

  // Takes over another EffectDesc::shadow_colors; the pipelines that the parameters then need are made here.
  Result<void> set_shadow_colors(bool shadow_colors);

  // Takes over other limits than those of EffectDesc, as set_params() takes over parameters. What commands in flight
  // use is freed when they are done.
  Result<void> set_limits(VkExtent2D max_extent, std::uint32_t max_cascades, std::uint32_t max_shadow_resolution);

  // Takes over parameters together with what set_shadow_colors() and set_limits() take from `desc`: all of it or
  // nothing. The other fields of `desc` must be those of desc().
  Result<void> set_params(const Params& params, const EffectDesc& desc);
  [[nodiscard]] const EffectDesc& desc() const;

  [[nodiscard]] Progress precompute_progress() const;
  // Records at most `budget` slices of the building of stale tables. Nothing to do: records nothing.
  Result<Progress> record_precompute(VkCommandBuffer cmd, std::uint32_t budget = UINT32_MAX);

  // Finished tables can be kept, on disk for instance, and loaded instead of being built again.
  // table_key() is printable text of several lines: two effects whose keys are equal have the same tables, byte for
  // byte. It names the medium, the tables' shape, their shaders, the library's version, the device and its driver.
  // It is empty when the host is out of memory.
  // table_bytes() is the size of all tables of params(): one after another, texel by texel without padding, in the
  // order single_rayleigh, single_mie, high_orders, sun_transmittance, sky_irradiance.
  [[nodiscard]] std::string table_key() const;
  [[nodiscard]] VkDeviceSize table_bytes() const;
  // Records the copy of the tables to `buffer` (VK_BUFFER_USAGE_TRANSFER_DST_BIT) from `offset` on, a multiple of 8
  // [bytes]; an error unless precompute_progress() is complete. After it the buffer is written by TRANSFER /
  // TRANSFER_WRITE: before the host reads it, make that visible to HOST / HOST_READ and wait for the commands.
  Result<void> record_save_tables(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset = 0);
  // Records the loading of what such a buffer (VK_BUFFER_USAGE_TRANSFER_SRC_BIT) holds, saved under the same
  // table_key(), in place of what is left to be built: precompute_progress() is then complete. Nothing to do: records
  // nothing. Before it make the buffer visible to TRANSFER / TRANSFER_READ, and keep it until the commands have
  // completed; after it synchronise as after record_precompute(). What the buffer holds is not checked: that
  // is for who kept it.
  Result<void> record_load_tables(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset = 0);

  // Records the effect: output = color seen through the air, plus the light that the air scatters.
  // Before it, make the inputs visible to COMPUTE_SHADER / SHADER_READ in the layouts that they state;
  // after it, the output is written by COMPUTE_SHADER / SHADER_WRITE.
  Result<void> record(VkCommandBuffer cmd, const FrameInputs& inputs);

  [[nodiscard]] LightTables light_tables() const;
  [[nodiscard]] ScatteringTables scattering_tables() const;
  [[nodiscard]] MemoryUsage memory() const;
  // The resources that memory().persistent consists of; the span is valid until the next call.
  std::span<const ResourceMemory> resources();
  // What a frame whose commands have completed has done; zeros without EffectDesc::counters.
  [[nodiscard]] Counters counters(std::uint64_t frame_index, std::uint32_t view = 0) const;
  // Times of the passes of a frame whose commands have completed, with EffectDesc::timings. The span is
  // valid until the next call.
  std::span<const PassTiming> timings(std::uint64_t frame_index, std::uint32_t view = 0);
  // Times of the stages of the last build of tables, all of whose commands have completed; likewise.
  std::span<const PassTiming> precompute_timings();

 private:
  struct State;
  explicit Effect(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tyndall
