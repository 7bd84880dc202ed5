// The ground through O'Neil's air: what it sends, attenuated, and the light that the air adds.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_inputs.glsl"
#include "scene/oneil_air.glsl"

layout(location = 5) in vec3 vertex_rayleigh;
layout(location = 6) in vec3 vertex_mie;
layout(location = 7) in vec3 vertex_through;
layout(location = 0) out vec4 radiance;

void ground_light(float altitude_m, float cos_sun_zenith, out vec3 sun, out vec3 sky) {
  light_on_ground(altitude_m, cos_sun_zenith, sun, sky);
}

void main() {
  vec3 rayleigh = vertex_rayleigh;
  vec3 mie = vertex_mie;
  vec3 through = vertex_through;
  vec3 offset = world_position - eye_position;
  if (kPerPixel != 0u) oneil_air(normalize(offset), length(offset), kAtDistance, rayleigh, mie, through);
  vec3 ground = ground_shown != 0.0 ? ground_radiance() : vec3(0.0);
  radiance = vec4(ground * through + air_radiance(normalize(offset), rayleigh, mie), 1.0);
}
