// Marches a ray of a slice through the shadow cascades. The ray advances in sections that are lit or in shadow: whole
// nodes with the tree, single cells without it. An undecided cell is compared in the shadow map itself, at the same
// position in both cases, so the tree saves reads without changing the result. The medium is integrated over panels on
// which it is smooth. The in-scattering of a panel is the value at its middle times the lit length, plus its slope
// times the first moment of the lit length. With kColors both are weighted by the colour of glass, which is read in
// every cell that is not in shadow. With kClouds they are weighted by the sunlight behind clouds, and lit sections are
// divided into steps of about a texel of the map of clouds.
#ifndef TYNDALL_MARCH_GLSL
#define TYNDALL_MARCH_GLSL

#include "lib/single_scattering.glsl"
#include "epipolar/constants.glsl"
#include "epipolar/ray_end.glsl"
#include "frame/clouds.glsl"
#include "frame/counters.glsl"
#include "frame/glass.glsl"
#include "frame/homogeneous_medium.glsl"
#include "frame/shadow_maps.glsl"
#include "frame/table_light.glsl"
#include "epipolar/sample_light.glsl"
#include "epipolar/min_max_tree.glsl"
#include "shared/constant_ids.h"

layout(constant_id = kTreeId) const bool kTree = true;
layout(std430, binding = 13) readonly buffer slice_lines_block { SliceLine slice_lines[]; };
layout(std430, binding = 14) readonly buffer min_max_tree_block { uvec2 tree[]; };
const bool kPanels = (kSingle == kIntegration || kCloudFraction) && !kHomogeneous;
const bool kTinted = kColors || kClouds;

uint steps_done = 0u;
uint nodes_visited = 0u;
uint reads_done = 0u;

// The contributions of cascades to the in-scattering of a ray, which can be added in any order.
struct March {
  LitSections lit;         // single = table, multiple = occluded
  Spectrum light;          // single = integration; in a homogeneous medium before homogeneous_phase()
  Spectrum plain;          // kCloudFraction: the same without clouds and glass
  float end_lit_fraction;  // lit fraction at the end of the farthest marched cascade; -1: none marched
};

// The state of a ray along a slice line. Distances are in cells from the camera.
struct Walk {
  vec4 line;  // SliceLine::line
  float depth;
  int first;
  int extent;
  int count;
  uint cascade;
  uint tree_base;  // index in `tree` of the blocks of the slice line
  bool full;       // nodes have two words
  float slope;     // change of depth per cell
  float number;    // ray_number() of the slope
  float reads_per_cell;
  float metres;  // length of the ray per cell
  float cells_per_m;
  float x;
  uint level;
  float lit;  // lit length within the panel, and its first moment about the middle
  float moment;
  float middle;
  Spectrum lit_tinted;  // kTinted: `lit` and `moment`, weighted by the colour of the light
  Spectrum moment_tinted;
  // For a homogeneous medium: transmittance and in-scattering up to `since`, and the source function after it, which is
  // the lit fraction times the colour. A section ends where the source function changes, so that the result does not
  // depend on the steps of the march.
  Spectrum transmittance;
  Spectrum light;
  Spectrum source;
  float since;
  float lit_fraction;  // lit fraction of the last section
  // kClouds: the change of (u, v, depth) in the map of clouds per cell, and the length of a step.
  vec3 cloud_change;
  float cloud_step;
};

vec2 load_node(bool full, uint at) {
  // One load serves both formats, because CPU devices execute the loads of all branches.
  uvec2 words = tree[full ? at : at >> 1u];
  uint halves = (at & 1u) != 0u ? words.y : words.x;
  return full ? uintBitsToFloat(words) : vec2(float(halves & 0xFFFFu), float(halves >> 16u));
}

void close_homogeneous(inout Walk w) {
  Spectrum transmittance, opacity;
  homogeneous_attenuation((w.x - w.since) * w.metres, transmittance, opacity);
  w.light += w.source * w.transmittance * opacity;
  w.transmittance *= transmittance;
  w.since = w.x;
}

void add_run(inout Walk w, inout LitSections sections, float to, float lit_fraction, Spectrum color) {
  if (kHomogeneous) {
    if (w.source != lit_fraction * color) close_homogeneous(w);
    w.source = lit_fraction * color;
  }
  if (kPanels) {
    float length_lit = lit_fraction * (to - w.x);
    float moment = length_lit * (0.5 * (w.x + to) - w.middle);
    w.lit += length_lit;
    w.moment += moment;
    if (kTinted) {
      w.lit_tinted += length_lit * color;
      w.moment_tinted += moment * color;
    }
  }
  // With clouds, cloud_fraction() contains the colour.
  if (kLitTables) {
    add_section(sections, w.x * w.metres, to * w.metres, lit_fraction, kClouds ? Spectrum(1.0) : color);
  }
  w.x = to;
  w.lit_fraction = lit_fraction;
}

bool section_closed(LitSections sections) { return kLitTables && kSections == kEach && sections.closed_at >= 0.0; }

// Returns the sunlight behind clouds in the section from w.x to `to`.
Spectrum clouds_before(Walk w, float to) {
  if (!kClouds) return Spectrum(1.0);
  return cloud_light(cloud_camera() + w.cloud_change * (0.5 * (w.x + to)), w.cloud_change.z * (to - w.x));
}

// Returns texture coordinates and depth of the comparison for the section [from, to] of the cell that begins at `cell`.
// `precise`, because the pipelines with and without the tree must compute the same bits although a compiler may fuse
// operations differently in each of them.
vec3 compared_place(vec4 line, float depth, float slope, float cell, float from, float to) {
  precise float z = depth + 0.5 * (from + to) * slope;
  return vec3(middle_of_cell(line, cell), z);
}

// Advances to `to`, or until a lit section is complete.
void walk_to(inout Walk w, inout LitSections sections, float to) {
  while (w.x < to && !section_closed(sections)) {
    bool undecided = false;
    bool read = false;
    float stop = to;  // end of the section that is read
    while (w.x < to && !read && !section_closed(sections)) {
      int j = int(w.x) - w.first;
      bool inside = j >= 0 && j < w.extent;
      bool in_tree = kTree && inside && j < w.count;
      bool dark = false;
      uint level = kTreeLeafLevel;
      if (kTree) {
        level = w.level;
        uint cell = in_tree ? uint(j) : 0u;
        vec2 node =
            load_node(w.full, w.tree_base + (cell / kTreeBlock) * kTreeNodes + node_index(cell % kTreeBlock, level));
        dark = in_tree && w.number > node.y;
        undecided = in_tree && w.number > node.x && !dark;
        nodes_visited += in_tree ? 1u : 0u;
      }
      undecided = undecided || (inside && !in_tree);
      int next = ((j >> level) + 1) << level;
      // A node may extend beyond the cells in the tree.
      int known = in_tree ? w.count : w.extent;
      float end = inside ? float(w.first + min(next, known)) : j < 0 ? float(w.first) : to;
      stop = end > w.x ? min(end, to) : to;
      // Cells that may be lit through glass are read, too.
      read = undecided || (kColors && inside && !dark);
      bool cut = false;  // the section ends within the node
      if (kClouds && !read && !dark && w.x + w.cloud_step > w.x) {
        cut = w.x + w.cloud_step < stop;
        stop = min(stop, w.x + w.cloud_step);
      }
      if (!read) {
        add_run(w, sections, stop, dark ? 0.0 : 1.0, dark ? Spectrum(1.0) : clouds_before(w, stop));
        ++steps_done;
      } else if (undecided && in_tree && level > kTreeLeafLevel) {
        w.level = level - 1u;
        read = false;
      }
      // Go up one level where a node of that level begins.
      if (kTree && !undecided && !cut && in_tree && (next & ((2 << level) - 1)) == 0)
        w.level = min(level + 1u, kTreeTopLevel);
    }
    if (read) {
      float step_cells = 1.0 / w.reads_per_cell;
      while (w.x < stop && !section_closed(sections)) {
        float cell = floor(w.x);
        float end = w.x + step_cells;
        end = min(cell + 1.0 - end > 0.01 * step_cells ? end : cell + 1.0, stop);
        end = end > w.x ? end : stop;
        vec3 place = compared_place(w.line, w.depth, w.slope, cell, w.x, end);
        float lit_fraction = texture(shadow_maps, vec4(place.xy, float(w.cascade), clamp(place.z, 0.0, 1.0)));
        add_run(w, sections, end, lit_fraction, glass_color(place.xy, place.z, w.cascade) * clouds_before(w, end));
        ++reads_done;
        ++steps_done;
      }
    }
  }
}

// Returns the state at the start of the section [from, to] of a ray of a slice in one cascade. `start` is where the ray
// enters the medium.
Walk begin_walk(uint cascade, uint slice, vec3 direction, float start, float from, float to) {
  float resolution = float(frame.shadow_resolution);
  uint line = (cascade - epipolar.first_cascade) * epipolar.slices + slice;
  Walk w;
  SliceLine stored = slice_lines[line];
  w.line = stored.line;
  w.depth = stored.depth;
  w.first = stored.cells.x;
  w.extent = stored.cells.y;
  w.count = stored.cells.z;
  w.cascade = cascade;
  w.tree_base = line * (epipolar.tree_cells / kTreeBlock) * kTreeNodes;
  w.full = epipolar.tree_format == kFloat32;
  mat4 shadow_from_world = cascades[cascade].shadow_from_world;
  precise vec3 per_metre = direction.x * shadow_from_world[0].xyz + direction.y * shadow_from_world[1].xyz +
                           direction.z * shadow_from_world[2].xyz;
  precise float cells_per_m = max(max(abs(per_metre.x), abs(per_metre.y)) * resolution, 1e-12);
  precise float slope = per_metre.z / cells_per_m;
  precise float first_x = from * cells_per_m;
  w.cells_per_m = cells_per_m;
  w.slope = slope;
  w.number = ray_number(frame.shadow_depth_reversed != 0u ? -w.slope : w.slope, resolution, epipolar.tree_format);
  w.metres = 1.0 / w.cells_per_m;
  w.x = first_x;
  w.reads_per_cell = max(1.0, float(frame.integration_steps) / max(to * w.cells_per_m - w.x, 1e-12));
  w.cloud_change = vec3(0.0);
  w.cloud_step = 0.0;
  if (kClouds) {
    float cells = to * w.cells_per_m - w.x;
    w.cloud_change = cloud_change(direction) * w.metres;
    w.cloud_step = cells / cloud_steps(w.cloud_change, cells, kCloudSteps);
    w.reads_per_cell = max(w.reads_per_cell, 1.0 / max(w.cloud_step, 1e-3));
  }
  w.level = kTreeLeafLevel;
  w.lit = 0.0;
  w.moment = 0.0;
  w.middle = 0.0;
  w.lit_tinted = Spectrum(0.0);
  w.moment_tinted = Spectrum(0.0);
  w.light = Spectrum(0.0);
  w.source = Spectrum(0.0);
  w.since = w.x;
  w.lit_fraction = 1.0;
  w.transmittance = kHomogeneous ? exp(-HOMOGENEOUS_EXTINCTION * (from - start)) : Spectrum(1.0);
  return w;
}

// The state of the integration over panels, at the beginning of the next panel.
struct Panels {
  float altitude;
  vec3 density;
  vec3 integral;      // density integral from where the ray enters the atmosphere
  Spectrum rayleigh;  // scattering coefficient x phase function
  Spectrum mie;
};

// Computes the state at the start of the section [from, to], and returns the number of its panels. A panel spans at
// most half of the aerosol's scale height, a fifth of an optical depth and a twelfth of the section.
int begin_panels(Ray ray, float from, float to, out Panels p) {
  float radius = medium.planet_radius_m;
  p.altitude = altitude_along(ray.altitude, ray.cos_zenith, from, radius);
  float h_end = altitude_along(ray.altitude, ray.cos_zenith, to, radius);
  p.density = densities(medium, p.altitude);
  Spectrum extinction = extinction_at(medium, min(p.altitude, h_end));
  float densest = LARGEST(extinction);
  float wanted =
      max(max(abs(h_end - p.altitude) / (0.5 * medium.mie_scale_height_m), (to - from) * densest / 0.2), 12.0);
  p.rayleigh = RAYLEIGH_SCATTERING(medium) * rayleigh_phase(ray.cos_view_sun);
  p.mie = mie_scattering_towards(medium, ray.cos_view_sun);
  p.integral = density_integral_along(medium, ray.altitude, ray.cos_zenith, from);
  return int(clamp(ceil(wanted), 1.0, 256.0));
}

// Returns the in-scattering of a panel of length panel_m that begins at distance t, from the lit length that `w` has
// found in it. Advances `p` to its end. With kCloudFraction, adds the in-scattering without tint to `plain`.
Spectrum panel_light(Walk w, Ray ray, float t, float panel_m, inout Panels p, inout Spectrum plain) {
  float radius = medium.planet_radius_m;
  float h_next = altitude_along(ray.altitude, ray.cos_zenith, t + panel_m, radius);
  vec3 density_next = densities(medium, h_next);
  vec3 mean = mean_densities(medium, p.density, density_next, h_next - p.altitude);
  float middle = altitude_along(ray.altitude, ray.cos_zenith, t + 0.5 * panel_m, radius);
  float cos_sun = cos_sun_zenith_along(ray, t + 0.5 * panel_m, radius);
  vec3 total = p.integral + 0.5 * panel_m * mean + density_integral_to_top(medium, middle, cos_sun);
  Spectrum arriving = sun_visibility(middle, cos_sun, radius) * transmittance(medium, total);
  float per_panel = w.metres / max(panel_m * w.cells_per_m, 1e-20);
  Spectrum light;
  if (kTinted) {
    Spectrum lit_m = w.lit_tinted * w.metres;
    Spectrum moment = w.moment_tinted * per_panel;
    light = arriving * (p.rayleigh * max(mean.x * lit_m + (density_next.x - p.density.x) * moment, Spectrum(0.0)) +
                        p.mie * max(mean.y * lit_m + (density_next.y - p.density.y) * moment, Spectrum(0.0)));
  }
  if (!kTinted || kCloudFraction) {
    float lit_m = w.lit * w.metres;
    float moment = w.moment * per_panel;  // [m]; the coordinate is in units of a panel
    Spectrum untinted = arriving * (p.rayleigh * max(mean.x * lit_m + (density_next.x - p.density.x) * moment, 0.0) +
                                    p.mie * max(mean.y * lit_m + (density_next.y - p.density.y) * moment, 0.0));
    if (kCloudFraction)
      plain += untinted;
    else
      light = untinted;
  }
  p.integral += mean * panel_m;
  p.altitude = h_next;
  p.density = density_next;
  return light;
}

// Marches the section [from, to] of a ray of a slice in one cascade.
void march_cascade(uint cascade, uint slice, Ray ray, TableRay path, float start, float from, float to,
                   inout March march) {
  Walk w = begin_walk(cascade, slice, ray.direction, start, from, to);
  float end = to * w.cells_per_m;
  Panels panels;
  // A single panel suffices if only lit lengths are needed.
  int count = 1;
  if (kPanels) count = begin_panels(ray, from, to, panels);
  float panel_m = (to - from) / float(count);
  for (int i = 0; i < count; ++i) {
    float t = from + float(i) * panel_m;
    bool last = i + 1 == count;
    float panel_end = last ? end : (t + panel_m) * w.cells_per_m;
    w.lit = 0.0;
    w.moment = 0.0;
    w.lit_tinted = Spectrum(0.0);
    w.moment_tinted = Spectrum(0.0);
    w.middle = (t + 0.5 * panel_m) * w.cells_per_m;
    while (w.x < panel_end) {
      walk_to(w, march.lit, panel_end);
      if (kLitTables) {
        bool open = kSections == kEach && march.lit.since >= 0.0 && march.lit.closed_at < 0.0;
        if (open && last && w.x >= end) march.lit.closed_at = to;
        close_section(march.lit, path, start);
      }
    }
    if (!kPanels) break;
    march.light += panel_light(w, ray, t, panel_m, panels, march.plain);
  }
  if (kHomogeneous) {
    close_homogeneous(w);
    march.light += w.light;
  }
  march.end_lit_fraction = w.lit_fraction;
}

March nothing_marched() { return March(nothing_lit(), Spectrum(0.0), Spectrum(0.0), -1.0); }

March add(March a, March b) {
  March m;
  m.lit = nothing_lit();
  m.lit.first = a.lit.first < 0.0 ? b.lit.first : b.lit.first < 0.0 ? a.lit.first : min(a.lit.first, b.lit.first);
  m.lit.total = a.lit.total + b.lit.total;
  m.lit.light = add(a.lit.light, b.lit.light);
  m.lit.tint = a.lit.tint + b.lit.tint;
  m.light = a.light + b.light;
  m.plain = a.plain + b.plain;
  m.lit.dark_until = a.lit.dark_until;
  m.end_lit_fraction = b.end_lit_fraction >= 0.0 ? b.end_lit_fraction : a.end_lit_fraction;
  return m;
}

// Computes the distances between which a ray is in a cascade. The section is empty if to <= from.
void cascade_range(uint cascade, Ray ray, float start, float end, out float from, out float to) {
  float depth_per_m = max(dot(ray.direction, frame.camera_forward), 1e-6);
  from = start;
  if (cascade > epipolar.first_cascade) from = clamp(cascades[cascade - 1u].far_m / depth_per_m, start, end);
  to = clamp(cascades[cascade].far_m / depth_per_m, from, end);
}

// Returns the total in-scattering of a ray from the contributions of its cascades.
Spectrum light_of(March march, Ray ray, TableRay path, float start, float end) {
  float depth_per_m = max(dot(ray.direction, frame.camera_forward), 1e-6);
  float t = start;
  if (epipolar.cascades > epipolar.first_cascade) {
    t = clamp(cascades[epipolar.cascades - 1u].far_m / depth_per_m, start, end);
  }
  Spectrum light = march.light;
  if (kHomogeneous) {
    Spectrum transmittance, opacity;
    if (kClouds) {
      transmittance = exp(-HOMOGENEOUS_EXTINCTION * (t - start));
      if (kSingle != kNone) add_clouded_homogeneous(ray.direction, t, end, kCloudSteps, light, transmittance);
      return light;
    }
    homogeneous_attenuation(end - t, transmittance, opacity);
    if (kSingle != kNone) light += exp(-HOMOGENEOUS_EXTINCTION * (t - start)) * opacity;
    return light;
  }
  if (kPanels) {
    if (kClouds) {
      if (end - t > 1e-3) add_clouded(ray, t, end, kCloudSteps, light, march.plain);
    } else if (end - t > 1e-3) {
      light += single_scattering(medium, ray.altitude, ray.cos_zenith, ray.cos_sun_zenith, ray.cos_view_sun, t, end,
                                 int(frame.integration_steps) / 3);
    }
  }
  if (kLitTables || frame.unoccluded != 0u) {
    Spectrum looked_up = kSections == kEach || kColors ? table_light(march.lit, path, start, t, end)
                                                       : contiguous_light(march.lit, path, start, t, end);
    if (kCloudFraction) looked_up *= cloud_fraction(light, march.plain);
    if (kCloudFraction && kSingle == kNone) light = Spectrum(0.0);
    light += looked_up;
  }
  return light;
}

// Returns whether a ray that ends at a view-space depth has a shadowed end point.
bool has_shadowed_end(March march, float depth_m) {
  bool in_map =
      epipolar.cascades > epipolar.first_cascade && depth_m <= cascades[max(epipolar.cascades, 1u) - 1u].far_m;
  return in_map && march.end_lit_fraction >= 0.0 && march.end_lit_fraction < 0.5;
}

#endif
