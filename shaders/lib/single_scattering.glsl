// Single scattering along a ray, lit by a point-sized sun, over black ground: radiance / E0 [1/sr].
// The ray is split where it enters and leaves the planet's shadow, a half-infinite cylinder. Each lit part is divided
// into panels that resolve the integrand: in altitude relative to the scale heights, in optical depth from the camera
// and, near the terminator, in the perigee altitude of the sun ray. Each panel uses four-point Gauss-Legendre
// quadrature with closed-form transmittances.
// A ray is (h0, mu, mu_s, nu): the altitude of its origin, the cosines of the view and sun zenith angles there, and the
// cosine of the angle between the view direction and the sun.
#ifndef TYNDALL_LIB_SINGLE_SCATTERING
#define TYNDALL_LIB_SINGLE_SCATTERING

#include "lib/optical_depth.glsl"
#include "lib/phase.glsl"

// Computes the part of the ray's infinite line that lies in the planet's shadow, as distances start <= end. Returns
// false if there is none. Solves r^2 - z^2 < R^2 with z = r0 mu_s + d nu < 0 as a quadratic in d, without squared
// radii.
bool shadow_segment(float h0, float mu, float mu_s, float nu, float R, OUT(float) start, OUT(float) end) {
  start = 0.0;
  end = 0.0;
  float r0 = R + h0;
  float z0 = r0 * mu_s;
  float a = (1.0 - nu) * (1.0 + nu);
  float b = r0 * (mu - mu_s * nu);
  float c = h0 * (2.0 * R + h0) - z0 * z0;
  float low = -1.0e30;
  float high = 1.0e30;
  if (a > 1.0e-12) {
    float discriminant = b * b - a * c;
    if (discriminant <= 0.0) {
      return false;
    }
    float root = sqrt(discriminant);
    if (b > 0.0) {
      low = -(b + root) / a;
      high = -c / (b + root);
    } else {
      high = (root - b) / a;
      low = root - b > 0.0 ? c / (root - b) : 0.0;
    }
  } else if (c >= 0.0) {
    return false;  // parallel to the cylinder's axis and outside of it
  }
  // The shadow exists only behind the planet, where z < 0.
  if (nu > 0.0) {
    high = min(high, -z0 / nu);
  } else if (nu < 0.0) {
    low = max(low, -z0 / nu);
  } else if (z0 >= 0.0) {
    return false;
  }
  start = low;
  end = high;
  return high > low;
}

// Returns the length of the next panel, which begins at distance d. fineness = 1 gives the panels that `probe` uses;
// smaller values give shorter ones. tau_from_start is the optical depth already crossed in this lit part, in the
// densest channel.
float panel_length(IN(Medium) m, float h0, float mu, float mu_s, float nu, float d, float fineness,
                   float tau_from_start) {
  float R = m.planet_radius_m;
  float h = altitude_along(h0, mu, d, R);
  float r = max(R + h, 1.0);
  float mu_d = cos_zenith_along(h0, mu, d, R);
  float small_scale = min(m.rayleigh_scale_height_m, m.mie_scale_height_m);
  float large_scale = max(m.rayleigh_scale_height_m, m.mie_scale_height_m);

  // Limit by altitude: a fraction of the smaller scale height near the ground, growing geometrically upwards.
  float step_h = fineness * (small_scale + 0.3333 * max(h, 0.0));
  if (mu_d < 0.0) {
    step_h = step_h / (1.0 + 0.3333 * fineness);
  }
  step_h = min(step_h, 3.0 * fineness * large_scale);
  float steepness = abs(mu_d);
  float span = 2.0 * step_h / (steepness + sqrt(steepness * steepness + 2.0 * step_h / r));

  // Limit by optical depth from the camera, with the extinction at the panel's lower end.
  float h_dense = mu_d < 0.0 ? h - min(steepness * span, step_h) : h;
  Spectrum extinction = extinction_at(m, h_dense);
  float densest = LARGEST(extinction);
  span = min(span, fineness * 1.5 * (1.0 + 0.25 * tau_from_start) / max(densest, 1.0e-30));

  // Limit by the change of the sun's transmittance: by its optical depth, by z near the horizontal and, below the
  // horizontal, by the perigee altitude of the sun ray.
  float z = r * clamp(((R + h0) * mu_s + d * nu) / r, -1.0, 1.0);
  float axis_scale = sqrt(2.0 * r * small_scale);
  float sun_slope = max(densest * steepness * r / (abs(z) + axis_scale), 1.0e-30);
  span = min(span, fineness * 2.0 / sun_slope);
  span = min(span, fineness * 0.5 * (axis_scale + abs(z)) / max(abs(nu), 1.0e-6));
  if (z < 0.0) {
    float h_sun = h - z * z / (r + sqrt(max((r - z) * (r + z), 0.0)));
    float step_sun = fineness * 0.5 * (small_scale + 0.3333 * max(h_sun, 0.0));
    float slope = abs(mu_d * r - nu * z) / R;
    float curvature = (1.0 - nu) * (1.0 + nu) / R;
    span = min(span, 2.0 * step_sun / (slope + sqrt(slope * slope + 2.0 * step_sun * curvature) + 1.0e-12));
  }
  return span;
}

// Returns the single scattering of the lit part [start, end] of the ray. `steps` is as in single_scattering().
Spectrum lit_scattering(IN(Medium) m, float h0, float mu, float mu_s, float nu, float start, float end, int steps) {
  float fineness = 12.0 / float(max(steps, 1));
  int max_panels = 8 + 6 * steps;
  float R = m.planet_radius_m;
  Spectrum rayleigh = RAYLEIGH_SCATTERING(m) * rayleigh_phase(nu);
  Spectrum mie = mie_scattering_towards(m, nu);
  vec4 node = vec4(0.069431844202974, 0.330009478207572, 0.669990521792428, 0.930568155797026);
  vec4 weight = vec4(0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727);
  Spectrum radiance = Spectrum(0.0);
  float d = start;
  float tau = 0.0;
  for (int panel = 0; panel < max_panels; ++panel) {
    float left = end - d;
    if (left <= 0.0 || tau > 40.0) {
      break;
    }
    float span = panel_length(m, h0, mu, mu_s, nu, d, fineness, tau);
    span = max(span, left / float(max_panels - panel));
    if (span > 0.9 * left) {
      span = left;
    } else if (span > 0.5 * left) {
      span = 0.5 * left;
    }
    for (int i = 0; i < 4; ++i) {
      float x = d + node[i] * span;
      float h = altitude_along(h0, mu, x, R);
      float sun = clamp(((R + h0) * mu_s + x * nu) / max(R + h, 1.0), -1.0, 1.0);
      vec3 integral = density_integral_along(m, h0, mu, x) + density_integral_to_top(m, h, sun);
      vec3 density = densities(m, h);
      radiance += weight[i] * span * transmittance(m, integral) * (rayleigh * density.x + mie * density.y);
    }
    Spectrum crossed =
        optical_depth(m, density_integral_along(m, altitude_along(h0, mu, d, R), cos_zenith_along(h0, mu, d, R), span));
    tau += LARGEST(crossed);
    d = span < left ? d + span : end;
  }
  return radiance;
}

// Returns radiance / E0 of the part [start, end] of the ray [m] as seen from its origin. `steps` is roughly the number
// of panels for a ray through the whole atmosphere: 12 gives an error of 0.1 %, 4 about one per cent.
Spectrum single_scattering(IN(Medium) m, float h0, float mu, float mu_s, float nu, float start, float end, int steps) {
  float shadow_start;
  float shadow_end;
  float first_end = end;
  float second_start = end;
  if (shadow_segment(h0, mu, mu_s, nu, m.planet_radius_m, shadow_start, shadow_end)) {
    first_end = clamp(shadow_start, start, end);
    second_start = clamp(shadow_end, start, end);
  }
  Spectrum radiance = Spectrum(0.0);
  for (int part = 0; part < 2; ++part) {
    float a = part == 0 ? start : second_start;
    float b = part == 0 ? first_end : end;
    if (b > a) {
      radiance += lit_scattering(m, h0, mu, mu_s, nu, a, b, steps);
    }
  }
  return radiance;
}

// Returns radiance / E0 of the ray up to the ground or the top of the atmosphere, and the transmittance to that end.
Spectrum single_scattering_to_end(IN(Medium) m, float h0, float mu, float mu_s, float nu, int steps,
                                  OUT(Spectrum) transmittance_to_end) {
  float start;
  float end;
  bool hits_ground;
  transmittance_to_end = Spectrum(1.0);
  if (!atmosphere_segment(h0, mu, m.atmosphere_height_m, m.planet_radius_m, start, end, hits_ground)) {
    return Spectrum(0.0);
  }
  transmittance_to_end = transmittance(m, density_integral_along(m, h0, mu, end));
  return single_scattering(m, h0, mu, mu_s, nu, start, end, steps);
}

#endif
