// In-scattering from the scattering tables with shadows, for scattering.single = table and scattering.multiple =
// occluded.
// kContiguous is the method of Yusov, "High Performance Outdoor Light Scattering Using Epipolar Sampling" (2013),
// section 2.4: one contiguous section from the first lit point. kEach is Tyndall's own: it evaluates every lit section.
#ifndef TYNDALL_TABLE_LIGHT_GLSL
#define TYNDALL_TABLE_LIGHT_GLSL

#include "frame/constants.glsl"
#include "frame/modes.glsl"
#include "frame/table_lookup.glsl"
#include "frame/view_ray.glsl"
#include "lib/single_scattering.glsl"

// The lit sections found so far along a ray. Distances are from the ray's origin [m].
struct LitSections {
  float first;         // distance to the first lit point; < 0: none yet
  float total;         // lit length
  float since;         // kEach: start of the current lit section; < 0: in shadow
  float closed_at;     // kEach: end of that section once found; close_section() must follow
  InScattering light;  // kEach: in-scattering of the completed sections
  Spectrum tint;     // kColors: integral of the glass colour over the lit length; with kEach, over the current section
  float dark_until;  // from planet_shadow_end()
};

LitSections nothing_lit() {
  return LitSections(-1.0, 0.0, -1.0, -1.0, InScattering(Spectrum(0.0), Spectrum(0.0)), Spectrum(0.0), -1.0);
}

// Returns the distance at which a ray that begins in the planet's shadow leaves it, or -1 if it begins in sunlight. No
// shadow map matters up to there, because nothing is lit.
float planet_shadow_end(Ray ray, float start) {
  float from, to;
  bool dark = shadow_segment(ray.altitude, ray.cos_zenith, ray.cos_sun_zenith, ray.cos_view_sun, medium.planet_radius_m,
                             from, to);
  return dark && from <= start && to > start ? to : -1.0;
}

// Returns the distance from which the tables are looked up for a lit section. If only the planet's shadow lies in front
// of the section, this is the start of the ray, because the shadow adds no light. A look-up from the section itself
// should give the same light, but in twilight the interpolated tables differ by tens of per cent between distant points
// of a ray. The sky would then have a step where the first lit point changes abruptly, for example where rays leave a
// shadow map.
float section_from(LitSections lit, float from, float start) { return from - lit.dark_until < 1e-3 ? start : from; }

// Adds the section [from, to], of which `lit_fraction` is lit with this colour.
void add_section(inout LitSections lit, float from, float to, float lit_fraction, Spectrum color) {
  if (kSections == kContiguous) {
    if (lit_fraction > 0.0 && lit.first < 0.0) lit.first = to - lit_fraction * (to - from);
    lit.total += lit_fraction * (to - from);
    if (kColors) lit.tint += lit_fraction * (to - from) * color;
  } else {
    bool bright = lit_fraction >= 0.5;
    if (bright && lit.since < 0.0) lit.since = from;
    if (!bright && lit.since >= 0.0) lit.closed_at = from;
    if (kColors && bright) lit.tint += (to - from) * color;
  }
}

InScattering add(InScattering a, InScattering b) { return InScattering(a.single + b.single, a.high + b.high); }

// Returns a section's light tinted by the mean glass colour over its lit length: the tables cannot resolve positions
// within a section.
InScattering tinted(InScattering light, Spectrum tint, float length_m) {
  if (!kColors) return light;
  Spectrum mean = tint / max(length_m, 1e-6);
  return InScattering(light.single * mean, light.high * mean);
}

// Returns the ray for table look-ups, from distance `start`, where it enters the atmosphere. It ends at the scene's
// surface even if that is below the ground sphere of the tables. If nothing was drawn and the sphere at frame.ground_m
// is lower than the ground sphere, the ray ends at this lower sphere. If it passes between both spheres, it continues
// to the top of the atmosphere, like rays above the horizon.
TableRay table_ray_of(Ray ray, float start) {
  float radius = medium.planet_radius_m;
  bool below = ray_hits_ground(ray.altitude, ray.cos_zenith, radius);
  float reach = ray.sky ? 0.0 : ray.length_m;
  if (ray.sky && frame.ground_m < ground_below(ray.altitude, radius)) {
    below = hits_planet(frame, ray.altitude, ray.cos_zenith, radius);
    reach = distance_to_sphere(ray.altitude, ray.cos_zenith, frame.ground_m, radius);
  }
  float h = altitude_along(ray.altitude, ray.cos_zenith, start, radius);
  TableRay path = table_ray(medium, min(h, medium.atmosphere_height_m),
                            cos_zenith_along(ray.altitude, ray.cos_zenith, start, radius),
                            cos_sun_zenith_along(ray, start, radius), ray.cos_view_sun, below);
  if (below) path.end_m = max(path.end_m, reach - start);
  return path;
}

InScattering section_light(TableRay path, float start, float from, float to) {
  return inscattering_between(frame.tables, medium, path, from - start, to - start);
}

// Adds the in-scattering of the section that ends at closed_at. Does nothing without kEach.
void close_section(inout LitSections lit, TableRay path, float start) {
  if (kSections != kEach) return;
  if (lit.since >= 0.0 && lit.closed_at > lit.since) {
    InScattering section = section_light(path, start, section_from(lit, lit.since, start), lit.closed_at);
    lit.light = add(lit.light, tinted(section, lit.tint, lit.closed_at - lit.since));
  }
  if (kColors && lit.closed_at >= 0.0) lit.tint = Spectrum(0.0);
  lit.since = lit.closed_at >= 0.0 ? -1.0 : lit.since;
  lit.closed_at = -1.0;
}

// Returns the in-scattering from the tables. `lit` holds the lit sections up to distance t. From there to `end`,
// nothing casts shadows. The modes that ignore shadows look up the whole ray.
Spectrum table_light(LitSections lit, TableRay path, float start, float t, float end) {
  Spectrum light = Spectrum(0.0);
  if (kSections == kEach) {
    if (kSingle == kTable) light += lit.light.single;
    if (kOccluded) light += lit.light.high;
  }
  // The sections to look up, as a set of bits: 0 for the lit part, 1 for the rest, 2 for the whole ray. A loop over
  // this set does not make neighbouring rays wait for sections that only some of them have.
  uint sections = frame.unoccluded != 0u ? 4u : 0u;
  if (kLitTables && kSections == kContiguous && lit.total > 1e-3) sections |= 1u;
  if (kLitTables && end - t > 1e-3) sections |= 2u;
  while (sections != 0u) {
    int i = findLSB(sections);
    sections &= sections - 1u;
    float from = i == 0 ? section_from(lit, lit.first, start) : i == 1 ? section_from(lit, t, start) : start;
    float to = i == 0 ? lit.first + lit.total : end;
    InScattering section = section_light(path, start, from, to);
    if (i == 0) section = tinted(section, lit.tint, lit.total);
    if (kSingle == kTable && i < 2 && lit.dark_until < end) light += section.single;
    // With kTable, no eye is below the lowest altitude of the tables: see tables_lack_single() in frame_constants.cpp.
    if (kSingle != kTable) section.high *= deep_factor(medium, path);
    if (kOccluded ? i < 2 : i == 2) light += section.high;
  }
  return light;
}

#endif
