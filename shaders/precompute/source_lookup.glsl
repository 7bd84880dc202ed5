// Look-ups in the source function between the nodes of its grid.
#ifndef TYNDALL_SOURCE_LOOKUP_GLSL
#define TYNDALL_SOURCE_LOOKUP_GLSL

#include "lib/table_values.glsl"
#include "precompute/gather_grid.glsl"

// Returns the light scattered per scattering coefficient [1/sr] at coordinates in the grid of the source function.
// `source_function` holds its fourth root, and is filtered linearly.
Spectrum source_at(sampler3D source_function, float altitude, float zenith, float azimuth, float sun) {
  const float kRows = float(kSourceAzimuths * kGatherAltitudes);
  float first = min(floor(altitude), float(kGatherAltitudes) - 2.0);
  float row = (first * float(kSourceAzimuths) + azimuth + 0.5) / kRows;
  vec3 at = vec3((sun + 0.5) / float(kGatherSuns), row, (zenith + 0.5) / float(kSourceZeniths));
  Spectrum low = CHANNELS(textureLod(source_function, at, 0.0));
  at.y += float(kSourceAzimuths) / kRows;
  Spectrum high = CHANNELS(textureLod(source_function, at, 0.0));
  return value_from_texel(mix(low, high, altitude - first));
}

// Returns the cosine of the azimuth between view and sun from the cosines of their zenith angles and of the angle
// between them. The result is beyond [-1; 1] if no geometry has these angles.
float cos_azimuth(float mu, float mu_s, float nu) {
  return (nu - mu * mu_s) * inversesqrt(max((1.0 - mu * mu) * (1.0 - mu_s * mu_s), 1.0e-12));
}

#endif
