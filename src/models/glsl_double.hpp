// shaders/lib compiled as C++ in double precision. The namespace tyndall::glsl64 holds Medium and every function of the
// library (geometry, medium, phase, optical_depth, single_scattering, sky_irradiance, homogeneous, oneil), with vec3 =
// glm::dvec3. Conventions are those of the GLSL files. Include it in .cpp files only: it defines functions of internal
// linkage.
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

#include "effect/shared.hpp"
#include "models/oneil_texels.hpp"

namespace tyndall::glsl64 {

using uint = std::uint32_t;
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;

#ifdef __clang__
#pragma clang diagnostic ignored "-Wkeyword-macro"
#endif
#define float double
#include "models/glsl_functions.inl"
#undef float

inline OneilScale widen(const shared::OneilScale& s) {
  return {s.scale_height_m, s.bend, s.k0, s.k1, s.k2, s.k3, s.k4, 0.0};
}
inline Oneil widen(const shared::Oneil& o) {
  return {o.integral_method, o.samples,   o.spacing, o.table_size, o.rayleigh_phase, 0, 0, 0,
          widen(o.rayleigh), widen(o.mie)};
}

// Returns the uploaded medium in double precision.
inline Medium widen(const shared::Medium& m) {
  const auto wide = [](const Vec3& v) { return vec3(v.x, v.y, v.z); };
  Medium out = {};
  out.rayleigh_scattering = wide(m.rayleigh_scattering);
  out.planet_radius_m = m.planet_radius_m;
  out.mie_scattering = wide(m.mie_scattering);
  out.atmosphere_height_m = m.atmosphere_height_m;
  out.mie_extinction = wide(m.mie_extinction);
  out.rayleigh_scale_height_m = m.rayleigh_scale_height_m;
  out.ozone_absorption = wide(m.ozone_absorption);
  out.mie_scale_height_m = m.mie_scale_height_m;
  out.mie_g = m.mie_g;
  out.ozone_centre_m = m.ozone_centre_m;
  out.ozone_half_width_m = m.ozone_half_width_m;
  out.mie_phase = m.mie_phase;
  out.ground_albedo = wide(m.ground_albedo);
  return out;
}

}  // namespace tyndall::glsl64
