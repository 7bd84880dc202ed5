// Look-ups in the scattering tables. Radiances are relative to the sun's irradiance above the atmosphere [1/sr].
#ifndef TYNDALL_TABLE_LOOKUP_GLSL
#define TYNDALL_TABLE_LOOKUP_GLSL

#include "lib/phase.glsl"
#include "lib/table_mapping.glsl"
#include "lib/table_values.glsl"

// The tables are filtered linearly, and clamped. A file that includes this one may define another layout.
#ifndef TABLE_LAYOUT
#define TABLE_LAYOUT(index) layout(binding = 6 + index)
#endif
TABLE_LAYOUT(0) uniform sampler3D single_rayleigh;
TABLE_LAYOUT(1) uniform sampler3D single_mie;
TABLE_LAYOUT(2) uniform sampler3D high_orders;

// A ray from a point within the atmosphere to its end: the ground if `below`, else the top of the atmosphere.
struct TableRay {
  float altitude;
  float cos_zenith;
  float cos_sun_zenith;
  float cos_view_sun;
  bool below;
  float end_m;
};

// In-scattered radiance at the origin of a ray.
struct InScattering {
  Spectrum single;  // order 1
  Spectrum high;    // orders 2 and higher
};

TableRay table_ray(Medium m, float h, float mu, float mu_s, float nu, bool below) {
  TableRay ray = TableRay(h, mu, mu_s, nu, below, 0.0);
  float R = m.planet_radius_m;
  ray.end_m = below ? distance_to_ground(h, mu, R) : distance_to_top(h, mu, m.atmosphere_height_m, R);
  return ray;
}

// Returns the same ray from a point further along, on the same side of the horizon. A pair of look-ups must agree on
// the side, or their difference jumps at the horizon.
TableRay ray_further_on(Medium m, TableRay ray, float distance_m) {
  float R = m.planet_radius_m;
  float h = altitude_along(ray.altitude, ray.cos_zenith, distance_m, R);
  float sun = ((R + ray.altitude) * ray.cos_sun_zenith + distance_m * ray.cos_view_sun) / (R + h);
  TableRay out_ray = ray;
  out_ray.altitude = min(h, m.atmosphere_height_m);
  out_ray.cos_zenith = cos_zenith_along(ray.altitude, ray.cos_zenith, distance_m, R);
  out_ray.cos_sun_zenith = clamp(sun, -1.0, 1.0);
  out_ray.end_m = max(ray.end_m - distance_m, 0.0);
  return out_ray;
}

// The terms that are constant along a ray: scattering times phase function, and the two slices of the angle axis.
// Compute them once, before a loop over points of the ray; some compilers do not hoist them.
struct TableAngle {
  Spectrum rayleigh;  // scattering x phase function [1 / (m sr)]
  Spectrum mie;
  Spectrum shape;  // angle_shape()
  float slices;
  float first;
  float part;  // weight of the second slice
};

TableAngle table_angle(TableShape t, Medium m, float nu) {
  TableAngle a;
  a.rayleigh = RAYLEIGH_SCATTERING(m) * rayleigh_phase(nu);
  a.mie = mie_scattering_towards(m, nu);
  a.shape = angle_shape(angle_shape_of(m), nu);
  a.slices = float(t.angles);
  float slice = clamp(q_from_angle(t, nu) * a.slices - 0.5, 0.0, a.slices - 1.0);
  a.first = min(floor(slice), a.slices - 2.0);
  a.part = slice - a.first;
  return a;
}

// Texture coordinates of altitude, view and sun in both slices of the angle axis. The third texture axis stores the
// suns of one angle after the other; filtering stays within one angle.
struct TableCoordinates {
  vec3 near;
  vec3 far;
};

// Returns the texture coordinates. `integral` is the density integral of the whole ray.
TableCoordinates table_coordinates(TableShape t, Medium m, TableAngle angle, TableRay ray, vec3 integral) {
  float h = table_altitude(m, ray.altitude);
  float v = v_from_view(t, m, h, ray.cos_zenith, ray.below);
  float mean_m = density_weighted_mean_distance(m, ray.altitude, ray.cos_zenith, ray.end_m, integral);
  float mu_s = ray_further_on(m, ray, mean_m).cos_sun_zenith;
  float u = u_for_lookup(t, m, ray.altitude < 0.0 ? ray.altitude : h, mu_s);
  float w = w_from_sun(t, mu_s);
  return TableCoordinates(vec3(u, v, (angle.first + w) / angle.slices),
                          vec3(u, v, (angle.first + 1.0 + w) / angle.slices));
}

Spectrum table_value(sampler3D table, TableCoordinates c, float part) {
  return value_from_texel(mix(CHANNELS(textureLod(table, c.near, 0.0)), CHANNELS(textureLod(table, c.far, 0.0)), part));
}

// Returns the in-scattering of a whole ray with the density integral `integral`.
InScattering inscattering_from_integral(TableShape t, Medium m, TableAngle angle, TableRay ray, vec3 integral) {
  TableCoordinates c = table_coordinates(t, m, angle, ray, integral);
  NormalisationFactors factors = normalisation_factors(m, integral);
  InScattering light;
  light.single = angle.rayleigh * factors.rayleigh * table_value(single_rayleigh, c, angle.part) +
                 angle.mie * factors.mie * table_value(single_mie, c, angle.part);
  light.high = factors.high * angle.shape * table_value(high_orders, c, angle.part);
  return light;
}

// Returns the optical depth of Rayleigh scattering and aerosol between the altitude h and the lowest of the tables
// above it, along a unit of the vertical.
Spectrum depth_below_tables(Medium m, float h) {
  float H = m.rayleigh_scale_height_m;
  float G = m.mie_scale_height_m;
  float lowest = lowest_table_altitude(m);
  return RAYLEIGH_SCATTERING(m) * (H * (exp(min(-h / H, 60.0)) - exp(-lowest / H))) +
         MIE_EXTINCTION(m) * (G * (exp(min(-h / G, 60.0)) - exp(-lowest / G)));
}

// Returns a factor for the orders >= 2 of a ray that begins below the lowest altitude of the tables. The tables give
// the light at that altitude, which is brighter. The factor is an estimate: light that does not come from above that
// altitude is absorbed in part, and scattered back in part, in proportion to 1 - g. Both parts are fitted to the path
// tracer (docs/adr/0007-below-sea-level.md).
Spectrum deep_factor(Medium m, TableRay ray) {
  float h = ray.altitude;
  float lowest = lowest_table_altitude(m);
  if (h >= lowest) return Spectrum(1.0);
  float slant = 1.0 / max(ray.cos_sun_zenith, 0.2);
  float G = m.mie_scale_height_m;
  float above = G * exp(-lowest / G);
  float here = G * exp(min(-h / G, 60.0));
  Spectrum back = (1.25 * (1.0 - max(m.mie_g, 0.0)) * slant) * MIE_SCATTERING(m);
  Spectrum absorbed = (0.5 * slant * (here - above)) * (MIE_EXTINCTION(m) - MIE_SCATTERING(m));
  Spectrum attenuation = exp(-absorbed) * (1.0 + back * above) / (1.0 + back * here);
  Spectrum from_above = exp(-depth_below_tables(m, h) / max(ray.cos_zenith, 1.0e-3));
  return mix(attenuation, Spectrum(1.0), from_above);
}

InScattering inscattering_to_end(TableShape t, Medium m, TableAngle angle, TableRay ray) {
  return inscattering_from_integral(t, m, angle, ray,
                                    density_integral_along(m, ray.altitude, ray.cos_zenith, ray.end_m));
}

// Returns the in-scattering of the part [from, to] of a ray [m] as seen from its origin: L(from) - T(from, to) L(to),
// attenuated by the medium before `from`.
InScattering inscattering_between(TableShape t, Medium m, TableRay ray, float from, float to) {
  float end = min(to, ray.end_m);
  InScattering light = InScattering(Spectrum(0.0), Spectrum(0.0));
  if (end <= from) return light;
  // A loop, because each inlined copy of the look-up is large.
  int ends = end < ray.end_m ? 2 : 1;
  TableAngle angle = table_angle(t, m, ray.cos_view_sun);
  for (int i = 0; i < ends; ++i) {
    float d = i == 0 ? from : end;
    Spectrum path_transmittance = transmittance(m, density_integral_along(m, ray.altitude, ray.cos_zenith, d));
    InScattering beyond = inscattering_to_end(t, m, angle, ray_further_on(m, ray, d));
    Spectrum weight = i == 0 ? path_transmittance : -path_transmittance;
    light.single += weight * beyond.single;
    light.high += weight * beyond.high;
  }
  light.single = max(light.single, Spectrum(0.0));
  light.high = max(light.high, Spectrum(0.0));
  return light;
}

#endif
