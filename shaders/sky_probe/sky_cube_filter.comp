// Filters the radiance of a sky probe's cube map for reflections in rough surfaces: the means of the radiance under the
// lobe of the GGX distribution, for a view along the normal and the reflected ray, weighted by the cosine. These are
// the integrals that Karis, "Real Shading in Unreal Engine 4" (2013), samples for his prefiltered environment map.
// Here they are sums over all texels around. At roughness 1 the lobe is the cosine, and the mean is the irradiance over
// pi. One invocation per texel of sky_cube_texels, from level 1 on. push: the first texel.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/tables.h"
#include "shared/sky_probe.h"
#include "sky_probe/sky_cube.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = 1) readonly buffer sky_probe_block { SkyProbeConstants probe; };
layout(std430, binding = 2) readonly buffer sky_cube_radiance_block { vec4 radiance[]; };
layout(std430, binding = 3) writeonly buffer sky_cube_texels_block { uvec2 texels[]; };
layout(push_constant) uniform Push { uint first; };

// Coarse texels whose centres are closer than this to the direction are divided into fine ones. 28 degrees, or five
// times their width.
const float kCosNear = 0.8829476;

vec3 direction;  // of the texel that is computed
float change;    // alpha^2 - 1
vec4 sum;        // rgb: the weighted radiance, a: the weights

// Adds a texel of the radiance. A half vector with the cosine k to the normal belongs to a ray with the cosine
// c = 2 k^2 - 1, and its density, as solid angle of rays, is proportional to 1 / (k^2 (alpha^2 - 1) + 1)^2.
void add(vec4 texel, float c) {
  float base = 1.0 + 0.5 * (1.0 + c) * change;
  float weight = max(c, 0.0) * texel.a / (base * base);
  sum += weight * vec4(texel.rgb, 1.0);
}

// Adds the fine texels within a coarse one. ratio: of their numbers along an edge.
void add_parts(uint coarse, uint start, uint ratio) {
  uint width = kSkyCubeCoarse * ratio;
  uint face_row = coarse / kSkyCubeCoarse;  // counted through all faces
  uint corner = face_row * ratio * width + (coarse % kSkyCubeCoarse) * ratio;
  for (uint y = 0u; y < ratio; ++y) {
    for (uint x = 0u; x < ratio; ++x) {
      uint index = corner + y * width + x;
      add(radiance[start + index], dot(direction, normalize(texel_point(index, width))));
    }
  }
}

void main() {
  uint size = probe.cube_size;
  uint index = first + gl_GlobalInvocationID.x;
  if (index >= 8u * size * size - 2u) return;  // the number of texels of all levels
  uint level = 1u;
  while (index >= level_start(size, level + 1u)) ++level;
  direction = normalize(texel_point(index - level_start(size, level), size >> level));
  float roughest = float(findMSB(size / kSkyCubeRoughest));
  float roughness = min(float(level) / roughest, 1.0);
  change = roughness * roughness * roughness * roughness - 1.0;
  sum = vec4(0.0);
  uint fine = max(size >> (level - 1u), kSkyCubeCoarse);
  uint fine_start = 8u * (size * size - fine * fine);
  uint coarse_start = 8u * (size * size - kSkyCubeCoarse * kSkyCubeCoarse);
  for (uint i = 0u; i < 6u * kSkyCubeCoarse * kSkyCubeCoarse; ++i) {
    float c = dot(direction, normalize(texel_point(i, kSkyCubeCoarse)));
    if (c > kCosNear && fine > kSkyCubeCoarse) {
      add_parts(i, fine_start, fine / kSkyCubeCoarse);
    } else {
      add(radiance[coarse_start + i], c);
    }
  }
  texels[index] = texel_of(sum.rgb / sum.a);
}
