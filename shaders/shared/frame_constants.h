// The constants of one frame. src/effect/frame_constants.cpp derives them; the caller never sets them. They are read
// from storage buffers (std430) and uniform buffers (std140; docs/epipolar.md says which). The layouts agree because
// every vec3 is followed by a four-byte member and every structure is a multiple of 16 bytes.
#ifndef TYNDALL_SHARED_FRAME_CONSTANTS
#define TYNDALL_SHARED_FRAME_CONSTANTS

#include "shared/tables.h"

const uint kMaxCascades = 8u;

struct CascadeConstants {
  mat4 shadow_from_world;
  float near_m;
  float far_m;
  float unused_0;
  float unused_1;
};

// The medium of scattering.medium = homogeneous, with derived coefficients.
struct HomogeneousMedium {
  vec3 rayleigh_scattering;  // [1/m]
  float extent_m;            // length of rays to the sky
  vec3 mie_scattering;
  float height_m;  // altitude of the top
  vec3 extinction;
  float phase_min;  // (1 - |g|)^2 of the aerosol's phase function
  // Phase functions at a right angle to the sun, times scattering, divided by extinction [1/sr].
  vec3 rayleigh_source;
  float phase_slope;   // 2 |g|
  vec3 mie_source;     // before the division by (phase_min + phase_slope (1 - |cos|))^1.5
  float phase_sign;    // sign of g
  float phase_second;  // coefficient of cos^2: 1 Cornette-Shanks, 0 Henyey-Greenstein
  float unused_0;
  float unused_1;
  float unused_2;
};

struct FrameConstants {
  mat4 view_from_clip;
  mat4 world_from_view;
  vec3 camera_position;  // world [m]
  float camera_altitude_m;
  vec3 camera_forward;  // world
  float sky_depth;
  vec3 camera_up;  // vertical of the planet at the camera, world
  float near_depth;
  vec3 ray_origin;    // rays through pixels are ray_origin + x ray_x + y ray_y, in world space, not normalised
  float horizon_cos;  // cosine of the zenith angle of the planet's horizon
  vec3 ray_x;
  // Sign of (depth behind glass - depth of the glass): 1, or -1 with shadow_depth_reversed; 0: shadow_colors has no
  // depth.
  float glass_depth_sign;
  vec3 ray_y;
  float ground_m;  // altitude of the sphere where rays end if nothing is drawn on them
  vec3 direction_to_sun;
  float cos_sun_angular_radius;
  vec3 sun_irradiance;  // includes scattering.scale
  uint shadow_resolution;
  uint width;
  uint height;
  uint cascade_count;  // 0: nothing is shadowed
  uint first_marched_cascade;
  uint integration_steps;
  uint only;  // 1: the output is the in-scattered light alone
  uint shadow_depth_reversed;
  uint unoccluded;  // 1: higher orders ignore shadows
  // The upper left corners of the frame's rectangle in the caller's images [pixels].
  ivec2 color_offset;
  ivec2 depth_offset;
  ivec2 output_offset;
  uint froxel_columns;
  uint froxel_rows;
  uint froxel_slices;
  float froxel_near_m;
  float froxel_far_m;
  uint unused_3;
  // The map of the clouds: rows of the linear part of its matrix [1/m], and the camera's (u, v, depth).
  vec3 cloud_u;
  float cloud_camera_u;
  vec3 cloud_v;
  float cloud_camera_v;
  vec3 cloud_depth;
  float cloud_camera_depth;
  TableShape tables;
  HomogeneousMedium homogeneous;
#if defined(SPECTRAL) || defined(__cplusplus)
  // Values at the fourth wavelength of scattering.color = spectral: extinction, rayleigh_source and mie_source of the
  // homogeneous medium.
  vec4 homogeneous_fourth_channel;
#endif
};

#endif
