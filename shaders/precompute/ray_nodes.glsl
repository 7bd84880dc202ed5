// The quadrature along a ray that starts at altitude h: panels of equal effort with four Gauss-Legendre nodes each.
#ifndef TYNDALL_RAY_NODES_GLSL
#define TYNDALL_RAY_NODES_GLSL

#include "lib/optical_depth.glsl"
#include "shared/tables.h"

// Number of steps along the ray in the search for the panels.
const int kWalkSteps = 192;

// The effort of one panel, and the effort per optical depth in the densest channel that is added to the sum over a ray.
// Rays of little effort have fewer panels than the largest number: downwards from low altitudes, and above most of the
// atmosphere. The addition is needed because the effort hardly grows beyond an optical depth of a few units.
const vec2 kPanelEffort = vec2(2.5, 3.5);
const float kEffortOfDepth = 3.0;

// Returns the distance along a ray of length `end` for s in [0; 1], dense at both ends.
float walk_distance(float end, float s) { return end * s * s * (3.0 - 2.0 * s); }

// Returns the effort per metre at distance d: the rate at which the integrand changes with optical depth, altitude and
// distance, reduced where the transmittance is low. x is for single scattering, which changes with the sunlight along
// the ray. y is for the higher orders, whose source function is smoother: there the transmittance towards the eye
// changes fastest. tau is the optical depth so far in the clearest channel; this step's is added to it.
vec2 effort(Medium m, float h0, float mu, float d, float step_m, inout float tau) {
  float R = m.planet_radius_m;
  float h = altitude_along(h0, mu, d, R);
  float cosine = cos_zenith_along(h0, mu, d, R);
  Spectrum extinction = extinction_at(m, h);
  float clearest = SMALLEST(extinction);
  float densest = LARGEST(extinction);
  float middle = tau + 0.5 * clearest * step_m;
  tau += clearest * step_m;
  float small_scale = min(m.rayleigh_scale_height_m, m.mie_scale_height_m);
  float large_scale = max(m.rayleigh_scale_height_m, m.mie_scale_height_m);
  float scale = min(small_scale + 0.3333 * max(h, 0.0), large_scale);
  float along_sun = 1.0 / (0.5 * sqrt(2.0 * R * large_scale));
  float climb = abs(cosine) / scale;
  return vec2((0.1 + exp(-0.5 * middle)) * (0.5 * densest + climb + along_sun),
              (0.1 + exp(-0.3 * middle)) * (0.8 * densest + 0.7 * climb + along_sun));
}

#endif
