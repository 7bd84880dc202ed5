// Ground cover: albedo and fine relief of meadow, forest, scree, rock and snow, computed from altitude, slope and
// noise, so that nothing has to be stored. Functions only; compiles as GLSL and as C++
// (src/scene/elevation/terrain_glsl.hpp).
// Albedo is linear and diffuse, at 680, 550 and 440 nm. Normals are in the map's frame: x east, y up, z south, on the
// tangent plane at that point of the map. Every octave of noise fades before it gets smaller than two footprints; edges
// that it would have made ragged are then blended over the same width.
#ifndef TYNDALL_TERRAIN_MATERIALS_GLSL
#define TYNDALL_TERRAIN_MATERIALS_GLSL

#include "scene/terrain_noise.glsl"

// terrain.shading, as in src/scene/description/scene_params.def.
const uint kTerrainShadingMaterials = 0u;
const uint kTerrainShadingHeight = 1u;
const uint kTerrainShadingPlain = 2u;

// Albedos are rounded from common field spectra (e.g. Baldridge et al., "The ASTER spectral library", 2009). Living
// plants are dark at 440 and 680 nm, where chlorophyll absorbs.
const vec3 kMeadowAlbedo = vec3(0.062, 0.098, 0.036);
const vec3 kDryGrassAlbedo = vec3(0.118, 0.112, 0.058);
const vec3 kForestAlbedo = vec3(0.024, 0.039, 0.019);
const vec3 kSteppeAlbedo = vec3(0.215, 0.180, 0.115);
const vec3 kScreeAlbedo = vec3(0.245, 0.228, 0.205);
const vec3 kGraniteAlbedo = vec3(0.165, 0.155, 0.148);
const vec3 kLimestoneAlbedo = vec3(0.235, 0.205, 0.170);
const vec3 kSchistAlbedo = vec3(0.105, 0.095, 0.088);
const vec3 kSnowAlbedo = vec3(0.84, 0.87, 0.90);
const vec3 kPlainAlbedo = vec3(0.30, 0.30, 0.30);

struct TerrainMaterial {
  vec3 albedo;
  vec3 normal;  // unit length, includes the fine relief
};

// Returns one octave: x is a value in about [-1, 1], yz the slope of a relief whose typical slope is one.
vec3 terrain_material_octave(ivec2 units, int a, int b, int shift, float footprint_m, uint salt) {
  float cell_m = float(1u << uint(shift)) * inversesqrt(4096.0 * float(a * a + b * b));
  float weight = clamp(cell_m / footprint_m * 0.4 - 0.8, 0.0, 1.0);
  vec3 n = vec3(0.0, 0.0, 0.0);
  if (weight > 0.0) {
    n = terrain_gradient_noise(terrain_cell(units, vec2(0.0, 0.0), a, b, shift), salt) * weight;
    vec2 slope = terrain_map_slope(vec2(n.y, n.z), a, b, shift) * cell_m;
    n = vec3(n.x * 1.6, slope.x, slope.y);
  }
  return n;
}

// Returns the weight of detail of a wavelength, or of a lattice's cell size, at a footprint.
float terrain_material_weight(float cell_m, float footprint_m) {
  return clamp(cell_m / footprint_m * 0.4 - 0.8, 0.0, 1.0);
}

// Returns ribs and gullies that run down `slope`, finer than the elevation resolves: x runs from 1 on crests to -1 in
// gullies, yz is the slope of a relief whose typical slope is one. On level ground they meander. Waves of coarsest_m
// metres and longer are left to the elevation.
vec3 terrain_material_ribs(vec2 slope, ivec2 units, int a, int b, int shift, float coarsest_m, float footprint_m,
                           uint salt) {
  float wave_m =
      float(1u << uint(shift)) * inversesqrt(float(a * a + b * b)) * (1.0 / (kTerrainUnitsPerM * kGullyTurns));
  float weight = terrain_material_weight(0.6 * wave_m, footprint_m) * clamp(2.0 - 2.0 * wave_m / coarsest_m, 0.0, 1.0);
  vec3 n = vec3(0.0, 0.0, 0.0);
  if (weight > 0.0) {
    vec2 across = vec2(-slope.y, slope.x) * inversesqrt(dot(slope, slope) + 0.01);
    vec2 z = terrain_gully(across, units, vec2(0.0, 0.0), a, b, shift, salt) * weight;
    vec2 fall = across * (-1.2 * z.y);
    n = vec3(z.x, fall.x, fall.y);
  }
  return n;
}

// Returns the fraction of a cover whose edge lies at x = 0. `width` has the unit of x.
float terrain_cover(float x, float width) { return clamp(x / width + 0.5, 0.0, 1.0); }

// The octaves of noise at a point, from coarse to fine: x is a value or a position on a rib, yz a slope.
struct TerrainDetail {
  vec3 wide;     // 1295 m
  vec3 patches;  // 458 m
  vec3 broad;    // ribs of 4.9 to 0.33 km
  vec3 coarse;   // ribs of 137 m
  vec3 middle;   // ribs of 54 m
  vec3 fine;     // 14 m
  vec3 grain;    // 4.4 m
  vec3 pebbles;  // 1.8 m
};

TerrainDetail terrain_detail(ivec2 units, vec2 gradient, float footprint_m, uint salt) {
  TerrainDetail d;
  d.wide = terrain_material_octave(units, 1, 3, 18, footprint_m, salt + 1u);
  d.patches = terrain_material_octave(units, 2, 1, 16, footprint_m, salt + 2u);
  // Far away the elevation's cells span several pixels. About two of these octaves replace the missing detail.
  float cells_m = 24.0 * footprint_m;
  d.broad = terrain_material_ribs(gradient, units, 2, 1, 19, cells_m, footprint_m, salt + 10u);  // 4.9 km
  d.broad += terrain_material_ribs(gradient + vec2(d.broad.y, d.broad.z) * 0.3, units, 1, 3, 18, cells_m, footprint_m,
                                   salt + 11u);  // 1.7 km
  d.broad += terrain_material_ribs(gradient + vec2(d.broad.y, d.broad.z) * 0.3, units, 3, 2, 17, cells_m, footprint_m,
                                   salt + 12u);  // 0.76 km
  d.broad += terrain_material_ribs(gradient + vec2(d.broad.y, d.broad.z) * 0.3, units, 1, 4, 16, cells_m, footprint_m,
                                   salt + 13u);  // 0.33 km
  // Level ground has no downhill direction; there the relief of the patches steers the ribs.
  vec2 steer = gradient + vec2(d.patches.y, d.patches.z) * 0.12;
  d.coarse = terrain_material_ribs(steer, units, 4, 3, 15, 1.0e9, footprint_m, salt + 3u);
  steer += vec2(d.coarse.y, d.coarse.z) * 0.35;
  d.middle = terrain_material_ribs(steer, units, 3, 1, 13, 1.0e9, footprint_m, salt + 4u);
  d.fine = terrain_material_octave(units, 1, 2, 11, footprint_m, salt + 5u);
  d.grain = terrain_material_octave(units, 3, 2, 10, footprint_m, salt + 6u);
  d.pebbles = terrain_material_octave(units, 2, 1, 8, footprint_m, salt + 7u);
  return d;
}

// Returns how dry the region is, from 0 to 1. It varies over distances of 939 and 130 km, and the region around the
// origin is wet. `hollow` is positive in hollows.
float terrain_dryness(ivec2 units, float altitude_m, float large, float hollow, uint salt) {
  vec2 none = vec2(0.0, 0.0);
  vec2 away = vec2(units) * (1.0 / (kTerrainUnitsPerM * 160000.0));
  float away2 = dot(away, away);
  float dry = terrain_gradient_noise(terrain_cell(units, none, 2, 1, 27), salt + 8u).x * 1.7 +
              terrain_gradient_noise(terrain_cell(units, none, 1, 4, 25), salt + 9u).x * 0.7 -
              0.9 / (1.0 + away2 * away2);
  return clamp(0.30 + 0.8 * dry + 0.10 * large + (altitude_m - 900.0) * 0.0003 - 0.25 * hollow, 0.0, 1.0);
}

// Returns the albedo of bare rock. The kind of rock changes over kilometres, its beds over tens of metres of altitude
// (tilted by the wide noise).
vec3 terrain_rock_albedo(TerrainDetail d, float altitude_m, float large, float steep, float footprint_m) {
  float kind = large + 0.35 * d.wide.x;
  vec3 stone = mix(kGraniteAlbedo, kLimestoneAlbedo, terrain_cover(kind - 0.15, 0.5));
  stone = mix(stone, kSchistAlbedo, terrain_cover(-kind - 0.45, 0.5));
  float bed = (altitude_m + 60.0 * d.wide.x + 10.0 * d.coarse.x + 4.0 * d.middle.x) * (1.0 / 46.0);
  float bed_seen = clamp(46.0 / (footprint_m * max(steep, 0.2) * 4.0) - 0.5, 0.0, 1.0);
  float beds = (terrain_phasor(bed).x * 0.6 + terrain_phasor(bed * 2.7).x * 0.4) * bed_seen;
  return stone * (0.94 + 0.16 * beds + 0.14 * d.middle.x + 0.22 * (d.fine.x + d.grain.x));
}

// Returns the cover of the ground. units: position on the map, see terrain_units(). altitude_m: above sea level.
// normal: of the large relief. bend: change of its slope over the distance that it resolves, positive in hollows.
// footprint_m: width of a pixel on the map. Takes about 1700 operations within a few metres, where every octave is
// visible, and 150 to 250 fewer for each octave that is not.
TerrainMaterial terrain_material(ivec2 units, float altitude_m, vec3 normal, float bend, float footprint_m, uint seed) {
  uint salt = terrain_hash(seed + 0x2c1b3c6du);
  vec2 gradient = vec2(normal.x, normal.z) * (-1.0 / max(normal.y, 0.05));
  TerrainDetail d = terrain_detail(units, gradient, footprint_m, salt);
  float hollow = bend / (0.35 + abs(bend)) - 0.28 * d.broad.x;
  float large = d.wide.x * 0.55 + d.patches.x * 0.45;
  float ragged = d.coarse.x * 0.22 + d.middle.x * 0.22 + d.fine.x * 0.32 + d.grain.x * 0.25;
  // The part of `ragged` that the footprint cannot resolve, as the width of a uniform distribution of the same
  // variance. Edges are softened by it.
  float lost_coarse = 1.0 - terrain_material_weight(82.0, footprint_m);
  float lost_middle = 1.0 - terrain_material_weight(32.0, footprint_m);
  float lost_fine = 1.0 - terrain_material_weight(14.0, footprint_m);
  float unresolved = sqrt(0.30 * lost_coarse + 0.30 * lost_middle + 0.25 * lost_fine);
  float edge = 0.05 + 0.75 * unresolved;

  // The tangent of the slope with the ribs that the elevation is too coarse for. Where even large relief is below a
  // pixel, the ground is steeper than its mean; without this, distant mountains would be all snow.
  float bare_m = clamp((altitude_m - 1500.0) * (1.0 / 900.0), 0.0, 1.0);
  float hidden = clamp(log2(max(footprint_m, 16.0) * 0.0625) * 0.14, 0.0, 1.0);
  vec2 ribbed = gradient +
                (vec2(d.coarse.y, d.coarse.z) * 0.28 + vec2(d.middle.y, d.middle.z) * 0.34) *
                    (bare_m * clamp(0.75 + large, 0.3, 1.2) * min(1.4 * length(gradient), 1.0)) +
                vec2(d.broad.y, d.broad.z) * ((0.22 + 0.14 * bare_m) * min(2.2 * length(gradient), 1.0));
  float steep = length(ribbed) * (1.0 + hidden);
  float rough_steep = steep * (1.0 + 0.25 * ragged + 0.10 * large);
  float sunny = clamp(normal.z * 1.6, -1.0, 1.0);  // south faces lose their snow earlier

  float dry = terrain_dryness(units, altitude_m, large, hollow, salt);

  // The fractions of the covers; later ones lie on top.
  float treeline_m = 1750.0 + 130.0 * sunny;
  float trees =
      terrain_cover((treeline_m - altitude_m) / 420.0 + 0.55 * large + 0.6 * ragged - 0.15, edge) *
      terrain_cover(large * 0.9 + ragged * 0.7 + 1.6 * min(steep, 0.45) + 0.25 * hollow - 0.38 - 0.7 * dry, edge) *
      terrain_cover(1.25 - rough_steep, 0.3);
  float barren = terrain_cover(
      (altitude_m - 2150.0 - 120.0 * sunny) / 500.0 + 0.5 * large + 0.8 * ragged + 0.5 * (steep - 0.5) - 0.5 * hollow,
      0.35 + edge);
  float scree = max(barren, terrain_cover(rough_steep - 0.66 + 0.10 * large, 0.10 + 0.35 * unresolved));
  // Rock stands out as ribs; debris lies in the gullies between them.
  float rock = terrain_cover(rough_steep - 0.84 + 0.12 * large - 0.25 * hollow +
                                 0.28 * (d.coarse.x * 0.5 + d.middle.x * 0.5) + 0.14 * barren * (d.fine.x + d.grain.x),
                             0.07 + 0.5 * unresolved);
  // Snow fills gullies, and the wind removes it from crests.
  float snowline_m = 2700.0 + 260.0 * sunny;
  float snow_depth = (altitude_m - snowline_m) / 450.0 + 0.45 * large + 0.35 * ragged + 0.9 * hollow -
                     0.60 * (d.coarse.x * 0.55 + d.middle.x * 0.45);
  float snow_hold = 0.66 + 0.24 * clamp((altitude_m - snowline_m) / 900.0, 0.0, 1.5);
  float snow = terrain_cover(snow_depth, 0.08 + edge + 2.0 * hidden) *
               terrain_cover(snow_hold - steep * (1.0 + 0.30 * (d.fine.x + d.grain.x)) + 0.12 * large + 0.30 * hollow -
                                 0.22 * (d.coarse.x * 0.5 + d.middle.x * 0.5),
                             0.07 + 0.5 * unresolved);

  vec3 meadow = mix(kMeadowAlbedo, kDryGrassAlbedo,
                    clamp((altitude_m - 1100.0) / 1300.0 + 0.35 * large + 0.25 * ragged + 0.9 * dry, 0.0, 1.0));
  meadow = mix(meadow, kSteppeAlbedo, clamp(2.0 * dry - 0.9, 0.0, 1.0));
  float speckle = d.fine.x + d.grain.x;
  vec3 albedo = meadow * (1.0 + 0.18 * d.patches.x + 0.20 * (speckle + 0.6 * d.pebbles.x) + 0.08 * d.middle.x);
  albedo = mix(albedo, kForestAlbedo * (1.0 + 0.45 * d.fine.x + 0.35 * d.grain.x + 0.1 * ragged), trees);
  albedo = mix(albedo, kScreeAlbedo * (1.0 + 0.16 * speckle - 0.10 * d.middle.x + 0.10 * d.pebbles.x), scree);

  albedo = mix(albedo, terrain_rock_albedo(d, altitude_m, large, steep, footprint_m), rock);
  albedo = mix(albedo, kSnowAlbedo * (1.0 + 0.02 * ragged), snow);

  // The fine relief: a typical slope for each octave and cover. Ribs exist on bare ground only, half filled by snow.
  float bare = max(scree * 0.6, rock);
  float relief = mix(mix(0.10, 0.55, trees), mix(0.32, 0.60, rock), bare);
  relief = mix(relief, 0.09, snow);
  vec2 slope =
      (ribbed - gradient) * (1.0 - 0.65 * snow) +
      (vec2(d.fine.y, d.fine.z) * 0.5 + vec2(d.grain.y, d.grain.z) * 0.5 + vec2(d.pebbles.y, d.pebbles.z) * 0.35) *
          relief;

  TerrainMaterial result;
  result.albedo = clamp(albedo, vec3(0.005), vec3(0.93));
  result.normal = normalize(normal - vec3(slope.x, 0.0, slope.y) * normal.y);
  return result;
}

// Returns a colour by altitude, as on a physical map: green lowlands, then yellow, brown, grey and white.
vec3 terrain_height_albedo(float altitude_m) {
  vec3 c = mix(vec3(0.10, 0.22, 0.08), vec3(0.20, 0.30, 0.10), clamp(altitude_m / 600.0, 0.0, 1.0));
  c = mix(c, vec3(0.42, 0.38, 0.16), clamp((altitude_m - 600.0) / 700.0, 0.0, 1.0));
  c = mix(c, vec3(0.34, 0.20, 0.10), clamp((altitude_m - 1300.0) / 900.0, 0.0, 1.0));
  c = mix(c, vec3(0.30, 0.28, 0.27), clamp((altitude_m - 2200.0) / 700.0, 0.0, 1.0));
  return mix(c, vec3(0.80, 0.81, 0.83), clamp((altitude_m - 2900.0) / 1300.0, 0.0, 1.0));
}

// Returns the ground in the selected mode of terrain.shading.
TerrainMaterial terrain_ground(uint shading, ivec2 units, float altitude_m, vec3 normal, float bend, float footprint_m,
                               uint seed) {
  TerrainMaterial ground;
  ground.normal = normal;
  ground.albedo = kPlainAlbedo;
  if (shading == kTerrainShadingMaterials) {
    ground = terrain_material(units, altitude_m, normal, bend, footprint_m, seed);
  } else if (shading == kTerrainShadingHeight) {
    ground.albedo = terrain_height_albedo(altitude_m);
  }
  return ground;
}

#endif
