// Where to sample the tables of tyndall::LightTables. Include it in your own shaders.
#ifndef TYNDALL_LIGHT_TABLES_GLSL
#define TYNDALL_LIGHT_TABLES_GLSL

// Texture coordinates for a point at `altitude_m` above sea level where the sun stands at
// `cos_sun_zenith`. The sun's coordinate is centred on the horizon that the point sees, where the light
// changes fastest.
vec2 light_table_uv(float altitude_m, float cos_sun_zenith, float planet_radius_m, float atmosphere_height_m) {
  float h = clamp(altitude_m, 0.0, atmosphere_height_m);
  float cos_horizon = -sqrt(h * (2.0 * planet_radius_m + h)) / (planet_radius_m + h);
  float x = clamp(cos_sun_zenith - cos_horizon, -1.0, 1.0);
  float v = 0.5 + 0.5 * sign(x) * sqrt(abs(x));
  return vec2(sqrt(h / atmosphere_height_m), v);
}

// The inverse: altitude and cosine of the sun's zenith angle for texture coordinates in [0; 1].
vec2 light_table_point(vec2 uv, float planet_radius_m, float atmosphere_height_m) {
  float h = uv.x * uv.x * atmosphere_height_m;
  float cos_horizon = -sqrt(h * (2.0 * planet_radius_m + h)) / (planet_radius_m + h);
  float s = 2.0 * uv.y - 1.0;
  return vec2(h, clamp(cos_horizon + s * abs(s), -1.0, 1.0));
}

#endif
