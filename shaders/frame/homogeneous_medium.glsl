// A medium of constant density in place of the atmosphere (Yusov, "IVB Atmospheric Light Scattering", 2012, section 2).
// The same light reaches every point of it, so the light of a lit section [a, b] of a ray has the closed form
//   L = E (beta_R p_R + beta_M p_M) / sigma (exp(-sigma a) - exp(-sigma b))
// per channel. The factors before the bracket depend on the direction only. They are left out along the ray and applied
// once per pixel. docs/homogeneous_medium.md has the equations and their limits.
#ifndef TYNDALL_HOMOGENEOUS_MEDIUM_GLSL
#define TYNDALL_HOMOGENEOUS_MEDIUM_GLSL

#include "frame/constants.glsl"
#include "frame/view_ray.glsl"
#include "lib/phase.glsl"
#include "lib/spectrum.glsl"
#include "shared/constant_ids.h"

layout(constant_id = kHomogeneousId) const bool kHomogeneous = false;

#ifdef SPECTRAL
#define HOMOGENEOUS_EXTINCTION vec4(frame.homogeneous.extinction, frame.homogeneous_fourth_channel.x)
#define HOMOGENEOUS_RAYLEIGH_SOURCE vec4(frame.homogeneous.rayleigh_source, frame.homogeneous_fourth_channel.y)
#define HOMOGENEOUS_MIE_SOURCE vec4(frame.homogeneous.mie_source, frame.homogeneous_fourth_channel.z)
#else
#define HOMOGENEOUS_EXTINCTION frame.homogeneous.extinction
#define HOMOGENEOUS_RAYLEIGH_SOURCE frame.homogeneous.rayleigh_source
#define HOMOGENEOUS_MIE_SOURCE frame.homogeneous.mie_source
#endif

// Clips [0, end] to the part below the medium's top, which is a horizontal plane.
void clip_to_top(float cos_zenith, out float start, inout float end) {
  float crossing =
      (frame.homogeneous.height_m - frame.camera_altitude_m) / (abs(cos_zenith) > 1e-9 ? cos_zenith : 1e-9);
  start = cos_zenith < 0.0 ? max(crossing, 0.0) : 0.0;
  end = max(cos_zenith < 0.0 ? end : min(end, crossing), start);
}

// Computes the part of the ray inside the medium [m]; returns false if there is none. A ray ends at the scene's
// surface, at the planet, or at the medium's extent.
bool clip_to_homogeneous(Ray ray, out float start, out float end) {
  end = ray.length_m;
  if (ray.sky) {
    float h = frame.camera_altitude_m;
    float radius = medium.planet_radius_m;
    end = hits_planet(frame, h, ray.cos_zenith, radius) ? distance_to_sphere(h, ray.cos_zenith, frame.ground_m, radius)
                                                        : frame.homogeneous.extent_m;
  }
  clip_to_top(ray.cos_zenith, start, end);
  return end > start;
}

bool clip_to_medium(Ray ray, out float start, out float end) {
  if (kHomogeneous) return clip_to_homogeneous(ray, start, end);
  return clip_to_atmosphere(frame, medium, ray, start, end);
}

// Computes exp(-sigma d), and 1 - exp(-sigma d) without cancellation.
void homogeneous_attenuation(float length_m, out Spectrum transmittance, out Spectrum opacity) {
  Spectrum tau = HOMOGENEOUS_EXTINCTION * length_m;
  transmittance = exp(-tau);
  opacity = mix(1.0 - transmittance, tau - 0.5 * tau * tau, lessThan(tau, Spectrum(2e-3)));
}

// Returns the factor that depends on the direction only [1/sr]: (beta_R p_R + beta_M p_M) / sigma.
Spectrum homogeneous_phase(float cos_view_sun) {
  float second = cos_view_sun * cos_view_sun;
  if (PHASE_TABULATED(medium)) {
    return HOMOGENEOUS_RAYLEIGH_SOURCE * (1.0 + second) +
           HOMOGENEOUS_MIE_SOURCE * CHANNELS(tabulated_phase(medium, cos_view_sun));
  }
  float root = inversesqrt(frame.homogeneous.phase_min +
                           frame.homogeneous.phase_slope * (1.0 - frame.homogeneous.phase_sign * cos_view_sun));
  return HOMOGENEOUS_RAYLEIGH_SOURCE * (1.0 + second) +
         HOMOGENEOUS_MIE_SOURCE * ((1.0 + frame.homogeneous.phase_second * second) * (root * root * root));
}

#endif
