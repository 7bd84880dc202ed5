// Structures of the C interface for tests, filled member by member and not with the conversions of src/c.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "gpu_test.hpp"
#include "tyndall/tyndall.h"

namespace tyndall {

#define EXPECT_SUCCESS(expression) EXPECT_EQ(expression, TyndallStatus_success) << tyndall_last_error()
#define ASSERT_SUCCESS(expression) ASSERT_EQ(expression, TyndallStatus_success) << tyndall_last_error()

struct Destroy {
  void operator()(TyndallParams* params) const { tyndall_params_destroy(params); }
  void operator()(TyndallEffect* effect) const { tyndall_effect_destroy(effect); }
};
using OwnedParams = std::unique_ptr<TyndallParams, Destroy>;
using OwnedEffect = std::unique_ptr<TyndallEffect, Destroy>;

template <typename T>
T sized() {
  T out = {};
  out.struct_size = sizeof out;
  return out;
}

inline TyndallDeviceInfo c_device(const DeviceInfo& info) {
  auto out = sized<TyndallDeviceInfo>();
  out.instance = info.instance;
  out.physical_device = info.physical_device;
  out.device = info.device;
  out.get_instance_proc_addr = info.get_instance_proc_addr;
  return out;
}

inline TyndallEffectDesc c_desc(const EffectDesc& desc) {
  auto out = sized<TyndallEffectDesc>();
  out.max_extent = desc.max_extent;
  out.frames_in_flight = desc.frames_in_flight;
  out.views = desc.views;
  out.output_format =
      desc.output_format == OutputFormat::rgba32f ? TyndallOutputFormat_rgba32f : TyndallOutputFormat_rgba16f;
  out.sky_depth = desc.sky_depth;
  out.depth_format = desc.depth_format;
  out.shadow_depth_reversed = desc.shadow_depth_reversed ? 1 : 0;
  out.max_cascades = desc.max_cascades;
  out.max_shadow_resolution = desc.max_shadow_resolution;
  out.shadow_colors = desc.shadow_colors ? 1 : 0;
  out.timings = desc.timings ? 1 : 0;
  out.counters = desc.counters ? 1 : 0;
  out.pipeline_threads = desc.pipeline_threads;
  out.clouds = desc.clouds ? 1 : 0;
  out.table_pipelines_later = desc.table_pipelines_later ? 1 : 0;
  out.check_inputs = desc.check_inputs ? 1 : 0;
  return out;
}

// The inputs of a frame, with their cascades.
struct CFrame {
  TyndallFrameInputs inputs = sized<TyndallFrameInputs>();
  std::vector<TyndallCascade> cascades;
};

inline CFrame c_frame(const FrameInputs& from) {
  CFrame out;
  const auto texture = [](const Texture& t) { return TyndallTexture{t.view, t.layout, t.offset}; };
  out.inputs.extent = from.extent;
  out.inputs.color = texture(from.color);
  out.inputs.depth = texture(from.depth);
  out.inputs.shadow_maps = texture(from.shadow_maps);
  out.inputs.shadow_colors = texture(from.shadow_colors);
  out.inputs.output = texture(from.output);
  out.inputs.shadow_color_depths = from.shadow_color_depths ? 1 : 0;
  out.inputs.shadow_resolution = from.shadow_resolution;
  out.inputs.first_marched_cascade = from.first_marched_cascade;
  out.inputs.view = from.view;
  out.inputs.frame_index = from.frame_index;
  std::copy_n(from.camera.world_from_view.m, 16, out.inputs.camera.world_from_view);
  std::copy_n(from.camera.clip_from_view.m, 16, out.inputs.camera.clip_from_view);
  const Vec3& to_sun = from.sun.direction_to_sun;
  const Vec3& irradiance = from.sun.irradiance;
  out.inputs.sun = {
      {to_sun.x, to_sun.y, to_sun.z}, {irradiance.x, irradiance.y, irradiance.z}, from.sun.angular_radius_rad};
  out.inputs.lowest_ground_m = from.lowest_ground_m;
  out.inputs.clouds.map = texture(from.clouds.map);
  std::copy_n(from.clouds.map_from_world.m, 16, out.inputs.clouds.map_from_world);
  for (const Cascade& cascade : from.cascades) {
    TyndallCascade& c = out.cascades.emplace_back();
    std::copy_n(cascade.shadow_from_world.m, 16, c.shadow_from_world);
    c.near_m = cascade.near_m;
    c.far_m = cascade.far_m;
  }
  out.inputs.cascades = out.cascades.data();
  out.inputs.cascade_count = static_cast<std::uint32_t>(out.cascades.size());
  return out;
}

}  // namespace tyndall
