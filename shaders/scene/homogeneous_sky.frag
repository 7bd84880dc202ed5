// The sky of Hoffman and Preetham's model, with sun and moon behind it.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "scene/moon.glsl"
#include "scene/homogeneous_air.glsl"

layout(location = 0) in vec3 offset;
layout(location = 1) in vec3 vertex_extinction;
layout(location = 2) in vec3 vertex_inscattering;
layout(location = 0) out vec4 radiance;

void main() {
  vec3 extinction = vertex_extinction;
  vec3 inscattering = vertex_inscattering;
  vec3 direction = normalize(offset);
  if (kPerPixel != 0u) {
    float air_m;
    air_to(direction, true, extinction, inscattering, air_m);
  }
  // The planet hides the sun, whether or not ground is drawn there.
  bool open = !ray_hits_ground(eye_altitude_m, dot(direction, eye_up), medium.planet_radius_m);
  radiance = vec4((open ? beyond_air(direction) * ground_shown * extinction : vec3(0.0)) + inscattering, 1.0);
}
