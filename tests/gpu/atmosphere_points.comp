// Evaluates the functions of tyndall/atmosphere.glsl, as an engine's shader does. Declares names that its internal
// functions have without their prefix.
#version 450

layout(local_size_x = 64) in;

struct Query {
  vec4 from;   // position; a: function
  vec4 other;  // position, direction or normal; a: steps
  vec4 plane;  // positions with dot(position, plane.xyz) < plane.a are lit
};
struct Medium {
  vec3 radiance;
};
layout(std430, binding = 0) readonly buffer query_block { Query queries[]; };
layout(std430, binding = 1) writeonly buffer answer_block { vec4 answers[]; };

vec4 transmittance;
float densities(vec3 p) { return dot(p, transmittance.xyz) < transmittance.w ? 1.0 : 0.0; }

#define IN in
#define TYNDALL_FIRST_BINDING 3
#define TYNDALL_SHADOW(p) densities(p)
#include "tyndall/atmosphere.glsl"

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= uint(queries.length())) return;
  Query query = queries[index];
  transmittance = query.plane;
  int kind = int(query.from.w);
  TyndallPath path = tyndall_between(query.from.xyz, query.from.xyz);
  path.inscattering = vec3(0.0);
  if (kind == 0) path.inscattering = tyndall_sun_irradiance(query.from.xyz);
  if (kind == 1) path.inscattering = tyndall_sky_irradiance(query.from.xyz, query.other.xyz);
  if (kind == 2) path.inscattering = tyndall_sky_radiance(query.from.xyz, query.other.xyz);
  if (kind == 3) path = tyndall_to_sky(query.from.xyz, query.other.xyz);
  if (kind == 4) path = tyndall_between(query.from.xyz, query.other.xyz);
  if (kind == 5) path = tyndall_between_shadowed(query.from.xyz, query.other.xyz, int(query.other.w));
  if (kind == 6) {
    TyndallFroxel volume = tyndall_froxel(query.from.xy, query.from.z);
    path = TyndallPath(tyndall_apply(volume, vec3(0.0)), volume.transmittance);
  }
  if (kind == 7) path.inscattering = tyndall_apply(tyndall_froxel(query.from.xy, query.from.z), query.other.xyz);
  answers[2u * index] = vec4(path.inscattering, 0.0);
  answers[2u * index + 1u] = vec4(path.transmittance.rgb, 0.0);
}
