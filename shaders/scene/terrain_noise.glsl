#ifndef TYNDALL_TERRAIN_NOISE_GLSL
#define TYNDALL_TERRAIN_NOISE_GLSL

struct TerrainCell {
  uvec2 corner;
  uint mask;
  vec2 f;
};

struct TerrainSurface {
  float height_m;
  vec2 slope;
  float crest;  // 1 on crests, 0 on floors
};

ivec2 terrain_units(vec2 map_m) { return ivec2(floor(map_m * 64.0 + vec2(0.5))); }

TerrainCell terrain_cell(ivec2 units, vec2 warp_m, int a, int b, int shift) {
  TerrainCell cell;
  uint ua = uint(a);
  uint ub = uint(b);
  uvec2 q = uvec2(units);
  uvec2 u = uvec2(ua * q.x - ub * q.y, ub * q.x + ua * q.y);
  uint low = (1u << uint(shift)) - 1u;
  float per_m = 64.0 / float(1u << uint(shift));
  vec2 w = vec2(float(a) * warp_m.x - float(b) * warp_m.y, float(b) * warp_m.x + float(a) * warp_m.y) * per_m;
  vec2 f = vec2(float(u.x & low), float(u.y & low)) * (1.0 / float(low + 1u)) + w;
  vec2 n = floor(f);
  cell.f = f - n;
  cell.mask = 0xffffffffu >> uint(shift);
  cell.corner = uvec2(u.x >> uint(shift), u.y >> uint(shift)) + uvec2(ivec2(n));
  return cell;
}

vec2 terrain_map_slope(vec2 d, int a, int b, int shift) {
  float per_m = 64.0 / float(1u << uint(shift));
  return vec2(float(a) * d.x + float(b) * d.y, float(a) * d.y - float(b) * d.x) * per_m;
}

uint terrain_hash(uint n) {
  uint h = n;
  h = (h ^ (h >> 16u)) * 0x7feb352du;
  h = (h ^ (h >> 15u)) * 0x846ca68bu;
  return h ^ (h >> 16u);
}

vec2 terrain_random2(uint h) {
  return vec2(float(h & 0xffffu), float(h >> 16u)) * (1.0 / 32767.5) - vec2(1.0);
}

uvec4 terrain_corners(TerrainCell cell, uint salt) {
  uint x0 = (cell.corner.x & cell.mask) * 0x9e3779b1u;
  uint x1 = ((cell.corner.x + 1u) & cell.mask) * 0x9e3779b1u;
  uint y0 = (cell.corner.y & cell.mask) * 0x85ebca77u + salt;
  uint y1 = ((cell.corner.y + 1u) & cell.mask) * 0x85ebca77u + salt;
  return uvec4(terrain_hash(x0 + y0), terrain_hash(x1 + y0), terrain_hash(x0 + y1), terrain_hash(x1 + y1));
}

vec2 terrain_value2(TerrainCell cell, uint salt) {
  uvec4 h = terrain_corners(cell, salt);
  vec2 t = cell.f * cell.f * (vec2(3.0) - cell.f * 2.0);
  return mix(mix(terrain_random2(h.x), terrain_random2(h.y), t.x), mix(terrain_random2(h.z), terrain_random2(h.w), t.x), t.y);
}

vec3 terrain_gradient_noise(TerrainCell cell, uint salt) {
  uvec4 h = terrain_corners(cell, salt);
  vec2 f = cell.f;
  vec2 t = f * f * f * (f * (f * 6.0 - vec2(15.0)) + vec2(10.0));
  vec2 dt = f * f * (f * (f - vec2(2.0)) + vec2(1.0)) * 30.0;
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

vec2 terrain_phasor(float turns) {
  float x = turns - floor(turns + 0.5);
  float y = 0.25 - abs(x);
  float xs = x * (8.0 - 16.0 * abs(x));
  float c_arg = y;
  float cs = c_arg * (8.0 - 16.0 * abs(c_arg));
  return vec2(cs * (0.775 + 0.225 * abs(cs)), xs * (0.775 + 0.225 * abs(xs)));
}

const float kJitter = 0.5;
vec2 terrain_gully_wave(TerrainCell cell, vec2 turns_per_cell, uint salt) {
  uvec4 h = terrain_corners(cell, salt);
  vec2 f = cell.f;
  vec2 t = f * f * (vec2(3.0) - f * 2.0);
  vec2 k = turns_per_cell;
  vec2 z00 = terrain_phasor(dot(k, f - terrain_random2(h.x) * kJitter));
  vec2 z10 = terrain_phasor(dot(k, f - vec2(1.0, 0.0) - terrain_random2(h.y) * kJitter));
  vec2 z01 = terrain_phasor(dot(k, f - vec2(0.0, 1.0) - terrain_random2(h.z) * kJitter));
  vec2 z11 = terrain_phasor(dot(k, f - vec2(1.0, 1.0) - terrain_random2(h.w) * kJitter));
  vec2 sum = mix(mix(z00, z10, t.x), mix(z01, z11, t.x), t.y);
  return sum * inversesqrt(dot(sum, sum) + 0.01);
}

float terrain_octave_weight(float wavelength_m, float spacing_m) {
  return clamp(wavelength_m / spacing_m * 0.5 - 1.0, 0.0, 1.0);
}

const float kTurns = 0.75;

// wave: x height, y its derivative by the phase
vec2 terrain_gully(vec2 across, ivec2 units, vec2 warp_m, int a, int b, int shift, uint salt) {
  float norm = kTurns * inversesqrt(float(a * a + b * b));
  vec2 k = vec2(float(a) * across.x - float(b) * across.y, float(b) * across.x + float(a) * across.y) * norm;
  return terrain_gully_wave(terrain_cell(units, warp_m, a, b, shift), k, salt);
}

void terrain_gully_octave(INOUT(TerrainSurface) s, ivec2 units, vec2 warp_m, int a, int b, int shift, float cell_m,
                          float amplitude, float gentle, float sharp, float spacing_m, uint salt) {
  float wave_m = cell_m / kTurns;
  float w = terrain_octave_weight(wave_m, spacing_m);
  float steep2 = dot(s.slope, s.slope);
  vec2 across = vec2(-s.slope.y, s.slope.x) * inversesqrt(steep2 + 1.0e-6);
  vec2 z = terrain_gully(across, units, warp_m, a, b, shift, salt);
  float amp = amplitude * wave_m * w * (steep2 + 0.7 * gentle * s.crest) / (steep2 + gentle);
  float crest = sqrt(max(0.5 - 0.5 * z.x, 0.0) + 0.001);
  float shape = mix(z.x, 0.273 + 1.0 - 2.0 * crest, sharp);
  s.crest = mix(s.crest, s.crest * clamp(0.6 + 0.7 * z.x, 0.0, 1.4), 0.6);
  s.height_m += amp * shape;
  s.slope -= across * (amp * z.y * (6.2832 / wave_m) * 0.5);
}

float terrain_height_units(ivec2 units, float spacing_m, uint seed) {
  uint salt = terrain_hash(seed + 0x51ed270bu);
  // ranges
  vec3 r0 = terrain_gradient_noise(terrain_cell(units, vec2(0.0), 1, 2, 25), salt + 1u);   // 234 km
  vec3 r1 = terrain_gradient_noise(terrain_cell(units, vec2(0.0), 3, 1, 24), salt + 2u);   // 83 km
  vec2 wa = terrain_value2(terrain_cell(units, vec2(0.0), 2, 1, 21), salt + 3u);   // 14.6 km
  vec2 wb = terrain_value2(terrain_cell(units, vec2(0.0), 1, 3, 19), salt + 4u);   // 2.6 km
  vec2 warp = wa * 2000.0 + wb * 200.0;
  vec2 o = vec2(units) * (1.0 / 64.0 / 90000.0);
  float home = 1.0 / (1.0 + dot(o, o) * dot(o, o));
  float range = smoothstep(-0.5, 0.75, r0.x * 0.9 + r1.x * 0.45 + 0.15 + 0.5 * home);

  // valleys: zero lines
  vec3 n2 = terrain_gradient_noise(terrain_cell(units, warp * 1.2, 3, 2, 23), salt + 5u);  // 36 km
  vec2 n2d = terrain_map_slope(vec2(n2.y, n2.z), 3, 2, 23);
  vec3 n1 = terrain_gradient_noise(terrain_cell(units, warp, 2, 1, 21), salt + 6u);  // 14.6 km
  vec2 n1d = terrain_map_slope(vec2(n1.y, n1.z), 2, 1, 21);

  float valley = sqrt(n2.x * n2.x + 0.003) - 0.05;           // 0 on the line
  vec2 valley_d = n2d * (n2.x * inversesqrt(n2.x * n2.x + 0.01));

  float mount = range * range * (3.0 - 2.0 * range);
  float relief = 250.0 + 2750.0 * mount;
  float gain = relief / 3000.0;
  TerrainSurface s;
  float c = 0.16;
  float vprof = valley / (valley + c);
  float vprof_d = c / ((valley + c) * (valley + c));
  float b0 = 0.8;
  float b1 = 0.45;
  s.height_m = 400.0 + 500.0 * range + relief * vprof * (b0 + b1 * n1.x);
  s.slope = (valley_d * (vprof_d * (b0 + b1 * n1.x)) + n1d * (b1 * vprof)) * relief;

  // side valleys
  float g2 = dot(n2d, n2d);
  vec2 across = vec2(-n2d.y, n2d.x) * inversesqrt(g2 + 1.0e-14);
  vec2 za = terrain_gully(across, units, warp, 3, 2, 21, salt + 9u);
  s.crest = vprof * clamp(0.5 + 0.6 * za.x, 0.0, 1.0) * mount;
  float amp_a = 1500.0 * gain * vprof * g2 / (g2 + 2.0e-10);
  s.height_m += amp_a * (0.273 + 1.0 - 2.0 * sqrt(max(0.5 - 0.5 * za.x, 0.0) + 0.001));
  s.slope -= across * (amp_a * za.y * (6.2832 / 12100.0) * 0.7);

  terrain_gully_octave(s, units, warp, 4, 1, 20, 3974.0, 0.12 * sqrt(gain), 0.012, 1.0, spacing_m, salt + 11u);
  terrain_gully_octave(s, units, warp, 1, 2, 18, 1832.0, 0.10, 0.04, 1.0, spacing_m, salt + 12u);
  terrain_gully_octave(s, units, warp, 2, 1, 17, 916.0, 0.08, 0.06, 1.0, spacing_m, salt + 13u);
  terrain_gully_octave(s, units, warp, 1, 2, 16, 458.0, 0.07, 0.06, 1.0, spacing_m, salt + 14u);
  terrain_gully_octave(s, units, warp, 1, 4, 16, 248.0, 0.06, 0.06, 1.0, spacing_m, salt + 16u);
  terrain_gully_octave(s, units, warp, 2, 3, 15, 142.0, 0.055, 0.06, 1.0, spacing_m, salt + 17u);
  terrain_gully_octave(s, units, warp, 3, 1, 14, 81.0, 0.05, 0.06, 1.0, spacing_m, salt + 18u);
  return s.height_m;
}

float terrain_height(vec2 map_m, float spacing_m, uint seed) {
  return terrain_height_units(terrain_units(map_m), spacing_m, seed);
}
#endif
