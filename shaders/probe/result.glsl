// Stores radiance and transmittance in a ProbeResult, in both modes of scattering.color.
#ifndef TYNDALL_PROBE_RESULT_GLSL
#define TYNDALL_PROBE_RESULT_GLSL

#include "shared/probe.h"

#ifdef SPECTRAL
#define PROBE_RESULT(radiance, transmittance) probe_result(radiance, transmittance)
ProbeResult probe_result(vec4 light, vec4 through) { return ProbeResult(light.rgb, light.a, through.rgb, through.a); }
#else
#define PROBE_RESULT(radiance, transmittance) ProbeResult(radiance, 0.0, transmittance, 0.0)
#endif

#endif
