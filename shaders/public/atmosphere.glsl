// Sunlight, sky light, in-scattering and transmittance for shaders of engines, in agreement with what Tyndall draws.
// docs/atmosphere_glsl.md explains how to use this file. Every name in it begins with tyndall_, Tyndall, kTyndall or
// TYNDALL_. It needs GLSL 4.50 or later and no extension.
//
// Positions are in the coordinates of AtmosphereInputs [m]. Directions have unit length. Irradiance has the unit of
// Sun::irradiance, radiance that unit per steradian; both include scattering.scale.
//
// Macros that you may define before you include this file:
//   TYNDALL_SET            descriptor set, by default 0
//   TYNDALL_FIRST_BINDING  binding of the uniform block, by default 0. The images of atmosphere_images() follow it.
//   TYNDALL_SHADOW(p)      returns the fraction of sunlight that reaches position p through your shadows, as a float or
//                          a vec3 from 0 to 1. It enables tyndall_between_shadowed().
//   TYNDALL_CLOUDS_BINDING binding of your map of clouds (FrameInputs::clouds), a combined image sampler with linear
//                          filtering that clamps to an opaque white border. Clouds then darken the results of
//                          tyndall_sun_irradiance() and tyndall_between_shadowed(), which it enables as well.
//   TYNDALL_PHASE_BINDING  binding of a uniform block with the rows of atmosphere_phase(), for atmosphere.mie_phase =
//                          draine or table. Without it, both phase functions are replaced by that of Henyey and
//                          Greenstein with the same mean cosine.
#ifndef TYNDALL_ATMOSPHERE_GLSL
#define TYNDALL_ATMOSPHERE_GLSL

#ifndef TYNDALL_SET
#define TYNDALL_SET 0
#endif
#ifndef TYNDALL_FIRST_BINDING
#define TYNDALL_FIRST_BINDING 0
#endif

#include "shared/medium.h"
#ifdef TYNDALL_PHASE_BINDING
layout(std140, set = TYNDALL_SET, binding = TYNDALL_PHASE_BINDING) uniform phase_rows_block {
  vec4 phase_rows[kPhaseNodes];
};
#define PHASE_ENTRY(m, i) phase_rows[i]
#define PHASE_TABULATED(m) ((m).mie_phase >= 2u)
#endif

#define TABLE_LAYOUT(index) layout(set = TYNDALL_SET, binding = TYNDALL_FIRST_BINDING + 2 + index)
#include "frame/table_lookup.glsl"
#include "lib/froxels.glsl"
#include "lib/single_scattering.glsl"
#include "lib/spectrum.glsl"
#include "shared/atmosphere.h"
#include "tyndall/light_tables.glsl"

layout(std140, set = TYNDALL_SET, binding = TYNDALL_FIRST_BINDING) uniform constants_block {
  AtmosphereConstants tyndall_constants;
};
layout(set = TYNDALL_SET, binding = TYNDALL_FIRST_BINDING + 1) uniform sampler2D sky_irradiance_table;
layout(set = TYNDALL_SET, binding = TYNDALL_FIRST_BINDING + 5) uniform sampler3D froxel_inscattering;
layout(set = TYNDALL_SET, binding = TYNDALL_FIRST_BINDING + 6) uniform sampler3D froxel_transmittance;

#ifdef TYNDALL_CLOUDS_BINDING
#include "lib/cloud_map.glsl"
layout(set = TYNDALL_SET, binding = TYNDALL_CLOUDS_BINDING) uniform sampler2D tyndall_clouds;

// Returns the fraction of sunlight that the clouds transmit to a position.
vec3 tyndall_cloud_transmittance(vec3 position) {
  vec4 place = vec4(position, 1.0);
  vec2 uv = vec2(dot(tyndall_constants.cloud_u, place), dot(tyndall_constants.cloud_v, place));
  vec4 texel = textureLod(tyndall_clouds, uv, 0.0);
  return mix(vec3(1.0), texel.rgb, behind_clouds(texel.a, dot(tyndall_constants.cloud_depth, place), 0.0));
}
#ifndef TYNDALL_SHADOW
#define TYNDALL_SHADOW(p) 1.0
#endif
#define SUNLIGHT_THROUGH(color, position) (color) * tyndall_cloud_transmittance(position)
#else
#define SUNLIGHT_THROUGH(color, position) (color)
#endif

// The in-scattering and the transmittance along a path.
struct TyndallPath {
  vec3 inscattering;       // radiance that reaches the beginning of the path
  Spectrum transmittance;  // fraction of the light at its end that reaches the beginning
};

// Returns the radiance `color` as it is seen through the path.
vec3 tyndall_apply(TyndallPath path, vec3 color) { return TRANSMITTED(color, path.transmittance) + path.inscattering; }

// A position as the other functions of this file take it.
struct Place {
  float altitude;  // [m]
  vec3 up;         // unit vector away from the planet's centre
  float cos_sun_zenith;
};

// The altitude is computed as a difference from that of the origin, because the distance from the planet's centre would
// round to half a metre.
Place place_at(vec3 position) {
  float r0 = tyndall_constants.origin_radius_m;
  float rise = dot(position, position) + 2.0 * r0 * dot(tyndall_constants.origin_up, position);
  Place place;
  place.altitude = tyndall_constants.origin_altitude_m + rise / max(sqrt(max(r0 * r0 + rise, 0.0)) + r0, 1.0);
  vec3 from_centre = r0 * tyndall_constants.origin_up + position;
  place.up = from_centre / max(length(from_centre), 1.0);
  place.cos_sun_zenith = clamp(dot(place.up, tyndall_constants.direction_to_sun), -1.0, 1.0);
  return place;
}

// A ray in the form of the tables, from where it is inside the atmosphere.
struct AtmosphereRay {
  TableRay path;
  float start_m;          // distance from the position to the beginning of `path`
  bool inside;            // false: the ray misses the atmosphere
  bool integrate_single;  // the tables lack accurate single scattering: see lacks_single()
};

// Returns whether single scattering must be integrated because the tables are not accurate here. Computes the same
// value as tables_lack_single() of src/effect/frame_constants.cpp.
bool lacks_single(Place place) {
  float R = tyndall_constants.medium.planet_radius_m;
  float dip = sqrt(max(-2.0 * place.altitude / R, 0.0));
  bool sunset = abs(place.cos_sun_zenith) < dip + 0.009;
  return place.altitude < 0.0 && (place.altitude < lowest_table_altitude(tyndall_constants.medium) || sunset);
}

// Returns the ray from a position. `reach` is the distance to the surface where it ends; 0 for a ray to the ground of
// the tables or to the sky.
AtmosphereRay ray_from(Place place, vec3 direction, float reach) {
  float R = tyndall_constants.medium.planet_radius_m;
  float top = tyndall_constants.medium.atmosphere_height_m;
  float mu = clamp(dot(place.up, direction), -1.0, 1.0);
  float nu = clamp(dot(tyndall_constants.direction_to_sun, direction), -1.0, 1.0);
  AtmosphereRay ray;
  float end;
  ray.inside = segment_below_top(place.altitude, mu, top, R, ray.start_m, end);
  bool below = ray_hits_ground(place.altitude, mu, R);
  float altitude = altitude_along(place.altitude, mu, ray.start_m, R);
  float sun = ((R + place.altitude) * place.cos_sun_zenith + ray.start_m * nu) / (R + altitude);
  ray.path = table_ray(tyndall_constants.medium, min(altitude, top),
                       cos_zenith_along(place.altitude, mu, ray.start_m, R), clamp(sun, -1.0, 1.0), nu, below);
  if (below) ray.path.end_m = max(ray.path.end_m, reach - ray.start_m);
  ray.integrate_single = lacks_single(place);
  return ray;
}

// Returns the path of a ray from where it enters the atmosphere to the distance `to` from there.
TyndallPath path_along(AtmosphereRay ray, float to) {
  TableRay path = ray.path;
  InScattering light = inscattering_between(tyndall_constants.tables, tyndall_constants.medium, path, 0.0, to);
  light.high *= deep_factor(tyndall_constants.medium, path);
  if (ray.integrate_single) {
    light.single = single_scattering(tyndall_constants.medium, path.altitude, path.cos_zenith, path.cos_sun_zenith,
                                     path.cos_view_sun, 0.0, min(to, path.end_m), 16);
  }
  return TyndallPath(
      COLOR(light.single + light.high) * tyndall_constants.sun_irradiance,
      transmittance(tyndall_constants.medium,
                    density_integral_along(tyndall_constants.medium, path.altitude, path.cos_zenith, to)));
}

// Returns the irradiance of the sun at normal incidence, relative to that above the atmosphere. The closed form serves
// altitudes above the atmosphere too. Where only the upper limb of the sun is seen, its light has grazed the horizon.
Spectrum sun_at(float altitude, float cos_sun_zenith) {
  float R = tyndall_constants.medium.planet_radius_m;
  float visible = sun_disc_visibility(altitude, cos_sun_zenith, R, tyndall_constants.sun_angular_radius_rad);
  vec3 integral =
      density_integral_to_top(tyndall_constants.medium, altitude, max(cos_sun_zenith, horizon_cos(altitude, R)));
  return visible * transmittance(tyndall_constants.medium, integral);
}

// Returns the irradiance of the sky on a surface that faces upwards, relative to the sun's above the atmosphere.
Spectrum sky_at(float altitude, float cos_sun_zenith) {
  vec2 uv = light_table_uv(altitude, cos_sun_zenith, tyndall_constants.medium.planet_radius_m,
                           tyndall_constants.medium.atmosphere_height_m);
  return LIGHT_OF_TEXEL(textureLod(sky_irradiance_table, uv, 0.0));
}

// Returns the irradiance of sunlight at a position, at normal incidence. It is 0 if the planet hides the sun; your
// shadows are not included, but clouds are.
vec3 tyndall_sun_irradiance(vec3 position) {
  Place place = place_at(position);
  Spectrum sun = sun_at(place.altitude, place.cos_sun_zenith);
#ifdef TYNDALL_CLOUDS_BINDING
  sun *= FILTER(tyndall_cloud_transmittance(position));
#endif
  return COLOR(sun) * tyndall_constants.sun_irradiance;
}

// Returns the irradiance of the sky and of the light that the ground reflects, on a surface with this normal. It is
// exact for a surface that faces upwards. For other surfaces, the sky and the ground are each treated as uniformly
// bright.
vec3 tyndall_sky_irradiance(vec3 position, vec3 normal) {
  Place place = place_at(position);
  Spectrum sky = sky_at(place.altitude, place.cos_sun_zenith);
  Spectrum sun = sun_at(place.altitude, place.cos_sun_zenith) * max(place.cos_sun_zenith, 0.0);
  float up = clamp(0.5 + 0.5 * dot(place.up, normal), 0.0, 1.0);
  Spectrum light = up * sky + (1.0 - up) * GROUND_ALBEDO(tyndall_constants.medium) * (sky + sun);
  return COLOR(light) * tyndall_constants.sun_irradiance;
}

// Returns the path from a position to the ground of the planet or out of the atmosphere. The position may be at any
// altitude, also below sea level and in space.
TyndallPath tyndall_to_sky(vec3 position, vec3 direction) {
  AtmosphereRay ray = ray_from(place_at(position), direction, 0.0);
  if (!ray.inside) return TyndallPath(vec3(0.0), Spectrum(1.0));
  return path_along(ray, ray.path.end_m);
}

// Returns the radiance of the sky in a direction: in-scattered light and, below the horizon, light that the ground of
// the planet reflects. It contains neither the sun's disc nor stars.
vec3 tyndall_sky_radiance(vec3 position, vec3 direction) {
  AtmosphereRay ray = ray_from(place_at(position), direction, 0.0);
  if (!ray.inside) return vec3(0.0);
  TyndallPath path = path_along(ray, ray.path.end_m);
  if (!ray.path.below) return path.inscattering;
  // The ground is where the ray ends, which may be below sea level.
  TableRay end = ray_further_on(tyndall_constants.medium, ray.path, ray.path.end_m);
  Spectrum light = sky_at(end.altitude, end.cos_sun_zenith) +
                   sun_at(end.altitude, end.cos_sun_zenith) * max(end.cos_sun_zenith, 0.0);
  Spectrum reflected = light * (GROUND_ALBEDO(tyndall_constants.medium) * 0.318309886183791);
  return path.inscattering + COLOR(reflected * path.transmittance) * tyndall_constants.sun_irradiance;
}

// Returns the path between two positions, without shadows.
TyndallPath tyndall_between(vec3 from, vec3 to) {
  float reach = distance(from, to);
  if (reach < 1.0e-4) return TyndallPath(vec3(0.0), Spectrum(1.0));
  AtmosphereRay ray = ray_from(place_at(from), (to - from) / reach, reach);
  if (!ray.inside || reach <= ray.start_m) return TyndallPath(vec3(0.0), Spectrum(1.0));
  return path_along(ray, reach - ray.start_m);
}

// Light and transmittance from the camera to a point, from the froxel volume.
struct TyndallFroxel {
  vec3 inscattering;
  Spectrum transmittance;
};

// Returns the radiance `color` as it is seen through the volume.
vec3 tyndall_apply(TyndallFroxel froxel, vec3 color) {
  return TRANSMITTED(color, froxel.transmittance) + froxel.inscattering;
}

// Looks up the froxel volume, which contains light shafts. uv: position in the picture from 0 to 1; distance_m:
// distance from the camera. Points beyond froxels.far_m get the value there.
TyndallFroxel tyndall_froxel(vec2 uv, float distance_m) {
  vec3 at = vec3(uv, froxel_coordinate(distance_m, tyndall_constants.froxel_near_m, tyndall_constants.froxel_far_m,
                                       tyndall_constants.froxel_slices));
  return TyndallFroxel(textureLod(froxel_inscattering, at, 0.0).rgb * tyndall_constants.froxel_irradiance,
                       CHANNELS(textureLod(froxel_transmittance, at, 0.0)));
}

#ifdef TYNDALL_SHADOW
// Returns the path between two positions, with your shadows and clouds in its single scattering: the fraction of single
// scattering that remains behind TYNDALL_SHADOW and the clouds is integrated in `steps` steps. Where nothing is in
// shadow, the result equals that of tyndall_between(). Light that is scattered more than once is not shadowed, as with
// scattering.multiple = unoccluded.
TyndallPath tyndall_between_shadowed(vec3 from, vec3 to, int steps) {
  float reach = distance(from, to);
  if (reach < 1.0e-4) return TyndallPath(vec3(0.0), Spectrum(1.0));
  vec3 direction = (to - from) / reach;
  AtmosphereRay ray = ray_from(place_at(from), direction, reach);
  if (!ray.inside || reach <= ray.start_m) return TyndallPath(vec3(0.0), Spectrum(1.0));
  TableRay path = ray.path;
  float end = min(reach - ray.start_m, path.end_m);
  InScattering light = inscattering_between(tyndall_constants.tables, tyndall_constants.medium, path, 0.0, end);
  if (ray.integrate_single) {
    light.single = single_scattering(tyndall_constants.medium, path.altitude, path.cos_zenith, path.cos_sun_zenith,
                                     path.cos_view_sun, 0.0, end, 16);
  }
  Spectrum rayleigh = RAYLEIGH_SCATTERING(tyndall_constants.medium) * rayleigh_phase(path.cos_view_sun);
  Spectrum mie = mie_scattering_towards(tyndall_constants.medium, path.cos_view_sun);
  float dt = end / float(max(steps, 1));
  Spectrum lit = Spectrum(0.0);
  Spectrum all = Spectrum(0.0);
  for (int i = 0; i < max(steps, 1); ++i) {
    float t = (float(i) + 0.5) * dt;
    TableRay here = ray_further_on(tyndall_constants.medium, path, t);
    if (sun_visibility(here.altitude, here.cos_sun_zenith, tyndall_constants.medium.planet_radius_m) == 0.0) continue;
    vec3 integral = density_integral_along(tyndall_constants.medium, path.altitude, path.cos_zenith, t) +
                    density_integral_to_top(tyndall_constants.medium, here.altitude, here.cos_sun_zenith);
    vec3 density = densities(tyndall_constants.medium, here.altitude);
    Spectrum source = transmittance(tyndall_constants.medium, integral) * (rayleigh * density.x + mie * density.y);
    all += source;
    vec3 position = from + direction * (ray.start_m + t);
    lit += source * FILTER(SUNLIGHT_THROUGH(vec3(TYNDALL_SHADOW(position)), position));
  }
  Spectrum fraction = mix(Spectrum(1.0), lit / max(all, Spectrum(1.0e-30)), greaterThan(all, Spectrum(1.0e-30)));
  light.high *= deep_factor(tyndall_constants.medium, path);
  return TyndallPath(
      COLOR(light.single * fraction + light.high) * tyndall_constants.sun_irradiance,
      transmittance(tyndall_constants.medium,
                    density_integral_along(tyndall_constants.medium, path.altitude, path.cos_zenith, end)));
}
#endif

#endif
