// 3D noise for the surfaces of spheres: gradient noise on the integer lattice (Perlin, "Improving noise", 2002) with
// hashed gradients (Jarzynski, Olano, "Hash functions for GPU rendering", 2020: pcg3d).
#ifndef TYNDALL_NOISE3_GLSL
#define TYNDALL_NOISE3_GLSL

uvec3 noise3_hash(uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

// Returns noise of about -0.7 to 0.7 with mean 0. Cells have size 1.
float noise3(vec3 p, uint seed) {
  ivec3 corner = ivec3(floor(p));
  vec3 f = p - vec3(corner);
  vec3 w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  float sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    ivec3 step = ivec3(i & 1, (i >> 1) & 1, i >> 2);
    vec3 gradient =
        vec3(noise3_hash(uvec3(corner + step) + uvec3(seed, 3u * seed, 7u * seed))) * (2.0 / 4294967295.0) - 1.0;
    vec3 side = mix(1.0 - w, w, vec3(step));
    sum += side.x * side.y * side.z * dot(gradient, f - vec3(step));
  }
  return sum;
}

// Returns a sum of octaves, each of half the size and half the amplitude. Octaves smaller than two footprints fade.
float noise3_sum(vec3 p, int octaves, float footprint, uint seed) {
  float sum = 0.0;
  float strength = 1.0;
  for (int i = 0; i < octaves; ++i) {
    float weight = clamp(1.5 - 2.0 * footprint, 0.0, 1.0);
    if (weight <= 0.0) break;
    sum += strength * weight * noise3(p, seed + uint(i));
    p = p.yzx * 2.03 + 0.37;
    footprint *= 2.03;
    strength *= 0.5;
  }
  return sum;
}

#endif
