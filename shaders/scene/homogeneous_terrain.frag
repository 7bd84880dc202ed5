// The ground through Hoffman and Preetham's air: equation 1.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/terrain_inputs.glsl"
#include "scene/homogeneous_air.glsl"

layout(location = 5) in vec3 vertex_extinction;
layout(location = 6) in vec3 vertex_inscattering;
layout(location = 0) out vec4 radiance;

void ground_light(float altitude_m, float cos_sun_zenith, out vec3 sun, out vec3 sky) {
  sun = sun_on_ground;
  sky = sky_on_ground;
  if (in_space != 0u) {
    sun = homogeneous_sun(medium, cos_sun_zenith);
    float place = sqrt(clamp(cos_sun_zenith, 0.0, 1.0)) * (kSunsOfSky - 1.0);
    uint below = uint(min(floor(place), kSunsOfSky - 2.0));
    sky = cos_sun_zenith > 0.0 ? mix(sky_by_sun[below].rgb, sky_by_sun[below + 1u].rgb, place - float(below)) : vec3(0.0);
  }
}

void main() {
  vec3 extinction = vertex_extinction;
  vec3 inscattering = vertex_inscattering;
  if (kPerPixel != 0u) {
    float air_m;
    air_to(world_position - eye_position, false, extinction, inscattering, air_m);
  }
  radiance = vec4(ground_radiance() * ground_shown * extinction + inscattering, 1.0);
}
