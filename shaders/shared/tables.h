// The structures shared by the passes that build and read the scattering tables: the shape of the tables, and the sizes
// of the grids on which the orders of scattering are solved (docs/tables.md). Compiled as GLSL (std430) and as C++
// (src/effect/shared.hpp, src/models/glsl_double.hpp).
#ifndef TYNDALL_SHARED_TABLES
#define TYNDALL_SHARED_TABLES

// The number of texels along each axis, and their parameterisation.
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

// The orders of scattering are solved at points of the gathering grid (altitude x sun angle). At each point, the
// incident light is known in kGatherZeniths x kGatherAzimuths directions, and the scattered light in kSourceZeniths x
// kSourceAzimuths. The azimuths cover one side of the sun's plane; the other side is the mirror image.
const uint kGatherAltitudes = 43u;
const uint kGatherBelow = 3u;                 // the number of these below sea level
const float kLowestGatherAltitude = -1000.0;  // [m]
const uint kGatherSuns = 64u;
const uint kGatherZeniths = 24u;  // half of them on each side of the horizon
const uint kGatherAzimuths = 16u;
const uint kSourceZeniths = 33u;
const uint kSourceAzimuths = 21u;
const uint kModes = 16u;  // of the Fourier series in azimuth
// The late orders are those after `orders` of TableShape.
const uint kLateOrders = 6u;    // the number of them that are solved; the rest is estimated
const uint kLateModes = 2u;     // terms of their Fourier series that follow the height of the sun along a ray
const uint kLateAzimuths = 2u;  // azimuths in which these terms are integrated
// Panels of four nodes for the integration along a ray. Single scattering needs more of them.
const uint kSinglePanels = 6u;
const uint kHighPanels = 4u;
const uint kSingleNodes = 24u;
const uint kHighNodes = 16u;

// One node of the integration along a ray. It depends on altitude and view angle only.
struct RayNode {
  vec3 weight_m;  // quadrature weight times the transmittance to the origin; at the ray's end: the transmittance
  float distance_m;
  float rayleigh;  // relative densities
  float mie;
  float altitude_m;
  float cos_zenith;
};

// Gauss-Legendre nodes and weights on [0; 1] for half of the zenith angles. Computed on the CPU.
struct ZenithQuadrature {
  float node[12];
  float weight[12];
};

#endif
