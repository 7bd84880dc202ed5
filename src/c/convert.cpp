// Each function names all members of the C++ structure in a structured binding. A new member is therefore an error of
// the compiler until it has been added here and to tyndall.h.
#include "c/convert.hpp"

#include <algorithm>
#include <cstring>

#include "c/handles.hpp"
#include "c/structures.hpp"

namespace tyndall::c {
namespace {

static_assert(TYNDALL_MAX_CASCADES == kMaxCascades && TYNDALL_MAX_VIEWS == kMaxViews);

static_assert(same(TyndallSeverity_info, Severity::info) && same(TyndallSeverity_warning, Severity::warning));
static_assert(same(TyndallOutputFormat_rgba16f, OutputFormat::rgba16f) &&
              same(TyndallOutputFormat_rgba32f, OutputFormat::rgba32f));

static_assert(same(TyndallFramePart_whole, FramePart::whole) && same(TyndallFramePart_first, FramePart::first) &&
              same(TyndallFramePart_second, FramePart::second) && same(TyndallFramePart_drop, FramePart::drop));

const TyndallDeviceInfo& callbacks(void* user) { return *static_cast<const TyndallDeviceInfo*>(user); }

// Text with a final 0, cut off if it does not fit.
struct Line {
  explicit Line(std::string_view from) {
    const std::size_t length = std::min(from.size(), sizeof text - 1);
    std::copy_n(from.data(), length, text);
    text[length] = '\0';
  }
  char text[1024];
};

void call_message(void* user, Severity severity, std::string_view text) {
  const TyndallDeviceInfo& c = callbacks(user);
  c.message(c.message_user, static_cast<TyndallSeverity>(severity), Line(text).text);
}

std::span<const std::uint32_t> call_replace_shader(void* user, std::string_view name) {
  const TyndallDeviceInfo& c = callbacks(user);
  std::size_t words = 0;
  const std::uint32_t* code = c.replace_shader(c.replace_shader_user, Line(name).text, &words);
  if (code == nullptr) return {};
  return {code, words};
}

VkResult call_allocate(void* user, const MemoryRequest& request, MemoryBlock& block) {
  const TyndallDeviceInfo& c = callbacks(user);
  const TyndallMemoryRequest wanted = {request.name,  request.image,  request.buffer,   request.requirements,
                                       request.usage, request.needed, request.preferred};
  TyndallMemoryBlock made = {};
  const VkResult result = c.allocate_memory(c.memory_user, &wanted, &made);
  if (result == VK_SUCCESS) block = {made.memory, made.offset, made.mapped, made.user};
  return result;
}

void call_free(void* user, const MemoryBlock& block, VkDeviceSize bytes) {
  const TyndallDeviceInfo& c = callbacks(user);
  const TyndallMemoryBlock freed = {block.memory, block.offset, block.mapped, block.user};
  c.free_memory(c.memory_user, &freed, bytes);
}

TyndallTexture c_texture(const Texture& texture) {
  const auto& [view, layout, offset] = texture;
  return {view, layout, offset};
}

void set(Texture& texture, const TyndallTexture& c) {
  auto& [view, layout, offset] = texture;
  view = c.view;
  layout = c.layout;
  offset = c.offset;
}

TyndallTable c_table(const Table& table) {
  const auto& [image, view, extent] = table;
  return {image, view, extent};
}

Vec3 vec3(const float (&c)[3]) { return {c[0], c[1], c[2]}; }

void set(float (&c)[3], const Vec3& v) {
  c[0] = v.x;
  c[1] = v.y;
  c[2] = v.z;
}

void set(Mat4& m, const float (&c)[16]) { std::copy_n(c, 16, m.m); }
void set(float (&c)[16], const Mat4& m) { std::copy_n(m.m, 16, c); }

void set(Camera& camera, const TyndallCamera& c) {
  auto& [world_from_view, clip_from_view] = camera;
  set(world_from_view, c.world_from_view);
  set(clip_from_view, c.clip_from_view);
}

void set(Cascade& cascade, const TyndallCascade& c) {
  auto& [shadow_from_world, near_m, far_m] = cascade;
  set(shadow_from_world, c.shadow_from_world);
  near_m = c.near_m;
  far_m = c.far_m;
}

void set(Sun& sun, const TyndallSun& c) {
  auto& [direction_to_sun, irradiance, angular_radius_rad] = sun;
  direction_to_sun = vec3(c.direction_to_sun);
  irradiance = vec3(c.irradiance);
  angular_radius_rad = c.angular_radius_rad;
}

void set(Clouds& clouds, const TyndallClouds& c) {
  auto& [map, map_from_world] = clouds;
  set(map, c.map);
  set(map_from_world, c.map_from_world);
}

void set(TyndallSun& c, const Sun& sun) {
  const auto& [direction_to_sun, irradiance, angular_radius_rad] = sun;
  set(c.direction_to_sun, direction_to_sun);
  set(c.irradiance, irradiance);
  c.angular_radius_rad = angular_radius_rad;
}

}  // namespace

DeviceInfo to_cpp(const TyndallDeviceInfo& c) {
  DeviceInfo out;
  auto& [instance, physical_device, device, get_instance_proc_addr, allocator, pipeline_cache, message, message_user,
         replace_shader, replace_shader_user, memory] = out;
  instance = c.instance;
  physical_device = c.physical_device;
  device = c.device;
  get_instance_proc_addr = c.get_instance_proc_addr;
  allocator = c.allocator;
  pipeline_cache = c.pipeline_cache;
  message = c.message != nullptr ? call_message : nullptr;
  replace_shader = c.replace_shader != nullptr ? call_replace_shader : nullptr;
  memory.allocate = c.allocate_memory != nullptr ? call_allocate : nullptr;
  memory.free = c.free_memory != nullptr ? call_free : nullptr;
  message_user = replace_shader_user = memory.user = const_cast<TyndallDeviceInfo*>(&c);
  return out;
}

TyndallDeviceInfo to_c(const DeviceInfo& info) {
  TyndallDeviceInfo out = {};
  out.instance = info.instance;
  out.physical_device = info.physical_device;
  out.device = info.device;
  out.get_instance_proc_addr = info.get_instance_proc_addr;
  out.allocator = info.allocator;
  out.pipeline_cache = info.pipeline_cache;
  return out;
}

EffectDesc to_cpp(const TyndallEffectDesc& c) {
  EffectDesc out;
  auto& [max_extent, frames_in_flight, views, output_format, sky_depth, depth_format, shadow_depth_reversed,
         max_cascades, max_shadow_resolution, shadow_colors, clouds, timings, counters, pipeline_threads,
         table_pipelines_later, check_inputs, tables_of] = out;
  max_extent = c.max_extent;
  frames_in_flight = c.frames_in_flight;
  views = c.views;
  output_format = static_cast<OutputFormat>(c.output_format);
  sky_depth = c.sky_depth;
  depth_format = c.depth_format;
  shadow_depth_reversed = c.shadow_depth_reversed != VK_FALSE;
  max_cascades = c.max_cascades;
  max_shadow_resolution = c.max_shadow_resolution;
  shadow_colors = c.shadow_colors != VK_FALSE;
  clouds = c.clouds != VK_FALSE;
  timings = c.timings != VK_FALSE;
  counters = c.counters != VK_FALSE;
  pipeline_threads = c.pipeline_threads;
  table_pipelines_later = c.table_pipelines_later != VK_FALSE;
  check_inputs = c.check_inputs != VK_FALSE;
  tables_of = c.tables_of != nullptr ? &*c.tables_of->effect : nullptr;
  return out;
}

TyndallEffectDesc to_c(const EffectDesc& desc) {
  const auto& [max_extent, frames_in_flight, views, output_format, sky_depth, depth_format, shadow_depth_reversed,
               max_cascades, max_shadow_resolution, shadow_colors, clouds, timings, counters, pipeline_threads,
               table_pipelines_later, check_inputs, tables_of] = desc;
  TyndallEffectDesc out = {};
  out.max_extent = max_extent;
  out.frames_in_flight = frames_in_flight;
  out.views = views;
  out.output_format = static_cast<TyndallOutputFormat>(output_format);
  out.sky_depth = sky_depth;
  out.depth_format = depth_format;
  out.shadow_depth_reversed = shadow_depth_reversed ? VK_TRUE : VK_FALSE;
  out.max_cascades = max_cascades;
  out.max_shadow_resolution = max_shadow_resolution;
  out.shadow_colors = shadow_colors ? VK_TRUE : VK_FALSE;
  out.clouds = clouds ? VK_TRUE : VK_FALSE;
  out.timings = timings ? VK_TRUE : VK_FALSE;
  out.counters = counters ? VK_TRUE : VK_FALSE;
  out.pipeline_threads = pipeline_threads;
  out.table_pipelines_later = table_pipelines_later ? VK_TRUE : VK_FALSE;
  out.check_inputs = check_inputs ? VK_TRUE : VK_FALSE;
  return out;
}

FrameInputs to_cpp(const TyndallFrameInputs& c, std::array<Cascade, kMaxCascades>& room) {
  FrameInputs out;
  auto& [extent, color, depth, shadow_maps, shadow_colors, shadow_color_depths, shadow_resolution, cascades,
         first_marched_cascade, camera, sun, output, frame_index, view, lowest_ground_m, clouds] = out;
  extent = c.extent;
  set(color, c.color);
  set(depth, c.depth);
  set(shadow_maps, c.shadow_maps);
  set(shadow_colors, c.shadow_colors);
  shadow_color_depths = c.shadow_color_depths != VK_FALSE;
  shadow_resolution = c.shadow_resolution;
  for (std::uint32_t i = 0; i < c.cascade_count; ++i) set(room[i], c.cascades[i]);
  cascades = std::span<const Cascade>(room.data(), c.cascade_count);
  first_marched_cascade = c.first_marched_cascade;
  set(camera, c.camera);
  set(sun, c.sun);
  set(output, c.output);
  frame_index = c.frame_index;
  view = c.view;
  lowest_ground_m = c.lowest_ground_m;
  set(clouds, c.clouds);
  return out;
}

TyndallFrameInputs to_c(const FrameInputs& inputs) {
  const auto& [extent, color, depth, shadow_maps, shadow_colors, shadow_color_depths, shadow_resolution, cascades,
               first_marched_cascade, camera, sun, output, frame_index, view, lowest_ground_m, clouds] = inputs;
  TyndallFrameInputs out = {};
  out.extent = extent;
  out.color = c_texture(color);
  out.depth = c_texture(depth);
  out.shadow_maps = c_texture(shadow_maps);
  out.shadow_colors = c_texture(shadow_colors);
  out.shadow_color_depths = shadow_color_depths ? VK_TRUE : VK_FALSE;
  out.shadow_resolution = shadow_resolution;
  out.first_marched_cascade = first_marched_cascade;
  set(out.camera.world_from_view, camera.world_from_view);
  set(out.camera.clip_from_view, camera.clip_from_view);
  set(out.sun, sun);
  out.output = c_texture(output);
  out.frame_index = frame_index;
  out.view = view;
  out.lowest_ground_m = lowest_ground_m;
  out.clouds.map = c_texture(clouds.map);
  set(out.clouds.map_from_world, clouds.map_from_world);
  return out;
}

AtmosphereInputs to_cpp(const TyndallAtmosphereInputs& c) {
  AtmosphereInputs out;
  auto& [origin_from_centre_m, sun, clouds_from_position] = out;
  origin_from_centre_m = {c.origin_from_centre_m[0], c.origin_from_centre_m[1], c.origin_from_centre_m[2]};
  set(sun, c.sun);
  set(clouds_from_position, c.clouds_from_position);
  return out;
}

TyndallAtmosphereInputs to_c(const AtmosphereInputs& inputs) {
  const auto& [origin_from_centre_m, sun, clouds_from_position] = inputs;
  TyndallAtmosphereInputs out = {};
  const auto& [x, y, z] = origin_from_centre_m;
  out.origin_from_centre_m[0] = x;
  out.origin_from_centre_m[1] = y;
  out.origin_from_centre_m[2] = z;
  set(out.sun, sun);
  set(out.clouds_from_position, clouds_from_position);
  return out;
}

SkyProbeInputs to_cpp(const TyndallSkyProbeInputs& c) {
  SkyProbeInputs out;
  auto& [up, altitude_m, sun] = out;
  up = vec3(c.up);
  altitude_m = c.altitude_m;
  set(sun, c.sun);
  return out;
}

TyndallSkyProbeInputs to_c(const SkyProbeInputs& inputs) {
  const auto& [up, altitude_m, sun] = inputs;
  TyndallSkyProbeInputs out = {};
  set(out.up, up);
  out.altitude_m = altitude_m;
  set(out.sun, sun);
  return out;
}

TyndallSkyCoefficients to_c(const SkyCoefficients& coefficients) {
  const auto& [buffer, offset, size] = coefficients;
  TyndallSkyCoefficients out = {};
  out.buffer = buffer;
  out.offset = offset;
  out.size = size;
  return out;
}

SkyProbeDesc to_cpp(const TyndallSkyProbeDesc& c) {
  SkyProbeDesc out;
  auto& [frames_in_flight, cube_size] = out;
  frames_in_flight = c.frames_in_flight;
  cube_size = c.cube_size;
  return out;
}

TyndallSkyProbeDesc to_c(const SkyProbeDesc& desc) {
  const auto& [frames_in_flight, cube_size] = desc;
  TyndallSkyProbeDesc out = {};
  out.frames_in_flight = frames_in_flight;
  out.cube_size = cube_size;
  return out;
}

TyndallSkyCube to_c(const SkyCube& cube) {
  const auto& [image, view, sampler, size, levels] = cube;
  TyndallSkyCube out = {};
  out.image = image;
  out.view = view;
  out.sampler = sampler;
  out.size = size;
  out.levels = levels;
  return out;
}

TyndallMemoryUsage to_c(const MemoryUsage& memory) {
  const auto& [persistent, transient, host] = memory;
  TyndallMemoryUsage out = {};
  out.persistent = persistent;
  out.transient = transient;
  out.host = host;
  return out;
}

TyndallCounters to_c(const Counters& counters) {
  const auto& [samples_marched, march_steps, tree_nodes_visited, shadow_map_fetches, pixels_corrected] = counters;
  TyndallCounters out = {};
  out.samples_marched = samples_marched;
  out.march_steps = march_steps;
  out.tree_nodes_visited = tree_nodes_visited;
  out.shadow_map_fetches = shadow_map_fetches;
  out.pixels_corrected = pixels_corrected;
  return out;
}

TyndallLightTables to_c(const LightTables& tables) {
  const auto& [sun_transmittance, sky_irradiance] = tables;
  TyndallLightTables out = {};
  out.sun_transmittance = sun_transmittance;
  out.sky_irradiance = sky_irradiance;
  return out;
}

TyndallScatteringTables to_c(const ScatteringTables& tables) {
  const auto& [single_rayleigh, single_mie, high_orders] = tables;
  TyndallScatteringTables out = {};
  out.single_rayleigh = c_table(single_rayleigh);
  out.single_mie = c_table(single_mie);
  out.high_orders = c_table(high_orders);
  return out;
}

TyndallProgress to_c(const Progress& progress) {
  const auto& [done, total] = progress;
  return {done, total};
}

TyndallResourceMemory to_c(const ResourceMemory& resource) {
  const auto& [name, bytes] = resource;
  return {name, bytes};
}

TyndallPassTiming to_c(const PassTiming& timing) {
  const auto& [name, gpu_ms] = timing;
  return {name, gpu_ms};
}

}  // namespace tyndall::c
