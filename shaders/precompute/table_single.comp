// Integrates single scattering along the ray of each texel, and writes the tables of the two species, without phase
// functions (lib/table_values.glsl). One invocation per sun x (kAnglesPerInvocation angles of one view) of one
// altitude.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "lib/table_mapping.glsl"
#include "lib/table_values.glsl"
#include "precompute/half_texel.glsl"
#include "precompute/ray_spectra.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer shape_block { TableShape shape; };
layout(std430, binding = 2) readonly buffer table_rays_block { QuadratureRay rays[]; };
layout(binding = 3, rgba16f) uniform writeonly image3D single_rayleigh;
layout(binding = 4, rgba16f) uniform writeonly image3D single_mie;

layout(push_constant) uniform Push {
  uint altitude;
  uint row;  // the first one
}
push;

void main() {
  Medium m = medium;
  TableShape t = shape;
  uint sun = gl_GlobalInvocationID.x;
  uint row = gl_GlobalInvocationID.y + push.row;
  uint groups = (t.angles + kAnglesPerInvocation - 1u) / kAnglesPerInvocation;
  uint view = row / groups;
  uint angle = (row - view * groups) * kAnglesPerInvocation;
  if (sun >= t.suns || view >= t.views) return;
  float mu_s = sun_from_w(t, (float(sun) + 0.5) / float(t.suns));
  vec4 rayleigh_factor = rays[view].rayleigh;
  vec4 mie_factor = rays[view].mie;
  uint count = uint(rays[view].start.z);
  float nu[kAnglesPerInvocation];
  float q0[kAnglesPerInvocation];
  Spectrum rayleigh[kAnglesPerInvocation];
  Spectrum mie[kAnglesPerInvocation];
  [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
    nu[k] = angle_from_q(t, (float(angle + k) + 0.5) / float(t.angles));
    // The sun axis refers to the mean distance. q0 is r cos(sun zenith) at the beginning of the ray.
    q0[k] = mie_factor.a * mu_s - rayleigh_factor.a * nu[k];
    rayleigh[k] = Spectrum(0.0);
    mie[k] = Spectrum(0.0);
  }
  for (uint i = 0u; i < count; ++i) {
    RayNode node = rays[view].single_nodes[i];
    [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
      Spectrum light = SINGLE_PATH(node) * sun_transmittance_at(m, node.place.z, q0[k] + node.path.a * nu[k]);
      rayleigh[k] += light * node.place.x;
      mie[k] += light * node.place.y;
    }
  }
  [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
    if (angle + k >= t.angles) return;
    ivec3 texel = ivec3(int(push.altitude), int(view), int(sun + t.suns * (angle + k)));
    imageStore(single_rayleigh, texel,
               half_texel(texel_from_value(rayleigh[k] * RAY_RAYLEIGH(rays[view], rayleigh_factor))));
    imageStore(single_mie, texel, half_texel(texel_from_value(mie[k] * RAY_MIE(rays[view], mie_factor))));
  }
}
