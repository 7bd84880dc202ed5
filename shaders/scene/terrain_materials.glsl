// What covers the ground: albedo and fine relief of meadow, forest, scree, rock and snow, from altitude,
// slope and noise alone, so that nothing has to be stored. Functions only; compiles as GLSL and as C++
// (src/scene/elevation/terrain_glsl.hpp).
// Albedo is linear, diffuse, at 680, 550 and 440 nm. Normals are in the map's frame: x east, y up,
// z south, on the tangent plane at that place of the map. Every octave of noise fades before it gets
// smaller than two footprints, and what it would have made ragged is then blended over the same width.
#ifndef TYNDALL_TERRAIN_MATERIALS_GLSL
#define TYNDALL_TERRAIN_MATERIALS_GLSL

#include "scene/terrain_noise.glsl"

// terrain.shading, as in src/scene/scene_params.def.
const uint kTerrainShadingMaterials = 0u;
const uint kTerrainShadingHeight = 1u;
const uint kTerrainShadingPlain = 2u;

// Albedos from the usual field spectra (e.g. Baldridge et al., "The ASTER spectral library", 2009),
// rounded: living plants are dark at 440 and 680 nm, where chlorophyll absorbs.
const vec3 kMeadowAlbedo = vec3(0.062, 0.098, 0.036);
const vec3 kDryGrassAlbedo = vec3(0.118, 0.112, 0.058);
const vec3 kForestAlbedo = vec3(0.024, 0.039, 0.019);
const vec3 kScreeAlbedo = vec3(0.245, 0.228, 0.205);
const vec3 kGraniteAlbedo = vec3(0.165, 0.155, 0.148);
const vec3 kLimestoneAlbedo = vec3(0.235, 0.205, 0.170);
const vec3 kSchistAlbedo = vec3(0.105, 0.095, 0.088);
const vec3 kSnowAlbedo = vec3(0.84, 0.87, 0.90);
const vec3 kPlainAlbedo = vec3(0.30, 0.30, 0.30);

struct TerrainMaterial {
  vec3 albedo;
  vec3 normal;  // unit length, with the fine relief added
};

// Adds one octave: x value in about [-1, 1], yz slope of a relief whose typical slope is one.
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

// Share of a cover whose edge lies where `x` is zero; `width` in the unit of x.
float terrain_cover(float x, float width) { return clamp(x / width + 0.5, 0.0, 1.0); }

// units: place on the map, see terrain_units. altitude_m: above sea level. normal: of the large relief.
// footprint_m: width of a pixel on the map. About 1200 operations within a few metres, where every octave is
// visible, 150 fewer for each that is not.
TerrainMaterial terrain_material(ivec2 units, float altitude_m, vec3 normal, float footprint_m, uint seed) {
  uint salt = terrain_hash(seed + 0x2c1b3c6du);
  vec3 wide = terrain_material_octave(units, 1, 3, 18, footprint_m, salt + 1u);     // 1295 m
  vec3 patches = terrain_material_octave(units, 2, 1, 16, footprint_m, salt + 2u);  // 458 m
  vec3 coarse = terrain_material_octave(units, 2, 3, 15, footprint_m, salt + 3u);   // 142 m
  vec3 middle = terrain_material_octave(units, 3, 1, 13, footprint_m, salt + 4u);   // 40 m
  vec3 fine = terrain_material_octave(units, 1, 2, 11, footprint_m, salt + 5u);     // 14 m
  vec3 grain = terrain_material_octave(units, 3, 2, 10, footprint_m, salt + 6u);    // 4.4 m
  vec3 pebbles = terrain_material_octave(units, 2, 1, 8, footprint_m, salt + 7u);   // 1.8 m
  float large = wide.x * 0.55 + patches.x * 0.45;
  float ragged = coarse.x * 0.4 + middle.x * 0.35 + fine.x * 0.25 + grain.x * 0.15;
  // How much of `ragged` the footprint leaves unresolved: edges are that much softer.
  float unresolved = clamp(footprint_m * 0.02, 0.0, 1.0);
  float edge = 0.12 + 0.7 * unresolved;

  float steep = sqrt(max(1.0 - normal.y * normal.y, 0.0)) / max(normal.y, 0.05);  // tangent of the slope
  float rough_steep = steep * (1.0 + 0.30 * ragged + 0.10 * large);
  float sunny = clamp(normal.z * 1.6, -1.0, 1.0);  // south faces lose their snow sooner

  // Which ground, as shares that later layers cover.
  float treeline_m = 1750.0 + 130.0 * sunny;
  float trees = terrain_cover((treeline_m - altitude_m) / 420.0 + 0.55 * large + 0.6 * ragged - 0.15, edge) *
                terrain_cover(large * 0.9 + ragged * 0.55 + 1.6 * min(steep, 0.45) - 0.38, edge) *
                terrain_cover(1.25 - rough_steep, 0.3);
  float barren =
      terrain_cover((altitude_m - 2150.0 - 120.0 * sunny) / 500.0 + 0.5 * large + 0.7 * ragged, 0.5 + edge);
  float scree = max(barren, terrain_cover(rough_steep - 0.62 + 0.10 * large, 0.10 + 0.2 * unresolved));
  float rock =
      terrain_cover(rough_steep - 0.80 + 0.12 * large + 0.10 * barren * ragged, 0.10 + 0.25 * unresolved);
  float snowline_m = 2620.0 + 260.0 * sunny;
  float snow_depth = (altitude_m - snowline_m) / 450.0 + 0.45 * large + 0.55 * ragged;
  float snow_hold = 0.62 + 0.22 * clamp((altitude_m - snowline_m) / 900.0, 0.0, 1.5);
  float snow = terrain_cover(snow_depth, edge) *
               terrain_cover(snow_hold - steep * (1.0 + 0.35 * ragged - 0.25 * middle.x) + 0.12 * large,
                             0.10 + 0.25 * unresolved);

  vec3 meadow = mix(kMeadowAlbedo, kDryGrassAlbedo,
                    clamp((altitude_m - 1100.0) / 1300.0 + 0.35 * large + 0.25 * ragged, 0.0, 1.0));
  vec3 albedo = meadow * (1.0 + 0.18 * patches.x + 0.15 * ragged);
  albedo = mix(albedo, kForestAlbedo * (1.0 + 0.25 * fine.x + 0.2 * ragged), trees);
  albedo = mix(albedo, kScreeAlbedo * (1.0 + 0.12 * ragged + 0.10 * pebbles.x), scree);

  // Rock: kinds change over kilometres, beds over tens of metres of altitude (tilted by the wide noise).
  float kind = large + 0.35 * wide.x;
  vec3 stone = mix(kGraniteAlbedo, kLimestoneAlbedo, terrain_cover(kind - 0.15, 0.5));
  stone = mix(stone, kSchistAlbedo, terrain_cover(-kind - 0.45, 0.5));
  float bed = (altitude_m + 60.0 * wide.x + 10.0 * coarse.x + 4.0 * middle.x) * (1.0 / 46.0);
  float bed_seen = clamp(46.0 / (footprint_m * max(steep, 0.2) * 4.0) - 0.5, 0.0, 1.0);
  float beds = (terrain_phasor(bed).x * 0.6 + terrain_phasor(bed * 2.7).x * 0.4) * bed_seen;
  albedo = mix(albedo, stone * (1.0 + 0.13 * beds + 0.22 * ragged), rock);
  albedo = mix(albedo, kSnowAlbedo * (1.0 + 0.02 * ragged), snow);

  // Fine relief: typical slope of each octave by cover.
  float bare = max(scree * 0.6, rock);
  float relief = mix(mix(0.10, 0.55, trees), mix(0.32, 0.50, rock), bare);
  relief = mix(relief, 0.09, snow);
  vec2 slope = vec2(coarse.y, coarse.z) * 0.35 * (1.0 - 0.8 * trees) + vec2(middle.y, middle.z) * 0.45 +
               vec2(fine.y, fine.z) * 0.5 + vec2(grain.y, grain.z) * 0.5 + vec2(pebbles.y, pebbles.z) * 0.35;
  slope = slope * relief;

  TerrainMaterial result;
  result.albedo = clamp(albedo, vec3(0.005), vec3(0.93));
  result.normal = normalize(normal - vec3(slope.x, 0.0, slope.y) * normal.y);
  return result;
}

// Colours by altitude, as on a physical map: green lowlands, yellow, brown, grey, white.
vec3 terrain_height_albedo(float altitude_m) {
  vec3 c = mix(vec3(0.10, 0.22, 0.08), vec3(0.20, 0.30, 0.10), clamp(altitude_m / 600.0, 0.0, 1.0));
  c = mix(c, vec3(0.42, 0.38, 0.16), clamp((altitude_m - 600.0) / 700.0, 0.0, 1.0));
  c = mix(c, vec3(0.34, 0.20, 0.10), clamp((altitude_m - 1300.0) / 900.0, 0.0, 1.0));
  c = mix(c, vec3(0.30, 0.28, 0.27), clamp((altitude_m - 2200.0) / 700.0, 0.0, 1.0));
  return mix(c, vec3(0.80, 0.81, 0.83), clamp((altitude_m - 2900.0) / 1300.0, 0.0, 1.0));
}

// The ground in one of the three modes of terrain.shading.
TerrainMaterial terrain_ground(uint shading, ivec2 units, float altitude_m, vec3 normal, float footprint_m,
                               uint seed) {
  TerrainMaterial ground;
  ground.normal = normal;
  ground.albedo = kPlainAlbedo;
  if (shading == kTerrainShadingMaterials) {
    ground = terrain_material(units, altitude_m, normal, footprint_m, seed);
  } else if (shading == kTerrainShadingHeight) {
    ground.albedo = terrain_height_albedo(altitude_m);
  }
  return ground;
}

#endif
