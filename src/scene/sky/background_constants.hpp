// The constants that background.frag reads, in std430.
#pragma once

#include "tyndall/types.hpp"

namespace tyndall::scene {

struct BackgroundConstants {
  Mat4 local_from_view;
  Vec3 direction_to_sun;
  float angular_radius_rad;
  Vec3 disc_radiance;
  float pixel_angle_rad;
  Vec3 limb_exponent;
  float sun_stretch;  // factor by which positions on the disc are stretched along `up`, minus 1; 0: the disc is round
  float tan_half[2];
  float jitter[2];
  Vec3 direction_to_moon;
  float moon_radius_rad;
  Vec3 moon_irradiance;
  float unused_1;
  Mat4 world_from_local;
  Vec3 up;
  float unused_2;
  Vec3 airglow;
  float unused_3;
};

}  // namespace tyndall::scene
