// The model of O'Neil, "Accurate Atmospheric Scattering", GPU Gems 2 (2005), chapter 16: single scattering by the
// midpoint rule with few points on the ray. Density integrals are not computed numerically; they come from a function
// of altitude and angle: the scale function, or the table that preceded it (O'Neil 2004). There are two species, each
// with a scale height, and no ozone. In a vec2, x is Rayleigh and y is the aerosol. Density integrals are in metres of
// sea-level density.
//
// In the published form, one polynomial covers all angles, including downward ones. Our form (kOneilComputed) is fitted
// to the planet and is evaluated for outward rays only: a downward ray uses the integral of the reversed ray, and a ray
// through its lowest point adds two outward ones. docs/oneil.md has the equations.
#ifndef TYNDALL_LIB_ONEIL
#define TYNDALL_LIB_ONEIL

#include "lib/geometry.glsl"
#include "lib/phase.glsl"
#include "lib/single_scattering.glsl"
#include "shared/oneil.h"

const uint kOneilComputed = 0u;   // scale function, fitted to the planet and the scale heights
const uint kOneilPublished = 1u;  // polynomial and equations as published
const uint kOneilTable = 2u;      // table over altitude and angle

const uint kOneilUniform = 0u;    // evenly spaced points along the ray, as published
const uint kOneilByDensity = 1u;  // points where most of the visible medium is

// Shaders may define these as constants. Branches on a variable are slow on CPU devices, which execute both sides, and
// the search for the sample points takes most of the time.
#ifndef ONEIL_INTEGRAL_METHOD
#define ONEIL_INTEGRAL_METHOD(o) o.integral_method
#define ONEIL_SPACING(o) o.spacing
#endif

// The table: GLSL reads a buffer through ONEIL_TEXEL, C++ passes a pointer.
#ifndef ONEIL_TABLE
#define ONEIL_TABLE uint
#endif
#ifndef ONEIL_TEXEL
#define ONEIL_TEXEL(table, index) vec4(0.0)
#endif

// Returns the density integral from sea level to infinity [m] for a zenith cosine c. `bend` stretches the axis where a
// thin atmosphere on a large planet makes the function steep. bend = 0 is the published form, for which c may be
// negative.
float oneil_scale(IN(OneilScale) s, float c) {
  float b = 1.0 / (1.0 + s.bend * c);
  float x = (1.0 - c) * b;
  return s.scale_height_m * (1.0 + s.bend) * b * exp(s.k0 + x * (s.k1 + x * (s.k2 + x * (s.k3 + x * s.k4))));
}

// Returns the density integral from altitude h to infinity for c >= 0, over a planet of radius R. The atmosphere
// above h looks like that above sea level when lengths along the horizon are scaled by sqrt(r / R); the error is of the
// order of the scale height over R.
float oneil_outward(IN(OneilScale) s, float h, float c, float R) {
  float stretch = sqrt(1.0 + h / R);
  return exp(min(-h / s.scale_height_m, 60.0)) * stretch * oneil_scale(s, c * stretch);
}

// Returns the table's entry: x is the density and y the density integral of Rayleigh scattering, z and w are those of
// the aerosol. Both axes are spaced by the square root, because altitude and cosine matter most near 0. The integrals
// end at the top of the atmosphere.
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

// Returns the factors by which density and density integral exceed those at sea level, where the table begins.
vec2 oneil_below_sea_level(IN(Oneil) o, float h) {
  float depth = max(-h, 0.0);
  return vec2(exp(min(depth / o.rayleigh.scale_height_m, 60.0)), exp(min(depth / o.mie.scale_height_m, 60.0)));
}

vec2 oneil_densities(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, float h) {
  if (ONEIL_INTEGRAL_METHOD(o) == kOneilTable) {
    vec4 entry = oneil_table(o, table, h, 1.0, m.atmosphere_height_m);
    return vec2(entry.x, entry.z) * oneil_below_sea_level(o, h);
  }
  return vec2(exp(min(-h / o.rayleigh.scale_height_m, 60.0)), exp(min(-h / o.mie.scale_height_m, 60.0)));
}

// Returns the density integral outwards from altitude h at zenith cosine c. Only the published function accepts c < 0.
vec2 oneil_density_integral(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, float h, float c) {
  if (ONEIL_INTEGRAL_METHOD(o) == kOneilTable) {
    vec4 entry = oneil_table(o, table, h, c, m.atmosphere_height_m);
    return vec2(entry.y, entry.w) * oneil_below_sea_level(o, h);
  }
  if (ONEIL_INTEGRAL_METHOD(o) == kOneilPublished) {
    return oneil_densities(m, o, table, h) * vec2(oneil_scale(o.rayleigh, c), oneil_scale(o.mie, c));
  }
  float R = m.planet_radius_m;
  return vec2(oneil_outward(o.rayleigh, h, c, R), oneil_outward(o.mie, h, c, R));
}

// A ray: altitude of its origin, cosines of the view and sun zenith angles there, cosine of the angle between view
// direction and sun.
struct OneilRay {
  float h0;
  float mu;
  float mu_s;
  float nu;
};

// A point of a ray: its altitude, and its signed distance from the ray's perigee.
struct OneilPoint {
  float q;
  float h;
};

OneilPoint oneil_point(IN(Medium) m, IN(OneilRay) ray, float d) {
  OneilPoint point;
  point.q = (m.planet_radius_m + ray.h0) * ray.mu + d;
  point.h = min(altitude_along(ray.h0, ray.mu, d, m.planet_radius_m), m.atmosphere_height_m);
  return point;
}

// Returns the density integral between two points of a ray, a before b. The ray's perigee is at altitude hp. `reversed`
// is for the published function only: the end of the ray is below its beginning, so the integrals are evaluated towards
// the beginning.
vec2 oneil_density_integral_between(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, IN(OneilPoint) a, IN(OneilPoint) b,
                                    float hp, bool reversed) {
  float R = m.planet_radius_m;
  float ca = clamp(a.q / (R + a.h), -1.0, 1.0);
  float cb = clamp(b.q / (R + b.h), -1.0, 1.0);
  if (ONEIL_INTEGRAL_METHOD(o) == kOneilPublished) {
    return reversed ? oneil_density_integral(m, o, table, b.h, -cb) - oneil_density_integral(m, o, table, a.h, -ca)
                    : oneil_density_integral(m, o, table, a.h, ca) - oneil_density_integral(m, o, table, b.h, cb);
  }
  vec2 from_a = oneil_density_integral(m, o, table, a.h, abs(ca));
  vec2 from_b = oneil_density_integral(m, o, table, b.h, abs(cb));
  vec2 integral = from_a - from_b;
  if (b.q <= 0.0) {
    integral = from_b - from_a;
  } else if (a.q < 0.0) {
    integral = 2.0 * oneil_density_integral(m, o, table, hp, 0.0) - from_a - from_b;
  }
  return max(integral, vec2(0.0));
}

// Returns the density integral from altitude h towards the sun at zenith cosine c, ignoring the planet.
vec2 oneil_sun_density_integral(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, float h, float c) {
  if (c >= 0.0 || ONEIL_INTEGRAL_METHOD(o) == kOneilPublished) {
    return oneil_density_integral(m, o, table, h, c);
  }
  float lowest = max(perigee_altitude(h, c, m.planet_radius_m), min(h, 0.0));
  return 2.0 * oneil_density_integral(m, o, table, lowest, 0.0) - oneil_density_integral(m, o, table, h, -c);
}

// Returns the transmittance. It is bounded because the published function, on planets other than its own, yields
// arbitrarily negative density integrals.
vec3 oneil_transmittance(IN(Medium) m, vec2 integral) {
  return exp(min(-(m.rayleigh_scattering * integral.x + m.mie_extinction * integral.y), vec3(40.0)));
}

// Returns the transmittance of sunlight down to altitude h. It is 0 in the planet's shadow, except with the published
// function, which has no shadow.
vec3 oneil_sunlight(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, float h, float c) {
  float visible = ONEIL_INTEGRAL_METHOD(o) == kOneilPublished ? 1.0 : sun_visibility(h, c, m.planet_radius_m);
  return visible * oneil_transmittance(m, oneil_sun_density_integral(m, o, table, h, c));
}

// A sunlit part of a ray, for the distribution of the sample points.
struct OneilPart {
  float from;  // distances from the ray's origin [m]
  float to;
  float perigee;    // altitude of the ray's perigee
  vec2 integral;    // density integral of the part
  float even;       // weight of the length in the distribution; the medium has the rest
  float depth;      // optical depth of the part, mean of the channels
  bool by_density;  // false: the points are evenly spaced
};

OneilPart oneil_part(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, IN(OneilRay) ray, float from, float to) {
  OneilPart part;
  part.from = from;
  part.to = to;
  part.perigee = perigee_altitude(ray.h0, ray.mu, m.planet_radius_m);
  part.integral = vec2(1.0);
  // In twilight the dense lower atmosphere is dark, so some points are spread evenly over the length.
  part.even = clamp(0.5 - 4.0 * ray.mu_s, 0.0, 0.7);
  part.depth = 0.0;
  part.by_density = ONEIL_SPACING(o) == kOneilByDensity && ONEIL_INTEGRAL_METHOD(o) != kOneilPublished;
  if (part.by_density) {
    part.integral = oneil_density_integral_between(m, o, table, oneil_point(m, ray, from), oneil_point(m, ray, to),
                                                   part.perigee, false);
    part.by_density = min(part.integral.x, part.integral.y) > 1.0e-20;
    vec3 tau = m.rayleigh_scattering * part.integral.x + m.mie_extinction * part.integral.y;
    part.depth = min((tau.x + tau.y + tau.z) / 3.0, 20.0);
  }
  return part;
}

// Returns the distance at which `fraction` of the part has been crossed. The fraction is a mean of the fraction of the
// length, weighted by part.even, and that of both species' density integrals. Uses Newton's method in a shrinking
// bracket, which converges from one side if `guess` lies between the densest point and the solution. `tolerance` is the
// accepted error of the fraction.
float oneil_distance_at_fraction(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, IN(OneilRay) ray, IN(OneilPart) part,
                                 float fraction, float tolerance, float guess) {
  OneilPoint start = oneil_point(m, ray, part.from);
  float low = part.from;
  float high = part.to;
  float length_m = part.to - part.from;
  float d = guess;
  for (int i = 0; i < 12; ++i) {
    OneilPoint here = oneil_point(m, ray, d);
    vec2 crossed = oneil_density_integral_between(m, o, table, start, here, part.perigee, false) / part.integral;
    vec2 slope = oneil_densities(m, o, table, here.h) / part.integral;
    float missing =
        fraction - part.even * (d - part.from) / length_m - (0.5 - 0.5 * part.even) * (crossed.x + crossed.y);
    if (abs(missing) < tolerance) {
      break;
    }
    if (missing > 0.0) {
      low = d;
    } else {
      high = d;
    }
    float next = d + missing / max((0.5 - 0.5 * part.even) * (slope.x + slope.y) + part.even / length_m, 1.0e-30);
    d = next > low && next < high ? next : 0.5 * (low + high);
  }
  return d;
}

// Returns the fraction of the medium that lies before the point at which the fraction `seen` of the visible light has
// been collected. `depth` is the optical depth of the whole path.
float oneil_fraction_before(float seen, float depth) {
  return depth > 0.01 ? -log(max(1.0 - seen, 0.0) + seen * exp(-depth)) / depth : seen;
}

// Single scattering along a ray without the phase functions: radiance / E0 = rayleigh * p_R(nu) + mie * p_M(nu).
struct OneilLight {
  vec3 rayleigh;
  vec3 mie;
  vec3 transmittance;
};

// Computes single scattering on the part [start, end] of the ray, which must lie within the atmosphere. The sample
// points are distributed over the sunlit medium; in the published form, evenly over the part.
OneilLight oneil_scattering(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, IN(OneilRay) ray, float start, float end) {
  float R = m.planet_radius_m;
  float hp = perigee_altitude(ray.h0, ray.mu, R);
  OneilPoint a = oneil_point(m, ray, start);
  OneilPoint b = oneil_point(m, ray, end);
  bool reversed = b.h < a.h - 1.0e-4 * m.atmosphere_height_m;  // more than a rounding error, as from top to top
  OneilLight light;
  light.rayleigh = vec3(0.0);
  light.mie = vec3(0.0);
  light.transmittance = oneil_transmittance(m, oneil_density_integral_between(m, o, table, a, b, hp, reversed));

  float first_end = end;
  float second_start = end;
  float shadow_start;
  float shadow_end;
  if (ONEIL_INTEGRAL_METHOD(o) != kOneilPublished &&
      shadow_segment(ray.h0, ray.mu, ray.mu_s, ray.nu, R, shadow_start, shadow_end)) {
    first_end = clamp(shadow_start, start, end);
    second_start = clamp(shadow_end, start, end);
  }
  float count = float(o.samples);
  for (int side = 0; side < 2; ++side) {
    float from = side == 0 ? start : second_start;
    float span = (side == 0 ? first_end : end) - from;
    if (span > 0.0) {
      OneilPart part = oneil_part(m, o, table, ray, from, from + span);
      float densest = clamp(-((R + ray.h0) * ray.mu), from, part.to);
      float last = densest;
      for (uint i = 0u; i < o.samples; ++i) {
        // Move away from the densest point, so that each search starts at the previous result.
        float seen = (float(densest < part.to ? i : o.samples - 1u - i) + 0.5) / count;
        float d = from + seen * span;
        float fraction = 1.0 / count;
        if (part.by_density) {
          fraction = oneil_fraction_before(seen + 0.5 / count, part.depth) -
                     oneil_fraction_before(seen - 0.5 / count, part.depth);
          d = oneil_distance_at_fraction(m, o, table, ray, part, oneil_fraction_before(seen, part.depth),
                                         0.02 * fraction, last);
          last = d < densest && densest < part.to ? densest : d;
        }
        OneilPoint here = oneil_point(m, ray, d);
        float sun = clamp(((R + ray.h0) * ray.mu_s + d * ray.nu) / (R + here.h), -1.0, 1.0);
        vec2 integral = oneil_density_integral_between(m, o, table, a, here, hp, reversed) +
                        oneil_sun_density_integral(m, o, table, here.h, sun);
        vec2 density = oneil_densities(m, o, table, here.h);
        float length_m = span / count;
        if (part.by_density) {
          vec2 relative = density / part.integral;
          length_m = fraction / max((0.5 - 0.5 * part.even) * (relative.x + relative.y) + part.even / span, 1.0e-30);
        }
        vec3 arriving = oneil_transmittance(m, integral) * length_m;
        light.rayleigh += arriving * density.x;
        light.mie += arriving * density.y;
      }
    }
  }
  light.rayleigh *= m.rayleigh_scattering;
  light.mie *= m.mie_scattering;
  return light;
}

// Returns radiance / E0 [1/sr]: applies the phase functions to the result of oneil_scattering.
vec3 oneil_radiance(IN(Medium) m, IN(Oneil) o, float nu, vec3 rayleigh, vec3 mie) {
  float uniform_phase = 0.0795774715459477;
  return rayleigh * (o.rayleigh_phase != 0u ? rayleigh_phase(nu) : uniform_phase) + mie * mie_phase(m, nu);
}

// Returns the ray from the point at distance `start` [m], where it enters the atmosphere from above the top. A ray that
// begins inside (start = 0) is returned as it is.
OneilRay oneil_enter(IN(Medium) m, IN(OneilRay) ray, float start) {
  OneilRay entered = ray;
  if (start > 0.0) {
    float R = m.planet_radius_m;
    float top = m.atmosphere_height_m;
    float perigee = perigee_altitude(ray.h0, ray.mu, R);
    entered.mu = -sqrt(clamp((top - perigee) * (2.0 * R + top + perigee), 0.0, (R + top) * (R + top))) / (R + top);
    entered.mu_s = clamp(((R + ray.h0) * ray.mu_s + start * ray.nu) / (R + top), -1.0, 1.0);
    entered.h0 = top;
  }
  return entered;
}

// Returns radiance / E0 [1/sr] of a ray up to the ground or the top of the atmosphere, and the transmittance to that
// end.
vec3 oneil_to_end(IN(Medium) m, IN(Oneil) o, ONEIL_TABLE table, IN(OneilRay) ray, OUT(vec3) path_transmittance) {
  float start;
  float end;
  bool hits_ground;
  path_transmittance = vec3(1.0);
  if (!atmosphere_segment(ray.h0, ray.mu, m.atmosphere_height_m, m.planet_radius_m, start, end, hits_ground)) {
    return vec3(0.0);
  }
  OneilLight light = oneil_scattering(m, o, table, oneil_enter(m, ray, start), 0.0, start > 0.0 ? end - start : end);
  path_transmittance = light.transmittance;
  return oneil_radiance(m, o, ray.nu, light.rayleigh, light.mie);
}

#endif
