// The distribution of the froxel volume along a ray. Texel k of n holds the path from the camera to the distance
// froxel_distance(k / (n - 1)). Up to near_m the texels are about evenly spaced, beyond it their spacing grows with the
// distance.
#ifndef TYNDALL_LIB_FROXELS
#define TYNDALL_LIB_FROXELS

// Returns the distance [m] for x in [0; 1], and the reverse.
float froxel_distance(float x, float near_m, float far_m) {
  return near_m * (exp(x * log(1.0 + far_m / near_m)) - 1.0);
}
float froxel_x(float distance_m, float near_m, float far_m) {
  return clamp(log(1.0 + max(distance_m, 0.0) / near_m) / log(1.0 + far_m / near_m), 0.0, 1.0);
}

// Returns the texture coordinate over n texels.
float froxel_coordinate(float distance_m, float near_m, float far_m, float n) {
  return (froxel_x(distance_m, near_m, far_m) * (n - 1.0) + 0.5) / n;
}

#endif
