// Integrates single scattering along the ray of each texel, and writes the tables of the two species, without phase
// functions (lib/table_values.glsl). One invocation per sun x angle x view of one altitude.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/table_mapping.glsl"
#include "lib/table_values.glsl"
#include "precompute/ray_nodes.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer shape_block { TableShape shape; };
layout(std430, binding = 2) readonly buffer node_block { RayNode nodes[]; };
layout(binding = 3, rgba16f) uniform writeonly image3D single_rayleigh;
layout(binding = 4, rgba16f) uniform writeonly image3D single_mie;

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
  vec3 rayleigh = vec3(0.0);
  vec3 mie = vec3(0.0);
  for (uint i = 0u; i < kSingleNodes; ++i) {
    RayNode node = nodes[base + i];
    vec3 light = node.weight_m * sun_transmittance_at(medium, node.altitude_m, q0 + node.distance_m * nu);
    rayleigh += light * node.rayleigh;
    mie += light * node.mie;
  }
  NormalisationFactors factors = normalisation_factors(medium, column);
  ivec3 texel = ivec3(int(push.first), int(id.z), int(id.x + shape.suns * id.y));
  imageStore(single_rayleigh, texel, vec4(texel_from_value(rayleigh / factors.rayleigh), 1.0));
  imageStore(single_mie, texel, vec4(texel_from_value(mie / factors.mie), 1.0));
}
