// The uniform block of tyndall/atmosphere.glsl. src/effect/atmosphere.cpp derives it. The layouts of std140 and C++
// agree because every vec3 is followed by a four-byte member and every structure is a multiple of 16 bytes.
#ifndef TYNDALL_SHARED_ATMOSPHERE
#define TYNDALL_SHARED_ATMOSPHERE

#include "shared/medium.h"
#include "shared/tables.h"

struct AtmosphereConstants {
  Medium medium;
  TableShape tables;
  vec3 origin_up;  // at the origin of the caller's coordinates: unit vector away from the planet's centre; 0 at the
                   // centre
  float origin_altitude_m;
  vec3 direction_to_sun;
  float origin_radius_m;  // distance of that origin from the planet's centre
  vec3 sun_irradiance;    // includes scattering.scale
  float sun_angular_radius_rad;
  float froxel_near_m;
  float froxel_far_m;
  float froxel_slices;
  float unused_0;
  vec3 froxel_irradiance;  // of the sun on the medium of the froxel volume
  float unused_1;
  vec4 cloud_u;  // rows of the matrix from the caller's coordinates to (u, v, depth) of the map of clouds
  vec4 cloud_v;
  vec4 cloud_depth;
};

#endif
