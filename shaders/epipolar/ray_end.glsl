// The end of a ray for interpolation: the surface in the depth buffer, the planet where nothing was drawn, or the sky.
#ifndef TYNDALL_RAY_END_GLSL
#define TYNDALL_RAY_END_GLSL

#include "frame/constants.glsl"
#include "frame/view_ray.glsl"
#include "frame/homogeneous_medium.glsl"
#include "epipolar/records.glsl"

// Returns the view-space depth [m] of the end of a ray to the sky: kSkyDepth, or the depth of the planet if it is in
// the way.
float sky_depth_m(vec3 direction) {
  float h = frame.camera_altitude_m;
  float radius = medium.planet_radius_m;
  float mu = dot(direction, frame.camera_up);
  if (!hits_planet(frame, h, mu, radius)) return kSkyDepth;
  return distance_to_sphere(h, mu, frame.ground_m, radius) * dot(direction, frame.camera_forward);
}

// Returns the length [m] inside the homogeneous medium of a ray to a view-space depth. A ray to kSkyDepth or beyond
// ends at the boundary of the medium.
float length_in_homogeneous(vec3 direction, float depth_m) {
  float start;
  float end =
      depth_m >= kSkyDepth ? frame.homogeneous.extent_m : depth_m / max(dot(direction, frame.camera_forward), 1e-6);
  clip_to_top(dot(direction, frame.camera_up), start, end);
  return end - start;
}

#endif
