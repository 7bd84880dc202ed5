// Density integrals along rays in closed form, without a table and without marching. The density profiles continue
// below sea level. Occlusion by the planet is left to the caller.
//
// Exponential species: let q be the signed distance from the ray's perigee (q0 = r0 mu at its origin) and y the
// altitude gained. The density integral to infinity is exp(-h0 / H) times the integral of exp(-y(q) / H) dq.
// To first order y = (q^2 - q0^2) / (2 r0). With s = sqrt(2 r0 H) and p = q / s, the integral is exp(-h0 / H) s E(p0),
// where E(p) = exp(p^2) * integral from p of exp(-t^2) dt = sqrt(pi) / 2 erfcx(p).
// The next order in H / r0 multiplies this by 1 + c(p0) H / r0, where c is the mean of (p^2 - p0^2)^2 / 2, weighted by
// exp(-p^2), beyond p0. It runs from 3/8 (horizontal) to 1 (vertical).
// Rational functions are fitted to E and c, with relative errors of 5e-8 and 1.1e-3. The remaining error is of order
// 0.2 (H / r0)^2: 1e-4 for the worst supported planet (H = 20 km, r = 1000 km) and 3e-7 on Earth.
#ifndef TYNDALL_LIB_OPTICAL_DEPTH
#define TYNDALL_LIB_OPTICAL_DEPTH

#include "lib/geometry.glsl"
#include "lib/medium.glsl"

// Returns the density integral of one exponential species from altitude h0 to infinity [m], for an outward ray (q0 = r0
// mu >= 0).
float exponential_density_integral(float h0, float q0, float scale_height, float R) {
  float r0 = max(R + h0, scale_height);  // smaller only deep inside the planet
  float s = sqrt(2.0 * r0 * scale_height);
  float p = q0 / s;
  float e_above = 0.8862269642 + p * (1.1930734838 + p * (0.7531244636 + p * (0.2549023374 + p * 0.04060864678)));
  float e_below =
      1.0 + p * (2.4746223286 + p * (2.6420678442 + p * (1.5468079195 + p * (0.5098054906 + p * 0.08121729357))));
  float c_above = 0.3753936665 + p * (0.652352705 + p * 0.4259731527);
  float c_below = 1.0 + p * (0.6341824736 + p * 0.4259731527);
  float path = s * e_above * (c_below + c_above * scale_height / r0) / (e_below * c_below);
  return exp(min(-h0 / scale_height, 60.0)) * path;
}

// Returns the density integral of ozone along an outward piece of a ray from (ha, qa) to (hb, qb), on which the density
// is linear in altitude: 0 at h_zero and 1 at h_one. Uses four-point Lobatto quadrature.
float linear_density_integral(float ha, float qa, float hb, float qb, float h_zero, float h_one, float R) {
  if (hb <= ha) {
    return 0.0;
  }
  float span = (hb - ha) * (2.0 * R + ha + hb) / max(qa + qb, 1.0e-6);
  float ra = R + ha;
  float d1 = 0.276393202250021 * span;
  float d2 = 0.723606797749979 * span;
  float rise1 = d1 * (2.0 * qa + d1);
  float rise2 = d2 * (2.0 * qa + d2);
  float h1 = ha + rise1 / (sqrt(ra * ra + rise1) + ra);
  float h2 = ha + rise2 / (sqrt(ra * ra + rise2) + ra);
  float mean_altitude = (ha - h_zero + hb - h_zero + 5.0 * (h1 - h_zero + h2 - h_zero)) / 12.0;
  return span * mean_altitude / (h_one - h_zero);
}

// Returns the density integral of ozone along an outward path from altitude ha, with qa = ra mu >= 0, to altitude hb.
float ozone_density_integral(IN(Medium) m, float ha, float qa, float hb) {
  float low = m.ozone_centre_m - m.ozone_half_width_m;
  float high = m.ozone_centre_m + m.ozone_half_width_m;
  float h0 = max(ha, low);
  float h3 = min(hb, high);
  if (h3 <= h0) {
    return 0.0;
  }
  float R = m.planet_radius_m;
  float h1 = clamp(m.ozone_centre_m, h0, h3);
  float qa_squared = qa * qa;
  float q0 = sqrt(qa_squared + max((h0 - ha) * (2.0 * R + h0 + ha), 0.0));
  float q1 = sqrt(qa_squared + max((h1 - ha) * (2.0 * R + h1 + ha), 0.0));
  float q3 = sqrt(qa_squared + max((h3 - ha) * (2.0 * R + h3 + ha), 0.0));
  return linear_density_integral(h0, q0, h1, q1, low, m.ozone_centre_m, R) +
         linear_density_integral(h1, q1, h3, q3, high, m.ozone_centre_m, R);
}

// Returns whether one of the three kinks of the ozone profile lies between the altitudes low and high.
bool crosses_ozone_kink(IN(Medium) m, float low, float high) {
  float low_distance = low - m.ozone_centre_m;
  float high_distance = high - m.ozone_centre_m;
  float w = m.ozone_half_width_m;
  return (low_distance < -w && high_distance > -w) || (low_distance < 0.0 && high_distance > 0.0) ||
         (low_distance < w && high_distance > w);
}

// Returns the density integrals of the three species between the altitudes ha and hb, at distances da < db from the
// origin of the ray (h0, mu). The whole interval must lie within the atmosphere.
vec3 density_integral_between(IN(Medium) m, float h0, float mu, float da, float ha, float db, float hb) {
  float R = m.planet_radius_m;
  float q0 = (R + h0) * mu;
  float qa = q0 + da;
  float qb = q0 + db;
  // A ray along the horizon ends at its perigee exactly: qb is 0.
  bool passes_perigee = qa < 0.0 && qb >= 0.0;
  float hp = min(ha, hb);  // the lowest altitude on the way
  if (passes_perigee) {
    float ra = R + ha;
    hp = min(hp, ha - qa * qa / (ra + sqrt(max((ra - qa) * (ra + qa), 0.0))));
  }
  float highest = max(ha, hb);

  float span = db - da;
  float scale = min(m.rayleigh_scale_height_m, m.mie_scale_height_m);
  bool is_short = abs(hb - ha) < scale && span * span < 2.0 * (R + ha) * scale;
  // Integrate ozone numerically where its profile is smooth, or where subtracting the altitudes would cancel.
  bool smooth_ozone = is_short && (highest - hp < 1.0e-4 * m.ozone_half_width_m || !crosses_ozone_kink(m, hp, highest));

  float ozone = 0.0;
  if (!smooth_ozone && highest > m.ozone_centre_m - m.ozone_half_width_m) {
    // Divide the ray into paths along which altitude increases: one from the lower end, or two from the perigee.
    float from = passes_perigee ? hp : qa >= 0.0 ? ha : hb;
    float q = passes_perigee ? 0.0 : abs(qa >= 0.0 ? qa : qb);
    float to = passes_perigee || qa < 0.0 ? ha : hb;
    int parts = passes_perigee ? 2 : 1;
    for (int part = 0; part < parts; ++part) {
      ozone += ozone_density_integral(m, from, q, part == 0 ? to : hb);
    }
  }

  if (is_short) {
    // The closed form would subtract nearly equal numbers. Use three-point Gauss-Legendre quadrature instead.
    float middle = 0.5 * (da + db);
    float offset = 0.387298334620742 * span;
    vec3 centre = densities(m, min(altitude_along(h0, mu, middle, R), m.atmosphere_height_m));
    vec3 sides = densities(m, min(altitude_along(h0, mu, middle - offset, R), m.atmosphere_height_m)) +
                 densities(m, min(altitude_along(h0, mu, middle + offset, R), m.atmosphere_height_m));
    vec3 integral = (8.0 * centre + 5.0 * sides) * (span / 18.0);
    return vec3(integral.x, integral.y, smooth_ozone ? integral.z : ozone);
  }

  float rayleigh_a = exponential_density_integral(ha, abs(qa), m.rayleigh_scale_height_m, R);
  float rayleigh_b = exponential_density_integral(hb, abs(qb), m.rayleigh_scale_height_m, R);
  float mie_a = exponential_density_integral(ha, abs(qa), m.mie_scale_height_m, R);
  float mie_b = exponential_density_integral(hb, abs(qb), m.mie_scale_height_m, R);
  float rayleigh = (qa < 0.0 ? -rayleigh_a : rayleigh_a) - (qb < 0.0 ? -rayleigh_b : rayleigh_b);
  float mie = (qa < 0.0 ? -mie_a : mie_a) - (qb < 0.0 ? -mie_b : mie_b);
  if (passes_perigee) {
    rayleigh += 2.0 * exponential_density_integral(hp, 0.0, m.rayleigh_scale_height_m, R);
    mie += 2.0 * exponential_density_integral(hp, 0.0, m.mie_scale_height_m, R);
  }
  return vec3(max(rayleigh, 0.0), max(mie, 0.0), ozone);
}

// Returns the density integrals from altitude h along cosine mu over the distance d. The part of the path above the top
// of the atmosphere contributes nothing.
vec3 density_integral_along(IN(Medium) m, float h, float mu, float d) {
  float top = m.atmosphere_height_m;
  float near;
  float far;
  if (!shell_intersections(h, mu, top, m.planet_radius_m, near, far)) {
    return vec3(0.0);
  }
  bool outside = h > top;
  float da = outside ? max(near, 0.0) : 0.0;
  float db = min(d, far);
  if (db <= da) {
    return vec3(0.0);
  }
  float ha = outside ? top : h;
  float hb = d < far ? min(altitude_along(h, mu, d, m.planet_radius_m), top) : top;
  return density_integral_between(m, h, mu, da, ha, db, hb);
}

// Returns the density integrals from altitude h along cosine mu to the top of the atmosphere, ignoring the planet.
vec3 density_integral_to_top(IN(Medium) m, float h, float mu) { return density_integral_along(m, h, mu, 1.0e30); }

#endif
