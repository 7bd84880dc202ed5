// The grids on which the orders of scattering are solved. Altitudes above sea level are spaced as in the tables, those
// below it evenly. Sun angles are densest near the horizon. The azimuths of the source function are counted from the
// plane that contains the sun, and are densest at the sun.
#ifndef TYNDALL_GATHER_GRID_GLSL
#define TYNDALL_GATHER_GRID_GLSL

#include "lib/table_mapping.glsl"
#include "shared/medium.h"
#include "shared/tables.h"

const float kPi = 3.14159265358979;
const float kSunKnee = 0.2;  // cosine of the sun's zenith angle at which the spacing is four times that at the horizon

// Return the lowest altitude of the grid [m], the altitude of index i, and the index of an altitude.
float lowest_gather_altitude(Medium m) { return max(kLowestGatherAltitude, -0.25 * m.planet_radius_m); }

float gather_altitude(Medium m, uint i) {
  if (i < kGatherBelow) return lowest_gather_altitude(m) * (1.0 - float(i) / float(kGatherBelow));
  float x = float(i - kGatherBelow) / float(kGatherAltitudes - 1u - kGatherBelow);
  return altitude_share(x) * m.atmosphere_height_m;
}
float gather_altitude_index(Medium m, float h) {
  float below = float(kGatherBelow);
  if (h < 0.0) return max(below * (1.0 - h / lowest_gather_altitude(m)), 0.0);
  return below + altitude_coordinate(min(h / m.atmosphere_height_m, 1.0)) * (float(kGatherAltitudes - 1u) - below);
}

// Returns the altitude of the ground for the points of the grid. Below sea level it is the altitude of the point
// itself, so that the solution at one altitude does not depend on deeper ones (docs/adr/0007-below-sea-level.md).
float gather_ground(float h) { return min(h, 0.0); }
float gather_ground_distance(Medium m, float h, float mu) {
  return h > 0.0 ? distance_to_ground(h, mu, m.planet_radius_m) : 0.0;
}
// Returns the first of the points (altitude x sun) whose irradiance lights the ground below a point.
uint gather_ground_row(uint altitude) { return min(altitude, kGatherBelow) * kGatherSuns; }

// Returns the index of the irradiance of one order at a point (altitude x sun). The last three orders are stored.
uint irradiance_row(uint order, uint point) { return order % 3u * (kGatherAltitudes * kGatherSuns) + point; }

// Returns the cosine of the lowest sun of the grid, which is below the horizon of the top of the atmosphere.
float lowest_gather_sun(Medium m) { return max(1.6 * horizon_cos(m.atmosphere_height_m, m.planet_radius_m), -1.0); }
// The mapping between suns and indices: the coordinate of the lowest sun, and the coordinate per index. Compute it
// once, before a loop; some compilers do not hoist it.
struct SunAxis {
  float from;
  float step_of_index;
};
SunAxis sun_axis(Medium m) {
  float low = lowest_gather_sun(m);
  float from = low / (kSunKnee - low);
  return SunAxis(from, (1.0 / (kSunKnee + 1.0) - from) / float(kGatherSuns - 1u));
}
float gather_sun(Medium m, uint i) {
  SunAxis axis = sun_axis(m);
  float s = axis.from + axis.step_of_index * float(i);
  return clamp(kSunKnee * s / (1.0 - abs(s)), -1.0, 1.0);
}
float gather_sun_index(SunAxis axis, float mu_s) {
  float s = mu_s / (kSunKnee + abs(mu_s));
  return clamp((s - axis.from) / axis.step_of_index, 0.0, float(kGatherSuns - 1u));
}

// The zenith angles of incident light, from quadrature nodes in [0; 1] on either side of the horizon. The angle from
// the horizon is the power 3/2 of the node: several nodes cover the aureole of a sun at any height, and more of them
// the light near the horizon, which changes fastest in turbid air. gather_zenith() returns the cosine,
// gather_zenith_stretch() the factor of the quadrature weight.
float gather_angle_span(float horizon, bool below) { return below ? kPi - acos(horizon) : acos(horizon); }
float gather_zenith(float horizon, float node, bool below) {
  float offset = node * sqrt(node) * gather_angle_span(horizon, below);
  return cos(below ? acos(horizon) + offset : acos(horizon) - offset);
}
float gather_zenith_stretch(float horizon, float node, bool below) {
  float mu = gather_zenith(horizon, node, below);
  return 1.5 * sqrt(node) * gather_angle_span(horizon, below) * sqrt(max((1.0 - mu) * (1.0 + mu), 0.0));
}
float gather_azimuth(uint k) { return (float(k) + 0.5) * kPi / float(kGatherAzimuths); }

// Zenith angles of the source function. They are symmetric to the horizontal and densest there, because in turbid air
// the light is brightest near the horizon and is scattered along it. The angle from the horizontal is a quadratic
// function of the index.
const float kSourceDensity = 0.35;  // spacing at the horizontal over the mean spacing
float source_zenith(uint j) {
  float x = 2.0 * float(j) / float(kSourceZeniths - 1u) - 1.0;
  return 0.5 * kPi * (1.0 + x * (kSourceDensity + (1.0 - kSourceDensity) * abs(x)));
}
float source_zenith_index(float angle) {
  float y = angle / (0.5 * kPi) - 1.0;
  float x = sign(y) * (sqrt(kSourceDensity * kSourceDensity + 4.0 * (1.0 - kSourceDensity) * abs(y)) - kSourceDensity) /
            (2.0 * (1.0 - kSourceDensity));
  return clamp(0.5 * (x + 1.0), 0.0, 1.0) * float(kSourceZeniths - 1u);
}

// Azimuths of the source function. They are denser towards the sun, because a linear function between azimuths 11
// degrees apart is up to 2 % off in the aureole.
const float kAzimuthDensity = 0.65;  // spacing at the sun over the mean spacing
float source_azimuth(uint k) { return kPi * spread_from_unit(float(k) / float(kSourceAzimuths - 1u), kAzimuthDensity); }
float source_azimuth_index(float azimuth) {
  return unit_from_spread(azimuth / kPi, kAzimuthDensity) * float(kSourceAzimuths - 1u);
}

// Indices of incident light and of the source function. The sun varies fastest, because neighbouring invocations
// process neighbouring suns.
uint gather_index(uint altitude, uint zenith, uint azimuth, uint sun) {
  return ((altitude * kGatherZeniths + zenith) * kGatherAzimuths + azimuth) * kGatherSuns + sun;
}
uint source_index(uint altitude, uint zenith, uint azimuth, uint sun) {
  return ((altitude * kSourceZeniths + zenith) * kSourceAzimuths + azimuth) * kGatherSuns + sun;
}
// Returns the texel of the source function in its image.
ivec3 source_texel(uint altitude, uint zenith, uint azimuth, uint sun) {
  return ivec3(int(sun), int(altitude * kSourceAzimuths + azimuth), int(zenith));
}

#endif
