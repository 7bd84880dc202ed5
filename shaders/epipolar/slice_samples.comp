// Computes the samples of all slices: the end and the optical depth of their rays, and coarse unshadowed in-scattering.
// The latter is that of a medium distributed evenly along the ray, in closed form. It follows every change of depth and
// direction, which is sufficient for refinement.
#version 460
#extension GL_GOOGLE_include_directive : require

#define COPY_CONSTANTS
#define UNIFORM_CONSTANTS

#include "epipolar/constants.glsl"
#include "epipolar/ray_end.glsl"
#include "epipolar/slices.glsl"
#include "frame/picture.glsl"
#include "lib/optical_depth.glsl"
#include "lib/phase.glsl"
#include "lib/table_values.glsl"

layout(local_size_x = 32, local_size_y = 2) in;

layout(std430, binding = 13) readonly buffer slices_block { EpipolarSlice slices[]; };
layout(std430, binding = 14) writeonly buffer samples_block { uvec4 samples[]; };
layout(std430, binding = 15) writeonly buffer coarse_inscattering_block { uint coarse[]; };

// Returns device depth at a position between pixels. On one surface it is the depth of the surface, because device
// depth is affine in the picture. At a depth discontinuity it is that of the nearest pixel, because averaging yields a
// depth where there is no surface.
float depth_at(vec2 position) {
  const float kSameSurface = 0.9;  // minimum ratio of view depths
  vec2 last = vec2(float(frame.width), float(frame.height)) - 1.0;
  vec2 place = clamp(position - 0.5, vec2(-0.5), last + 0.5);
  vec2 corner = floor(place);
  vec2 part = place - corner;
  // The four surrounding pixels: x lower left, y lower right, z upper right, w upper left. Beyond the picture the
  // outermost pixels are repeated.
  vec4 d = gather_depth(ivec2(corner));
  d = corner.x < 0.0 ? d.yyzz : corner.x >= last.x ? d.xxww : d;
  d = corner.y < 0.0 ? d.xyyx : corner.y >= last.y ? d.wzzw : d;
  float a = view_depth(frame, position, min(min(d.x, d.y), min(d.z, d.w)));
  float b = view_depth(frame, position, max(max(d.x, d.y), max(d.z, d.w)));
  bool scene = all(notEqual(d, vec4(frame.sky_depth)));
  float between = mix(mix(d.w, d.z, part.x), mix(d.x, d.y, part.x), part.y);
  float nearest_pixel = part.y >= 0.5 ? (part.x >= 0.5 ? d.y : d.x) : (part.x >= 0.5 ? d.z : d.w);
  return scene && min(a, b) > kSameSurface * max(a, b) ? between : nearest_pixel;
}

// Returns the sunlight where a ray from outside of the atmosphere is closest to the ground. Without it, samples on both
// sides of the terminator would look alike.
Spectrum sunlight_of_ray(Ray ray, float end) {
  float radius = medium.planet_radius_m;
  float lowest = min(max(-(radius + ray.altitude) * ray.cos_zenith, 0.0), end);
  float altitude = max(altitude_along(ray.altitude, ray.cos_zenith, lowest, radius), medium.rayleigh_scale_height_m);
  float cos_sun = cos_sun_zenith_along(ray, lowest, radius);
  return sun_visibility(altitude, cos_sun, radius) *
         transmittance(medium, density_integral_to_top(medium, altitude, cos_sun));
}

void main() {
  load_medium();
  uint i = gl_GlobalInvocationID.x;
  uint id = gl_GlobalInvocationID.y;
  if (i >= epipolar.samples || id >= epipolar.slices) return;
  EpipolarSlice slice = slices[id];
  if (i > slice.last) return;
  vec2 position = sample_position(slice, i);
  float depth = depth_at(position);
  bool sky = depth == frame.sky_depth;
  Sample s;
  s.source = Spectrum(0.0);
  uint at = id * epipolar.samples + i;
  if (kHomogeneous) {
    // Along a slice, only the length in the medium changes. Pixels apply the phase functions and the extinction
    // coefficient.
    vec3 direction = ray_direction(frame, position);
    s.depth_m = sky ? sky_depth_m(direction) : view_depth(frame, position, depth);
    s.extinction = Spectrum(0.0);
    Spectrum transmittance, opacity;
    homogeneous_attenuation(length_in_homogeneous(direction, s.depth_m), transmittance, opacity);
    STORE_SAMPLE(at, s)
    coarse[at] = pack_coarse(opacity);  // no edge is marched for being a skyline
    return;
  }
  Ray ray = ray_to_depth(frame, position, view_depth(frame, position, depth), sky);
  bool from_space = ray.altitude > medium.atmosphere_height_m;
  // Between pixels that are many kilometres apart, the interpolated depth is that of a chord far below the ground.
  if (from_space && !sky && hits_planet(frame, ray.altitude, ray.cos_zenith, medium.planet_radius_m))
    ray.length_m =
        min(ray.length_m, distance_to_sphere(ray.altitude, ray.cos_zenith, frame.ground_m, medium.planet_radius_m));
  s.depth_m = sky ? sky_depth_m(ray.direction) : ray.length_m * dot(ray.direction, frame.camera_forward);
  vec3 integral = vec3(0.0);
  float start, end;
  if (clip_to_atmosphere(frame, medium, ray, start, end)) {
    integral = max(density_integral_along(medium, ray.altitude, ray.cos_zenith, end), vec3(0.0));
  }
  s.extinction = extinction_of(optical_depth(medium, integral), s.depth_m);
  STORE_SAMPLE(at, s)
  NormalisationFactors factors = normalisation_factors(medium, integral);
  Spectrum light = RAYLEIGH_SCATTERING(medium) * rayleigh_phase(ray.cos_view_sun) * factors.rayleigh +
                   mie_scattering_towards(medium, ray.cos_view_sun) * factors.mie;
  if (from_space) light *= sunlight_of_ray(ray, end);
  coarse[at] = pack_coarse(light) | (s.depth_m >= kSkyDepth ? kSkySample : 0u);
}
