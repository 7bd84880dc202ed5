// The sun's disc as seen from above the atmosphere. Its mean radiance times its solid angle is the irradiance above the
// atmosphere. Limb darkening: I = I0 mu^alpha with alpha by wavelength (Hestroffer, Magnan, "Wavelength dependency of
// the Solar limb darkening", 1998, equation 4).
#ifndef TYNDALL_SUN_DISC_GLSL
#define TYNDALL_SUN_DISC_GLSL

layout(std430, binding = 0) readonly buffer background_block {
  mat4 local_from_view;
  vec3 direction_to_sun;
  float angular_radius_rad;
  vec3 disc_radiance;     // mean over the disc
  float pixel_angle_rad;  // angle that one pixel spans at the centre of the picture
  vec3 limb_exponent;
  // Refraction flattens the disc. Vertical angles are multiplied by 1 + sun_stretch before they are compared with the
  // radius; 0 gives a round disc.
  float sun_stretch;
  vec2 tan_half;  // tangents of half the field of view; y points down in clip space
  vec2 jitter;    // subpixel offset of the picture in clip space
  vec3 direction_to_moon;
  float moon_radius_rad;  // 0: no moon
  vec3 moon_irradiance;   // irradiance of the sun at the moon
  float unused_1;
  mat4 world_from_local;  // directions
  vec3 up;                // vertical at the origin of the world; only with sun_stretch
  float unused_2;
  vec3 airglow;  // radiance
  float unused_3;
};

// Returns the radiance in a direction of unit length; 0 beside the disc.
vec3 sun_disc(vec3 direction) {
  // The chord between unit vectors is precise where the arc cosine of a dot product is not.
  float chord = distance(direction, direction_to_sun);
  if (sun_stretch > 0.0) {
    vec3 upright = normalize(up - direction_to_sun * dot(up, direction_to_sun) + 1e-9);
    vec3 offset = direction - direction_to_sun;
    chord = length(offset + upright * (sun_stretch * dot(offset, upright)));
  }
  float angle = 2.0 * asin(min(0.5 * chord, 1.0));
  // A pixel away from the centre of the picture spans a smaller angle.
  float forward = dot(direction, -vec3(local_from_view[2]));
  float pixel = pixel_angle_rad * forward * forward;
  float cover = clamp((angular_radius_rad - angle) / pixel + 0.5, 0.0, 1.0);
  float x = min(angle / angular_radius_rad, 1.0);
  float mu = sqrt(max(1.0 - x * x, 1e-4));
  vec3 limb = pow(vec3(mu), limb_exponent) * (0.5 * limb_exponent + 1.0);
  return cover * limb * disc_radiance;
}

#endif
