// The mapping between a ray and its coordinates in the scattering tables. Each of the four axes has a pair of functions
// that convert between its quantity and a coordinate in [0; 1] over the texels. There are three parameterisations:
//   yusov    - Yusov, "High Performance Outdoor Light Scattering Using Epipolar Sampling" (2013), section 2. The view
//              axis is the fifth root of the distance from the horizon in cosine, the sun axis Bruneton's arctangent.
//              Two axes differ from the publication. Altitude is a fourth power of the coordinate: its spacing is 400 m
//              at 1 km, where the published square has 600 m, over which the light of a low sun in turbid air changes
//              several times. The spacing of the angle between view and sun grows slowly from the sun. The published
//              power of 3/2 leaves 30 degrees between the texels around 90 degrees, and triples the errors of twilight.
//   bruneton - Bruneton and Neyret, "Precomputed Atmospheric Scattering" (2008), section 4: the distances to the
//              horizon and to the boundary, an exponential for the sun, and the cosine of the angle to the sun.
//   linear   - altitude and the three cosines.
// In the first two, one half of the view axis is for rays that end on the ground (`below`) and the other for rays that
// leave the atmosphere. Filtering never crosses the horizon.
#ifndef TYNDALL_LIB_TABLE_MAPPING
#define TYNDALL_LIB_TABLE_MAPPING

#include "lib/optical_depth.glsl"
#include "shared/medium.h"
#include "shared/tables.h"

// Rays that begin nearer than this to the ground or the top are looked up as if they began at this distance from it
// [m].
const float kTableMargin = 16.0;
// The lowest altitude of the tables [m]. Rays that begin below it are looked up as if they began at this altitude.
const float kLowestTableAltitude = -500.0;
// Offset in the fourth power that spaces altitudes (altitude_share()). It prevents texels from crowding at the ground:
// the lowest ones are 90 m apart with the default size.
const float kAltitudeOffset = 0.25;
// Spacing of the yusov mapping of the angle between view and sun beside the sun, relative to the mean spacing.
const float kAngleDensity = 0.8;
// The cosine of the lowest sun, which is 16 degrees below the horizontal. In twilight, the sun can be this low at the
// density-weighted mean distance of a ray that begins high up. (The gathering grid ends 11 degrees below the
// horizontal, because it uses the sun at the beginning of a ray.)
const float kLowestSun = -0.28;
// The yusov mapping of the sun: the arctangent of kSunShape times the cosine, which lies in [kSunFrom; kSunTo].
const float kSunShape = 5.3496235;  // tan(1.26 * 1.1)
const float kSunFrom = -0.982145272;
const float kSunTo = 1.386;
// The decay rate of the exponential in the bruneton mapping of the sun.
const float kSunFade = 3.0;

// Returns the texture coordinate over n texels for x in [0; 1], where 0 and 1 map to texel centres.
float texel_from_unit(float x, float n) { return (x * (n - 1.0) + 0.5) / n; }
float unit_from_texel(float c, float n) { return clamp((c * n - 0.5) / (n - 1.0), 0.0, 1.0); }

// Returns the altitude relative to the height of the atmosphere for a coordinate in [0; 1], and the reverse. The
// spacing grows with the third power of the coordinate.
float altitude_share(float x) {
  float low = kAltitudeOffset * kAltitudeOffset;
  float high = (1.0 + kAltitudeOffset) * (1.0 + kAltitudeOffset);
  float squared = (x + kAltitudeOffset) * (x + kAltitudeOffset);
  return (squared * squared - low * low) / (high * high - low * low);
}
float altitude_coordinate(float share) {
  float low = kAltitudeOffset * kAltitudeOffset;
  float high = (1.0 + kAltitudeOffset) * (1.0 + kAltitudeOffset);
  return sqrt(sqrt(share * (high * high - low * low) + low * low)) - kAltitudeOffset;
}

// Maps [0; 1] to itself such that the slope is `density` at 0 and grows linearly, and the reverse.
float spread_from_unit(float x, float density) { return x * (density + (1.0 - density) * x); }
float unit_from_spread(float y, float density) {
  return (sqrt(density * density + 4.0 * (1.0 - density) * y) - density) / (2.0 * (1.0 - density));
}

float altitude_margin(IN(Medium) m) { return min(kTableMargin, 0.01 * m.atmosphere_height_m); }

float lowest_table_altitude(IN(Medium) m) { return max(kLowestTableAltitude, -0.125 * m.planet_radius_m); }

// Returns the number of texels below sea level along the altitude axis. They are evenly spaced. The altitude of the
// next texel is the margin above sea level.
float texels_below_sea(IN(TableShape) t) { return float(min(t.altitudes / 10u, 3u)); }

// Returns the altitude at which the tables are looked up for h. On either side of sea level, it is at least
// altitude_margin() away.
float table_altitude(IN(Medium) m, float h) {
  float margin = altitude_margin(m);
  return h < 0.0 ? clamp(h, lowest_table_altitude(m), -margin) : clamp(h, margin, m.atmosphere_height_m - margin);
}

// Returns the distance from altitude h to the horizon of ground_below() [m].
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
  if (t.parameterization == kYusovMapping) {
    x = altitude_coordinate(x);
  } else if (t.parameterization == kBrunetonMapping) {
    // The distance to the horizon, sqrt(r^2 - R^2), relative to those of the lowest and highest texels.
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
  if (t.parameterization == kBrunetonMapping) {
    float R = m.planet_radius_m;
    float rho = mix(horizon_distance(margin, R), horizon_distance(height - margin, R), x);
    return clamp(rho * rho / (sqrt(R * R + rho * rho) + R), margin, height - margin);
  }
  if (t.parameterization == kYusovMapping) {
    x = altitude_share(x);
  }
  return margin + x * (height - 2.0 * margin);
}

// The interpolation between two altitudes follows sunlight, because the value of a texel is the fourth root of a mean
// of sunlight along the ray. In turbid air under a low sun, sunlight changes several times between two texels, and
// weights that are linear in the coordinate have errors of up to 30 %. The weights are therefore linear in the fourth
// root of the aerosol's transmittance towards the sun. A small part of them is linear in the coordinate. It dominates
// where there is little aerosol.
const float kLinearPart = 0.04;  // per scale height of the aerosol
// The cosine of the lowest sun whose transmittance is used. The light of lower suns comes from higher altitudes.
const float kLowestWeighingSun = 0.015;

// Returns the fourth root of the aerosol's transmittance from altitude h towards the sun. quarter_depth is a quarter of
// its optical depth from sea level.
float sunlight_root(IN(Medium) m, float h, float quarter_depth) {
  return exp(-quarter_depth * exp(min(-h / m.mie_scale_height_m, 60.0)));
}

// Returns the coordinate of altitude h for a look-up, where mu_s is the cosine of the sun's zenith angle in the table.
// It equals u_from_altitude() at the texels, and moves the weights of the linear filter between them.
float u_for_lookup(IN(TableShape) t, IN(Medium) m, float h, float mu_s) {
  float n = float(t.altitudes);
  float texel = u_from_altitude(t, m, h) * n - 0.5;
  float first = clamp(floor(texel), 0.0, n - 2.0);
  float low = altitude_from_u(t, m, (first + 0.5) / n);
  // For rays from below sea level, the texel above them means sea level itself (table_altitude()).
  float high = first + 1.0 == texels_below_sea(t) ? 0.0 : altitude_from_u(t, m, (first + 1.5) / n);
  float R = m.planet_radius_m;
  float extinction = LARGEST(MIE_EXTINCTION(m));
  float integral = exponential_density_integral(0.0, max(mu_s, kLowestWeighingSun) * R, m.mie_scale_height_m, R);
  float quarter_depth = 0.25 * extinction * integral;
  float root = sunlight_root(m, low, quarter_depth);
  float linear = kLinearPart * (high - low) / m.mie_scale_height_m;
  float whole = sunlight_root(m, high, quarter_depth) - root + linear;
  float part = sunlight_root(m, h, quarter_depth) - root + linear * (texel - first);
  return (first + 0.5 + clamp(part / max(whole, 1.0e-9), 0.0, 1.0)) / n;
}

// Returns the longest path of a ray from altitude h to the top, minus the distance to the horizon [m].
float distance_from_ground_to_top(IN(Medium) m, float h) {
  float ground = ground_below(h, m.planet_radius_m);
  float top = m.atmosphere_height_m;
  return sqrt((top - ground) * (2.0 * m.planet_radius_m + top + ground));
}

// Returns the coordinate within one half of the view axis of n texels. x in [0; 1] is counted from the horizon.
float v_from_half(bool below, float x, float n) {
  float v = (0.5 + x * (0.5 * n - 1.0)) / n;
  return below ? v : 0.5 + v;
}

// Returns the view coordinate of a ray. h must be an altitude from table_altitude().
float v_from_view(IN(TableShape) t, IN(Medium) m, float h, float mu, bool below) {
  float n = float(t.views);
  if (t.parameterization == kLinearMapping) {
    return texel_from_unit(0.5 * mu + 0.5, n);
  }
  float R = m.planet_radius_m;
  float horizon = ground_horizon_cos(h, R);
  if (t.parameterization == kYusovMapping) {
    float x = below ? (horizon - mu) / (horizon + 1.0) : (mu - horizon) / (1.0 - horizon);
    return v_from_half(below, pow(clamp(x, 0.0, 1.0), 0.2), n);
  }
  float rho = horizon_distance(h, R);
  float top = m.atmosphere_height_m;
  if (below) {
    float d = distance_to_ground(h, mu, R);
    // The first texel looks straight down, the last one at the horizon: x is counted from the horizon as above it.
    return v_from_half(true, clamp((rho - d) / (rho - (h - ground_below(h, R))), 0.0, 1.0), n);
  }
  float longest = rho + distance_from_ground_to_top(m, h);
  float d = distance_to_top(h, mu, top, R);
  return v_from_half(false, clamp((longest - d) / (longest - (top - h)), 0.0, 1.0), n);
}

float view_from_v(IN(TableShape) t, IN(Medium) m, float h, float v, OUT(bool) below) {
  float n = float(t.views);
  float R = m.planet_radius_m;
  if (t.parameterization == kLinearMapping) {
    float mu = 2.0 * unit_from_texel(v, n) - 1.0;
    below = ray_hits_ground(h, mu, R);
    return mu;
  }
  below = v < 0.5;
  float x = clamp(((below ? v : v - 0.5) * n - 0.5) / (0.5 * n - 1.0), 0.0, 1.0);
  float horizon = ground_horizon_cos(h, R);
  if (t.parameterization == kYusovMapping) {
    float x2 = x * x;
    float fifth = x2 * x2 * x;
    return below ? horizon - fifth * (horizon + 1.0) : horizon + fifth * (1.0 - horizon);
  }
  float rho = horizon_distance(h, R);
  float top = m.atmosphere_height_m;
  // The cosine of the ray that reaches the shell of altitude s at distance d, from r_s^2 = r^2 + d^2 + 2 r d mu.
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
  if (t.parameterization == kYusovMapping) {
    x = (atan(max(mu_s, kLowestSun) * kSunShape) - kSunFrom) / (kSunTo - kSunFrom);
  } else if (t.parameterization == kBrunetonMapping) {
    x = (1.0 - exp(-kSunFade * (max(mu_s, kLowestSun) - kLowestSun))) / (1.0 - exp(-kSunFade * (1.0 - kLowestSun)));
  }
  return texel_from_unit(clamp(x, 0.0, 1.0), float(t.suns));
}

float sun_from_w(IN(TableShape) t, float w) {
  float x = unit_from_texel(w, float(t.suns));
  if (t.parameterization == kYusovMapping) {
    return clamp(tan(mix(kSunFrom, kSunTo, x)) / kSunShape, kLowestSun, 1.0);
  }
  if (t.parameterization == kBrunetonMapping) {
    float part = 1.0 - x * (1.0 - exp(-kSunFade * (1.0 - kLowestSun)));
    return clamp(kLowestSun - log(part) / kSunFade, kLowestSun, 1.0);
  }
  return 2.0 * x - 1.0;
}

float q_from_angle(IN(TableShape) t, float nu) {
  float x = 0.5 * nu + 0.5;
  if (t.parameterization == kYusovMapping) {
    x = unit_from_spread(acos(clamp(nu, -1.0, 1.0)) * 0.318309886183791, kAngleDensity);
  }
  return texel_from_unit(clamp(x, 0.0, 1.0), float(t.angles));
}

float angle_from_q(IN(TableShape) t, float q) {
  float x = unit_from_texel(q, float(t.angles));
  return t.parameterization == kYusovMapping ? cos(spread_from_unit(x, kAngleDensity) * 3.14159265358979)
                                             : 2.0 * x - 1.0;
}

#endif
