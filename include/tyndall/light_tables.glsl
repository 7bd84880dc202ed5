// Where to sample the tables of tyndall::LightTables. Include it in your own shaders.
#ifndef TYNDALL_LIGHT_TABLES_GLSL
#define TYNDALL_LIGHT_TABLES_GLSL

// Texels of both tables along altitude; the first and the last stand for sea level and the top.
const float kLightTableAltitudes = 64.0;

// Texture coordinates for a point at `altitude_m` above sea level where the sun stands at
// `cos_sun_zenith`. The sun's coordinate is centred on the horizon that the point sees, where the light
// changes fastest.
vec2 light_table_uv(float altitude_m, float cos_sun_zenith, float planet_radius_m, float atmosphere_height_m) {
  float h = clamp(altitude_m, 0.0, atmosphere_height_m);
  float cos_horizon = -sqrt(h * (2.0 * planet_radius_m + h)) / (planet_radius_m + h);
  float x = clamp(cos_sun_zenith - cos_horizon, -1.0, 1.0);
  float v = 0.5 + 0.5 * sign(x) * sqrt(abs(x));
  float u = (sqrt(h / atmosphere_height_m) * (kLightTableAltitudes - 1.0) + 0.5) / kLightTableAltitudes;
  return vec2(u, v);
}

// The inverse: altitude and cosine of the sun's zenith angle for texture coordinates in [0; 1].
vec2 light_table_point(vec2 uv, float planet_radius_m, float atmosphere_height_m) {
  float x = clamp((uv.x * kLightTableAltitudes - 0.5) / (kLightTableAltitudes - 1.0), 0.0, 1.0);
  float h = x * x * atmosphere_height_m;
  float cos_horizon = -sqrt(h * (2.0 * planet_radius_m + h)) / (planet_radius_m + h);
  float s = 2.0 * uv.y - 1.0;
  return vec2(h, clamp(cos_horizon + s * abs(s), -1.0, 1.0));
}

#endif
