// Marches, or only marks, the pixels that no sample fits in depth (Yusov 2013, section 1.7), in the rows of the slice
// that is nearest to each.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/epipolar.h"

layout(local_size_x = kMarchGroup) in;

#include "epipolar/march_bindings.glsl"

layout(std430, binding = 10) readonly buffer break_list_block { WorkList breaks; uint break_list[]; };
layout(binding = 11) uniform sampler2D scene_color;
layout(binding = 12) uniform sampler2D scene_depth;
layout(binding = 13, OUTPUT_FORMAT) uniform writeonly image2D output_color;

#include "epipolar/slices.glsl"

void main() {
  uint at = gl_GlobalInvocationID.x;
  if (at >= breaks.count) return;
  ivec2 pixel = ivec2(break_list[at] & 0xFFFFu, break_list[at] >> 16u);
  vec2 position = vec2(pixel) + 0.5;
  Ray ray = view_ray(frame, pixel, texelFetch(scene_depth, pixel, 0).r);
  uint id = uint(slice_coordinate(position) + 0.5);
  id = id >= epipolar.slices ? (epipolar.closed != 0u ? 0u : epipolar.slices - 1u) : id;
  float start, end;
  vec3 light = vec3(0.0);
  vec3 through = vec3(1.0);
  if (epipolar.correct_depth_breaks != 0u && clip_to_air(medium, ray, start, end)) {
    TableRay path = table_ray_of(ray, start);
    March march = nothing_marched();
    if (kLitTables || kSingle == kIntegration) {
      for (uint c = epipolar.first_cascade; c < epipolar.cascades; ++c) {
        float from, to;
        cascade_range(c, ray, start, end, from, to);
        if (to - from <= 1e-3) continue;
        march_cascade(c, id, ray, path, start, from, to, march);
      }
    }
    light = light_of(march, ray, path, start, end);
    float from_altitude = altitude_along(ray.altitude, ray.cos_zenith, start, medium.planet_radius_m);
    float from_cosine = cos_zenith_along(ray.altitude, ray.cos_zenith, start, medium.planet_radius_m);
    through = transmittance(medium, column_along(medium, from_altitude, from_cosine, end - start));
  }
  vec3 color = light * frame.sun_irradiance;
  if (frame.only == 0u) color += texelFetch(scene_color, pixel, 0).rgb * through;
  if (epipolar.show_depth_breaks != 0u) color = vec3(0.0, frame.sun_irradiance.g, 0.0) * 0.2;
  imageStore(output_color, pixel, vec4(color, 1.0));
  count(kPixelsCorrected, 1u);
  count(kMarchSteps, steps_done);
  count(kTreeNodes, nodes_visited);
  count(kShadowFetches, reads_done);
}
