// Integrates the sum of the source functions of the orders >= 2 along the ray of each texel, and writes the table of
// the higher orders, phase functions included (lib/table_values.glsl). One invocation per sun x angle x view of one
// altitude.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;
layout(std430, binding = 3) readonly buffer sum_block { vec4 source[]; };

#include "lib/table_mapping.glsl"
#include "precompute/ray_nodes.glsl"
#include "precompute/source_lookup.glsl"

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer shape_block { TableShape shape; };
layout(std430, binding = 2) readonly buffer node_block { RayNode nodes[]; };
layout(binding = 4, rgba16f) uniform writeonly image3D high_orders;

layout(push_constant) uniform Push { uint first; }
push;  // altitude

void main() {
  uvec3 id = gl_GlobalInvocationID;
  if (id.x >= shape.suns || id.y >= shape.angles || id.z >= shape.views) return;
  uint base = id.z * kNodeStride;
  float R = medium.planet_radius_m;
  float h = altitude_from_u(shape, medium, (float(push.first) + 0.5) / float(shape.altitudes));
  bool below;
  float mu = view_from_v(shape, medium, h, (float(id.z) + 0.5) / float(shape.views), below);
  float mu_s = sun_from_w(shape, (float(id.x) + 0.5) / float(shape.suns));
  float nu = angle_from_q(shape, (float(id.y) + 0.5) / float(shape.angles));
  float end = nodes[base + kEndNode].distance_m;
  vec3 column = density_integral_along(medium, h, mu, end);
  // The sun axis refers to the mean distance. q0 is r cos(sun zenith) at the beginning of the ray.
  float middle = density_weighted_mean_distance(medium, h, mu, end, column);
  float q0 = (R + altitude_along(h, mu, middle, R)) * mu_s - middle * nu;
  vec3 radiance = vec3(0.0);
  if (shape.orders > 1u) {
    for (uint i = 0u; i < kHighNodes; ++i) {
      RayNode node = nodes[base + kFirstHighNode + i];
      vec3 scattering = medium.rayleigh_scattering * node.rayleigh + medium.mie_scattering * node.mie;
      float sun_here = (q0 + node.distance_m * nu) / (R + node.altitude_m);
      radiance += node.weight_m * scattering * source_at(medium, node.altitude_m, node.cos_zenith, sun_here, nu);
    }
  }
  NormalisationFactors factors = normalisation_factors(medium, column);
  ivec3 texel = ivec3(int(push.first), int(id.z), int(id.x + shape.suns * id.y));
  imageStore(high_orders, texel, vec4(texel_from_value(radiance / max(factors.high, vec3(1.0e-30))), 1.0));
}
