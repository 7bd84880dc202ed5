// Computes the quadrature nodes along each ray of one altitude of the tables, or of the whole gathering grid, and the
// other fields of QuadratureRay. One invocation per altitude and view angle.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/table_mapping.glsl"
#include "precompute/ray_nodes.glsl"
#include "precompute/gather_grid.glsl"
#include "lib/table_values.glsl"
#include "shared/constant_ids.h"
#include "precompute/ray_spectra.glsl"

layout(local_size_x = 8, local_size_y = 1) in;
layout(constant_id = kRaysOfTablesId) const
    int kOfTables = 0;  // 1: the rays of the tables, 0: those of the gathering grid

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer shape_block {
  TableShape shape;
  ZenithQuadrature quadrature;
};
layout(std430, binding = 2) writeonly buffer ray_block { QuadratureRay rays[]; };

layout(push_constant) uniform Push { uint first; }
push;

// A ray from altitude h with the cosine mu of the zenith angle, and its length.
struct Line {
  float h;
  float mu;
  float end;
};

const uint kSingle = 0u;  // components of the effort
const uint kHigh = 1u;

// `depth` is the optical depth of the ray.
uint panels_for(float total, float depth, uint kind) {
  uint most = kind == kSingle ? kSinglePanels : kHighPanels;
  return uint(clamp(ceil((total + kEffortOfDepth * depth) / kPanelEffort[kind]), 1.0, float(most)));
}

float node_altitude(Line line, float d) {
  float R = medium.planet_radius_m;
  // A ray that begins above sea level does not go below it. A lower altitude is a rounding error.
  return clamp(altitude_along(line.h, line.mu, d, R), ground_below(line.h, R), medium.atmosphere_height_m);
}

Spectrum transmittance_along(Line line, float d) {
  return transmittance(medium, density_integral_along(medium, line.h, line.mu, d));
}

void write_node(uint ray, uint i, uint kind, Line line, float d, float weight_m) {
  float h = node_altitude(line, d);
  vec2 density = densities(medium, h).xy;
  Spectrum weight = weight_m * transmittance_along(line, d);
  if (kind == kSingle) {
    rays[ray].single_nodes[i] = SINGLE_NODE(weight, d, density, h);
    return;
  }
  float mu = cos_zenith_along(line.h, line.mu, d, medium.planet_radius_m);
  Spectrum scattering = RAYLEIGH_SCATTERING(medium) * density.x + MIE_SCATTERING(medium) * density.y;
  rays[ray].high_nodes[i] =
      RayNode(vec4((weight * scattering).rgb, d),
              vec4(gather_altitude_index(medium, h), source_zenith_index(acos(mu)), mu, medium.planet_radius_m + h));
  SET_HIGH_PATH(rays[ray], i, weight * scattering)
}

// Divides the ray into panels of equal effort, and writes the nodes of each. Returns their number.
uint write_nodes(uint ray, Line line, float total, float depth, uint kind) {
  uint panels = panels_for(total, depth, kind);
  float bounds[kSinglePanels + 1u];
  bounds[0] = 0.0;
  uint found = 1u;
  float sum = 0.0;
  float tau = 0.0;
  float before = 0.0;
  for (int i = 0; i < kWalkSteps; ++i) {
    float after = walk_distance(line.end, float(i + 1) / float(kWalkSteps));
    float middle = 0.5 * (before + after);
    float here = (after - before) * effort(medium, line.h, line.mu, middle, after - before, tau)[kind];
    while (found < panels && sum + here >= total * float(found) / float(panels)) {
      float part = here > 0.0 ? (total * float(found) / float(panels) - sum) / here : 0.0;
      bounds[found] = before + clamp(part, 0.0, 1.0) * (after - before);
      ++found;
    }
    sum += here;
    before = after;
  }
  for (uint i = found; i <= panels; ++i) bounds[i] = line.end;
  vec4 node = vec4(0.069431844202974, 0.330009478207572, 0.669990521792428, 0.930568155797026);
  vec4 weight = vec4(0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727);
  for (uint i = 0u; i < 4u * panels; ++i) {
    float a = bounds[i / 4u];
    float span = bounds[i / 4u + 1u] - a;
    write_node(ray, i, kind, line, a + node[i % 4u] * span, weight[i % 4u] * span);
  }
  return 4u * panels;
}

// Writes the reciprocals of the normalisation factors, and the point of the ray at its density-weighted mean distance:
// the distance itself, and the distance of the point from the planet's centre. The tables use the sun's zenith angle at
// this point.
void write_factors(uint ray, Line line) {
  vec3 integral = density_integral_along(medium, line.h, line.mu, line.end);
  float mean_m = density_weighted_mean_distance(medium, line.h, line.mu, line.end, integral);
  float R = medium.planet_radius_m;
  NormalisationFactors factors = normalisation_factors(medium, integral);
  rays[ray].rayleigh = vec4((1.0 / factors.rayleigh).rgb, mean_m);
  rays[ray].mie = vec4((1.0 / factors.mie).rgb, R + altitude_along(line.h, line.mu, mean_m, R));
  rays[ray].high = vec4((1.0 / max(factors.high, Spectrum(1.0e-30))).rgb, 0.0);
  SET_FACTORS(rays[ray], factors)
}

void main() {
  uint view = gl_GlobalInvocationID.x;
  uint altitude = gl_GlobalInvocationID.y + push.first;
  uint views = kOfTables == 1 ? shape.views : kGatherZeniths;
  if (view >= views || altitude >= (kOfTables == 1 ? shape.altitudes : kGatherAltitudes)) return;
  Line line;
  bool below;
  if (kOfTables == 1) {
    line.h = altitude_from_u(shape, medium, (float(altitude) + 0.5) / float(shape.altitudes));
    line.mu = view_from_v(shape, medium, line.h, (float(view) + 0.5) / float(shape.views), below);
  } else {
    line.h = gather_altitude(medium, altitude);
    below = view < 12u;
    line.mu = gather_zenith(horizon_cos(line.h, medium.planet_radius_m), quadrature.node[view % 12u], below);
  }
  uint ray = kOfTables == 1 ? view : altitude * views + view;
  float R = medium.planet_radius_m;
  line.end = distance_to_top(line.h, line.mu, medium.atmosphere_height_m, R);
  if (below) {
    line.end =
        kOfTables == 1 ? distance_to_ground(line.h, line.mu, R) : gather_ground_distance(medium, line.h, line.mu);
  }
  vec2 total = vec2(0.0);
  float tau = 0.0;
  float before = 0.0;
  for (int i = 0; i < kWalkSteps; ++i) {
    float after = walk_distance(line.end, float(i + 1) / float(kWalkSteps));
    total += (after - before) * effort(medium, line.h, line.mu, 0.5 * (before + after), after - before, tau);
    before = after;
  }
  Spectrum depths = optical_depth(medium, density_integral_along(medium, line.h, line.mu, line.end));
  float depth = LARGEST(depths);
  float single = float(write_nodes(ray, line, total[kSingle], depth, kSingle));
  float high = float(write_nodes(ray, line, total[kHigh], depth, kHigh));
  rays[ray].start = vec4(line.h, line.mu, single, high);
  Spectrum transmitted = transmittance_along(line, line.end);
  rays[ray].end = vec4(transmitted.rgb, line.end);
  SET_END(rays[ray], transmitted)
  write_factors(ray, line);
}
