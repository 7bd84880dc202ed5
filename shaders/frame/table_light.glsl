// The light of a ray by the scattering tables, with the shadow maps' shafts: what `single = table` and
// `multiple = occluded` take. Include after the declarations of medium, frame, shadow_maps and the tables.
// Sources: Yusov, "High Performance Outdoor Light Scattering Using Epipolar Sampling" (2013), section 2.4, for
// one contiguous section from the first lit point; each lit section by itself is ours.
#ifndef TYNDALL_TABLE_LIGHT_GLSL
#define TYNDALL_TABLE_LIGHT_GLSL

#include "frame/table_lookup.glsl"

// What a walk along the ray has found. Distances from the ray's origin [m].
struct LitSections {
  float first;    // lit point; < 0: none yet
  float total_m;  // lit length
  float since;    // start of the lit section that the walk is in; < 0: in the shadow
  AirLight light;  // of the sections that are complete, with each = true
};

AirLight add(AirLight a, AirLight b) { return AirLight(a.single + b.single, a.high + b.high); }

// The ray in the coordinates of the tables: begun where it enters the air, at distance `start`.
TableRay table_ray_of(Ray ray, float start) {
  float radius = medium.planet_radius_m;
  bool below = ray_hits_ground(ray.altitude, ray.cos_zenith, radius);
  float h = altitude_along(ray.altitude, ray.cos_zenith, start, radius);
  return table_ray(medium, clamp(h, 0.0, medium.atmosphere_height_m),
                   cos_zenith_along(ray.altitude, ray.cos_zenith, start, radius),
                   cos_sun_zenith_along(ray, start, radius), ray.cos_view_sun, below);
}

AirLight section_light(TableRay path, float start, float from, float to) {
  return light_between(frame.tables, medium, path, from - start, to - start);
}

// Reads the map at every texel between two distances inside one cascade.
void walk_cascade(uint cascade, Ray ray, TableRay path, float start, float from, float to, bool each,
                  inout LitSections lit) {
  mat4 shadow_from_world = frame.cascades[cascade].shadow_from_world;
  vec3 uvz_from = shadow_uvz(shadow_from_world, frame.camera_position + ray.direction * from);
  vec3 uvz_to = shadow_uvz(shadow_from_world, frame.camera_position + ray.direction * to);
  vec2 texels = abs(uvz_to.xy - uvz_from.xy) * float(frame.shadow_resolution);
  float wanted = max(max(texels.x, texels.y), float(frame.integration_steps));
  int reads = int(clamp(ceil(wanted), 1.0, 16.0 * float(frame.shadow_resolution)));
  float step_m = (to - from) / float(reads);
  vec3 duvz = (uvz_to - uvz_from) / float(reads);
  vec3 uvz = uvz_from + 0.5 * duvz;
  for (int i = 0; i < reads; ++i) {
    float share = texture(shadow_maps, vec4(uvz.xy, float(cascade), clamp(uvz.z, 0.0, 1.0)));
    float here = from + float(i) * step_m;
    if (share > 0.0 && lit.first < 0.0) lit.first = here + (1.0 - share) * step_m;
    lit.total_m += share * step_m;
    if (each && share >= 0.5 && lit.since < 0.0) lit.since = here;
    if (each && share < 0.5 && lit.since >= 0.0) {
      lit.light = add(lit.light, section_light(path, start, lit.since, here));
      lit.since = -1.0;
    }
    uvz += duvz;
  }
}

// The lit part of [start, end]: cut by the shadow maps as far as they reach, whole beyond them.
AirLight lit_table_light(Ray ray, TableRay path, float start, float end) {
  bool each = frame.sections == 1u;
  LitSections lit = LitSections(-1.0, 0.0, -1.0, AirLight(vec3(0.0), vec3(0.0)));
  float depth_per_m = max(dot(ray.direction, frame.camera_forward), 1e-6);
  float t = start;
  for (uint c = frame.first_marched_cascade; c < frame.cascade_count; ++c) {
    float to = min(frame.cascades[c].far_m / depth_per_m, end);
    if (to - t > 1e-3) {
      walk_cascade(c, ray, path, start, t, to, each, lit);
      t = to;
    }
  }
  if (each) {
    float from = lit.since >= 0.0 ? lit.since : t;
    return end - from > 1e-3 ? add(lit.light, section_light(path, start, from, end)) : lit.light;
  }
  AirLight light = lit.light;
  if (lit.total_m > 1e-3) light = section_light(path, start, lit.first, lit.first + lit.total_m);
  if (end - t > 1e-3) light = add(light, section_light(path, start, t, end));
  return light;
}

#endif
