// Elevation of the procedural mountains: a pure function of the map position, the sample spacing and a seed. Functions
// only; compiles as GLSL in single precision and as C++ in double precision (src/scene/elevation/terrain_glsl.hpp), so
// literals have a dot and nothing assigns to a swizzle.
//
// Positions are integers in units of 1/64 m, x east and z south of the origin. Octave k of the noise has its own
// lattice, the image of the positions under the integer matrix (a -b; b a) / 2^shift: rotated by atan(b/a), with cells
// of 2^shift / (64 sqrt(a^2 + b^2)) m. Cell numbers and fractions come from integer arithmetic, so the noise is as
// precise 2000 km away as at the origin, and no lattice repeats within 16 000 km.
//
// The largest shapes are belts of mountains on continents. Valleys follow the zero lines of a 36 km noise, ridges those
// of a 14.7 km noise, and massifs of 7 km lie between. Gullies run down the slope of the coarser octaves; each gully
// octave branches off the previous one. The slope that steers them is smooth and turns no faster than their own waves;
// otherwise they would fold into walls.
// A gully octave is a sum of plane waves around jittered lattice points, as in sparse Gabor noise (Lagae et al.,
// "Procedural noise using sparse Gabor convolution", 2009), with the wave vector across the local slope. The sum is
// normalised to a phase (Tricard et al., "Procedural phasor noise", 2019). The wave is even about its points, so
// turning the slope by half a turn at a crest changes nothing.
#ifndef TYNDALL_TERRAIN_NOISE_GLSL
#define TYNDALL_TERRAIN_NOISE_GLSL

#include "lib/portable.glsl"

const float kTerrainUnitsPerM = 64.0;
const float kTerrainMinM = 200.0;   // never reached
const float kTerrainMaxM = 5000.0;  // never reached
const float kTau = 6.283185307;

// Wavelengths of a gully octave per lattice cell, and the largest displacement of its points in cells.
const float kGullyTurns = 0.75;
const float kGullyJitter = 0.5;
// The squared amplitude of a wave below which its normalisation to a phase fades.
const float kGullyCalm = 0.12;

// A position within one lattice.
struct TerrainCell {
  uvec2 corner;  // number of the cell
  uint mask;     // valid bits of cell numbers
  vec2 f;        // position in the cell, [0; 1)
};

// The terrain after the octaves that have been added so far.
struct TerrainSurface {
  float height_m;
  vec2 slope;   // smooth gradient that steers finer gullies, m/m
  float crest;  // [0; 1] 1 on crests, 0 on valley floors
};

// Returns bounds of the elevation that terrain_height_at() can return [m].
vec2 terrain_height_bounds() { return vec2(kTerrainMinM, kTerrainMaxM); }

// Returns the integer position, in units of 1 / kTerrainUnitsPerM metres, that is nearest to a point of the map. Far
// from the origin, floats are too coarse; compute with integers there.
ivec2 terrain_units(vec2 map_m) { return ivec2(floor(map_m * kTerrainUnitsPerM + vec2(0.5, 0.5))); }

TerrainCell terrain_cell(ivec2 units, vec2 warp_m, int a, int b, int shift) {
  uint ua = uint(a);
  uint ub = uint(b);
  uvec2 q = uvec2(units);
  uvec2 u = uvec2(ua * q.x - ub * q.y, ub * q.x + ua * q.y);  // modulo 2^32, as are cell numbers
  uint size = 1u << uint(shift);
  float per_unit = 1.0 / float(size);
  float per_m = kTerrainUnitsPerM * per_unit;
  vec2 w = vec2(float(a) * warp_m.x - float(b) * warp_m.y, float(b) * warp_m.x + float(a) * warp_m.y) * per_m;
  vec2 f = vec2(float(u.x & (size - 1u)), float(u.y & (size - 1u))) * per_unit + w;
  vec2 whole = floor(f);
  TerrainCell cell;
  cell.f = f - whole;
  cell.mask = 0xffffffffu >> uint(shift);
  cell.corner = uvec2(u.x >> uint(shift), u.y >> uint(shift)) + uvec2(ivec2(whole));
  return cell;
}

// Converts a gradient per cell of a lattice to a gradient per metre of the map.
vec2 terrain_map_slope(vec2 d, int a, int b, int shift) {
  float per_m = kTerrainUnitsPerM / float(1u << uint(shift));
  return vec2(float(a) * d.x + float(b) * d.y, float(a) * d.y - float(b) * d.x) * per_m;
}

// An integer finaliser of the multiply-xorshift family, with the constants of C. Wellons' search (public domain).
uint terrain_hash(uint n) {
  uint h = n;
  h = (h ^ (h >> 16u)) * 0x7feb352du;
  h = (h ^ (h >> 15u)) * 0x846ca68bu;
  return h ^ (h >> 16u);
}

// Returns two numbers in [-1; 1].
vec2 terrain_random2(uint h) { return vec2(float(h & 0xffffu), float(h >> 16u)) * (1.0 / 32767.5) - vec2(1.0, 1.0); }

uvec4 terrain_corners(TerrainCell cell, uint salt) {
  uint x0 = (cell.corner.x & cell.mask) * 0x9e3779b1u;
  uint x1 = ((cell.corner.x + 1u) & cell.mask) * 0x9e3779b1u;
  uint y0 = (cell.corner.y & cell.mask) * 0x85ebca77u + salt;
  uint y1 = ((cell.corner.y + 1u) & cell.mask) * 0x85ebca77u + salt;
  return uvec4(terrain_hash(x0 + y0), terrain_hash(x1 + y0), terrain_hash(x0 + y1), terrain_hash(x1 + y1));
}

// Returns two independent value noises in [-1; 1].
vec2 terrain_value2(TerrainCell cell, uint salt) {
  uvec4 h = terrain_corners(cell, salt);
  vec2 t = cell.f * cell.f * (vec2(3.0, 3.0) - cell.f * 2.0);
  return mix(mix(terrain_random2(h.x), terrain_random2(h.y), t.x), mix(terrain_random2(h.z), terrain_random2(h.w), t.x),
             t.y);
}

// Returns gradient noise (Perlin, "Improving noise", 2002): x is the value, mostly in [-0.7; 0.7], yz the gradient per
// cell.
vec3 terrain_gradient_noise(TerrainCell cell, uint salt) {
  uvec4 h = terrain_corners(cell, salt);
  vec2 f = cell.f;
  vec2 t = f * f * f * (f * (f * 6.0 - vec2(15.0, 15.0)) + vec2(10.0, 10.0));
  vec2 dt = f * f * (f * (f - vec2(2.0, 2.0)) + vec2(1.0, 1.0)) * 30.0;
  vec2 ga = terrain_random2(h.x);
  vec2 gb = terrain_random2(h.y);
  vec2 gc = terrain_random2(h.z);
  vec2 gd = terrain_random2(h.w);
  float va = dot(ga, f);
  float vb = dot(gb, f - vec2(1.0, 0.0));
  float vc = dot(gc, f - vec2(0.0, 1.0));
  float vd = dot(gd, f - vec2(1.0, 1.0));
  float k = va - vb - vc + vd;
  float v = va + t.x * (vb - va) + t.y * (vc - va) + t.x * t.y * k;
  vec2 d = ga + (gb - ga) * t.x + (gc - ga) * t.y + (ga - gb - gc + gd) * (t.x * t.y) +
           dt * (vec2(t.y, t.x) * k + vec2(vb - va, vc - va));
  return vec3(v, d.x, d.y) * 1.4;
}

// Returns cosine and sine of an angle in turns, with an error below 0.0012.
vec2 terrain_phasor(float turns) {
  float x = turns - floor(turns + 0.5);
  float y = 0.25 - abs(x);
  float s = x * (8.0 - 16.0 * abs(x));
  float c = y * (8.0 - 16.0 * abs(y));
  return vec2(c * (0.775 + 0.225 * abs(c)), s * (0.775 + 0.225 * abs(s)));
}

// Returns cosine and sine of the phase of gullies that run at right angles to `across` (map frame). The length of
// `across`, at most one, scales the wave number.
vec2 terrain_gully(vec2 across, ivec2 units, vec2 warp_m, int a, int b, int shift, uint salt) {
  TerrainCell cell = terrain_cell(units, warp_m, a, b, shift);
  uvec4 h = terrain_corners(cell, salt);
  float turns = kGullyTurns * inversesqrt(float(a * a + b * b));
  vec2 k = vec2(float(a) * across.x - float(b) * across.y, float(b) * across.x + float(a) * across.y) * turns;
  vec2 f = cell.f;
  vec2 t = f * f * (vec2(3.0, 3.0) - f * 2.0);
  vec2 z00 = terrain_phasor(dot(k, f - terrain_random2(h.x) * kGullyJitter));
  vec2 z10 = terrain_phasor(dot(k, f - vec2(1.0, 0.0) - terrain_random2(h.y) * kGullyJitter));
  vec2 z01 = terrain_phasor(dot(k, f - vec2(0.0, 1.0) - terrain_random2(h.z) * kGullyJitter));
  vec2 z11 = terrain_phasor(dot(k, f - vec2(1.0, 1.0) - terrain_random2(h.w) * kGullyJitter));
  vec2 sum = mix(mix(z00, z10, t.x), mix(z01, z11, t.x), t.y);
  // Where the waves cancel, crest and floor are adjacent. Full normalisation would turn the slope between them into a
  // wall.
  return sum * inversesqrt(dot(sum, sum) + kGullyCalm);
}

// Returns the cross-section of a gully for the cosine of its phase: sharp crests, rounded floors, mean zero. `blunt`
// rounds the crests to what the spacing can resolve.
float terrain_gully_profile(float cosine, float blunt) {
  // The mean of sqrt(sin^2(phase / 2) + blunt) is sqrt(0.405 + blunt) within 0.02.
  return 2.0 * (sqrt(0.405 + blunt) - sqrt(max(0.5 - 0.5 * cosine, 0.0) + 0.001 + blunt));
}

// A point to be given gullies, and which of their octaves it needs.
struct TerrainPoint {
  ivec2 units;      // position on the map
  vec2 warp_m;      // its displacement, see terrain_warp()
  float spacing_m;  // of the samples
  float detail_m;   // octaves between this wavelength and twice this fade in; huge for procedural terrain
};

// Adds one gully octave to `s`. amplitude is the height per wavelength; gullies fade where the squared slope is below
// `gentle`.
void terrain_gully_octave(INOUT(TerrainSurface) s, TerrainPoint point, int a, int b, int shift, float amplitude,
                          float gentle, uint salt) {
  float wave_m =
      float(1u << uint(shift)) * inversesqrt(float(a * a + b * b)) * (1.0 / (kTerrainUnitsPerM * kGullyTurns));
  float per_wave = point.spacing_m / wave_m;
  float shown = clamp(0.5 / per_wave - 1.0, 0.0, 1.0);
  float wanted = clamp(2.0 - wave_m / point.detail_m, 0.0, 1.0);
  if (wanted > 0.0) {
    float steep2 = dot(s.slope, s.slope);
    // On crests, where the slope reverses, the wave number goes to zero; otherwise its direction would jump. `still`
    // runs from 1 there to 0 on steep slopes and raises the mean of the wave (fitted to 2e5 points, within 0.07). Waves
    // that the spacing cannot resolve are replaced by that mean, so that all spacings agree on average.
    float turn2 = gentle;
    float still = turn2 / (steep2 + turn2);
    vec2 across = vec2(-s.slope.y, s.slope.x) * inversesqrt(steep2 + turn2);
    // On valley floors the raised mean is removed again, or it would form a bank along them.
    vec2 z = vec2(0.07 + still * (0.22 + 0.65 * still), 0.0);
    float rise = still * (0.22 + 0.7 * still * still);
    float sunk = rise * (1.0 - min(1.5 * s.crest, 1.0));
    float profile = rise - sunk;
    if (shown > 0.0) {
      vec2 wave = terrain_gully(across, point.units, point.warp_m, a, b, shift, salt);
      profile = mix(profile, terrain_gully_profile(wave.x, 2.5 * per_wave * per_wave) - sunk, shown);
      z = mix(z, wave, shown);
    }
    float height_m = amplitude * wave_m * wanted * (steep2 + 0.4 * gentle * s.crest) /
                     ((steep2 + 0.5 * gentle) * (1.0 + 0.3 * steep2 * steep2));
    s.height_m += height_m * profile;
    s.slope -= across * (height_m * z.y * (kTau / wave_m) * 0.5);
    s.crest = s.crest * mix(1.0, clamp(0.6 + 0.7 * z.x, 0.0, 1.4), 0.6);
  }
}

// Adds the gully octaves from 2.4 km to 60 m.
void terrain_gullies(INOUT(TerrainSurface) s, TerrainPoint point, float strength, uint salt) {
  terrain_gully_octave(s, point, 1, 2, 18, 0.110 * strength, 0.024, salt + 12u);
  terrain_gully_octave(s, point, 2, 1, 17, 0.095 * strength, 0.018, salt + 13u);
  terrain_gully_octave(s, point, 1, 2, 16, 0.080 * strength, 0.014, salt + 14u);
  terrain_gully_octave(s, point, 1, 4, 16, 0.066 * strength, 0.012, salt + 15u);
  terrain_gully_octave(s, point, 2, 3, 15, 0.060 * strength, 0.012, salt + 16u);
  terrain_gully_octave(s, point, 3, 1, 14, 0.054 * strength, 0.012, salt + 17u);
}

// Returns a displacement of the map [m], so that no feature is aligned with a lattice.
vec2 terrain_warp(ivec2 units, uint salt) {
  return terrain_value2(terrain_cell(units, vec2(0.0, 0.0), 2, 1, 21), salt + 3u) * 2000.0 +  // 14.7 km
         terrain_value2(terrain_cell(units, vec2(0.0, 0.0), 1, 3, 19), salt + 4u) * 200.0;    // 2.6 km
}

// Limits a height smoothly to within the bounds; heights from 450 to 4400 m are unchanged.
float terrain_soft_limit(float height_m) {
  float over = max(height_m - 4400.0, 0.0);
  float under = max(450.0 - height_m, 0.0);
  return clamp(height_m, 450.0, 4400.0) + 600.0 * over / (over + 600.0) - 250.0 * under / (under + 250.0);
}

// Returns the seed of the mountains of one of the planet's map projections (src/scene/description/map_projection.hpp).
uint terrain_projection_seed(uint seed, uint projection) { return seed + projection * 0x9e3779b9u; }

uint terrain_salt(uint seed) { return terrain_hash(seed + 0x51ed2712u); }

// Returns how mountainous the region is: x from 0 (lowland) to 1 (high mountains), y from 0 (plain) to 1 (upland). The
// origin always lies in high mountains.
vec2 terrain_country(ivec2 units, uint salt) {
  // Belts of mountains follow the zero lines of a 1050 km noise; uplands lie on one side of them.
  vec2 none = vec2(0.0, 0.0);
  float plates = terrain_gradient_noise(terrain_cell(units, none, 4, 1, 28), salt + 1u).x +
                 terrain_gradient_noise(terrain_cell(units, none, 1, 2, 26), salt + 7u).x * 0.32;  // 469 km
  float broken = terrain_gradient_noise(terrain_cell(units, none, 3, 1, 25), salt + 2u).x;         // 166 km
  vec2 away = vec2(units) * (1.0 / (kTerrainUnitsPerM * 110000.0));
  float away2 = dot(away, away);
  float belt = 1.0 - abs(plates - 0.05) * 4.2 + broken * 1.1;
  float range = smoothstep(-0.35, 1.1, belt + 1.2 / (1.0 + away2 * away2));
  float upland = smoothstep(-0.15, 0.45, plates + 0.25 * broken);
  return vec2(range, upland);
}

// Returns the elevation in m at a position (1/64 m). Detail below about two spacings is left out.
float terrain_height_at(ivec2 units, float spacing_m, uint seed) {
  uint salt = terrain_salt(seed);
  vec2 country = terrain_country(units, salt);
  float range = country.x;
  float high = range * range * (3.0 - 2.0 * range);
  float relief_m = 220.0 + 260.0 * country.y + 2600.0 * high;

  // Main valleys follow the zero lines of `line`; ridges of half their wavelength lie between them.
  vec2 warp_m = terrain_warp(units, salt);
  vec3 line = terrain_gradient_noise(terrain_cell(units, warp_m * 1.2, 3, 2, 23), salt + 5u);  // 36 km
  vec2 line_d = terrain_map_slope(vec2(line.y, line.z), 3, 2, 23);
  vec3 swell = terrain_gradient_noise(terrain_cell(units, warp_m, 2, 1, 21), salt + 6u);  // 14.7 km
  vec2 swell_d = terrain_map_slope(vec2(swell.y, swell.z), 2, 1, 21);
  float root = inversesqrt(line.x * line.x + 0.006);
  float off = 1.0 / root - 0.0775;
  vec2 off_d = line_d * (line.x * root);
  float rise = 1.5 * off / (off + 0.32);
  float rise_d = 0.48 / ((off + 0.32) * (off + 0.32));
  // Main ridges follow the zero lines of the swell, rounded over about 2 km.
  float spine = sqrt(swell.x * swell.x + 0.012);
  float body = 1.03 - 1.0 * spine;
  TerrainSurface s;
  s.height_m = 400.0 + 250.0 * range + 330.0 * high + 380.0 * country.y + relief_m * rise * body;
  s.slope = (off_d * (rise_d * body) + swell_d * (-rise * swell.x / spine)) * relief_m;

  // Side valleys and the massifs between them. These have no gullies: the slope that steers waves of this length would
  // turn within one wavelength, and they would fold into walls.
  vec3 side = terrain_gradient_noise(terrain_cell(units, warp_m * 0.8, 2, 1, 20), salt + 9u);  // 7.3 km
  vec2 side_d = terrain_map_slope(vec2(side.y, side.z), 2, 1, 20);
  float side_m = 0.62 * relief_m * (0.25 + 0.75 * rise) * clamp(7327.0 / spacing_m - 1.0, 0.0, 1.0);
  s.height_m += side_m * side.x;
  s.slope += side_d * side_m;
  s.crest = rise * clamp(0.55 + 1.2 * side.x, 0.0, 1.0) * high;

  TerrainPoint point;
  point.units = units;
  point.warp_m = warp_m;
  point.spacing_m = spacing_m;
  point.detail_m = 1.0e9;
  float gain = sqrt(relief_m * (1.0 / 3000.0));
  // 5.3 km
  terrain_gully_octave(s, point, 4, 1, 20, 0.140 * gain, 0.030, salt + 11u);
  // Knolls, so that finer gullies have something to run down where the terrain so far is level.
  vec3 knoll = terrain_gradient_noise(terrain_cell(units, warp_m, 1, 2, 18), salt + 10u);  // 1.8 km
  float knoll_m = 190.0 * gain * (0.3 + 0.7 * rise) * clamp(1832.0 / spacing_m - 1.0, 0.0, 1.0);
  s.height_m += knoll_m * knoll.x;
  s.slope += terrain_map_slope(vec2(knoll.y, knoll.z), 1, 2, 18) * knoll_m;
  terrain_gullies(s, point, 0.35 + 0.65 * gain, salt);
  return terrain_soft_limit(s.height_m);
}

#endif
