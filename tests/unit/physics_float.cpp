#include "physics_float.hpp"

#include <bit>
#include <cstdint>

#include <glm/glm.hpp>

#include "models/oneil_texels.hpp"

namespace tyndall::glsl32 {
namespace lib {

using uint = std::uint32_t;
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using vec4 = glm::vec4;

#include "models/glsl_functions.inl"

}  // namespace lib

namespace {

// The structures have the same members in the same order, as in the shaders.
lib::Medium medium_of(const shared::Medium& m) { return std::bit_cast<lib::Medium>(m); }

Column array_of(const lib::vec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

float altitude_of(float x, float y, float z, float R) { return lib::altitude_of(lib::vec3(x, y, z), R); }
float altitude_along(float h0, float mu, float d, float R) { return lib::altitude_along(h0, mu, d, R); }
float distance_to_top(float h0, float mu, float top, float R) { return lib::distance_to_top(h0, mu, top, R); }
float ground_below(float h, float R) { return lib::ground_below(h, R); }
float horizon_cos(float h, float R) { return lib::horizon_cos(h, R); }
float ground_horizon_cos(float h, float R) { return lib::ground_horizon_cos(h, R); }
bool ray_hits_ground(float h, float mu, float R) { return lib::ray_hits_ground(h, mu, R); }
float sun_disc_visibility(float h, float mu_s, float R, float angular_radius_rad) {
  return lib::sun_disc_visibility(h, mu_s, R, angular_radius_rad);
}
bool atmosphere_segment(float h0, float mu, float top, float R, float& start, float& end, bool& hits_ground) {
  return lib::atmosphere_segment(h0, mu, top, R, start, end, hits_ground);
}
bool shadow_segment(float h0, float mu, float mu_s, float nu, float R, float& start, float& end) {
  return lib::shadow_segment(h0, mu, mu_s, nu, R, start, end);
}
Column density_integral_to_top(const shared::Medium& m, float h, float mu) {
  return array_of(lib::density_integral_to_top(medium_of(m), h, mu));
}
Column density_integral_along(const shared::Medium& m, float h, float mu, float d) {
  return array_of(lib::density_integral_along(medium_of(m), h, mu, d));
}
float mie_phase(const shared::Medium& m, float nu) { return lib::mie_phase(medium_of(m), nu); }
Column single_scattering(const shared::Medium& m, float h0, float mu, float mu_s, float nu, float start, float end,
                         int steps) {
  return array_of(lib::single_scattering(medium_of(m), h0, mu, mu_s, nu, start, end, steps));
}
Column single_scattering_to_end(const shared::Medium& m, float h0, float mu, float mu_s, float nu, int steps) {
  lib::vec3 transmittance;
  return array_of(lib::single_scattering_to_end(medium_of(m), h0, mu, mu_s, nu, steps, transmittance));
}
Column sky_irradiance_single(const shared::Medium& m, float h, float mu_s, int panels, int steps) {
  return array_of(lib::sky_irradiance_single(medium_of(m), h, mu_s, panels, steps));
}

}  // namespace tyndall::glsl32
