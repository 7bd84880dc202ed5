// The light of the marched samples, from what one pass per cascade has gathered.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/epipolar.h"

layout(local_size_x = kMarchGroup) in;

#include "epipolar/march_bindings.glsl"

layout(std430, binding = 10) readonly buffer slice_block { EpipolarSlice slices[]; };
layout(std430, binding = 11) readonly buffer march_list_block { WorkList march_work; uint march_list[]; };
layout(std430, binding = 12) buffer sample_block { uvec4 samples[]; };
layout(std430, binding = 13) buffer state_block { float states[]; };

layout(push_constant) uniform Push { uint processing; };  // CascadeProcessing

#include "epipolar/march_state.glsl"
#include "epipolar/slices.glsl"

void main() {
  uint at = gl_GlobalInvocationID.x;
  if (gl_WorkGroupID.y > 0u || at >= march_work.count) return;  // the list counts groups for every cascade
  uint id = march_list[at] >> 16u;
  uint i = march_list[at] & 0xFFFFu;
  uint sample_at = id * epipolar.samples + i;
  Sample s = unpack_sample(samples[sample_at]);
  Ray ray = sample_ray(sample_position(slices[id], i), s.depth_m);
  float start, end;
  vec3 light = vec3(0.0);
  if (clip_to_air(medium, ray, start, end)) {
    March march = load_march(at);
    uint turns = processing == 2u ? epipolar.cascades - epipolar.first_cascade : 1u;
    for (uint c = 1u; c < turns; ++c) {
      march = add(march, load_march(c * epipolar.slices * epipolar.samples + at));
    }
    light = light_of(march, ray, table_ray_of(ray, start), start, end);
  }
  vec3 through, lost;
  attenuation(optical_depth_at(s.log_density, s.depth_m), through, lost);
  s.source = light / max(lost, vec3(1e-20));
  samples[sample_at] = pack_sample(s);
}
