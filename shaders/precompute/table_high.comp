// Integrates the sum of the source functions of the orders >= 2 along the ray of each texel, and writes the table of
// the higher orders, phase functions included (lib/table_values.glsl). One invocation per sun x (kAnglesPerInvocation
// angles of one view) of one altitude.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "lib/table_mapping.glsl"
#include "precompute/half_texel.glsl"
#include "precompute/source_lookup.glsl"
#include "precompute/ray_spectra.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer shape_block { TableShape shape; };
layout(std430, binding = 2) readonly buffer table_rays_block { QuadratureRay rays[]; };
layout(binding = 3) uniform sampler3D source_function;
layout(binding = 4, rgba16f) uniform writeonly image3D high_orders;

layout(push_constant) uniform Push {
  uint altitude;
  uint row;  // the first one
}
push;

// Cosines of the sun's zenith angle. source_at_node() treats a sun below the first and above the second differently.
const float kLowSun = 0.2;
const float kHighSun = 0.5;

// Returns the angle nearest to x that forms a triangle on the sphere with a and b.
float angle_in_triangle(float x, float a, float b) { return clamp(x, abs(a - b), min(a + b, 2.0 * kPi - a - b)); }

// Returns the source function at a node. mu_s is the cosine of the sun's zenith angle, nu that of the angle between
// view and sun. Interpolation also reads texels whose three angles form no triangle on the sphere. For these, one of
// the angles is changed:
//   nu <= 0: the azimuth is clamped. Opposite the sun, the light hardly depends on the angle to the sun. In a turbid
//            atmosphere near the horizon it depends strongly on the view zenith angle, which therefore stays as it is.
//   nu > 0:  the angle to the sun determines the aureole. With a low sun, the azimuth is clamped and the light is
//            corrected by angle_shape(). Otherwise the zenith angle of the view is changed, or that of the sun if the
//            sun is high and nearer to the vertical than the view, because its exact position then matters least.
Spectrum source_at_node(AngleShape form, SunAxis suns, RayNode node, float mu_s, float nu) {
  float mu = node.place.z;
  float spread = sqrt(max((1.0 - mu * mu) * (1.0 - mu_s * mu_s), 1.0e-12));
  float cosine = (nu - mu * mu_s) / spread;
  float zenith = node.place.y;
  Spectrum scale = Spectrum(1.0);
  if (cosine > 1.0 && nu > 0.0 && mu_s < kLowSun) {
    scale = angle_shape(form, nu) / angle_shape(form, min(mu * mu_s + spread, 1.0));
  } else if (abs(cosine) > 1.0 && nu > 0.0) {
    float between = acos(clamp(nu, -1.0, 1.0));
    float view = acos(clamp(mu, -1.0, 1.0));
    float sun = acos(clamp(mu_s, -1.0, 1.0));
    if (mu_s > max(kHighSun, abs(mu))) {
      mu_s = cos(angle_in_triangle(sun, view, between));
    } else {
      zenith = source_zenith_index(angle_in_triangle(view, sun, between));
    }
  }
  float azimuth = source_azimuth_index(acos(clamp(cosine, -1.0, 1.0)));
  return scale * source_at(source_function, node.place.x, zenith, azimuth, gather_sun_index(suns, mu_s));
}

void main() {
  AngleShape form = angle_shape_of(medium);
  SunAxis suns = sun_axis(medium);
  TableShape t = shape;
  uint sun = gl_GlobalInvocationID.x;
  uint row = gl_GlobalInvocationID.y + push.row;
  uint groups = (t.angles + kAnglesPerInvocation - 1u) / kAnglesPerInvocation;
  uint view = row / groups;
  uint angle = (row - view * groups) * kAnglesPerInvocation;
  if (sun >= t.suns || view >= t.views) return;
  float mu_s = sun_from_w(t, (float(sun) + 0.5) / float(t.suns));
  float mean_m = rays[view].rayleigh.a;
  float mean_r = rays[view].mie.a;
  uint count = t.orders > 1u ? uint(rays[view].start.w) : 0u;
  float nu[kAnglesPerInvocation];
  float q0[kAnglesPerInvocation];
  Spectrum radiance[kAnglesPerInvocation];
  [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
    nu[k] = angle_from_q(t, (float(angle + k) + 0.5) / float(t.angles));
    // The sun axis refers to the mean distance. q0 is r cos(sun zenith) at the beginning of the ray.
    q0[k] = mean_r * mu_s - mean_m * nu[k];
    radiance[k] = Spectrum(0.0);
  }
  for (uint i = 0u; i < count; ++i) {
    RayNode node = rays[view].high_nodes[i];
    [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
      float sun_here = (q0[k] + node.path.a * nu[k]) / node.place.w;
      radiance[k] += HIGH_PATH(rays[view], node, i) * source_at_node(form, suns, node, sun_here, nu[k]);
    }
  }
  Spectrum factor = RAY_HIGH(rays[view]);
  [[unroll]] for (uint k = 0u; k < kAnglesPerInvocation; ++k) {
    if (angle + k >= t.angles) return;
    Spectrum value = radiance[k] * factor / angle_shape(form, nu[k]);
    ivec3 texel = ivec3(int(push.altitude), int(view), int(sun + t.suns * (angle + k)));
    imageStore(high_orders, texel, half_texel(texel_from_value(value)));
  }
}
