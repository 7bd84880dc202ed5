// The ground in sunlight that has come through the air and under the light of the sky.
// Out: radiance of the ground itself; what the air adds between it and the eye is the effect's business.
#version 460
#extension GL_GOOGLE_include_directive : require

#define SHADOW_COLORS 6
#include "scene/terrain_ground.glsl"
#include "tyndall/light_tables.glsl"

layout(location = 0) out vec4 radiance;

layout(binding = 4) uniform sampler2D sun_transmittance;
layout(binding = 5) uniform sampler2D sky_irradiance;

void ground_light(float altitude_m, float cos_sun_zenith, out vec3 sun, out vec3 sky) {
  vec2 uv = light_table_uv(altitude_m, cos_sun_zenith, terrain.planet_radius_m, terrain.atmosphere_height_m);
  sun = texture(sun_transmittance, uv).rgb;
  sky = texture(sky_irradiance, uv).rgb;
}

void main() { radiance = vec4(ground_radiance(), 1.0); }
