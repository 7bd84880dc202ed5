// The inputs of tyndall/atmosphere.glsl: its uniform block and its images.
#include "tyndall/atmosphere.hpp"

#include <cmath>
#include <cstddef>
#include <cstring>

#include "effect/effect_state.hpp"
#include "effect/frame_constants.hpp"
#include "effect/frame_geometry.hpp"
#include "effect/medium.hpp"
#include "effect/modes.hpp"
#include "effect/phase_rows.hpp"
#include "effect/spectral_medium.hpp"
#include "gpu/guard.hpp"
#include "gpu/try.hpp"

namespace tyndall {
namespace {

Error invalid_atmosphere(const char* what) {
  return {ErrorCode::invalid_argument, std::string("atmosphere_constants: ") + what};
}

// Returns whether a number is finite in single precision, which the constants have.
bool is_float(double value) { return std::isfinite(static_cast<float>(value)); }

Result<void> check(const AtmosphereInputs& inputs, double scale) {
  const Vec3& d = inputs.sun.direction_to_sun;
  const Vec3& e = inputs.sun.irradiance;
  const double direction = length({d.x, d.y, d.z});
  const double radius = length(inputs.origin_from_centre_m);
  if (!is_float(radius)) {
    return invalid_atmosphere(std::isfinite(radius) ? "origin_from_centre_m exceeds 3e38; expected metres"
                                                    : "origin_from_centre_m is not finite; expected metres");
  }
  if (!std::isfinite(direction) || direction < 1e-6) {
    return invalid_atmosphere("direction_to_sun has no direction; expected a vector of length 1");
  }
  for (const float channel : {e.x, e.y, e.z}) {
    if (!std::isfinite(channel) || channel < 0.0F) {
      return invalid_atmosphere("irradiance is negative or not finite; expected at least 0");
    }
    if (!is_float(channel * scale)) {
      return invalid_atmosphere("irradiance times scattering.scale is too large; expected at most 3e38");
    }
  }
  if (!std::isfinite(inputs.sun.angular_radius_rad) || inputs.sun.angular_radius_rad < 0.0F) {
    return invalid_atmosphere("angular_radius_rad is negative or not finite; expected at least 0");
  }
  for (const float entry : inputs.clouds_from_position.m) {
    if (!std::isfinite(entry)) {
      return invalid_atmosphere(
          "clouds_from_position is not finite; expected a matrix to (u, v, depth) of the map of clouds");
    }
  }
  return {};
}

Vec3 divided(const DVec3& v, double by) {
  return {static_cast<float>(v.x / by), static_cast<float>(v.y / by), static_cast<float>(v.z / by)};
}

shared::AtmosphereConstants constants_of(const Params& params, const AtmosphereInputs& inputs) {
  shared::AtmosphereConstants out = {};
  out.medium = medium_from_params(params);
  out.tables = table_shape(params);
  const double radius = length(inputs.origin_from_centre_m);
  if (radius > 0.0) out.origin_up = divided(inputs.origin_from_centre_m, radius);
  out.origin_radius_m = static_cast<float>(radius);
  out.origin_altitude_m = static_cast<float>(radius - static_cast<double>(params.planet.radius_m));
  const Vec3& d = inputs.sun.direction_to_sun;
  out.direction_to_sun = divided({d.x, d.y, d.z}, length({d.x, d.y, d.z}));
  out.sun_angular_radius_rad = inputs.sun.angular_radius_rad;
  const Vec3& e = inputs.sun.irradiance;
  const float scale = params.scattering.scale;
  out.sun_irradiance = {e.x * scale, e.y * scale, e.z * scale};
  out.froxel_near_m = params.froxels.near_m;
  out.froxel_far_m = params.froxels.far_m;
  out.froxel_slices = static_cast<float>(params.froxels.slices);
  out.froxel_irradiance = out.sun_irradiance;
  if (is_homogeneous(params.scattering)) {
    const Vec3& arrives = params.homogeneous_medium.sunlight;
    out.froxel_irradiance = {e.x * scale * arrives.x, e.y * scale * arrives.y, e.z * scale * arrives.z};
  }
  const Mat4& clouds = inputs.clouds_from_position;
  const auto row = [&clouds](int i) {
    return shared::vec4(clouds.m[i], clouds.m[4 + i], clouds.m[8 + i], clouds.m[12 + i]);
  };
  out.cloud_u = row(0);
  out.cloud_v = row(1);
  out.cloud_depth = row(2);
  return out;
}

}  // namespace

Result<AtmosphereConstants> atmosphere_constants(const Params& params, const AtmosphereInputs& inputs) {
  return guarded("atmosphere_constants", [&]() -> Result<AtmosphereConstants> {
    TYNDALL_TRY(check_params(params));
    TYNDALL_TRY(check(inputs, params.scattering.scale));
    const shared::AtmosphereConstants constants = constants_of(params, inputs);
    // With the macro TYNDALL_SPECTRAL, the medium at the beginning is larger.
    const shared::SpectralMedium medium = spectral_medium_from_params(params);
    const bool spectral = params.scattering.color == ColorMode::spectral;
    const std::size_t size = spectral ? sizeof medium : sizeof(shared::Medium);
    AtmosphereConstants out;
    static_assert(offsetof(shared::AtmosphereConstants, medium) == 0);
    static_assert(sizeof constants + sizeof medium - sizeof(shared::Medium) <= sizeof out.bytes);
    std::memcpy(out.bytes.data(), &medium, size);
    std::memcpy(out.bytes.data() + size, &constants.tables, sizeof constants - sizeof(shared::Medium));
    return out;
  });
}

Result<void> atmosphere_phase(const Params& params, AtmospherePhase& out) {
  return guarded("atmosphere_phase", [&]() -> Result<void> {
    TYNDALL_TRY(check_params(params));
    const PhaseRows rows = phase_rows(params, params.scattering.color);
    static_assert(sizeof out == kPhaseBytes);
    if (rows.empty()) {
      return Error{ErrorCode::invalid_argument,
                   "atmosphere_phase: atmosphere.mie_phase has a formula in the shader; expected draine or table"};
    }
    std::memcpy(out.rows.data(), rows.data(), sizeof out);
    return {};
  });
}

AtmosphereImages atmosphere_images(const Effect& effect, std::uint32_t view) {
  AtmosphereImages out;
  if (!effect.state_) return out;
  const Effect::State& state = *effect.state_;
  constexpr TableId kOrder[] = {TableId::sky_irradiance, TableId::single_rayleigh, TableId::single_mie,
                                TableId::high_orders};
  for (const TableId id : kOrder) {
    out.list[out.count++] = {state.linear.get(), state.tables.table(id).view.get(), VK_IMAGE_LAYOUT_GENERAL};
  }
  for (std::uint32_t i = 0; i < FroxelVolume::kImages; ++i) {
    const VkImageView image = state.froxels.view_of(view, i);
    if (image != VK_NULL_HANDLE) out.list[out.count++] = {state.linear.get(), image, VK_IMAGE_LAYOUT_GENERAL};
  }
  return out;
}

}  // namespace tyndall
