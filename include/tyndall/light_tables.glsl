// Texture coordinates for the tables of tyndall::LightTables. Include this file in your own shaders.
#ifndef TYNDALL_LIGHT_TABLES_GLSL
#define TYNDALL_LIGHT_TABLES_GLSL

// Number of texels of both tables along altitude. The last one is the top of the atmosphere.
const float kLightTableAltitudes = 64.0;
// The first kLightTableBelow of them are below sea level, evenly spaced upwards from kLowestLightAltitude [m]; the next
// one is sea level. Points below the lowest altitude use the first texel.
const float kLightTableBelow = 4.0;
const float kLowestLightAltitude = -1000.0;

// Returns the cosine of the zenith angle of the sea-level horizon, seen from altitude `h` [m]; 0 below sea level.
float light_table_horizon(float h, float planet_radius_m) {
  return h > 0.0 ? -sqrt(h * (2.0 * planet_radius_m + h)) / (planet_radius_m + h) : 0.0;
}

// Returns the texture coordinates for a point at `altitude_m` above sea level and the cosine of the sun's zenith angle
// there. The second coordinate is 0.5 when the sun is on the point's horizon, and has its finest resolution there,
// because the light changes fastest around sunset.
vec2 light_table_uv(float altitude_m, float cos_sun_zenith, float planet_radius_m, float atmosphere_height_m) {
  float lowest = max(kLowestLightAltitude, -0.25 * planet_radius_m);
  float h = clamp(altitude_m, lowest, atmosphere_height_m);
  float x = clamp(cos_sun_zenith - light_table_horizon(h, planet_radius_m), -1.0, 1.0);
  float v = 0.5 + 0.5 * sign(x) * sqrt(abs(x));
  float above = sqrt(max(h, 0.0) / atmosphere_height_m) * (kLightTableAltitudes - 1.0 - kLightTableBelow);
  float below = min(h, 0.0) / lowest * kLightTableBelow;
  return vec2((kLightTableBelow + above - below + 0.5) / kLightTableAltitudes, v);
}

// Returns the inverse of light_table_uv(): altitude [m] and cosine of the sun's zenith angle, for coordinates in [0;
// 1].
vec2 light_table_point(vec2 uv, float planet_radius_m, float atmosphere_height_m) {
  float lowest = max(kLowestLightAltitude, -0.25 * planet_radius_m);
  float texel = uv.x * kLightTableAltitudes - 0.5 - kLightTableBelow;  // counted from the texel at sea level
  float x = clamp(texel / (kLightTableAltitudes - 1.0 - kLightTableBelow), 0.0, 1.0);
  float h = texel < 0.0 ? lowest * min(-texel / kLightTableBelow, 1.0) : x * x * atmosphere_height_m;
  float s = 2.0 * uv.y - 1.0;
  return vec2(h, clamp(light_table_horizon(h, planet_radius_m) + s * abs(s), -1.0, 1.0));
}

#endif
