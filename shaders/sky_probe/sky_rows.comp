// Integrates the sky's radiance at one zenith angle, and the ground's below the horizon, times the spherical harmonics
// up to order 2 (tyndall/sky_probe.glsl). One workgroup per row of the quadrature, one invocation per azimuth; the
// other side of the sun's plane has the same radiance. The sun's disc is left out. sky_probe_rows: the sums of each
// row, relative to the sun's irradiance above the atmosphere.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "sky_probe/sky_radiance.glsl"

#include "tyndall/sky_probe.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = 2) writeonly buffer sky_probe_rows_block { vec4 rows[]; };
layout(push_constant) uniform Push { uint first; };

const float kPi = 3.14159265358979;

shared vec3 light[kSkyProbeAzimuths];
shared vec3 directions[2][kSkyProbeAzimuths];
shared float cos_zenith;  // of the row

// Node and weight of the Gauss-Legendre rule with four nodes on [0; 1], repeated on `panels` panels.
vec2 gauss(uint index, float panels) {
  const float node[4] = {0.069431844202974, 0.330009478207572, 0.669990521792428, 0.930568155797026};
  const float weight[4] = {0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727};
  return vec2((float(index / 4u) + node[index % 4u]) / panels, weight[index % 4u] / panels);
}

// Zenith angle of a row, and its solid angle per radian of azimuth. The intervals are separated by the sun, the
// horizontal and the horizon, where the radiance has kinks. The nodes are dense at these.
struct Row {
  float zenith;
  float weight;
  bool below;
};
Row row_of(uint index, float sun, float horizon) {
  uint interval = index / kSkyProbeNodes;
  vec2 g = gauss(index % kSkyProbeNodes, float(kSkyProbeNodes / 4u));
  float bound[5] = {0.0, sun, 0.5 * kPi, horizon, kPi};
  float reach = bound[interval + 1u] - bound[interval];
  bool middle = interval == 1u || interval == 2u;  // dense at both ends
  float offset = reach * g.x * g.x * (middle ? 3.0 - 2.0 * g.x : 1.0);
  float stretch = reach * g.x * (middle ? 6.0 * (1.0 - g.x) : 2.0);
  Row row;
  row.zenith = interval == 0u ? sun - offset : bound[interval] + offset;
  row.weight = reach > 1.0e-5 ? stretch * g.y * sin(row.zenith) : 0.0;
  row.below = interval == 3u;
  return row;
}

void main() {
  uint index = first + gl_WorkGroupID.x;
  uint azimuth = gl_LocalInvocationIndex;
  float horizon = acos(clamp(ground_horizon_cos(probe.altitude_m, medium.planet_radius_m), -1.0, 0.0));
  Row row = row_of(index, acos(clamp(probe.cos_sun_zenith, 0.0, 1.0)), horizon);
  vec2 g = gauss(azimuth, float(kSkyProbeAzimuths / 4u));
  float phi = kPi * g.x * g.x;  // dense at the sun
  float mu = cos(row.zenith);
  float sin_zenith = sin(row.zenith);
  float nu = clamp(mu * probe.cos_sun_zenith + sin_zenith * probe.sin_sun_zenith * cos(phi), -1.0, 1.0);
  float weight = row.weight * 2.0 * kPi * g.x * g.y;
  light[azimuth] = weight > 0.0 ? weight * sky_radiance(cos(row.zenith), nu, row.below) : vec3(0.0);
  vec3 in_plane = mu * probe.up + sin_zenith * cos(phi) * probe.ahead;
  vec3 beside = sin_zenith * sin(phi) * probe.side;
  directions[0][azimuth] = in_plane + beside;
  directions[1][azimuth] = in_plane - beside;
  if (azimuth == 0u) cos_zenith = mu;
  barrier();
  if (azimuth >= kSkyProbeSums) return;
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < kSkyProbeAzimuths; ++i) {
    float factor = 2.0 * max(azimuth == 9u ? cos_zenith : -cos_zenith, 0.0);
    if (azimuth < 9u) {
      float one[9];
      float other[9];
      tyndall_sky_basis(directions[0][i], one);
      tyndall_sky_basis(directions[1][i], other);
      factor = one[azimuth] + other[azimuth];
    }
    sum += factor * light[i];
  }
  rows[index * kSkyProbeSums + azimuth] = vec4(sum, 0.0);
}
