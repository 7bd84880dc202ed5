// The terrain's chart in single precision: see src/scene/chart.hpp. Heights and distances keep their
// digits because the planet's radius is never added to what is subtracted from it again.
#ifndef TYNDALL_CHART_GLSL
#define TYNDALL_CHART_GLSL

vec3 world_from_map(vec2 map_m, float altitude_m, float radius_m) {
  float arc = length(map_m) / radius_m;
  float sine_per_arc = arc > 1e-4 ? sin(arc) / arc : 1.0 - arc * arc / 6.0;
  float scale = sine_per_arc * (1.0 + altitude_m / radius_m);
  float half_sine = sin(0.5 * arc);
  return vec3(map_m.x * scale, altitude_m * cos(arc) - 2.0 * radius_m * half_sine * half_sine, map_m.y * scale);
}

// The surface's normal in the world, from the gradient of the elevation in map coordinates. The chart is
// taken as true to scale, which it is to 0.4 % within 1000 km of the origin.
vec3 normal_from_gradient(vec2 gradient, vec3 up) {
  vec3 east = normalize(vec3(1.0, 0.0, 0.0) - up * up.x);
  vec3 south = cross(east, up);
  return normalize(up - gradient.x * east - gradient.y * south);
}

#endif
