// Composes the pixels of blocks that unwarp.comp has listed, each with the samples at its own depth. Pixels that fit no
// sample are listed to be marched. With kDownscale, the output is the half- or quarter-resolution buffer.
#version 460
#extension GL_GOOGLE_include_directive : require

#define UNIFORM_CONSTANTS

#include "epipolar/correction_list.glsl"
#include "epipolar/downscaled.glsl"
#include "epipolar/skyline.glsl"
#include "epipolar/store_downscaled.glsl"
#include "epipolar/unwarp.glsl"
#include "frame/output.glsl"
#include "frame/picture.glsl"

layout(local_size_x = kMarchGroup) in;

layout(std430, binding = 16) readonly buffer work_block {
  WorkList work;
  uint items[];
};

// Returns whether a pixel is next to the limb as seen from above the atmosphere and must be marched: its ray grazes the
// planet, and the samples around it do not all end on the same side of the limb. In-scattering changes there by a large
// factor from pixel to pixel, so the remaining samples are no substitute.
bool at_limb(Around a, vec2 position) {
  const float kGrazing = 4.0;  // depth of the tangent point below the surface, at most [scale heights]
  float scale_heights = frame.camera_altitude_m / medium.rayleigh_scale_height_m;
  if (kHomogeneous || scale_heights < kAllOfAir) return false;
  float cos_zenith = dot(ray_direction(frame, position), frame.camera_up);
  float sin_zenith = sqrt(max(1.0 - cos_zenith * cos_zenith, 0.0));
  float dip = (1.0 - sin_zenith) * (medium.planet_radius_m + frame.camera_altitude_m) / medium.rayleigh_scale_height_m;
  bool grazes = cos_zenith < 0.0 && dip > kAllOfAir && dip < scale_heights + kGrazing;
  return grazes && depths_differ(a);
}

// Error of the picture that cannot be seen, relative to the colour of a pixel.
const float kInvisible = 0.004;

// Returns an upper bound of the opacity of the medium in front of a pixel. It costs much less than own_optical_depth().
float opacity_bound(vec2 position, float visible_m, bool sky) {
  if (sky) return 1.0;
  Ray ray = ray_to_depth(frame, position, visible_m, false);
  float lowest = ray.altitude + ray.length_m * min(ray.cos_zenith, 0.0);
  return min(LARGEST(extinction_at(medium, min(lowest, medium.atmosphere_height_m))) * ray.length_m, 1.0);
}

// Returns whether a pixel that no sample resembles may be visibly wrong. Its in-scattering may be anything up to that
// of the brightest sample, and its transmittance anything that its opacity allows. `color`: the colour of the pixel.
bool may_be_unlike(Around a, float opacity, vec3 color) {
  Spectrum high = max(max(a.source[0], a.source[1]), max(a.source[2], a.source[3]));
  vec3 error = (COLOR(high * high) * frame.sun_irradiance + color) * opacity;
  return any(greaterThan(error, kInvisible * color));
}

// Returns whether the in-scattering of a pixel may be visibly wrong because some of its samples are at other depths.
// The error is estimated by the difference between the samples, times the part of the weight that is lost.
bool may_be_wrong(Around a, Blend b, Spectrum opacity, vec3 color) {
  Spectrum low = min(min(a.source[0], a.source[1]), min(a.source[2], a.source[3]));
  Spectrum high = max(max(a.source[0], a.source[1]), max(a.source[2], a.source[3]));
  vec3 error = COLOR(max(1.0 - b.weight, 0.0) * (high * high - low * low) * opacity) * frame.sun_irradiance;
  return any(greaterThan(error, epipolar.tolerated_difference * color));
}

void unwarp_pixel(uint block, uint k) {
  ivec2 place = ivec2((block & 0xFFFFu) + (k & 1u), (block >> 16u) + (k >> 1u));
  if (any(greaterThanEqual(place, computed_size()))) return;
  ivec2 pixel = kDownscale == 1 ? place : pixel_of_downscaled(place);
  vec2 position = vec2(pixel) + 0.5;
  float depth = load_depth(pixel);
  bool sky = depth == frame.sky_depth;
  float visible_m = view_depth(frame, position, depth);
  float depth_m = sky ? sky_depth_m(ray_direction(frame, position)) : visible_m;
  Around a = around(position, depth_m);
  Blend b = blend(a, position);
  // Next to a skyline, only one of the two slices may contribute. Its influence would end with a visible seam, most of
  // which is optical depth.
  bool skyline = kSkyline && depth_m >= kSkyDepth && depths_differ(a);
  if (skyline) b.source = sky_source(a, position, b.source);
  bool unlike_all = b.weight < (sky ? epipolar.min_weight_sky : epipolar.min_weight);
  if (skyline || kSparse)
    b.extinction = extinction_of(max(own_optical_depth(position, visible_m, sky), Spectrum(0.0)), depth_m);
  bool wrong = unlike_all;
  if (kDownscale == 1) {
    vec3 background = load_color(pixel);
    vec3 color = compose(b, position, depth_m, visible_m, sky, background);
    store_color(pixel, color);
    if (!kHomogeneous) {
      Spectrum transmittance, opacity;
      attenuation(optical_depth_at(b.extinction, depth_m), transmittance, opacity);
      wrong = unlike_all ? may_be_unlike(a, opacity_bound(position, visible_m, sky), color)
                         : may_be_wrong(a, b, opacity, color);
    }
  } else {
    store_downscaled(place, depth_m, b.source, b.extinction);
  }
  if (wrong || at_limb(a, position)) list_correction(pixel);
}

void main() {
  uint i = list_item(kMarchGroup);
  if (i < 4u * work.count) unwarp_pixel(items[i / 4u], i % 4u);
}
