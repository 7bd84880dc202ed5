// Adds up the rows of sky_rows.comp, and corrects the coefficients: surfaces that face upwards and downwards must have
// the exact irradiance, although harmonics of higher order are missing. Among all changes with this effect, the
// smallest is chosen: that with the least mean square of the change in irradiance over all normals. One workgroup.
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
  vec3 even = vec3(0.0);  // irradiance of both sides from the harmonics, as mean and half difference
  vec3 odd = vec3(0.0);
  for (int i = 0; i < 9; ++i) {
    vec3 part = tyndall_sky_cosine(i) * basis[i] * sums[i];
    if (i > 0 && i < 4)
      odd += part;
    else
      even += part;
  }
  vec3 from_above = sums[9] - (even + odd);
  vec3 from_below = sums[10] - (even - odd);
  // A change of the coefficients by w b(up) / a changes the irradiance of the normal n by w K, where b are the
  // harmonics, a the factors of the cosine, and K = (1 + 3 c + 5 P2(c)) / (4 pi) with c = dot(n, up): 9 / (4 pi) for
  // `up` and 3 / (4 pi) for its opposite. The change is a sum of two, one for `up` and one for its opposite.
  const float kUnit = 0.174532925199433;  // 4 pi / 72
  vec3 up = kUnit * (9.0 * from_above - 3.0 * from_below);
  vec3 down = kUnit * (9.0 * from_below - 3.0 * from_above);
  bool is_odd = index > 0u && index < 4u;
  vec3 correction = (is_odd ? up - down : up + down) * (basis[index] / tyndall_sky_cosine(int(index)));
  coefficients[index] = vec4((sums[index] + correction) * probe.irradiance, 0.0);
}
