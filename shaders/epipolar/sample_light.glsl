// In-scattering from the tables for a marched sample, in the modes with one section from the first lit point and
// without colours. The result is that of table_light() in frame/table_light.glsl, with fewer look-ups. The
// in-scattering of a section is that beyond its start minus that beyond its end. Ends that sections share are looked up
// once, in a loop over the positions. The density integral beyond a position is that of the whole ray minus that before
// the position.
#ifndef TYNDALL_SAMPLE_LIGHT_GLSL
#define TYNDALL_SAMPLE_LIGHT_GLSL

#include "frame/table_light.glsl"

// Returns the in-scattering of the lit section found up to distance t, of the unshadowed rest of the ray to `end`, and
// of the whole ray for orders that ignore shadows.
Spectrum contiguous_light(LitSections lit, TableRay path, float start, float t, float end) {
  const float kNear = 1e-3;  // [m]
  float lit_from = section_from(lit, lit.first, start);
  float lit_to = lit.first + lit.total;
  bool any_lit = kLitTables && lit.total > kNear;
  bool any_rest = kLitTables && end - t > kNear;
  if (!any_lit) t = section_from(lit, t, start);
  // The coefficients of in-scattering beyond each position, for the shadowed part and for the whole ray.
  bool whole = frame.unoccluded != 0u;
  bool to_rest = any_lit && any_rest && t - lit_to < kNear;
  vec4 places = vec4(start, lit_from, lit_to, t);
  vec4 shadowed = vec4(0.0, any_lit ? 1.0 : 0.0, any_lit && !to_rest ? -1.0 : 0.0, any_rest && !to_rest ? 1.0 : 0.0);
  float shadowed_end = any_rest ? -1.0 : 0.0;
  if (any_lit && lit_from - start < kNear) shadowed.xy = vec2(1.0, 0.0);
  if (any_lit && !any_rest && end - lit_to < kNear) {
    shadowed.z = 0.0;
    shadowed_end = -1.0;
  }
  bool beyond_end = end - start < path.end_m;
  uint wanted = (whole || shadowed.x != 0.0 ? 1u : 0u) | (shadowed.y != 0.0 ? 2u : 0u) | (shadowed.z != 0.0 ? 4u : 0u) |
                (shadowed.w != 0.0 ? 8u : 0u) | (beyond_end && (whole || shadowed_end != 0.0) ? 16u : 0u);
  vec3 column = density_integral_along(medium, path.altitude, path.cos_zenith, path.end_m);
  TableAngle angle = table_angle(frame.tables, medium, path.cos_view_sun);
  Spectrum light = Spectrum(0.0);
  Spectrum high = Spectrum(0.0);
  Spectrum deep = deep_factor(medium, path);  // matters only in the pipelines that draw eyes below the tables
  while (wanted != 0u) {
    int i = findLSB(wanted);
    wanted &= wanted - 1u;
    float place = i == 0 ? places.x : i == 1 ? places.y : i == 2 ? places.z : i == 3 ? places.w : end;
    float counts = i == 0 ? shadowed.x : i == 1 ? shadowed.y : i == 2 ? shadowed.z : i == 3 ? shadowed.w : shadowed_end;
    float d = min(place - start, path.end_m);
    vec3 before = density_integral_along(medium, path.altitude, path.cos_zenith, d);
    Spectrum transmitted = transmittance(medium, before);
    InScattering beyond = inscattering_from_integral(frame.tables, medium, angle, ray_further_on(medium, path, d),
                                                     max(column - before, vec3(0.0)));
    if (kSingle == kTable && lit.dark_until < end) light += counts * transmitted * beyond.single;
    if (kSingle != kTable) beyond.high *= deep;
    if (kOccluded)
      light += counts * transmitted * beyond.high;
    else if (i == 0)
      high += transmitted * beyond.high;
    else if (i == 4)
      high -= transmitted * beyond.high;
  }
  light = max(light, Spectrum(0.0));
  return whole ? light + max(high, Spectrum(0.0)) : light;
}

#endif
