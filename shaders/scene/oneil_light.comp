// Lights the ground seen through O'Neil's medium, once per visible pixel.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_pixel.glsl"
#include "scene/oneil_air.glsl"

// The results at the vertices; not read with scattering.evaluate = pixel.
layout(binding = 9, rgba32f) readonly uniform image2D air_0;
layout(binding = 10, rgba32f) readonly uniform image2D air_1;
layout(binding = 11, rgba32f) readonly uniform image2D air_2;

void ground_light(float altitude_m, float cos_sun_zenith, out vec3 sun, out vec3 sky) {
  light_on_ground(altitude_m, cos_sun_zenith, sun, sky);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  GroundPoint point;
  if (!ground_of_pixel(pixel, point)) return;
  vec3 offset = point.position - eye_position;
  OneilLight light;
  if (kPerPixel != 0u) {
    light = oneil_light(normalize(offset), length(offset), kAtDistance);
  } else {
    light.rayleigh = imageLoad(air_0, pixel).rgb;
    light.mie = imageLoad(air_1, pixel).rgb;
    light.transmittance = imageLoad(air_2, pixel).rgb;
  }
  vec3 ground = ground_shown != 0.0 ? ground_radiance(point) : vec3(0.0);
  imageStore(scene_color, pixel,
             vec4(ground * light.transmittance + oneil_inscattering(normalize(offset), light), 1.0));
}
