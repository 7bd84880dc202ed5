// Evaluates the radiance of the sky at the centres of the texels of a sky probe's cube map. One invocation per texel.
// sky_cube_radiance: the radiance, and the solid angle of the texel [sr]. sky_cube_texels: the radiance in half floats.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "sky_probe/sky_radiance.glsl"

#include "sky_probe/sky_cube.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = 2) writeonly buffer sky_cube_radiance_block { vec4 radiance[]; };
layout(std430, binding = 3) writeonly buffer sky_cube_texels_block { uvec2 texels[]; };
layout(push_constant) uniform Push { uint first; };

// Returns the solid angle of a texel [sr]: its area on the face times the mean of the density (1 + s^2 + t^2)^-1.5. The
// mean is the value at the centre plus the next term of its series, which contains the Laplacian.
float solid_angle(uint index, uint width) {
  float h = 1.0 / float(width);
  vec3 centre = texel_point(index, width);
  float q = dot(centre, centre);
  float density = inversesqrt(q) / q;
  float laplacian = density * (15.0 * (q - 1.0) / (q * q) - 6.0 / q);
  return 4.0 * h * h * (density + h * h * laplacian / 6.0);
}

void main() {
  uint index = first + gl_GlobalInvocationID.x;
  vec3 direction = normalize(texel_point(index, probe.cube_size));
  float mu = clamp(dot(direction, probe.up), -1.0, 1.0);
  float nu = clamp(mu * probe.cos_sun_zenith + dot(direction, probe.ahead) * probe.sin_sun_zenith, -1.0, 1.0);
  bool below = ray_hits_ground(probe.altitude_m, mu, medium.planet_radius_m);
  vec3 light = sky_radiance(mu, nu, below) * probe.irradiance;
  radiance[index] = vec4(light, solid_angle(index, probe.cube_size));
  texels[index] = texel_of(light);
}
