// Where a ray stands in the scattering tables, and back. Each of the four axes has a pair of functions between
// its quantity and a coordinate in [0; 1] over the texels; three parameterisations of each:
//   yusov    - Yusov, "High Performance Outdoor Light Scattering Using Epipolar Sampling" (2013), section 2:
//              square root of altitude, fifth root of the distance from the horizon in cosine, Bruneton's
//              arctangent for the sun; even in the angle between view and sun, where he takes its power 3/2:
//              that leaves 30 degrees between the texels around 90, and triples the errors of twilight;
//   bruneton - Bruneton and Neyret, "Precomputed Atmospheric Scattering" (2008), section 4: distances to the
//              horizon and to the boundary, an exponential for the sun, linear in the cosine to the sun;
//   linear   - in altitude and the three cosines.
// In the first two the view axis has one half for rays that end on the ground and one for those that leave the
// air (`below` tells which), and filtering never crosses the horizon.
#ifndef TYNDALL_LIB_TABLE_MAPPING
#define TYNDALL_LIB_TABLE_MAPPING

#include "lib/geometry.glsl"
#include "shared/medium.h"
#include "shared/tables.h"

// Altitudes nearer to the ground or the top than this are looked up as if they were this far [m].
const float kTableMargin = 16.0;
// The lowest altitude of the tables [m]: rays from below are looked up as if they began here.
const float kLowestTableAltitude = -500.0;
// The lowest sun, as a cosine: 16 degrees below the horizontal, where rays from high up that begin in twilight
// have the middle of their air. (The sources end at 11 degrees, of the sun at the ray's beginning.)
const float kLowestSun = -0.28;
// The yusov mapping of the sun: the arctangent of so many times its cosine, and its least and largest.
const float kSunShape = 5.3496235;  // tan(1.26 * 1.1)
const float kSunFrom = -0.982145272;
const float kSunTo = 1.386;
// The bruneton mapping of the sun.
const float kSunFade = 3.0;

// A value x in [0; 1] that is to lie on texel centres at 0 and 1, as a texture coordinate over n texels.
float texel_from_unit(float x, float n) { return (x * (n - 1.0) + 0.5) / n; }
float unit_from_texel(float c, float n) { return clamp((c * n - 0.5) / (n - 1.0), 0.0, 1.0); }

float altitude_margin(IN(Medium) m) { return min(kTableMargin, 0.01 * m.atmosphere_height_m); }

float lowest_table_altitude(IN(Medium) m) { return max(kLowestTableAltitude, -0.125 * m.planet_radius_m); }

// Texels along altitude that stand for altitudes below sea level, evenly spaced; the next one stands for the margin
// above it.
float texels_below_sea(IN(TableShape) t) { return float(min(t.altitudes / 10u, 3u)); }

// The altitude that stands for h in the tables; `margin` away from sea level on either side of it.
float table_altitude(IN(Medium) m, float h) {
  float margin = altitude_margin(m);
  return h < 0.0 ? clamp(h, lowest_table_altitude(m), -margin) : clamp(h, margin, m.atmosphere_height_m - margin);
}

// Distance from altitude h to the horizon of ground_below() [m].
float horizon_distance(float h, float R) {
  float ground = ground_below(h, R);
  return sqrt((h - ground) * (2.0 * R + h + ground));
}

float u_from_altitude(IN(TableShape) t, IN(Medium) m, float h) {
  float below = texels_below_sea(t);
  float n = float(t.altitudes);
  if (h < 0.0) {
    return (max(below * (1.0 - h / lowest_table_altitude(m)), 0.0) + 0.5) / n;
  }
  float margin = altitude_margin(m);
  float height = m.atmosphere_height_m;
  float x = clamp((h - margin) / (height - 2.0 * margin), 0.0, 1.0);
  if (t.parameterization == 0u) {
    x = sqrt(x);
  } else if (t.parameterization == 1u) {
    // Distance to the horizon: sqrt(r^2 - R^2), between those of the lowest and the highest texel.
    float R = m.planet_radius_m;
    float low = horizon_distance(margin, R);
    x = (horizon_distance(table_altitude(m, h), R) - low) / (horizon_distance(height - margin, R) - low);
  }
  return (below + x * (n - 1.0 - below) + 0.5) / n;
}

float altitude_from_u(IN(TableShape) t, IN(Medium) m, float u) {
  float margin = altitude_margin(m);
  float height = m.atmosphere_height_m;
  float below = texels_below_sea(t);
  float texel = u * float(t.altitudes) - 0.5;
  if (texel < below - 1.0e-3) {
    return lowest_table_altitude(m) * min(1.0 - texel / below, 1.0);
  }
  float x = clamp((texel - below) / (float(t.altitudes) - 1.0 - below), 0.0, 1.0);
  if (t.parameterization == 1u) {
    float R = m.planet_radius_m;
    float rho = mix(horizon_distance(margin, R), horizon_distance(height - margin, R), x);
    return clamp(rho * rho / (sqrt(R * R + rho * rho) + R), margin, height - margin);
  }
  if (t.parameterization == 0u) {
    x = x * x;
  }
  return margin + x * (height - 2.0 * margin);
}

// Longest way of a ray from altitude h to the top, less that to the horizon [m].
float distance_from_ground_to_top(IN(Medium) m, float h) {
  float ground = ground_below(h, m.planet_radius_m);
  float top = m.atmosphere_height_m;
  return sqrt((top - ground) * (2.0 * m.planet_radius_m + top + ground));
}

// Coordinate within one half of the view axis of n texels: x in [0; 1] counts from the horizon.
float v_from_half(bool below, float x, float n) {
  float v = (0.5 + x * (0.5 * n - 1.0)) / n;
  return below ? v : 0.5 + v;
}

// h is an altitude as from table_altitude.
float v_from_view(IN(TableShape) t, IN(Medium) m, float h, float mu, bool below) {
  float n = float(t.views);
  if (t.parameterization == 2u) {
    return texel_from_unit(0.5 * mu + 0.5, n);
  }
  float R = m.planet_radius_m;
  float horizon = ground_horizon_cos(h, R);
  if (t.parameterization == 0u) {
    float x = below ? (horizon - mu) / (horizon + 1.0) : (mu - horizon) / (1.0 - horizon);
    return v_from_half(below, pow(clamp(x, 0.0, 1.0), 0.2), n);
  }
  float rho = horizon_distance(h, R);
  float top = m.atmosphere_height_m;
  if (below) {
    float d = distance_to_ground(h, mu, R);
    // Texel 0 straight down, the last one at the horizon: counted from the horizon as in the other half.
    return v_from_half(true, clamp((rho - d) / (rho - (h - ground_below(h, R))), 0.0, 1.0), n);
  }
  float longest = rho + distance_from_ground_to_top(m, h);
  float d = distance_to_top(h, mu, top, R);
  return v_from_half(false, clamp((longest - d) / (longest - (top - h)), 0.0, 1.0), n);
}

float view_from_v(IN(TableShape) t, IN(Medium) m, float h, float v, OUT(bool) below) {
  float n = float(t.views);
  float R = m.planet_radius_m;
  if (t.parameterization == 2u) {
    float mu = 2.0 * unit_from_texel(v, n) - 1.0;
    below = ray_hits_ground(h, mu, R);
    return mu;
  }
  below = v < 0.5;
  float x = clamp(((below ? v : v - 0.5) * n - 0.5) / (0.5 * n - 1.0), 0.0, 1.0);
  float horizon = ground_horizon_cos(h, R);
  if (t.parameterization == 0u) {
    float x2 = x * x;
    float fifth = x2 * x2 * x;
    return below ? horizon - fifth * (horizon + 1.0) : horizon + fifth * (1.0 - horizon);
  }
  float rho = horizon_distance(h, R);
  float top = m.atmosphere_height_m;
  // Cosine of the ray that reaches the shell of altitude s at distance d: r_s^2 = r^2 + d^2 + 2 r d mu.
  float ground = ground_below(h, R);
  float shell = below ? ground : top;
  float longest = below ? rho : rho + distance_from_ground_to_top(m, h);
  float shortest = below ? h - ground : top - h;
  float d = max(longest - x * (longest - shortest), 1.0e-3);
  float mu = ((shell - h) * (2.0 * R + shell + h) - d * d) / (2.0 * (R + h) * d);
  return below ? clamp(mu, -1.0, horizon) : clamp(mu, horizon, 1.0);
}

float w_from_sun(IN(TableShape) t, float mu_s) {
  float x = 0.5 * mu_s + 0.5;
  if (t.parameterization == 0u) {
    x = (atan(max(mu_s, kLowestSun) * kSunShape) - kSunFrom) / (kSunTo - kSunFrom);
  } else if (t.parameterization == 1u) {
    x = (1.0 - exp(-kSunFade * (max(mu_s, kLowestSun) - kLowestSun))) / (1.0 - exp(-kSunFade * (1.0 - kLowestSun)));
  }
  return texel_from_unit(clamp(x, 0.0, 1.0), float(t.suns));
}

float sun_from_w(IN(TableShape) t, float w) {
  float x = unit_from_texel(w, float(t.suns));
  if (t.parameterization == 0u) {
    return clamp(tan(mix(kSunFrom, kSunTo, x)) / kSunShape, kLowestSun, 1.0);
  }
  if (t.parameterization == 1u) {
    float part = 1.0 - x * (1.0 - exp(-kSunFade * (1.0 - kLowestSun)));
    return clamp(kLowestSun - log(part) / kSunFade, kLowestSun, 1.0);
  }
  return 2.0 * x - 1.0;
}

float q_from_angle(IN(TableShape) t, float nu) {
  float x = 0.5 * nu + 0.5;
  if (t.parameterization == 0u) {
    x = acos(clamp(nu, -1.0, 1.0)) * 0.318309886183791;
  }
  return texel_from_unit(clamp(x, 0.0, 1.0), float(t.angles));
}

float angle_from_q(IN(TableShape) t, float q) {
  float x = unit_from_texel(q, float(t.angles));
  return t.parameterization == 0u ? cos(x * 3.14159265358979) : 2.0 * x - 1.0;
}

// The cosine to the sun that view and sun zenith angles allow, nearest to nu.
float possible_angle(float mu, float mu_s, float nu) {
  float spread = sqrt(max((1.0 - mu) * (1.0 + mu) * (1.0 - mu_s) * (1.0 + mu_s), 0.0));
  return clamp(nu, mu * mu_s - spread, mu * mu_s + spread);
}

#endif
