// The scattering table of the published method, for comparison with ours: Yusov, "High Performance Outdoor Light
// Scattering Using Epipolar Sampling" (2013), section 2, after Bruneton and Neyret (2008). Written from the published
// description. The size is 32 x 128 x 64 x 16 (altitude, view, sun, angle between them); phase functions are included
// in the values.
#ifndef TYNDALL_PUBLISHED_TABLE_GLSL
#define TYNDALL_PUBLISHED_TABLE_GLSL

#include "lib/geometry.glsl"
#include "lib/phase.glsl"
#include "shared/medium.h"

const vec4 kSize = vec4(32.0, 128.0, 64.0, 16.0);
const uvec3 kTexels = uvec3(32u, 128u, 64u * 16u);
const float kPi = 3.14159265358979;
const float kMargin = 16.0;        // distance from the ground and from the top [m]
const float kHorizonGuard = 1e-4;  // in view cosines

struct Point {
  float altitude;
  float view;  // cosines of the zenith angles
  float sun;
  float between;  // cosine of the angle between view and sun
};

vec3 texel_centre(vec3 c, vec3 size) { return (c * (size - 1.0) + 0.5) / size; }

// Returns the texture coordinates of a point. `above` selects the side of the horizon.
vec4 table_coordinates(Medium m, Point p, bool above) {
  float h = clamp(p.altitude, kMargin, m.atmosphere_height_m - kMargin);
  float u = sqrt((h - kMargin) / (m.atmosphere_height_m - 2.0 * kMargin));
  float horizon = horizon_cos(h, m.planet_radius_m);
  float t = above ? (p.view - horizon) / (1.0 - horizon) : (horizon - p.view) / (horizon + 1.0);
  float v = (above ? 0.5 : 0.0) + 0.5 / kSize.y + pow(clamp(t, 0.0, 1.0), 0.2) * (0.5 * kSize.y - 1.0) / kSize.y;
  float w = 0.5 * (atan(max(p.sun, -0.1975) * tan(1.26 * 1.1)) / 1.1 + (1.0 - 0.26));
  float q = acos(clamp(p.between, -1.0, 1.0)) / kPi;
  q = 0.5 + 0.5 * sign(q - 0.5) * pow(abs(2.0 * (q - 0.5)), 1.5);
  vec3 c = texel_centre(clamp(vec3(u, w, q), 0.0, 1.0), kSize.xzw);
  return vec4(c.x, v, c.y, c.z);
}

vec3 table_value(sampler3D table, vec4 c) {
  float slice = clamp(c.w * kSize.w - 0.5, 0.0, kSize.w - 1.0);
  float first = min(floor(slice), kSize.w - 2.0);
  float w = clamp(c.z, 0.5 / kSize.z, 1.0 - 0.5 / kSize.z);
  vec3 near = textureLod(table, vec3(c.xy, (first + w) / kSize.w), 0.0).rgb;
  vec3 far = textureLod(table, vec3(c.xy, (first + 1.0 + w) / kSize.w), 0.0).rgb;
  return mix(near, far, slice - first);
}

// Returns the point for which the texel stands, and the unit vectors of view and sun with y up. Where no geometry has
// the three angles, the vectors are not exactly of unit length, so that their dot products stay exact.
Point table_point(Medium m, uvec3 texel, out bool above, out vec3 view, out vec3 to_sun) {
  vec3 c = vec3(float(texel.x), float(texel.z % 64u), float(texel.z / 64u)) / (kSize.xzw - 1.0);
  Point p;
  p.altitude = c.x * c.x * (m.atmosphere_height_m - 2.0 * kMargin) + kMargin;
  float horizon = horizon_cos(p.altitude, m.planet_radius_m);
  above = texel.y >= 64u;
  float t = float(texel.y % 64u) / (0.5 * kSize.y - 1.0);
  t = t * t * t * t * t;
  p.view = above ? max(horizon + t * (1.0 - horizon), horizon + kHorizonGuard)
                 : min(horizon - t * (horizon + 1.0), horizon - kHorizonGuard);
  p.view = clamp(p.view, -1.0, 1.0);
  p.sun = clamp(tan((2.0 * c.y - 1.0 + 0.26) * 1.1) / tan(1.26 * 1.1), -1.0, 1.0);
  float q = 2.0 * c.z - 1.0;
  p.between = cos(kPi * (0.5 + 0.5 * sign(q) * pow(abs(q), 2.0 / 3.0)));
  float spread = sqrt(max((1.0 - p.view * p.view) * (1.0 - p.sun * p.sun), 1e-20));
  p.between = clamp(p.between, p.view * p.sun - spread, p.view * p.sun + spread);
  view = vec3(sqrt(max(1.0 - p.view * p.view, 0.0)), p.view, 0.0);
  float x = view.x > 0.0 ? (p.between - p.sun * view.y) / view.x : 0.0;
  to_sun = vec3(x, p.sun, sqrt(clamp(1.0 - x * x - p.sun * p.sun, 0.0, 1.0)));
  return p;
}

// Returns the distance to the ground or to the top of the atmosphere [m].
float ray_length(Medium m, Point p, bool above) {
  float near;
  float far;
  if (!above && shell_intersections(p.altitude, p.view, 0.0, m.planet_radius_m, near, far)) return max(near, 0.0);
  return distance_to_top(p.altitude, p.view, m.atmosphere_height_m, m.planet_radius_m);
}

Point point_along(Medium m, Point p, float d) {
  float R = m.planet_radius_m;
  Point out_point = p;
  out_point.altitude = altitude_along(p.altitude, p.view, d, R);
  out_point.view = cos_zenith_along(p.altitude, p.view, d, R);
  out_point.sun = ((R + p.altitude) * p.sun + d * p.between) / (R + out_point.altitude);
  return out_point;
}

// Returns the relative densities of air molecules and aerosol.
vec2 density_at(Medium m, float h) { return exp(-abs(h) / vec2(m.rayleigh_scale_height_m, m.mie_scale_height_m)); }

vec3 transmittance(Medium m, vec2 integral) {
  return exp(-(m.rayleigh_scattering * integral.x + m.mie_extinction * integral.y));
}

#endif
