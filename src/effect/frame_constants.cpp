#include "effect/frame_constants.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "air/phase.hpp"
#include "effect/modes.hpp"
#include "effect/spectral_medium.hpp"

namespace tyndall {
namespace {

Vec3 column(const Mat4& m, int i) { return {m.m[4 * i], m.m[4 * i + 1], m.m[4 * i + 2]}; }

Vec3 times(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

Vec3 normalized(const Vec3& v) {
  const double length =
      std::sqrt(static_cast<double>(v.x) * v.x + static_cast<double>(v.y) * v.y + static_cast<double>(v.z) * v.z);
  return {static_cast<float>(v.x / length), static_cast<float>(v.y / length), static_cast<float>(v.z / length)};
}

// Sets the position and the direction of the camera, and the values that depend on its altitude.
void set_camera(shared::FrameConstants& out, const FrameInputs& inputs, const Params& params) {
  out.view_from_clip = inverse(inputs.camera.clip_from_view);
  out.world_from_view = inputs.camera.world_from_view;
  out.camera_position = column(inputs.camera.world_from_view, 3);
  const Vec3 back = column(inputs.camera.world_from_view, 2);
  out.camera_forward = normalized({-back.x, -back.y, -back.z});

  const double radius = params.planet.radius_m;
  const double x = out.camera_position.x;
  const double y = out.camera_position.y;
  const double z = out.camera_position.z;
  const double distance = std::sqrt(x * x + z * z + (radius + y) * (radius + y));
  out.camera_altitude_m = static_cast<float>(camera_altitude_m(inputs, params));
  const double altitude = out.camera_altitude_m;
  // Computes the same value as ground_below() of shaders/lib/geometry.glsl.
  const double below = altitude < 0.0 ? std::min(altitude, std::max(2.0 * altitude, -0.5 * radius)) : 0.0;
  const double ground = std::min(below, std::max<double>(inputs.lowest_ground_m, -0.5 * radius));
  out.ground_m = static_cast<float>(ground);
  out.horizon_cos =
      static_cast<float>(-std::sqrt((altitude - ground) * (2.0 * radius + altitude + ground)) / (radius + altitude));
  out.camera_up = {static_cast<float>(x / distance), static_cast<float>((radius + y) / distance),
                   static_cast<float>(z / distance)};
}

// Sets the rays of the pixels. A ray passes through all points that project to the centre of its pixel. The first three
// homogeneous coordinates of the point on the near plane are an affine function of the pixel. They are its position
// divided by its W in clip space, and thus point forwards even if an oblique near plane lies behind the camera there.
void set_rays(shared::FrameConstants& out, const FrameInputs& inputs, const EffectDesc& desc) {
  const double near_plane = 1.0 - static_cast<double>(desc.sky_depth);
  const Mat4& m = out.view_from_clip;
  const auto entry = [&](int row, int col) { return static_cast<double>(m.m[4 * col + row]); };
  const double width = inputs.extent.width;
  const double height = inputs.extent.height;
  double view[3][3];  // ray_origin, ray_x and ray_y in view space
  double largest = 0.0;
  for (int row = 0; row < 3; ++row) {
    const double centre = entry(row, 2) * near_plane + entry(row, 3);
    view[1][row] = entry(row, 0) * 2.0 / width;
    view[2][row] = entry(row, 1) * 2.0 / height;
    view[0][row] = centre - entry(row, 0) - entry(row, 1);
    largest = std::max(largest, std::abs(centre));
  }
  Vec3* const rays[3] = {&out.ray_origin, &out.ray_x, &out.ray_y};
  for (int i = 0; i < 3; ++i) {
    double world[3] = {};
    for (int row = 0; row < 3; ++row) {
      for (int k = 0; k < 3; ++k) {
        world[row] += static_cast<double>(inputs.camera.world_from_view.m[4 * k + row]) * view[i][k] / largest;
      }
    }
    *rays[i] = {static_cast<float>(world[0]), static_cast<float>(world[1]), static_cast<float>(world[2])};
  }
}

// Returns the constants of the homogeneous medium (Yusov 2012): the medium at sea level times a density. Sets
// FrameConstants::homogeneous_fourth_channel.
shared::HomogeneousMedium homogeneous_constants(const Params& params, shared::vec4& fourth_channel) {
  const HomogeneousMediumParams& p = params.homogeneous_medium;
  const shared::SpectralMedium sea_level = spectral_medium_from_params(params);
  shared::HomogeneousMedium out = {};
  out.rayleigh_scattering = times(sea_level.rayleigh_scattering, Vec3(p.density));
  out.mie_scattering = times(sea_level.mie_scattering, Vec3(p.density));
  const Vec3& air = sea_level.rayleigh_scattering;
  const Vec3& aerosol = sea_level.mie_extinction;
  out.extinction = times(Vec3(air.x + aerosol.x, air.y + aerosol.y, air.z + aerosol.z), Vec3(p.density));
  const double g = params.atmosphere.mie_g;
  const bool second = params.atmosphere.mie_phase == MiePhase::cornette_shanks;
  const double rayleigh = 3.0 / (16.0 * std::numbers::pi);
  // The tabulated function is a factor of its own in the shaders.
  const double mie =
      air::tabulated(params.atmosphere)
          ? 1.0
          : (1.0 - g * g) * (second ? 3.0 / (8.0 * std::numbers::pi * (2.0 + g * g)) : 0.25 / std::numbers::pi);
  const auto ratio = [](double factor, float s, float e) {
    return static_cast<float>(factor * s / std::max(static_cast<double>(e), 1e-30));
  };
  const auto source = [&](double factor, const Vec3& scattering, const Vec3& extinction) {
    return Vec3(ratio(factor, scattering.x, extinction.x), ratio(factor, scattering.y, extinction.y),
                ratio(factor, scattering.z, extinction.z));
  };
  const shared::vec4& fourth = sea_level.fourth_channel;
  const float fourth_extinction = p.density * (fourth.x + fourth.z);
  fourth_channel = {fourth_extinction, ratio(rayleigh, p.density * fourth.x, fourth_extinction),
                    ratio(mie, p.density * fourth.y, fourth_extinction), 0.0};
  out.rayleigh_source = source(rayleigh, out.rayleigh_scattering, out.extinction);
  out.mie_source = source(mie, out.mie_scattering, out.extinction);
  out.phase_min = static_cast<float>((1.0 - std::abs(g)) * (1.0 - std::abs(g)));
  out.phase_slope = static_cast<float>(2.0 * std::abs(g));
  out.phase_sign = g < 0.0 ? -1.0F : 1.0F;
  out.phase_second = second ? 1.0F : 0.0F;
  out.extent_m = p.extent_m;
  out.height_m = p.height_m;
  return out;
}

// Sets the map of the clouds relative to the camera, in double precision: the map can be far from the world's origin.
void set_clouds(shared::FrameConstants& out, const FrameInputs& inputs) {
  const Mat4& m = inputs.clouds.map_from_world;
  const Vec3 eye = column(inputs.camera.world_from_view, 3);
  const auto row = [&](int i) { return Vec3(m.m[i], m.m[4 + i], m.m[8 + i]); };
  const auto at_camera = [&](int i) {
    const Vec3 r = row(i);
    return static_cast<float>(double{r.x} * eye.x + double{r.y} * eye.y + double{r.z} * eye.z + double{m.m[12 + i]});
  };
  out.cloud_u = row(0);
  out.cloud_v = row(1);
  out.cloud_depth = row(2);
  out.cloud_camera_u = at_camera(0);
  out.cloud_camera_v = at_camera(1);
  out.cloud_camera_depth = at_camera(2);
}

}  // namespace

Mat4 inverse(const Mat4& matrix) {
  // Gauss-Jordan elimination on [matrix | identity] with partial pivoting, because the entries of projections with an
  // infinite far plane differ by many orders of magnitude.
  double a[4][8] = {};
  for (int row = 0; row < 4; ++row) {
    for (int col = 0; col < 4; ++col) a[row][col] = matrix.m[4 * col + row];
    a[row][4 + row] = 1.0;
  }
  for (int col = 0; col < 4; ++col) {
    int pivot = col;
    for (int row = col + 1; row < 4; ++row) {
      if (std::abs(a[row][col]) > std::abs(a[pivot][col])) pivot = row;
    }
    std::swap(a[col], a[pivot]);
    const double scale = 1.0 / a[col][col];
    for (double& entry : a[col]) entry *= scale;
    for (int row = 0; row < 4; ++row) {
      if (row == col) continue;
      const double factor = a[row][col];
      for (int k = 0; k < 8; ++k) a[row][k] -= factor * a[col][k];
    }
  }
  Mat4 out;
  for (int row = 0; row < 4; ++row) {
    for (int col = 0; col < 4; ++col) out.m[4 * col + row] = static_cast<float>(a[row][4 + col]);
  }
  return out;
}

shared::TableShape table_shape(const Params& params) {
  const UVec4& size = params.tables.size;
  shared::TableShape shape = {};
  shape.altitudes = size.x;
  shape.views = size.y;
  shape.suns = size.z;
  shape.angles = size.w;
  static_assert(static_cast<std::uint32_t>(TableParameterization::yusov) == shared::kYusovMapping);
  static_assert(static_cast<std::uint32_t>(TableParameterization::bruneton) == shared::kBrunetonMapping);
  static_assert(static_cast<std::uint32_t>(TableParameterization::linear) == shared::kLinearMapping);
  shape.parameterization = static_cast<std::uint32_t>(params.tables.parameterization);
  shape.orders = params.tables.orders;
  return shape;
}

double camera_altitude_m(const FrameInputs& inputs, const Params& params) {
  const double radius = params.planet.radius_m;
  const Vec3 place = column(inputs.camera.world_from_view, 3);
  const double x = place.x;
  const double y = place.y;
  const double z = place.z;
  const double distance = std::sqrt(x * x + z * z + (radius + y) * (radius + y));
  return (x * x + z * z + y * (2.0 * radius + y)) / (distance + radius);
}

bool tables_lack_single(double altitude_m, double cos_sun_zenith, double radius_m) {
  const double lowest_m = std::max(-500.0, -0.125 * radius_m);  // lowest_table_altitude() of lib/table_mapping.glsl
  if (altitude_m >= 0.0) return false;
  if (altitude_m < lowest_m) return true;
  // While the sun is near the horizontal, by no more than the dip of the horizon, it has set at some points of a ray
  // and not at others. The tables blur this edge over the distance between two of their sun angles.
  constexpr double kBetweenSuns_rad = 0.009;
  const double dip = std::sqrt(-2.0 * altitude_m / radius_m);
  return std::abs(cos_sun_zenith) < dip + kBetweenSuns_rad;
}

bool tables_lack_single(const FrameInputs& inputs, const Params& params) {
  const Vec3 eye = column(inputs.camera.world_from_view, 3);
  const Vec3 sun = inputs.sun.direction_to_sun;
  const double radius = params.planet.radius_m;
  const double y = radius + eye.y;
  const double up = std::sqrt(double{eye.x} * eye.x + double{eye.z} * eye.z + y * y);
  const double cosine = (double{sun.x} * eye.x + double{sun.y} * y + double{sun.z} * eye.z) / up /
                        std::sqrt(double{sun.x} * sun.x + double{sun.y} * sun.y + double{sun.z} * sun.z);
  return tables_lack_single(camera_altitude_m(inputs, params), cosine, radius);
}

shared::FrameConstants frame_constants(const FrameInputs& inputs, const EffectDesc& desc, const Params& params) {
  shared::FrameConstants out = {};
  set_camera(out, inputs, params);
  set_rays(out, inputs, desc);
  out.sky_depth = desc.sky_depth;
  out.near_depth = 1.0F - desc.sky_depth;
  out.direction_to_sun = normalized(inputs.sun.direction_to_sun);
  out.cos_sun_angular_radius = std::cos(inputs.sun.angular_radius_rad);
  const float scale = params.scattering.scale;
  out.sun_irradiance = {inputs.sun.irradiance.x * scale, inputs.sun.irradiance.y * scale,
                        inputs.sun.irradiance.z * scale};
  out.shadow_resolution = inputs.shadow_resolution;
  out.width = inputs.extent.width;
  out.height = inputs.extent.height;
  out.cascade_count = params.scattering.light_shafts ? static_cast<std::uint32_t>(inputs.cascades.size()) : 0;
  out.first_marched_cascade = inputs.first_marched_cascade;
  out.integration_steps = params.scattering.integration_steps;
  out.only = params.scattering.only.value;
  const bool homogeneous = is_homogeneous(params.scattering);
  out.unoccluded = !homogeneous && params.scattering.multiple == MultipleScattering::unoccluded ? 1 : 0;
  if (homogeneous) {
    out.homogeneous = homogeneous_constants(params, out.homogeneous_fourth_channel);
    out.sun_irradiance = times(out.sun_irradiance, params.homogeneous_medium.sunlight);
  }
  out.glass_depth_sign = !inputs.shadow_color_depths ? 0.0F : desc.shadow_depth_reversed ? -1.0F : 1.0F;
  out.shadow_depth_reversed = desc.shadow_depth_reversed ? 1 : 0;
  out.color_offset = {inputs.color.offset.x, inputs.color.offset.y};
  out.depth_offset = {inputs.depth.offset.x, inputs.depth.offset.y};
  out.output_offset = {inputs.output.offset.x, inputs.output.offset.y};
  out.froxel_columns = params.froxels.columns;
  out.froxel_rows = params.froxels.rows;
  out.froxel_slices = params.froxels.slices;
  out.froxel_near_m = params.froxels.near_m;
  out.froxel_far_m = params.froxels.far_m;
  out.tables = table_shape(params);
  if (has_clouds(inputs)) set_clouds(out, inputs);
  return out;
}

CascadeArray cascade_constants(const FrameInputs& inputs) {
  CascadeArray out = {};
  for (std::size_t i = 0; i < inputs.cascades.size(); ++i) {
    out[i].shadow_from_world = inputs.cascades[i].shadow_from_world;
    out[i].near_m = inputs.cascades[i].near_m;
    out[i].far_m = inputs.cascades[i].far_m;
  }
  return out;
}

}  // namespace tyndall
