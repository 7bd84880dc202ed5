// shaders/lib compiled as C++ in double precision. The namespace tyndall::glsl64 holds Medium and every function of the
// library (geometry, medium, phase, optical_depth, single_scattering, sky_irradiance, homogeneous, oneil), with vec3 =
// glm::dvec3. Conventions are those of the GLSL files. Include it in .cpp files only: it defines functions of internal
// linkage.
#pragma once

#include <array>
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
// Row i of the table of the phase function, which the C++ form of Medium points to; null where there is a formula.
#define PHASE_ROWS_OF_MEDIUM const ::tyndall::shared::vec4* phase_rows = nullptr;
#define PHASE_ENTRY(m, i) vec4((m).phase_rows[i].x, (m).phase_rows[i].y, (m).phase_rows[i].z, (m).phase_rows[i].w)
#define PHASE_TABULATED(m) ((m).phase_rows != nullptr)
#define float double
#include "models/glsl_functions.inl"
#undef float
#undef PHASE_ROWS_OF_MEDIUM
#undef PHASE_ENTRY
#undef PHASE_TABULATED

inline std::array<double, 3> to_array(const vec3& v) { return {v.x, v.y, v.z}; }

inline OneilScale widen(const shared::OneilScale& s) {
  return {s.scale_height_m, s.bend, s.k0, s.k1, s.k2, s.k3, s.k4, 0.0};
}
inline Oneil widen(const shared::Oneil& o) {
  return {o.integral_method, o.samples,   o.spacing, o.table_size, o.rayleigh_phase, 0, 0, 0,
          widen(o.rayleigh), widen(o.mie)};
}

// Returns the uploaded medium in double precision, with the rows of its phase function if it has no formula.
inline Medium widen(const shared::Medium& m, const shared::vec4* phase_rows = nullptr) {
  const auto wide = [](const Vec3& v) { return vec3(v.x, v.y, v.z); };
  Medium out = {};
  out.phase_rows = phase_rows;
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
