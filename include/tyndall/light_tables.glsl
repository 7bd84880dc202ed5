// Texture coordinates for the tables of tyndall::LightTables. Include this file in your own shaders.
#ifndef TYNDALL_LIGHT_TABLES_GLSL
#define TYNDALL_LIGHT_TABLES_GLSL

// Texels of both tables along altitude; the last stands for the top of the atmosphere.
const float kLightTableAltitudes = 64.0;
// Of these, the texels below sea level, evenly spaced from the lowest altitude [m] up; the next one stands for sea
// level. Deeper points have the light of the lowest.
const float kLightTableBelow = 4.0;
const float kLowestLightAltitude = -1000.0;

// Cosine of the zenith angle of the horizon of sea level; level from below.
float light_table_horizon(float h, float planet_radius_m) {
  return h > 0.0 ? -sqrt(h * (2.0 * planet_radius_m + h)) / (planet_radius_m + h) : 0.0;
}

// Texture coordinates for a point at `altitude_m` above sea level where the sun stands at
// `cos_sun_zenith`. The sun's coordinate is centred on the horizon that the point sees, where the light
// changes fastest.
vec2 light_table_uv(float altitude_m, float cos_sun_zenith, float planet_radius_m, float atmosphere_height_m) {
  float lowest = max(kLowestLightAltitude, -0.25 * planet_radius_m);
  float h = clamp(altitude_m, lowest, atmosphere_height_m);
  float x = clamp(cos_sun_zenith - light_table_horizon(h, planet_radius_m), -1.0, 1.0);
  float v = 0.5 + 0.5 * sign(x) * sqrt(abs(x));
  float above = sqrt(max(h, 0.0) / atmosphere_height_m) * (kLightTableAltitudes - 1.0 - kLightTableBelow);
  float below = min(h, 0.0) / lowest * kLightTableBelow;
  return vec2((kLightTableBelow + above - below + 0.5) / kLightTableAltitudes, v);
}

// The inverse: altitude and cosine of the sun's zenith angle for texture coordinates in [0; 1].
vec2 light_table_point(vec2 uv, float planet_radius_m, float atmosphere_height_m) {
  float lowest = max(kLowestLightAltitude, -0.25 * planet_radius_m);
  float texel = uv.x * kLightTableAltitudes - 0.5 - kLightTableBelow;  // from that of sea level
  float x = clamp(texel / (kLightTableAltitudes - 1.0 - kLightTableBelow), 0.0, 1.0);
  float h = texel < 0.0 ? lowest * min(-texel / kLightTableBelow, 1.0) : x * x * atmosphere_height_m;
  float s = 2.0 * uv.y - 1.0;
  return vec2(h, clamp(light_table_horizon(h, planet_radius_m) + s * abs(s), -1.0, 1.0));
}

#endif
