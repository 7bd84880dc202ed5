// The input and output of shaders/probe, one of each per ray. prepare_probe_ray() (src/models) computes the input in
// double precision, because single precision can be wrong about the horizon and about where a ray enters and leaves the
// atmosphere.
#ifndef TYNDALL_SHARED_PROBE
#define TYNDALL_SHARED_PROBE

struct ProbeRay {
  float altitude_m;  // of the origin, or of the entry into the atmosphere for rays from above it
  float cos_view_zenith;
  float cos_sun_zenith;
  float cos_view_sun;
  float end_m;            // distance to the ground or to the top; 0: the ray misses the atmosphere
  uint on_ground;         // 1: the ray ends on the ground
  uint integrate_single;  // 1: the tables do not resolve order 1 of this ray
  float unused_1;
};

struct ProbeResult {
  vec3 radiance;          // relative to the sun's irradiance above the atmosphere [1/sr]
  float radiance_fourth;  // fourth channel, with scattering.color = spectral
  vec3 transmittance;     // to the end of the ray
  float transmittance_fourth;
};

#endif
