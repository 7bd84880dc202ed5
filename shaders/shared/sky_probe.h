// The constants of shaders/sky_probe. Compiled as GLSL (std430) and as C++ (src/effect/shared.hpp).
#ifndef TYNDALL_SHARED_SKY_PROBE
#define TYNDALL_SHARED_SKY_PROBE

// The quadrature over the sphere: rows of nodes at one zenith angle, on one side of the sun's plane.
const uint kSkyProbeNodes = 12u;     // zenith angles in each of four intervals
const uint kSkyProbeRows = 48u;      // 4 kSkyProbeNodes
const uint kSkyProbeAzimuths = 32u;  // a multiple of 4
const uint kSkyProbeSums = 11u;      // vec4 per row: 9 coefficients, and the irradiance from above and from below

// The coarsest level of the cube map's radiance that is stored, and the level that is filtered for roughness 1
// [texels].
const uint kSkyCubeCoarse = 16u;
const uint kSkyCubeRoughest = 8u;

struct SkyProbeConstants {
  vec3 up;  // directions in the axes of the caller
  float altitude_m;
  vec3 ahead;  // horizontal, towards the sun
  float cos_sun_zenith;
  vec3 side;  // horizontal, perpendicular to it
  float sin_sun_zenith;
  vec3 irradiance;        // of the sun above the atmosphere
  uint integrate_single;  // 1: the tables lack single scattering
  TableShape shape;
  uint cube_size;  // of a face [texels]
  uint unused_0;
  uint unused_1;
  uint unused_2;
};

#endif
