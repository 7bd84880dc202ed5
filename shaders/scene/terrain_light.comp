// The ground in sunlight that has come through the air and under the light of the sky, once for each pixel that shows
// it. In: what terrain.frag has left. Out, in its place: radiance of the ground itself; what the air adds between it
// and the eye is the effect's business.
#version 460
#extension GL_GOOGLE_include_directive : require

#define SHADOW_COLORS 6
#include "scene/terrain_pixel.glsl"
#include "tyndall/light_tables.glsl"

layout(binding = 4) uniform sampler2D sun_transmittance;
layout(binding = 5) uniform sampler2D sky_irradiance;

void ground_light(float altitude_m, float cos_sun_zenith, out vec3 sun, out vec3 sky) {
  vec2 uv = light_table_uv(altitude_m, cos_sun_zenith, terrain.planet_radius_m, terrain.atmosphere_height_m);
  sun = textureLod(sun_transmittance, uv, 0.0).rgb;
  sky = textureLod(sky_irradiance, uv, 0.0).rgb;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  GroundPoint point;
  if (ground_of_pixel(pixel, point)) imageStore(scene_color, pixel, vec4(ground_radiance(point), 1.0));
}
