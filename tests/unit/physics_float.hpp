// shaders/lib compiled in single precision, as on the GPU: every literal and every operation is float
// (physics_float.cpp is built with -fsingle-precision-constant). Arguments and results are floats in plain types.
#pragma once

#include <array>

#include "effect/shared.hpp"

namespace tyndall::glsl32 {

using Column = std::array<float, 3>;

float altitude_of(float x, float y, float z, float R);
float altitude_along(float h0, float mu, float d, float R);
float distance_to_top(float h0, float mu, float top, float R);
float ground_below(float h, float R);
float horizon_cos(float h, float R);
float ground_horizon_cos(float h, float R);
bool ray_hits_ground(float h, float mu, float R);
float sun_disc_visibility(float h, float mu_s, float R, float angular_radius_rad);
bool atmosphere_segment(float h0, float mu, float top, float R, float& start, float& end, bool& hits_ground);
bool shadow_segment(float h0, float mu, float mu_s, float nu, float R, float& start, float& end);
Column density_integral_to_top(const shared::Medium& m, float h, float mu);
Column density_integral_along(const shared::Medium& m, float h, float mu, float d);
float mie_phase(const shared::Medium& m, float nu);
Column single_scattering(const shared::Medium& m, float h0, float mu, float mu_s, float nu, float start, float end,
                         int steps);
Column single_scattering_to_end(const shared::Medium& m, float h0, float mu, float mu_s, float nu, int steps);
Column sky_irradiance_single(const shared::Medium& m, float h, float mu_s, int panels, int steps);

}  // namespace tyndall::glsl32
