// Tyndall records outdoor light scattering into your command buffer, as compute dispatches: sky, aerial perspective and
// light shafts, from your colour, depth and shadow cascades.
//
// Conventions: SI units. World space is right-handed: x east, y up, z south; y = 0 at sea level below the origin,
// planet centre at (0, -planet.radius_m, 0). Matrices are column-major. Radiance has the caller's unit: that of
// Sun::irradiance, per steradian.
// Ownership: everything in DeviceInfo and FrameInputs is borrowed. The effect never transitions the caller's images,
// allocates nothing while recording, starts no threads and has no global state.
// Threads: use an Effect from one thread at a time. Different effects are independent.
// Errors: functions return a Result. They never throw, print or exit, and the callbacks of DeviceInfo must not throw. A
// function that returns an error has changed nothing, and the same call can be repeated.
// Submission: submit the commands of every record function that succeeded, in the order of recording. The effect counts
// them as done; after dropping them, create it again.
//
// A frame:   effect.set_params(params);            // after they have changed
//            effect.record_precompute(cmd);        // until its progress is complete
//            ... draw the shadow cascades and the opaque scene ...
//            effect.record(cmd, inputs);           // output = the scene seen through the atmosphere
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tyndall/export.h"
#include "tyndall/memory.hpp"
#include "tyndall/params.hpp"
#include "tyndall/result.hpp"
#include "tyndall/types.hpp"

namespace tyndall {

constexpr std::uint32_t kMaxCascades = 8;
constexpr std::uint32_t kMaxViews = 8;

enum class Severity : std::uint32_t { info, warning };

// The Vulkan device, borrowed for the effect's whole life.
struct DeviceInfo {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
  const VkAllocationCallbacks* allocator = nullptr;
  VkPipelineCache pipeline_cache = VK_NULL_HANDLE;
  // Receives remarks on suspicious inputs; see EffectDesc::check_inputs.
  void (*message)(void* user, Severity severity, std::string_view text) = nullptr;
  void* message_user = nullptr;
  // For shader development: returns SPIR-V to use in place of the built-in shader of that name, or an empty span. The
  // code must stay valid until the pipelines are made, and have the same bindings. The format of its output is changed
  // to that of the effect. Do not cache the tables that such shaders make under table_key().
  std::span<const std::uint32_t> (*replace_shader)(void* user, std::string_view name) = nullptr;
  void* replace_shader_user = nullptr;
  // The allocator for all images and buffers. Without it, each has an allocation of the device.
  MemoryCallbacks memory = {};
};

// The requirements for a device: Vulkan 1.3 and these extensions (none at present), but no optional feature. Devices
// with VK_KHR_portability_subset (MoltenVK) are the exception: its features mutableComparisonSamplers and events must
// be enabled. A queue with compute suffices.
struct Requirements {
  std::uint32_t api_version;
  std::span<const char* const> device_extensions;
};
[[nodiscard]] TYNDALL_API Requirements requirements();

// The format of the output. Radiance beyond 65504, the largest number in half precision, is clamped to it in rgba16f.
enum class OutputFormat : std::uint32_t { rgba16f, rgba32f };

class Effect;

// Settings of an effect. set_limits(), set_shadow_colors() and set_params() change some of them later.
struct EffectDesc {
  VkExtent2D max_extent = {1920, 1080};  // [1; 16384] px - largest FrameInputs::extent
  // [1; 8] - frames recorded before the first completes. record() fails if the commands of the frame that is
  // frames_in_flight earlier have not completed, because both use the same constants and descriptor sets.
  std::uint32_t frames_in_flight = 2;
  // [1; 8] - pictures of one frame: eyes of a stereo pair, a split screen, a reflection. All may be recorded before any
  // completes. They share buffers, so their commands run one after the other.
  std::uint32_t views = 1;
  OutputFormat output_format = OutputFormat::rgba16f;
  float sky_depth = 0.0F;  // 0 or 1 - depth where nothing was drawn; 0 with reversed Z
  // Format of FrameInputs::depth, used by check_inputs only: with 16 bits, distant ground reads as sky.
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  bool shadow_depth_reversed = false;  // 1 is nearest to the sun in shadow maps
  // Capacity of epipolar sampling: [1; 8] cascades that it can march, and [1; 16384] texels of width of a shadow map
  // that its min/max trees can cover. Wider maps work, but what lies beyond is read texel by texel.
  std::uint32_t max_cascades = 4;
  std::uint32_t max_shadow_resolution = 1024;
  bool shadow_colors = false;  // frames may have FrameInputs::shadow_colors; needs more pipelines
  bool clouds = false;         // frames may have FrameInputs::clouds; needs more pipelines
  bool timings = false;        // measure each pass with timestamps, which the queue must have
  bool counters = false;       // count what the passes do; see Effect::counters()
  // [1; 64] - threads that create pipelines in create(), set_params() and prepare_pipelines(), including the calling
  // one. With more than one, replace_shader is called by several threads at once.
  std::uint32_t pipeline_threads = 1;
  // Leaves the pipelines that build tables, about twelve, to the first record_precompute() of a build, which then also
  // allocates descriptor sets. For programs that usually load the tables.
  bool table_pipelines_later = false;
  // Reports suspicious inputs of a frame through DeviceInfo::message. Each is reported once per view, and again only
  // after a frame in which it was right.
  bool check_inputs = true;
  // Shares the tables of this effect, of the same VkDevice, instead of having its own. Both effects then have the same
  // rights: the tables exist until the last effect that uses them is destroyed, and each effect can build, load and
  // save them. The parameters that determine the tables must agree: planet.*, atmosphere.*, tables.* and
  // scattering.color; otherwise create() returns an error. To change them, call set_params() of each effect; the first
  // call begins the build. record() returns an error if the parameters of its effect belong neither to the finished
  // tables nor to those that are being built. The effects count as one object: use them from one thread at a time, and
  // submit their commands to the same queue. DeviceInfo::memory, message and replace_shader of the effect that made the
  // tables must outlive all effects that share them. The memory of the tables is part of one effect's memory() and
  // resources(). query_memory() omits it if this is not null. Read by create() and query_memory() only; null in desc().
  const Effect* tables_of = nullptr;
};

// Bytes of device memory, equal to what create() allocates or requests from DeviceInfo::memory. `persistent` is in use
// for the effect's whole life. `transient` is freed when the tables are built and the frames then in flight have
// completed. `host` is host-visible. While tables are rebuilt, `transient` includes the new ones, and the old ones stay
// in use.
struct MemoryUsage {
  VkDeviceSize persistent = 0;
  VkDeviceSize transient = 0;
  VkDeviceSize host = 0;
};
// Returns the memory that an effect would use. Allocates nothing.
[[nodiscard]] TYNDALL_API Result<MemoryUsage> query_memory(const DeviceInfo& device, const EffectDesc& desc,
                                                           const Params& params = {});

// An image of the caller, and its layout while the effect runs.
struct Texture {
  VkImageView view = VK_NULL_HANDLE;
  VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL;  // one in which it can be sampled
  // [>= 0] px - where the rectangle of FrameInputs::extent begins in color, depth and output, which may be larger.
  // Nothing outside the rectangle is read or written. Must be 0 for shadow maps.
  VkOffset2D offset = {0, 0};
};

// One orthographic shadow map, a layer of FrameInputs::shadow_maps.
struct Cascade {
  Mat4 shadow_from_world;  // affine, along the sun's rays, to (u, v, depth), each 0 to 1 inside the map
  float near_m = 0.0F;     // [m] - the map was drawn for view depths from near_m to far_m
  float far_m = 0.0F;      // [m] - the map is used for view depths from the previous cascade's far_m to this one
};

// A perspective camera. Errors: a world_from_view that is transposed, scaled or sheared; a projection that is
// orthographic, looks down +z, or contradicts EffectDesc::sky_depth.
struct Camera {
  Mat4 world_from_view;  // rigid; the view looks down -z, x right, y up
  Mat4 clip_from_view;   // to Vulkan clip space, depth 0 to 1; may be infinite, reversed or off-centre
};

struct Sun {
  Vec3 direction_to_sun = {0.0F, 1.0F, 0.0F};  // unit length, towards the sun
  Vec3 irradiance = Vec3(10.0F);         // [>= 0] - above the atmosphere, at normal incidence; times scattering.scale
  float angular_radius_rad = 0.004655F;  // [rad] - for tyndall_sun_irradiance() of shaders; frames do not depend on it
};

// Clouds or fog of the caller between the sun and the scene, as a layer that is seen from the sun (docs/clouds.md).
struct Clouds {
  // 2D image: red, green and blue are the fraction of sunlight that passes the layer, linear, 1 = clear. Alpha is the
  // depth of the layer in this map, at least in half floats: what is farther from the sun is darkened. Nothing is
  // darkened outside of the map. A null view: no clouds. Needs EffectDesc::clouds.
  Texture map;
  Mat4 map_from_world;  // affine, along the sun's rays, to (u, v, depth); depth grows away from the sun
};

// The inputs of one frame. All images must be visible to compute shaders when the commands execute.
struct FrameInputs {
  VkExtent2D extent = {0, 0};  // [1; max_extent] px - size of the picture
  Texture color;               // linear radiance of the opaque scene, and of what is outside the atmosphere (stars)
  Texture depth;               // device depth; sampled as float
  Texture shadow_maps;         // 2D array of depth images, one layer per cascade; null without cascades
  // 2D array of the same size and layers: transmittance of glass towards the sun, linear, 1 = clear; null for none.
  // Needs EffectDesc::shadow_colors. It is filtered like the shadow comparison, so draw glass one texel wider than its
  // opening. The colour does not matter where the shadow map is in shadow.
  Texture shadow_colors;
  // Alpha of shadow_colors is the depth of the glass nearest to the sun, in the convention of shadow_maps and at least
  // in half floats: light is not coloured between sun and glass. Otherwise colour applies along the whole lit path.
  bool shadow_color_depths = false;
  std::uint32_t shadow_resolution = 0;      // texels - width and height of a layer
  std::span<const Cascade> cascades;        // at most kMaxCascades, from near to far
  std::uint32_t first_marched_cascade = 0;  // light shafts start with this one, which must include the camera
  Camera camera;
  Sun sun;
  Texture output;  // written, in layout GENERAL; must not be the view of color or depth
  // Number of the frame: one more for each frame. It selects the slot of the frame's constants and descriptor sets, so
  // record() fails if commands with the same slot have not completed.
  std::uint64_t frame_index = 0;
  std::uint32_t view = 0;  // [0; EffectDesc::views)
  // [<= 0] m - altitude of the lowest land around the camera. A ray on which nothing is drawn ends on a sphere, which
  // also forms the horizon. The sphere is at this altitude or, if that is lower and the camera is below sea level, at
  // twice the camera's depth.
  float lowest_ground_m = 0.0F;
  Clouds clouds;
};

// The parts in which Effect::record() can record a frame. Of the caller's images, `first` reads FrameInputs::depth
// only, and `second` uses all of them. `drop` ends a frame that will not get its second part: it records no pass, and
// FrameInputs::output stays as it is. It needs FrameInputs::frame_index and view only.
enum class FramePart : std::uint32_t { whole, first, second, drop };

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

// Work done by the passes of a frame.
struct Counters {
  std::uint64_t samples_marched = 0;  // rays marched: epipolar samples, or pixels with brute force
  std::uint64_t march_steps = 0;      // segments of rays classified as lit or shadowed
  std::uint64_t tree_nodes_visited = 0;
  std::uint64_t shadow_map_fetches = 0;  // comparisons of four texels, without those that build the trees
  std::uint64_t pixels_corrected = 0;
};

struct PassTiming {
  const char* name;
  double gpu_ms;
};

// Look-up tables for shading the opaque scene: RGBA16F images in layout GENERAL. Sample them with a linear, clamping
// sampler at light_table_uv() of tyndall/light_tables.glsl, and multiply red, green and blue by sun.irradiance *
// scattering.scale. With scattering.color = spectral in table_params(), they include the colour of the sun; the colour
// and alpha together determine the light at the four wavelengths. Valid once record_precompute() is complete; its
// commands write them in COMPUTE_SHADER / SHADER_WRITE.
struct LightTables {
  VkImageView sun_transmittance = VK_NULL_HANDLE;  // from the sun to a point; 0 below the horizon
  VkImageView sky_irradiance = VK_NULL_HANDLE;     // on a horizontal surface under an open sky
};

// A scattering table: an RGBA16F 3D image in layout GENERAL, with tables.size as its extent. Axes: altitude; view
// zenith angle; sun zenith angle (fast) and the angle between view and sun (slow) along the third.
struct Table {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkExtent3D extent = {0, 0, 0};
};
// shaders/lib/table_values.glsl defines the texels' values, and shaders/lib/table_mapping.glsl their coordinates.
struct ScatteringTables {
  Table single_rayleigh;
  Table single_mie;
  Table high_orders;
};

// Returns the colour of the sun above the atmosphere, per sun.irradiance: white with scattering.color = rgb, and the
// linear Rec. 709 colour of its spectrum, with the luminance 1, with spectral. For callers that draw the sun's disc.
// With an effect, pass table_params(effect).
[[nodiscard]] TYNDALL_API Vec3 sun_color(const Params& params);

struct AtmosphereImages;

// Returns the parameters of the tables in use: params() with the planet.*, atmosphere.*, tables.* and scattering.color
// for which the tables were last completed. They differ from params() while tables are being built. Pass them to
// sun_color() and atmosphere_constants(), and decode the tables by their scattering.color.
[[nodiscard]] TYNDALL_API Params table_params(const Effect& effect);
// Returns how the next picture represents light. If pictures read no tables (scattering.medium = homogeneous, or
// scattering.single = integration or none with multiple = none), it is params().scattering.color, otherwise that of
// table_params().
[[nodiscard]] TYNDALL_API ColorMode picture_color(const Effect& effect);

class TYNDALL_API Effect {
 public:
  // Allocates all memory and makes the pipelines that `params` need. Tables are built by record_precompute().
  static Result<Effect> create(const DeviceInfo& device, const EffectDesc& desc, const Params& params);
  // A moved-from Effect can be destroyed or assigned to. Its functions return an error, or, without a Result, null
  // handles, zeros, empty strings and empty spans.
  Effect(Effect&&) noexcept;
  // Destroys the previous effect, as the destructor does.
  Effect& operator=(Effect&&) noexcept;
  // Destroys everything immediately. All recorded commands must have completed; check_inputs reports frames whose
  // commands have not.
  ~Effect();

  // Applies new parameters. An error names the first that is out of range. Allocates the memory for tables that
  // become stale; the old tables stay in use until record_precompute() has completed the new ones, and only then do the
  // views of light_tables() and scattering_tables() change. Makes missing pipelines, about 0.1 s each on a CPU device.
  // After scattering.color has changed from spectral to rgb, the larger buffers of spectral stay in use until the new
  // tables are complete; the next call after that frees them, also with the same parameters.
  // With `desc`, also changes EffectDesc::clouds and what set_shadow_colors() and set_limits() change, in one step: all
  // or nothing. Its other fields must equal those of desc().
  Result<void> set_params(const Params& params, const std::optional<EffectDesc>& desc = std::nullopt);
  // Returns the parameters in use.
  [[nodiscard]] const Params& params() const;
  // Makes at most `budget` of the pipelines that other parameters would need, so that switching costs nothing.
  Result<Progress> prepare_pipelines(std::uint32_t budget = UINT32_MAX);

  // Changes EffectDesc::shadow_colors, and makes the pipelines that the parameters then need.
  Result<void> set_shadow_colors(bool shadow_colors);
  // Changes these limits of EffectDesc. Frees memory once the commands in flight have completed.
  Result<void> set_limits(VkExtent2D max_extent, std::uint32_t max_cascades, std::uint32_t max_shadow_resolution);
  // Returns the settings in use.
  [[nodiscard]] const EffectDesc& desc() const;

  // Returns how many slices of the tables have been recorded.
  [[nodiscard]] Progress precompute_progress() const;
  // Records at most `budget` slices of the stale tables, by default all of them. Records nothing when all are complete.
  // A slice has at most 131 072 invocations, whatever tables.size is. If frames are drawn while tables are built, 8
  // slices per frame are a suitable budget for integrated GPUs.
  Result<Progress> record_precompute(VkCommandBuffer cmd, std::uint32_t budget = UINT32_MAX);

  // Returns a key for caching finished tables: printable text of several lines that describes medium, table shape,
  // shaders, library version, device and driver. Equal keys mean equal tables, byte for byte. The key is empty if the
  // host is out of memory.
  [[nodiscard]] std::string table_key() const;
  // Returns the size of all tables [bytes]: single_rayleigh, single_mie, high_orders, sun_transmittance and
  // sky_irradiance, one after another, without padding.
  [[nodiscard]] VkDeviceSize table_bytes() const;
  // Records a copy of the finished tables to `buffer` (TRANSFER_DST) at `offset` [bytes], a multiple of 8. An error
  // unless precompute_progress() is complete. The copy is a TRANSFER / TRANSFER_WRITE. Saving and loading are also
  // errors if an effect that shares the tables (EffectDesc::tables_of) has set other parameters for them.
  Result<void> record_save_tables(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset = 0);
  // Records a copy of tables that were saved under the same table_key(), instead of building them;
  // precompute_progress() is then complete. `buffer` (TRANSFER_SRC) must be visible to TRANSFER / TRANSFER_READ and
  // exist until the commands have completed. Its contents are not checked. Synchronise as after record_precompute().
  // Does nothing when complete.
  Result<void> record_load_tables(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset = 0);

  // Records the effect: output = color * transmittance + in-scattered light. Inputs must be visible to COMPUTE_SHADER /
  // SHADER_READ in the layouts that they state. Writes output in COMPUTE_SHADER / SHADER_WRITE. Changes the pipeline,
  // descriptor set 0 and the push constants of the compute bind point, as record_precompute() does, and no other state.
  // A frame can be recorded in two parts, with the same inputs and to any command buffers that execute one after the
  // other. The commands of the first part read the depth and write only to memory of the effect, so they can run while
  // shadow maps and colour are drawn. The picture is the same, byte for byte. The second part, or FramePart::drop, must
  // follow before the next frame or view, and before calls that change parameters, limits or tables; they are errors in
  // between.
  Result<void> record(VkCommandBuffer cmd, const FrameInputs& inputs, FramePart part = FramePart::whole);

  // Return the tables in use. Views change only when record_precompute() or record_load_tables() completes new ones.
  [[nodiscard]] LightTables light_tables() const;
  [[nodiscard]] ScatteringTables scattering_tables() const;
  // Returns the memory in use now.
  [[nodiscard]] MemoryUsage memory() const;
  // Returns the resources that make up memory().persistent. The span is valid until the next call.
  std::span<const ResourceMemory> resources();
  // Returns the counters of a frame whose commands have completed; zeros without EffectDesc::counters.
  [[nodiscard]] Counters counters(std::uint64_t frame_index, std::uint32_t view = 0) const;
  // Returns the times of the passes of a frame whose commands have completed; empty without EffectDesc::timings. The
  // span is valid until the next call. A pass that is recorded several times has several entries. On GPUs, the first
  // entry is "effect", the time of all passes together; do not add it to the others. A frame in two parts has one
  // before the passes of each part.
  std::span<const PassTiming> timings(std::uint64_t frame_index, std::uint32_t view = 0);
  // Returns the times of the stages of the last build of tables, once its commands have completed.
  std::span<const PassTiming> precompute_timings();

 private:
  friend TYNDALL_API AtmosphereImages atmosphere_images(const Effect& effect,
                                                        std::uint32_t view);  // see atmosphere.hpp
  friend TYNDALL_API Params table_params(const Effect& effect);
  friend TYNDALL_API ColorMode picture_color(const Effect& effect);
  friend class SkyProbe;
  struct State;
  explicit Effect(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tyndall
