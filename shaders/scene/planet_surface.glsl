// The surface of a planet seen from space, from noise alone: seas, land by climate, and polar ice. Albedos are diffuse,
// at 680, 550 and 440 nm.
#ifndef TYNDALL_PLANET_SURFACE_GLSL
#define TYNDALL_PLANET_SURFACE_GLSL

#include "scene/noise3.glsl"

// The albedo of ground between the terrain's edge and the horizon.
const vec3 kUnseenAlbedo = vec3(0.09, 0.09, 0.06);

const vec3 kSeaAlbedo = vec3(0.018, 0.034, 0.062);
const vec3 kShelfAlbedo = vec3(0.030, 0.075, 0.085);
const vec3 kWoodAlbedo = vec3(0.035, 0.065, 0.028);
const vec3 kPlainsAlbedo = vec3(0.110, 0.115, 0.058);
const vec3 kDesertAlbedo = vec3(0.330, 0.260, 0.165);
const vec3 kBarrenAlbedo = vec3(0.190, 0.170, 0.150);
const vec3 kIceAlbedo = vec3(0.72, 0.77, 0.80);

// Returns the albedo. n is the unit vector from the planet's centre, footprint the width of a pixel there [rad].
vec3 planet_albedo(vec3 n, vec3 north, float footprint, uint seed) {
  vec3 warp = vec3(noise3(n * 2.1, seed + 40u), noise3(n * 2.1 + 7.3, seed + 41u), noise3(n * 2.1 - 5.1, seed + 42u));
  float height = noise3_sum((n + 0.25 * warp) * 1.6, 12, 1.6 * footprint, seed) - 0.03;
  float wet = noise3_sum((n + 0.2 * warp) * 3.1, 6, 3.1 * footprint, seed + 20u);
  float latitude = abs(dot(n, north));
  float edge = 0.004 + 1.6 * footprint;

  vec3 sea = mix(kSeaAlbedo, kShelfAlbedo, smoothstep(-0.09, 0.0, height));
  // Deserts lie along the thirtieth parallels, forests at the equator and beyond the forty-fifth.
  float belt = exp(-pow((latitude - 0.45) / 0.16, 2.0));
  float dry = clamp(0.35 + 0.75 * belt - 1.1 * wet, 0.0, 1.0);
  vec3 land = mix(kWoodAlbedo, kPlainsAlbedo, smoothstep(0.15, 0.5, dry));
  land = mix(land, kDesertAlbedo, smoothstep(0.55, 0.9, dry));
  land = mix(land, kBarrenAlbedo, smoothstep(0.25, 0.45, height));
  vec3 albedo = mix(sea, land, smoothstep(-edge, edge, height));
  float cold = latitude + 0.35 * max(height, 0.0) + 0.12 * wet;
  return mix(albedo, kIceAlbedo, smoothstep(0.88 - 0.5 * edge, 0.91 + 0.5 * edge, cold));
}

#endif
