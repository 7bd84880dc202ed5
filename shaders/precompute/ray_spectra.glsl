// Access to the spectra of a QuadratureRay, whose fourth channels are stored apart. Where the callers have already
// loaded the other three channels, they pass these as an argument.
#ifndef TYNDALL_RAY_SPECTRA_GLSL
#define TYNDALL_RAY_SPECTRA_GLSL

#include "shared/tables.h"

#ifdef SPECTRAL
#define SINGLE_NODE(weight, d, density, h) RayNode(vec4((weight).rgb, d), vec4(density, h, (weight).a))
#define SINGLE_PATH(node) vec4(node.path.rgb, node.place.w)
#define HIGH_PATH(ray, node, i) vec4(node.path.rgb, ray.high_fourth_channel[(i) >> 2u][(i)&3u])
#define RAY_END(ray, end) vec4((end).rgb, ray.fourth_channel.x)
#define RAY_RAYLEIGH(ray, rayleigh) vec4((rayleigh).rgb, ray.fourth_channel.y)
#define RAY_MIE(ray, mie) vec4((mie).rgb, ray.fourth_channel.z)
#define RAY_HIGH(ray) vec4(ray.high.rgb, ray.fourth_channel.w)
#define SET_HIGH_PATH(ray, i, path) ray.high_fourth_channel[(i) >> 2u][(i)&3u] = (path).a;
#define SET_END(ray, transmittance) ray.fourth_channel.x = (transmittance).a;
#define SET_FACTORS(ray, factors) \
  ray.fourth_channel.yzw = 1.0 / vec3((factors).rayleigh.a, (factors).mie.a, max((factors).high.a, 1.0e-30));
#else
#define SINGLE_NODE(weight, d, density, h) RayNode(vec4(weight, d), vec4(density, h, 0.0))
#define SINGLE_PATH(node) node.path.rgb
#define HIGH_PATH(ray, node, i) node.path.rgb
#define RAY_END(ray, end) (end).rgb
#define RAY_RAYLEIGH(ray, rayleigh) (rayleigh).rgb
#define RAY_MIE(ray, mie) (mie).rgb
#define RAY_HIGH(ray) ray.high.rgb
#define SET_HIGH_PATH(ray, i, path)
#define SET_END(ray, transmittance)
#define SET_FACTORS(ray, factors)
#endif

#endif
