// What the passes that build and read the scattering tables share: the shape of the tables, and the sizes
// of the grids on which the orders of scattering are solved (docs/tables.md). Compiled by GLSL (std430) and
// by C++ (src/effect/shared.hpp, src/models/glsl_double.hpp).
#ifndef TYNDALL_SHARED_TABLES
#define TYNDALL_SHARED_TABLES

// Texels along each axis, and how they are spread.
struct TableShape {
  uint altitudes;
  uint views;  // even: one half for each side of the horizon
  uint suns;
  uint angles;
  uint parameterization;  // a TableParameterization of include/tyndall/params.def
  uint orders;            // of scattering, >= 1
  uint unused_0;
  uint unused_1;
};

// The orders of scattering are solved at points of altitude x sun angle. At each, the light that arrives is
// known in kGatherZeniths x kGatherAzimuths directions (the azimuths are those of one side of the sun's plane,
// the other is its mirror image), and the light that is scattered at kSourceZeniths x kSourceAzimuths.
const uint kGatherAltitudes = 43u;
const uint kGatherBelow = 3u;                 // of these, below sea level
const float kLowestGatherAltitude = -1000.0;  // [m]
const uint kGatherSuns = 64u;
const uint kGatherZeniths = 24u;  // half of them on each side of the horizon
const uint kGatherAzimuths = 16u;
const uint kSourceZeniths = 33u;
const uint kSourceAzimuths = 17u;
const uint kModes = 16u;  // of the Fourier series in azimuth
// Of the integration along a ray, four nodes per panel: finer for light scattered once.
const uint kSinglePanels = 6u;
const uint kHighPanels = 4u;
const uint kSingleNodes = 24u;
const uint kHighNodes = 16u;

// One node of the integration along a ray that depends on altitude and view angle only.
struct RayNode {
  vec3 weight_m;  // quadrature weight times the transmittance to the origin; at the ray's end: transmittance
  float distance_m;
  float rayleigh;  // relative densities
  float mie;
  float altitude_m;
  float cos_zenith;
};

// Gauss-Legendre nodes and weights on [0; 1] for half the zenith angles, computed on the CPU.
struct ZenithQuadrature {
  float node[12];
  float weight[12];
};

#endif
