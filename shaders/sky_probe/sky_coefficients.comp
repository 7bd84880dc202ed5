// Adds up the rows of sky_rows.comp, and corrects the coefficients: a surface that faces upwards must have the exact
// irradiance, although harmonics of higher order are missing. Among all changes with this effect, the smallest is
// chosen: that with the least mean square of the change in irradiance over all normals. One workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/tables.h"
#include "shared/sky_probe.h"
#include "tyndall/sky_probe.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = 1) readonly buffer sky_probe_block { SkyProbeConstants probe; };
layout(std430, binding = 2) readonly buffer sky_probe_rows_block { vec4 rows[]; };
layout(std430, binding = 3) writeonly buffer sky_coefficients_block { vec4 coefficients[9]; };

shared vec3 sums[kSkyProbeSums];

void main() {
  uint index = gl_LocalInvocationIndex;
  if (index < kSkyProbeSums) {
    vec3 sum = vec3(0.0);
    for (uint row = 0u; row < kSkyProbeRows; ++row) sum += rows[row * kSkyProbeSums + index].rgb;
    sums[index] = sum;
  }
  barrier();
  if (index >= 9u) return;
  float basis[9];
  tyndall_sky_basis(probe.up, basis);
  vec3 missing = sums[9];
  for (int i = 0; i < 9; ++i) missing -= tyndall_sky_cosine(i) * basis[i] * sums[i];
  // The sum of the squares of all nine harmonics is 9 / (4 pi) in every direction.
  vec3 correction = missing * (1.396263401595464 * basis[index] / tyndall_sky_cosine(int(index)));
  coefficients[index] = vec4((sums[index] + correction) * probe.irradiance, 0.0);
}
