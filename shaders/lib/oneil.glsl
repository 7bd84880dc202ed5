// O'Neil, "Accurate Atmospheric Scattering", GPU Gems 2 (2005), chapter 16: light scattered once, by the midpoint
// rule with few points on the ray, and with columns of air that are not integrated but come from a function of
// altitude and angle: the scale function, or the table that preceded it (O'Neil 2004). Two species with a scale
// height each; no ozone. x of a vec2 is Rayleigh, y the aerosol; columns in m of air as at sea level.
//
// As printed, one polynomial answers for every angle, downwards as well. Here (kOneilComputed) it is fitted to
// the planet, and asked for outward rays only: the column of a ray that comes down is that of its way back, and
// one that passes its lowest point is put together from two. docs/oneil.md has the equations.
#ifndef TYNDALL_LIB_ONEIL
#define TYNDALL_LIB_ONEIL

#include "lib/geometry.glsl"
#include "lib/phase.glsl"
#include "lib/single_scattering.glsl"
#include "shared/oneil.h"

const uint kOneilComputed = 0u;   // scale function fitted to planet and scale heights
const uint kOneilPublished = 1u;  // the polynomial and the equations as printed
const uint kOneilTable = 2u;      // altitude times angle

const uint kOneilUniform = 0u;    // points evenly along the ray, as printed
const uint kOneilByDensity = 1u;  // points where most of the air is that can be seen

// GLSL may give these as constants: of a variable CPU devices go both ways, and the search for places of points is most
// of the work.
#ifndef ONEIL_INTEGRAL_METHOD
#define ONEIL_INTEGRAL_METHOD(o) o.integral_method
#define ONEIL_SPACING(o) o.spacing
#endif

// The table: GLSL reads a buffer by ONEIL_TEXEL, C++ passes a pointer.
#ifndef ONEIL_TABLE
#define ONEIL_TABLE uint
#endif
#ifndef ONEIL_TEXEL
#define ONEIL_TEXEL(table, index) vec4(0.0)
#endif

// Column from sea level outwards to infinity [m] under the cosine c to the vertical. bend stretches the axis
// where thin air on a large planet makes the function steep; 0 is the printed form, and c may be negative
// then.
float oneil_scale(IN(OneilScale) s, float c) {
  float b = 1.0 / (1.0 + s.bend * c);
  float x = (1.0 - c) * b;
  return s.scale_height_m * (1.0 + s.bend) * b * exp(s.k0 + x * (s.k1 + x * (s.k2 + x * (s.k3 + x * s.k4))));
}

// The same from altitude h >= 0, c >= 0, over a planet of radius R. Seen from the centre the air is as curved
// as at sea level once lengths along the horizon shrink by sqrt(r / R); what is left out is of the order of the
// scale height over R.
float oneil_outward(IN(OneilScale) s, float h, float c, float R) {
  float stretch = sqrt(1.0 + h / R);
  return exp(min(-h / s.scale_height_m, 60.0)) * stretch * oneil_scale(s, c * stretch);
}

// Entry of the table: x density and y column of Rayleigh scattering, zw of the aerosol. Altitude and cosine are
// spread by their square roots over it, because both matter most near 0. Columns end at the top.
vec4 oneil_table(IN(Oneil) o, ONEIL_TABLE table, float h, float c, float top) {
  float last = float(o.table_size - 1u);
  float u = sqrt(clamp(h / top, 0.0, 1.0)) * last;
  float v = sqrt(clamp(c, 0.0, 1.0)) * last;
  uint i = min(uint(u), o.table_size - 2u);
  uint j = min(uint(v), o.table_size - 2u);
  float fu = u - float(i);
  float fv = v - float(j);
  uint at = j * o.table_size + i;
  vec4 low = mix(ONEIL_TEXEL(table, at), ONEIL_TEXEL(table, at + 1u), fu);
  vec4 high = mix(ONEIL_TEXEL(table, at + o.table_size), ONEIL_TEXEL(table, at + o.table_size + 1u), fu);
  return mix(low, high, fv);
}

vec2 oneil_densities(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, float h) {
  if (ONEIL_INTEGRAL_METHOD(o) == kOneilTable) {
    vec4 entry = oneil_table(o, table, h, 1.0, m.atmosphere_height_m);
    return vec2(entry.x, entry.z);
  }
  return vec2(exp(min(-h / o.rayleigh.scale_height_m, 60.0)), exp(min(-h / o.mie.scale_height_m, 60.0)));
}

// Column outwards from altitude h under c; c >= 0 but with the printed function.
vec2 oneil_density_integral(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, float h, float c) {
  if (ONEIL_INTEGRAL_METHOD(o) == kOneilTable) {
    vec4 entry = oneil_table(o, table, h, c, m.atmosphere_height_m);
    return vec2(entry.y, entry.w);
  }
  if (ONEIL_INTEGRAL_METHOD(o) == kOneilPublished) {
    return oneil_densities(m, o, table, h) * vec2(oneil_scale(o.rayleigh, c), oneil_scale(o.mie, c));
  }
  float R = m.planet_radius_m;
  float above = max(h, 0.0);
  return vec2(oneil_outward(o.rayleigh, above, c, R), oneil_outward(o.mie, above, c, R));
}

// Column between two points of a ray at altitudes ha and hb, where the signed distances from its lowest point
// are qa < qb; that point is at altitude hp. For the printed function `reversed` says that the ray's end is
// below its beginning: columns are then looked up towards the beginning.
vec2 oneil_density_integral_between(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, float qa, float ha, float qb,
                                    float hb, float hp, bool reversed) {
  float R = m.planet_radius_m;
  float ca = clamp(qa / (R + ha), -1.0, 1.0);
  float cb = clamp(qb / (R + hb), -1.0, 1.0);
  if (ONEIL_INTEGRAL_METHOD(o) == kOneilPublished) {
    return reversed ? oneil_density_integral(m, o, table, hb, -cb) - oneil_density_integral(m, o, table, ha, -ca)
                    : oneil_density_integral(m, o, table, ha, ca) - oneil_density_integral(m, o, table, hb, cb);
  }
  vec2 a = oneil_density_integral(m, o, table, ha, abs(ca));
  vec2 b = oneil_density_integral(m, o, table, hb, abs(cb));
  vec2 column = a - b;
  if (qb <= 0.0) {
    column = b - a;
  } else if (qa < 0.0) {
    column = 2.0 * oneil_density_integral(m, o, table, hp, 0.0) - a - b;
  }
  return max(column, vec2(0.0));
}

// Column from altitude h towards the sun at cosine c; the planet is no obstacle.
vec2 oneil_sun_density_integral(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, float h, float c) {
  if (c >= 0.0 || ONEIL_INTEGRAL_METHOD(o) == kOneilPublished) {
    return oneil_density_integral(m, o, table, h, c);
  }
  float lowest = max(perigee_altitude(h, c, m.planet_radius_m), 0.0);
  return 2.0 * oneil_density_integral(m, o, table, lowest, 0.0) - oneil_density_integral(m, o, table, h, -c);
}

// On other planets than its own the printed function makes columns negative without bound.
vec3 oneil_transmittance(IN(Medium) m, vec2 column) {
  return exp(min(-(m.rayleigh_scattering * column.x + m.mie_extinction * column.y), vec3(40.0)));
}

// Of the sun's light to altitude h; 0 where the planet hides it, but with the printed function, which grows
// instead.
vec3 oneil_sunlight(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, float h, float c) {
  float visible = ONEIL_INTEGRAL_METHOD(o) == kOneilPublished ? 1.0 : sun_visibility(h, c, m.planet_radius_m);
  return visible * oneil_transmittance(m, oneil_sun_density_integral(m, o, table, h, c));
}

// A distance in [from, to] of the ray by which `share` of its air between the two has been crossed: the mean of
// the shares of both species, whose columns from `from` to `to` are `whole`, and a part `even` of the length. Newton's
// method in a bracket that shrinks; it comes from one side when `guess` lies between the densest air and the answer. To
// `tolerance` in the share.
float oneil_place(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, float h0, float mu, float hp, float from, float to,
                  vec2 whole, float even, float share, float tolerance, float guess) {
  float R = m.planet_radius_m;
  float q0 = (R + h0) * mu;
  float h_from = min(altitude_along(h0, mu, from, R), m.atmosphere_height_m);
  float low = from;
  float high = to;
  float d = guess;
  for (int i = 0; i < 12; ++i) {
    float h = min(altitude_along(h0, mu, d, R), m.atmosphere_height_m);
    vec2 crossed = oneil_density_integral_between(m, o, table, q0 + from, h_from, q0 + d, h, hp, false) / whole;
    vec2 slope = oneil_densities(m, o, table, h) / whole;
    float missing = share - even * (d - from) / (to - from) - (0.5 - 0.5 * even) * (crossed.x + crossed.y);
    if (abs(missing) < tolerance) {
      break;
    }
    if (missing > 0.0) {
      low = d;
    } else {
      high = d;
    }
    float next = d + missing / max((0.5 - 0.5 * even) * (slope.x + slope.y) + even / (to - from), 1.0e-30);
    d = next > low && next < high ? next : 0.5 * (low + high);
  }
  return d;
}

// Share of the air before which a fraction `seen` of what an eye sees of it lies, if the air between the eye and all
// of it has this optical depth.
float oneil_seen(float seen, float depth) {
  return depth > 0.01 ? -log(max(1.0 - seen, 0.0) + seen * exp(-depth)) / depth : seen;
}

// Light of the part [start, end] of the ray (h0, mu, mu_s, nu: see single_scattering), which begins and ends in
// the air, but for the phase functions: radiance / E0 is rayleigh times p_R(nu) plus mie times p_M(nu); and the
// transmittance of that part. The points are spread over what the sun reaches (as printed: evenly over the
// part).
void oneil_scattering(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, float h0, float mu, float mu_s, float nu,
                      float start, float end, OUT(vec3) rayleigh, OUT(vec3) mie, OUT(vec3) through) {
  float R = m.planet_radius_m;
  float top = m.atmosphere_height_m;
  float q0 = (R + h0) * mu;
  float hp = perigee_altitude(h0, mu, R);
  float ha = min(altitude_along(h0, mu, start, R), top);
  float hb = min(altitude_along(h0, mu, end, R), top);
  bool reversed = hb < ha - 1.0e-4 * top;  // more than a rounding error: from top to top is not
  rayleigh = vec3(0.0);
  mie = vec3(0.0);
  through =
      oneil_transmittance(m, oneil_density_integral_between(m, o, table, q0 + start, ha, q0 + end, hb, hp, reversed));

  float first_end = end;
  float second_start = end;
  float dark_start;
  float dark_end;
  if (ONEIL_INTEGRAL_METHOD(o) != kOneilPublished && shadow_segment(h0, mu, mu_s, nu, R, dark_start, dark_end)) {
    first_end = clamp(dark_start, start, end);
    second_start = clamp(dark_end, start, end);
  }
  for (int part = 0; part < 2; ++part) {
    float from = part == 0 ? start : second_start;
    float span = (part == 0 ? first_end : end) - from;
    if (span > 0.0) {
      float to = from + span;
      float count = float(o.samples);
      bool by_column = ONEIL_SPACING(o) == kOneilByDensity && ONEIL_INTEGRAL_METHOD(o) != kOneilPublished;
      vec2 whole = vec2(1.0);
      float depth = 0.0;
      if (by_column) {
        float h_from = min(altitude_along(h0, mu, from, R), top);
        float h_to = min(altitude_along(h0, mu, to, R), top);
        whole = oneil_density_integral_between(m, o, table, q0 + from, h_from, q0 + to, h_to, hp, false);
        by_column = min(whole.x, whole.y) > 1.0e-20;
        vec3 tau = m.rayleigh_scattering * whole.x + m.mie_extinction * whole.y;
        depth = min((tau.x + tau.y + tau.z) / 3.0, 20.0);
      }
      // In twilight the dense air below gets no light: there they are spread over the whole ray as well.
      float even = clamp(0.5 - 4.0 * mu_s, 0.0, 0.7);
      float densest = clamp(-q0, from, to);
      float last = densest;
      for (uint i = 0u; i < o.samples; ++i) {
        // Away from the densest air, so that each place starts from the one before.
        float place = (float(densest < to ? i : o.samples - 1u - i) + 0.5) / count;
        float d = from + place * span;
        float part_of_air = 1.0 / count;
        if (by_column) {
          float share = oneil_seen(place, depth);
          part_of_air = oneil_seen(place + 0.5 / count, depth) - oneil_seen(place - 0.5 / count, depth);
          d = oneil_place(m, o, table, h0, mu, hp, from, to, whole, even, share, 0.02 * part_of_air, last);
          last = d < densest && densest < to ? densest : d;
        }
        float h = min(altitude_along(h0, mu, d, R), top);
        float sun = clamp(((R + h0) * mu_s + d * nu) / (R + h), -1.0, 1.0);
        vec2 column = oneil_density_integral_between(m, o, table, q0 + start, ha, q0 + d, h, hp, reversed) +
                      oneil_sun_density_integral(m, o, table, h, sun);
        vec2 density = oneil_densities(m, o, table, h);
        float length_m = span / count;
        if (by_column) {
          length_m = part_of_air /
                     max((0.5 - 0.5 * even) * (density.x / whole.x + density.y / whole.y) + even / span, 1.0e-30);
        }
        vec3 arrives = oneil_transmittance(m, column) * length_m;
        rayleigh += arrives * density.x;
        mie += arrives * density.y;
      }
    }
  }
  rayleigh *= m.rayleigh_scattering;
  mie *= m.mie_scattering;
}

// Radiance / E0 [1/sr] from what oneil_scattering found.
vec3 oneil_radiance(IN(Medium) m, IN(Oneil) o, float nu, vec3 rayleigh, vec3 mie) {
  float even = 0.0795774715459477;
  return rayleigh * (o.rayleigh_phase != 0u ? rayleigh_phase(nu) : even) + mie * mie_phase(m, nu);
}

// Moves a ray from above the top to where it enters the air; end is measured from there then.
void oneil_enter(float top, float R, INOUT(float) h0, INOUT(float) mu, INOUT(float) mu_s, float nu, float start,
                 INOUT(float) end) {
  if (start > 0.0) {
    float r0 = R + h0;
    float lowest = perigee_altitude(h0, mu, R);
    mu = -sqrt(clamp((top - lowest) * (2.0 * R + top + lowest), 0.0, (R + top) * (R + top))) / (R + top);
    mu_s = clamp((r0 * mu_s + start * nu) / (R + top), -1.0, 1.0);
    h0 = top;
    end -= start;
  }
}

// Radiance / E0 [1/sr] of a ray to its end in the ground or at the top, and the transmittance there.
vec3 oneil_to_end(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, float h0, float mu, float mu_s, float nu,
                  OUT(vec3) through) {
  float start;
  float end;
  bool hits_ground;
  through = vec3(1.0);
  float top = m.atmosphere_height_m;
  if (!atmosphere_segment(h0, mu, top, m.planet_radius_m, start, end, hits_ground)) {
    return vec3(0.0);
  }
  float altitude = h0;
  float view = mu;
  float sun = mu_s;
  oneil_enter(top, m.planet_radius_m, altitude, view, sun, nu, start, end);
  vec3 rayleigh;
  vec3 mie;
  oneil_scattering(m, o, table, altitude, view, sun, nu, 0.0, end, rayleigh, mie, through);
  return oneil_radiance(m, o, nu, rayleigh, mie);
}

#endif
