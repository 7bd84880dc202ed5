// The structures shared by the passes that build and read the scattering tables: the shape of the tables, and the sizes
// of the grids on which the orders of scattering are solved (docs/tables.md). Compiled as GLSL (std430) and as C++
// (src/effect/shared.hpp, src/models/glsl_double.hpp).
#ifndef TYNDALL_SHARED_TABLES
#define TYNDALL_SHARED_TABLES

// Values of TableShape::parameterization, as TableParameterization of include/tyndall/params.def.
const uint kYusovMapping = 0u;
const uint kBrunetonMapping = 1u;
const uint kLinearMapping = 2u;

// The number of texels along each axis, and their parameterisation.
struct TableShape {
  uint altitudes;
  uint views;  // even: one half for each side of the horizon
  uint suns;
  uint angles;
  uint parameterization;
  uint orders;  // of scattering, >= 1
  uint unused_0;
  uint unused_1;
};

// The orders of scattering are solved at points of the gathering grid (altitude x sun angle). At each point, the
// incident light is known in kGatherZeniths x kGatherAzimuths directions, and the scattered light in kSourceZeniths x
// kSourceAzimuths. The azimuths cover one side of the sun's plane; the other side is the mirror image.
const uint kGatherAltitudes = 43u;
const uint kGatherBelow = 3u;                 // the number of gathering altitudes below sea level
const float kLowestGatherAltitude = -1000.0;  // [m]
const uint kGatherSuns = 64u;
const uint kGatherZeniths = 24u;  // half of them on each side of the horizon
const uint kGatherAzimuths = 16u;
const uint kSourceZeniths = 33u;
const uint kSourceAzimuths = 21u;
// Entries of two floats per coefficient of the phase functions, if the aerosol's is tabulated, and then depends on the
// channel: Rayleigh and the first channel, the second and the third, the fourth. Otherwise there is one.
const uint kPhaseTerms = 3u;
const uint kModes = 16u;  // of the Fourier series in azimuth
// The late orders are those after `orders` of TableShape.
const uint kLateOrders = 6u;    // number of late orders that are solved; the rest is estimated
const uint kLateModes = 2u;     // terms of their Fourier series that follow the height of the sun along a ray
const uint kLateTerms = 5u;     // terms of the Fourier series from which the late orders start
const uint kLateAzimuths = 2u;  // azimuths in which these terms are integrated
// Each invocation of the passes over rays processes this many azimuths, or angles between view and sun. They share the
// loads of the nodes.
const uint kAnglesPerInvocation = 4u;
// The largest numbers of panels of four nodes in the integration along a ray. Single scattering needs more of them.
const uint kSinglePanels = 6u;
const uint kHighPanels = 4u;
const uint kSingleNodes = 24u;
const uint kHighNodes = 16u;

// One node of the integration along a ray.
struct RayNode {
  // rgb: quadrature weight times the transmittance to the origin [m], for the higher orders also times the scattering
  // coefficient [1]. a: distance from the origin [m].
  vec4 path;
  // Single scattering: the relative densities of Rayleigh scattering and aerosol, the altitude [m], with SPECTRAL the
  // fourth channel of `path`.
  // Higher orders: the coordinates of altitude and view zenith angle in the grid of the source function, the cosine of
  // the view zenith angle, the distance to the planet's centre [m].
  vec4 place;
};

// A ray with its nodes. They depend on altitude and view angle only, and serve every position of the sun.
struct QuadratureRay {
  vec4 start;     // altitude [m], cosine of the zenith angle, numbers of nodes for single scattering and higher orders
  vec4 end;       // rgb: transmittance to the end of the ray, a: length of the ray [m]
  vec4 rayleigh;  // rgb: reciprocal of the normalisation factor, a: density-weighted mean distance [m]
  vec4 mie;       // rgb: the same of the aerosol, a: distance of that point to the planet's centre [m]
  vec4 high;      // rgb: the same of the higher orders
  RayNode single_nodes[kSingleNodes];
  RayNode high_nodes[kHighNodes];
#ifdef SPECTRAL
  // The fourth channels of `end`, `rayleigh`, `mie` and `high`, and of the paths of the higher orders. (Those of single
  // scattering are in RayNode::place.)
  vec4 fourth_channel;
  vec4 high_fourth_channel[kHighNodes / 4u];
#endif
};
// The number of bytes by which SPECTRAL enlarges a QuadratureRay.
const uint kSpectralRayBytes = 16u + 4u * kHighNodes;

// Gauss-Legendre nodes and weights on [0; 1] for half of the zenith angles. Computed on the CPU.
struct ZenithQuadrature {
  float node[12];
  float weight[12];
};

#endif
