// Marches the selected samples through all cascades at once, or through one cascade with the state stored for a last
// pass (Yusov 2013, sections 1.6 and 1.8). Marches also the pixels that fit no sample in depth (section 1.7), along the
// slice line of the nearest slice. There is one shader for all modes, because creating a pipeline for each would be
// expensive.
#version 460
#extension GL_GOOGLE_include_directive : require

#define COPY_CONSTANTS

#include "epipolar/constants.glsl"
#include "epipolar/march.glsl"
#include "epipolar/march_state.glsl"
#include "epipolar/slices.glsl"
#include "epipolar/work_list.glsl"
#include "frame/picture.glsl"

layout(local_size_x = kMarchGroup) in;

layout(std430, binding = 17) readonly buffer slices_block { EpipolarSlice slices[]; };
layout(std430, binding = 16) readonly buffer work_block {
  WorkList work;
  uint items[];
};
layout(std430, binding = 18) buffer samples_block { uvec4 samples[]; };
layout(std430, binding = 19) writeonly buffer corrected_inscattering_block { uvec2 corrected[]; };
layout(std430, binding = 20) buffer coarse_inscattering_block { uint coarse[]; };

layout(push_constant) uniform Push {
  uint processing;  // kAllCascades to kPixels
  uint turn;        // kOneCascade: the cascade, counted from the first marched
};

void march_item(uint at) {
  bool pixels = processing == kPixels;
  uint item = items[at];
  ivec2 pixel = ivec2(item & 0xFFFFu, item >> 16u);
  uint id = item >> 16u;
  uint sample_at = pixels ? 0u : id * epipolar.samples + (item & 0xFFFFu);
  Sample s = squared(LOAD_ROOTS(sample_at));
  vec2 position = vec2(pixel) + 0.5;
  if (pixels) {
    float depth = load_depth(pixel);
    s.depth_m = depth == frame.sky_depth ? kSkyDepth : view_depth(frame, position, depth);
    id = uint(slice_coordinate(position) + 0.5);
    id = id >= epipolar.slices ? (epipolar.closed != 0u ? 0u : epipolar.slices - 1u) : id;
  } else {
    position = sample_position(slices[id], item & 0xFFFFu);
  }
  Ray ray = ray_to_depth(frame, position, s.depth_m, s.depth_m >= kSkyDepth);
  float start, end;
  bool in_air = clip_to_medium(ray, start, end);
  if (!in_air) end = start;
  TableRay path = table_ray_of(ray, start);

  uint first = epipolar.first_cascade;
  uint last = epipolar.cascades;
  uint state = at;
  if (processing == kOneCascade) {
    first += turn;
    last = first + 1u;
  } else if (processing == kCascadesAside) {
    first += gl_WorkGroupID.z;
    last = first + 1u;
    state += gl_WorkGroupID.z * epipolar.slices * epipolar.samples;
  } else if (processing == kFinish) {
    last = first;
  }
  March march = nothing_marched();
  if (kLitTables && !kHomogeneous) march.lit.dark_until = planet_shadow_end(ray, start);
  if (kLitTables || kSingle == kIntegration) {
    for (uint c = first; c < last; ++c) {
      float from, to;
      cascade_range(c, ray, start, end, from, to);
      if (kLitTables) {
        from = max(from, march.lit.dark_until);
        if (to <= march.lit.dark_until) march.end_lit_fraction = 0.0;
      }
      if (!in_air || to - from <= 1e-3) continue;
      march_cascade(c, id, ray, path, start, from, to, march);
    }
  }
  if (processing == kOneCascade || processing == kCascadesAside) {
    if (processing == kOneCascade && turn > 0u) march = add(load_march(state), march);
    store_march(state, march);
  } else {
    // kFinish adds up `turn` states.
    for (uint i = 0u; i < (processing == kFinish ? turn : 0u); ++i) {
      march = add(march, load_march(i * epipolar.slices * epipolar.samples + at));
    }
    Spectrum light = in_air ? light_of(march, ray, path, start, end) : Spectrum(0.0);
    if (pixels) {
      corrected[at] = pack_light(light);
    } else {
      Spectrum transmittance, opacity;
      attenuation(optical_depth_at(s.extinction, s.depth_m), transmittance, opacity);
      if (kHomogeneous) homogeneous_attenuation(end - start, transmittance, opacity);
      s.source = light / max(opacity, Spectrum(1e-20));
      // A ray that misses the medium counts as lit, because neighbours that hit the medium are interpolated with it.
      if (kHomogeneous && kSingle != kNone && !in_air) s.source = Spectrum(1.0);
      STORE_SAMPLE(sample_at, s)
      if (has_shadowed_end(march, s.depth_m)) coarse[sample_at] |= kShadowedEnd;
    }
  }
  bool counts = processing == kAllCascades || (processing == kOneCascade && turn == 0u) ||
                (processing == kCascadesAside && gl_WorkGroupID.z == 0u);
  count(kPixelsCorrected, pixels ? 1u : 0u);
  count(kSamplesMarched, counts ? 1u : 0u);
}

void main() {
  load_medium();
  load_frame();
  load_epipolar();
  // The dispatch has workgroups for every cascade side by side. The other modes need those of one cascade.
  bool turn_here = processing == kCascadesAside || gl_WorkGroupID.z == 0u;
  uint at = list_item(kMarchGroup);
  bool overflown = processing == kPixels && work.count > epipolar.correction_capacity;  // correction_list.glsl
  if (turn_here && at < work.count && !overflown) march_item(at);
  count(kMarchSteps, steps_done);
  count(kNodesVisited, nodes_visited);
  count(kShadowFetches, reads_done);
}
