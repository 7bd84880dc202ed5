// The source function between the nodes of its grid. Include after declaring a buffer `source[]` of vec4 that
// holds the fourth root of (light scattered per metre / scattering coefficient).
#ifndef TYNDALL_SOURCE_LOOKUP_GLSL
#define TYNDALL_SOURCE_LOOKUP_GLSL

#include "precompute/gather_grid.glsl"
#include "lib/table_values.glsl"

vec3 source_column(uint base, uint sun, float fraction) {
  return mix(source[base + sun].rgb, source[base + sun + 1u].rgb, fraction);
}

vec3 source_plane(uint altitude, uint zenith, float zenith_part, uint azimuth, float azimuth_part, uint sun,
                  float sun_part) {
  uint base = source_index(altitude, zenith, azimuth, 0u);
  uint row = kSourceAzimuths * kGatherSuns;
  vec3 near = mix(source_column(base, sun, sun_part), source_column(base + kGatherSuns, sun, sun_part), azimuth_part);
  base += row;
  vec3 far = mix(source_column(base, sun, sun_part), source_column(base + kGatherSuns, sun, sun_part), azimuth_part);
  return mix(near, far, zenith_part);
}

// Zenith angles of view and sun, and the azimuth between them.
struct SourceAngles {
  float view;
  float sun;
  float azimuth;
};

// Returns the angle nearest to x that forms a triangle on the sphere with a and b.
float angle_in_triangle(float x, float a, float b) { return clamp(x, abs(a - b), min(a + b, 2.0 * kPi - a - b)); }

// Returns the angles from their cosines. Some texels of the tables stand for triples that form no triangle, and
// interpolation reads them. On the sun's side the angle between view and sun is preserved, because the aureole depends
// on it, and the view is moved; or the sun where it is high and nearer to the vertical, where its exact position
// matters least. On the other side the light hardly depends on that angle, but in turbid air near the horizon it
// depends strongly on the view, which is preserved instead.
const float kHighSun = 0.5;
SourceAngles source_angles(float mu, float mu_s, float nu) {
  bool move_sun = mu_s > max(kHighSun, abs(mu));
  SourceAngles a = SourceAngles(acos(clamp(mu, -1.0, 1.0)), acos(clamp(mu_s, -1.0, 1.0)), 0.0);
  float spread = sqrt(max((1.0 - mu * mu) * (1.0 - mu_s * mu_s), 1.0e-12));
  float cosine = (nu - mu * mu_s) / spread;
  if (abs(cosine) > 1.0 && nu > 0.0) {
    float between = acos(clamp(nu, -1.0, 1.0));
    if (move_sun) {
      a.sun = angle_in_triangle(a.sun, a.view, between);
    } else {
      a.view = angle_in_triangle(a.view, a.sun, between);
    }
  }
  a.azimuth = acos(clamp(cosine, -1.0, 1.0));
  return a;
}

// Returns the light scattered at altitude h into the direction opposite to a view ray of cosine mu, under a sun at
// mu_s, with nu between view ray and sun, per scattering coefficient [1/sr].
vec3 source_at(Medium m, float h, float mu, float mu_s, float nu) {
  SourceAngles angles = source_angles(mu, mu_s, nu);
  float azimuth = source_azimuth_index(angles.azimuth);
  float zenith = source_zenith_index(angles.view);
  float sun = gather_sun_index(m, mu_s > kHighSun ? cos(angles.sun) : mu_s);
  float altitude = gather_altitude_index(m, h);
  uint a = min(uint(altitude), kGatherAltitudes - 2u);
  uint z = min(uint(zenith), kSourceZeniths - 2u);
  uint k = min(uint(azimuth), kSourceAzimuths - 2u);
  uint s = min(uint(sun), kGatherSuns - 2u);
  float zf = zenith - float(z);
  float kf = azimuth - float(k);
  float sf = sun - float(s);
  vec3 low = source_plane(a, z, zf, k, kf, s, sf);
  vec3 high = source_plane(a + 1u, z, zf, k, kf, s, sf);
  return value_from_texel(mix(low, high, altitude - float(a)));
}

#endif
