// Look-ups in the scattering tables. Include after declaring
//   uniform sampler3D single_rayleigh, single_mie, high_orders;   linear, clamped
// Radiances are relative to the sun's irradiance above the atmosphere [1/sr].
#ifndef TYNDALL_TABLE_LOOKUP_GLSL
#define TYNDALL_TABLE_LOOKUP_GLSL

#include "lib/phase.glsl"
#include "lib/table_mapping.glsl"
#include "lib/table_values.glsl"

// A ray from a point within the air to its end: the ground if `below`, else the top of the atmosphere.
struct TableRay {
  float altitude;
  float cos_zenith;
  float cos_sun_zenith;
  float cos_view_sun;
  bool below;
  float end_m;
};

// What the air of a ray sends to its origin.
struct AirLight {
  vec3 single;  // scattered once
  vec3 high;    // more than once
};

TableRay table_ray(Medium m, float h, float mu, float mu_s, float nu, bool below) {
  TableRay ray = TableRay(h, mu, mu_s, nu, below, 0.0);
  float R = m.planet_radius_m;
  if (below) {
    float near;
    float far;
    ray.end_m = -(R + h) * mu;  // at the perigee, for rays that miss the ground by a rounding error
    if (shell_intersections(h, mu, min(h, 0.0), R, near, far)) ray.end_m = near;
    ray.end_m = max(ray.end_m, 0.0);
  } else {
    ray.end_m = distance_to_top(h, mu, m.atmosphere_height_m, R);
  }
  return ray;
}

// The same ray from a point further along, on the same side of the horizon: pairs of look-ups must agree on
// it, or their difference breaks at the horizon.
TableRay ray_further_on(Medium m, TableRay ray, float distance_m) {
  float R = m.planet_radius_m;
  float h = altitude_along(ray.altitude, ray.cos_zenith, distance_m, R);
  float sun = ((R + ray.altitude) * ray.cos_sun_zenith + distance_m * ray.cos_view_sun) / (R + h);
  TableRay out_ray = ray;
  out_ray.altitude = clamp(h, 0.0, m.atmosphere_height_m);
  out_ray.cos_zenith = cos_zenith_along(ray.altitude, ray.cos_zenith, distance_m, R);
  out_ray.cos_sun_zenith = clamp(sun, -1.0, 1.0);
  out_ray.end_m = max(ray.end_m - distance_m, 0.0);
  return out_ray;
}

// Texture coordinates of altitude, view and sun, and the slice that the angle to the sun lies in: the third
// texture axis holds the suns of one angle after the other, and filtering stays within one.
struct TableCoordinates {
  vec3 near;
  vec3 far;
  float far_part;
};

// `column`: of the whole ray.
TableCoordinates table_coordinates(TableShape t, Medium m, TableRay ray, vec3 column) {
  float h = table_altitude(m, ray.altitude);
  float u = u_from_altitude(t, m, h);
  float v = v_from_view(t, m, h, ray.cos_zenith, ray.below);
  float middle = middle_of_air(m, ray.altitude, ray.cos_zenith, ray.end_m, column);
  float w = w_from_sun(t, ray_further_on(m, ray, middle).cos_sun_zenith);
  float slices = float(t.angles);
  float slice = clamp(q_from_angle(t, ray.cos_view_sun) * slices - 0.5, 0.0, slices - 1.0);
  float first = min(floor(slice), slices - 2.0);
  TableCoordinates c;
  c.near = vec3(u, v, (first + w) / slices);
  c.far = vec3(u, v, (first + 1.0 + w) / slices);
  c.far_part = slice - first;
  return c;
}

vec3 table_value(sampler3D table, TableCoordinates c) {
  return value_from_texel(mix(textureLod(table, c.near, 0.0).rgb, textureLod(table, c.far, 0.0).rgb, c.far_part));
}

// `column`: of the whole ray.
AirLight light_of_column(TableShape t, Medium m, TableRay ray, vec3 column) {
  TableCoordinates c = table_coordinates(t, m, ray, column);
  Guide guide = guide_for_column(m, column);
  vec3 rayleigh = m.rayleigh_scattering * rayleigh_phase(ray.cos_view_sun);
  vec3 mie = m.mie_scattering * mie_phase(m, ray.cos_view_sun);
  AirLight light;
  light.single = rayleigh * guide.rayleigh * table_value(single_rayleigh, c) +
                 mie * guide.mie * table_value(single_mie, c);
  light.high = guide.high * table_value(high_orders, c);
  return light;
}

AirLight light_to_end(TableShape t, Medium m, TableRay ray) {
  return light_of_column(t, m, ray, column_along(m, ray.altitude, ray.cos_zenith, ray.end_m));
}

// The light of the part [from, to] of a ray [m], seen from the ray's origin: L(a) - T(a, b) L(b), dimmed by
// the air before it.
AirLight light_between(TableShape t, Medium m, TableRay ray, float from, float to) {
  float end = min(to, ray.end_m);
  AirLight light = AirLight(vec3(0.0), vec3(0.0));
  if (end <= from) return light;
  // A loop, because every copy of the look-up is a heavy piece of code.
  int ends = end < ray.end_m ? 2 : 1;
  for (int i = 0; i < ends; ++i) {
    float d = i == 0 ? from : end;
    vec3 through = transmittance(m, column_along(m, ray.altitude, ray.cos_zenith, d));
    AirLight beyond = light_to_end(t, m, ray_further_on(m, ray, d));
    vec3 share = i == 0 ? through : -through;
    light.single += share * beyond.single;
    light.high += share * beyond.high;
  }
  light.single = max(light.single, vec3(0.0));
  light.high = max(light.high, vec3(0.0));
  return light;
}

#endif
