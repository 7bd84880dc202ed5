// Lights the ground by attenuated sunlight and by the sky, once per visible pixel. In: the ground points that
// terrain.frag wrote. Out, in the same image: the radiance of the ground itself; the effect adds the medium between
// ground and eye.
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
