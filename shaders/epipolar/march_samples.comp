// Marches the chosen samples: through all cascades, or through one and leaving what was gathered to
// finish_samples.comp (Yusov 2013, section 1.6; cascades: 1.8).
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/epipolar.h"

layout(local_size_x = kMarchGroup) in;

#include "epipolar/march_bindings.glsl"

layout(std430, binding = 10) readonly buffer slice_block { EpipolarSlice slices[]; };
layout(std430, binding = 11) readonly buffer march_list_block { WorkList march_work; uint march_list[]; };
layout(std430, binding = 12) buffer sample_block { uvec4 samples[]; };
layout(std430, binding = 13) buffer state_block { float states[]; };

layout(push_constant) uniform Push {
  uint processing;  // CascadeProcessing
  uint pass;        // 1: the cascade, counted from the first marched
};

#include "epipolar/march_state.glsl"
#include "epipolar/slices.glsl"

void main() {
  uint at = gl_GlobalInvocationID.x;
  if (at >= march_work.count) return;
  uint id = march_list[at] >> 16u;
  uint i = march_list[at] & 0xFFFFu;
  uint sample_at = id * epipolar.samples + i;
  Sample s = unpack_sample(samples[sample_at]);
  Ray ray = sample_ray(sample_position(slices[id], i), s.depth_m);
  float start, end;
  bool in_air = clip_to_air(medium, ray, start, end);
  if (!in_air) end = start;
  TableRay path = table_ray_of(ray, start);

  uint turn = processing == 2u ? gl_WorkGroupID.y : pass;
  uint first = epipolar.first_cascade + (processing == 0u ? 0u : turn);
  uint last = processing == 0u ? epipolar.cascades : first + 1u;
  March march = nothing_marched();
  if (kLitTables || kSingle == kIntegration) {
    for (uint c = first; c < last; ++c) {
      float from, to;
      cascade_range(c, ray, start, end, from, to);
      if (!in_air || to - from <= 1e-3) continue;
      march_cascade(c, id, ray, path, start, from, to, march);
    }
  }
  if (processing == 0u) {
    vec3 light = in_air ? light_of(march, ray, path, start, end) : vec3(0.0);
    vec3 through, lost;
    attenuation(optical_depth_at(s.log_density, s.depth_m), through, lost);
    s.source = light / max(lost, vec3(1e-20));
    samples[sample_at] = pack_sample(s);
  } else {
    uint state = processing == 2u ? turn * epipolar.slices * epipolar.samples + at : at;
    if (processing == 1u && turn > 0u) march = add(load_march(state), march);
    store_march(state, march);
  }
  if (processing == 0u || turn == 0u) count(kSamplesMarched, 1u);
  count(kMarchSteps, steps_done);
  count(kTreeNodes, nodes_visited);
  count(kShadowFetches, reads_done);
}
