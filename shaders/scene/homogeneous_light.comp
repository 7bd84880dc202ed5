// Lights the ground seen through Hoffman and Preetham's medium, once per visible pixel: equation 1.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_pixel.glsl"
#include "scene/homogeneous_air.glsl"

// The results at the vertices; not read with scattering.evaluate = pixel.
layout(binding = 9, rgba32f) readonly uniform image2D air_0;
layout(binding = 10, rgba32f) readonly uniform image2D air_1;

void ground_light(float altitude_m, float cos_sun_zenith, out vec3 sun, out vec3 sky) {
  sun = sun_on_ground;
  sky = sky_on_ground;
  if (in_space != 0u) {
    sun = homogeneous_sun(medium, cos_sun_zenith);
    float place = sqrt(clamp(cos_sun_zenith, 0.0, 1.0)) * (kSunsOfSky - 1.0);
    uint below = uint(min(floor(place), kSunsOfSky - 2.0));
    sky =
        cos_sun_zenith > 0.0 ? mix(sky_by_sun[below].rgb, sky_by_sun[below + 1u].rgb, place - float(below)) : vec3(0.0);
  }
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  GroundPoint point;
  if (!ground_of_pixel(pixel, point)) return;
  vec3 extinction;
  vec3 inscattering;
  if (kPerPixel != 0u) {
    float air_m;
    air_to(point.position - eye_position, false, extinction, inscattering, air_m);
  } else {
    extinction = imageLoad(air_0, pixel).rgb;
    inscattering = imageLoad(air_1, pixel).rgb;
  }
  vec3 ground = ground_shown != 0.0 ? ground_radiance(point) : vec3(0.0);
  imageStore(scene_color, pixel, vec4(ground * extinction + inscattering, 1.0));
}
