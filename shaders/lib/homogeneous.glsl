// The model of Hoffman and Preetham, "Photorealistic Real-Time Outdoor Light Scattering" (Game Developer, 2002).
// Equation numbers refer to that article. Air and haze have their ground density everywhere; a path through a whole
// layer has the optical length of the real layer. docs/models.md lists our assumptions where the article is silent.
// Radiance is relative to the sun's irradiance above the atmosphere [1/sr]. h is the altitude of the eye, mu and mu_s
// are the cosines of the zenith angles of the ray and the sun at the eye, and nu is the cosine of the angle between
// them.
#ifndef TYNDALL_LIB_HOMOGENEOUS
#define TYNDALL_LIB_HOMOGENEOUS

#include "lib/geometry.glsl"
#include "lib/phase.glsl"
#include "lib/portable.glsl"
#include "shared/homogeneous.h"

// Returns the optical length of a layer from the ground, given its vertical length (equation 5). The equation is fitted
// to the sky, so directions below the horizontal get the length of the horizontal.
float homogeneous_optical_length(float zenith_length_m, float mu) {
  float above = clamp(mu, 0.0, 1.0);
  float zenith_deg = acos(above) * 57.2957795130823;
  return zenith_length_m / (above + 0.15 * pow(93.885 - zenith_deg, -1.253));
}

// Returns the transmittance of `air_m` metres of air and `haze_m` metres of haze.
vec3 homogeneous_extinction(IN(Homogeneous) m, float air_m, float haze_m) {
  return exp(-(m.air_scattering * air_m + m.haze_extinction * haze_m));
}

// Returns the direct sunlight at the ground on a surface that faces the sun, relative to that above the atmosphere.
vec3 homogeneous_sun(IN(Homogeneous) m, float mu_s) {
  float visible = m.sun_radius_rad > 0.0 ? sun_disc_visibility(0.0, mu_s, m.planet_radius_m, m.sun_radius_rad)
                                         : (mu_s < 0.0 ? 0.0 : 1.0);
  return homogeneous_extinction(m, homogeneous_optical_length(m.air_length_m, mu_s),
                                homogeneous_optical_length(m.haze_length_m, mu_s)) *
         visible;
}

// Returns (1 - exp(-beta s)) / beta, which is s for beta = 0.
float homogeneous_attenuated_length(float beta, float s) {
  float x = beta * s;
  return x > 0.01 ? (1.0 - exp(-x)) / beta : s * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0))));
}

vec3 homogeneous_attenuated_lengths(vec3 beta, float s) {
  return vec3(homogeneous_attenuated_length(beta.x, s), homogeneous_attenuated_length(beta.y, s),
              homogeneous_attenuated_length(beta.z, s));
}

// The medium along a path: first `near_air_m` of air alone, then `haze_m` of air and haze, then the rest of `air_m`.
struct HomogeneousPath {
  float air_m;
  float haze_m;  // at most air_m
  float near_air_m;
  float mu_s;  // cosine of the sun's zenith angle for the sunlight on this path
};

// Returns the in-scattered radiance per unit of sunlight at the ground, and the transmittance of the whole path in
// `extinction`. With near_air_m = 0 this is the two-shell sky equation; with air_m = haze_m as well, it is equation 4.
vec3 homogeneous_inscattering(IN(Homogeneous) m, IN(HomogeneousPath) path, float nu, OUT(vec3) extinction) {
  float far_air_m = max(path.air_m - path.haze_m - path.near_air_m, 0.0);
  vec3 air = m.air_scattering * rayleigh_phase(nu);
  vec3 both = air + m.haze_scattering * henyey_greenstein_phase(nu, m.haze_g);
  vec3 beta = m.air_scattering + m.haze_extinction;
  vec3 through_near = exp(-m.air_scattering * path.near_air_m);
  vec3 through_both = through_near * exp(-beta * path.haze_m);
  extinction = through_both * exp(-m.air_scattering * far_air_m);
  return air * homogeneous_attenuated_lengths(m.air_scattering, path.near_air_m) +
         through_near * both * homogeneous_attenuated_lengths(beta, path.haze_m) +
         through_both * air * homogeneous_attenuated_lengths(m.air_scattering, far_air_m);
}

// Returns the optical length of one layer along a ray to a surface `end_m` away, with a density that falls with
// altitude. From the lower end upwards, the whole layer has the length of equation 5; the ray gets its part of that.
float homogeneous_falling_length(float zenith_length_m, float low_m, float mu_up, float end_m) {
  float whole = homogeneous_optical_length(zenith_length_m, mu_up);
  return exp(min(-low_m / zenith_length_m, 0.0)) * homogeneous_attenuated_length(1.0 / whole, end_m);
}

// Returns the optical length of one layer along a ray that leaves the layer. `near` is the part before the ray's lowest
// point.
float homogeneous_leaving_length(float zenith_length_m, float h, float mu, float perigee_m, OUT(float) near) {
  float here = exp(min(-h / zenith_length_m, 0.0)) * homogeneous_optical_length(zenith_length_m, abs(mu));
  near = 0.0;
  if (mu >= 0.0) {
    return here;
  }
  float to_perigee = exp(min(-perigee_m / zenith_length_m, 0.0)) * homogeneous_optical_length(zenith_length_m, 0.0);
  near = max(to_perigee - here, 0.0);
  return near + to_perigee;
}

// Returns the path of a ray from an eye at any altitude to a surface `end_m` away. With end_m < 0 the ray goes to the
// ground at sea level or out into space. The article only describes eyes near the ground; from above the atmosphere,
// our ray begins where it enters.
HomogeneousPath homogeneous_path(IN(Homogeneous) m, float h, float mu, float mu_s, float nu, float end_m) {
  float R = m.planet_radius_m;
  HomogeneousPath path;
  path.air_m = 0.0;
  path.haze_m = 0.0;
  path.near_air_m = 0.0;
  path.mu_s = mu_s;
  float start;
  float leave;
  bool on_ground;
  bool meets = atmosphere_segment(h, mu, m.atmosphere_height_m, R, start, leave, on_ground);
  float end = end_m;
  if (end_m < 0.0) {
    if (!meets) {
      return path;
    }
    end = on_ground ? leave : -1.0;
  }
  float perigee_d = -(R + h) * mu;
  if (h > m.atmosphere_height_m) {
    // The eye is in space: use the sunlight at the ray's lowest point.
    float lowest = end >= 0.0 ? end : max(perigee_d, 0.0);
    float r = R + altitude_along(h, mu, lowest, R);
    path.mu_s = clamp(((R + h) * mu_s + lowest * nu) / max(r, 1.0), -1.0, 1.0);
  }
  if (end >= 0.0) {
    float length_m = max(end - start, 0.0);
    if (m.falloff == 0u) {
      path.air_m = length_m;
      path.haze_m = length_m;
      return path;
    }
    // Evaluate the ray from its lower end upwards.
    float high_m = h > m.atmosphere_height_m ? m.atmosphere_height_m : h;
    float end_altitude = altitude_along(h, mu, end, R);
    bool down = end_altitude < high_m;
    float mu_up = down ? -cos_zenith_along(h, mu, end, R) : mu;
    float low_m = max(down ? end_altitude : h, 0.0);
    path.air_m = homogeneous_falling_length(m.air_length_m, low_m, mu_up, length_m);
    path.haze_m = min(homogeneous_falling_length(m.haze_length_m, low_m, mu_up, length_m), path.air_m);
    path.near_air_m = down ? path.air_m - path.haze_m : 0.0;
    return path;
  }
  if (m.falloff == 0u) {
    float mu_in = start > 0.0 ? cos_zenith_along(h, mu, start, R) : mu;
    path.air_m = homogeneous_optical_length(m.air_length_m, mu_in);
    path.haze_m = homogeneous_optical_length(m.haze_length_m, mu_in);
    return path;
  }
  float perigee_m = max(perigee_altitude(h, mu, R), 0.0);
  float near_air;
  float near_haze;
  path.air_m = homogeneous_leaving_length(m.air_length_m, h, mu, perigee_m, near_air);
  path.haze_m = min(homogeneous_leaving_length(m.haze_length_m, h, mu, perigee_m, near_haze), path.air_m);
  path.near_air_m = clamp(near_air - near_haze, 0.0, path.air_m - path.haze_m);
  return path;
}

#endif
