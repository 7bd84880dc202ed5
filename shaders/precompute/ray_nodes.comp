// Computes the quadrature nodes along each ray of one altitude of the tables, or of the whole gathering grid. Writes
// kNodeStride nodes per ray. One invocation per altitude and view angle.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "lib/table_mapping.glsl"
#include "precompute/ray_nodes.glsl"
#include "precompute/gather_grid.glsl"
#include "shared/constant_ids.h"

layout(local_size_x = 8, local_size_y = 1) in;
layout(constant_id = kRaysOfTablesId) const
    int kOfTables = 0;  // 1: the rays of the tables, 0: those of the gathering grid

layout(std430, binding = 0) readonly buffer medium_block { Medium medium; };
layout(std430, binding = 1) readonly buffer shape_block {
  TableShape shape;
  ZenithQuadrature quadrature;
};
layout(std430, binding = 2) writeonly buffer node_block { RayNode nodes[]; };

layout(push_constant) uniform Push { uint first; }
push;

// Divides the ray into panels of equal effort, and writes the nodes of each. `kind` selects a component of the effort.
void lay_nodes(float h, float mu, float end, vec2 totals, int kind, uint panels, uint base) {
  float total = totals[kind];
  float bounds[kSinglePanels + 1u];
  bounds[0] = 0.0;
  uint found = 1u;
  float sum = 0.0;
  float tau = 0.0;
  float before = 0.0;
  for (int i = 0; i < kWalkSteps; ++i) {
    float after = walk_distance(end, float(i + 1) / float(kWalkSteps));
    float here = (after - before) * effort(medium, h, mu, 0.5 * (before + after), after - before, tau)[kind];
    while (found < panels && sum + here >= total * float(found) / float(panels)) {
      float part = here > 0.0 ? (total * float(found) / float(panels) - sum) / here : 0.0;
      bounds[found] = before + clamp(part, 0.0, 1.0) * (after - before);
      ++found;
    }
    sum += here;
    before = after;
  }
  for (uint i = found; i <= panels; ++i) bounds[i] = end;
  vec4 node = vec4(0.069431844202974, 0.330009478207572, 0.669990521792428, 0.930568155797026);
  vec4 weight = vec4(0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727);
  for (uint i = 0u; i < 4u * panels; ++i) {
    float a = bounds[i / 4u];
    float span = bounds[i / 4u + 1u] - a;
    nodes[base + i] = ray_node(medium, h, mu, a + node[i % 4u] * span, weight[i % 4u] * span);
  }
}

void main() {
  uint view = gl_GlobalInvocationID.x;
  uint altitude = gl_GlobalInvocationID.y + push.first;
  uint views = kOfTables == 1 ? shape.views : kGatherZeniths;
  if (view >= views || altitude >= (kOfTables == 1 ? shape.altitudes : kGatherAltitudes)) return;
  float h;
  float mu;
  bool below;
  if (kOfTables == 1) {
    h = altitude_from_u(shape, medium, (float(altitude) + 0.5) / float(shape.altitudes));
    mu = view_from_v(shape, medium, h, (float(view) + 0.5) / float(shape.views), below);
  } else {
    h = gather_altitude(medium, altitude);
    float half_node = quadrature.node[view % 12u];
    below = view < 12u;
    mu = gather_zenith(horizon_cos(h, medium.planet_radius_m), half_node, below);
  }
  uint base = (kOfTables == 1 ? view : altitude * views + view) * kNodeStride;
  float R = medium.planet_radius_m;
  float end = distance_to_top(h, mu, medium.atmosphere_height_m, R);
  if (below) end = kOfTables == 1 ? distance_to_ground(h, mu, R) : gather_ground_distance(medium, h, mu);

  vec2 total = vec2(0.0);
  float tau = 0.0;
  float before = 0.0;
  for (int i = 0; i < kWalkSteps; ++i) {
    float after = walk_distance(end, float(i + 1) / float(kWalkSteps));
    total += (after - before) * effort(medium, h, mu, 0.5 * (before + after), after - before, tau);
    before = after;
  }
  lay_nodes(h, mu, end, total, 0, kSinglePanels, base);
  lay_nodes(h, mu, end, total, 1, kHighPanels, base + kFirstHighNode);
  nodes[base + kEndNode] = ray_node(medium, h, mu, end, 1.0);
}
