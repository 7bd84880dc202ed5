// A spherical planet of radius R seen from near its surface: altitudes, horizons, shells.
// A ray is given by the altitude h0 of its origin and the cosine mu of its angle from the local vertical; d
// is the distance along it. World: planet centre at (0, -R, 0), y up.
#ifndef TYNDALL_LIB_GEOMETRY
#define TYNDALL_LIB_GEOMETRY

#include "lib/portable.glsl"

// Altitude of the world position p above sea level [m].
float altitude_of(vec3 p, float R) {
  float horizontal_squared = p.x * p.x + p.z * p.z;
  float y = p.y + R;
  return (horizontal_squared + p.y * (2.0 * R + p.y)) / (sqrt(horizontal_squared + y * y) + R);
}

// Unit vector away from the planet's centre at the world position p.
vec3 up_at(vec3 p, float R) { return normalize(vec3(p.x, p.y + R, p.z)); }

// Altitude at distance d (of either sign) along the ray: r^2 - r0^2 = d (2 r0 mu + d).
float altitude_along(float h0, float mu, float d, float R) {
  float r0 = R + h0;
  float rise = d * (2.0 * r0 * mu + d);
  return h0 + rise / (sqrt(max(r0 * r0 + rise, 0.0)) + r0);
}

// Cosine of the ray's angle from the local vertical at distance d.
float cos_zenith_along(float h0, float mu, float d, float R) {
  float r0 = R + h0;
  float r = R + altitude_along(h0, mu, d, R);
  return clamp((r0 * mu + d) / max(r, 1.0), -1.0, 1.0);
}

// Altitude of the point of the ray's whole line that is nearest to the planet's centre.
float perigee_altitude(float h0, float mu, float R) {
  float r0 = R + h0;
  float q0 = r0 * mu;
  return h0 - q0 * q0 / (r0 + r0 * sqrt(max((1.0 - mu) * (1.0 + mu), 0.0)));
}

// Distances at which the ray's whole line crosses the shell of altitude hs; false (near = far = 0) if it
// misses. Both roots are free of cancellation; negative ones lie behind the origin.
bool shell_intersections(float h0, float mu, float hs, float R, OUT(float) near, OUT(float) far) {
  near = 0.0;
  far = 0.0;
  float q0 = (R + h0) * mu;
  float rise = (hs - h0) * (2.0 * R + hs + h0);
  float q_squared = q0 * q0 + rise;
  if (rise < 0.0) {
    // From outside: by the perigee, whose altitude keeps its digits where q0^2 + rise cancels.
    float hp = perigee_altitude(h0, mu, R);
    q_squared = (hs - hp) * (2.0 * R + hs + hp);
  }
  if (q_squared < 0.0) {
    return false;
  }
  float q = sqrt(q_squared);
  if (q0 > 0.0) {
    near = -(q0 + q);
    far = rise / (q0 + q);
  } else {
    far = q - q0;
    near = far > 0.0 ? -rise / far : 0.0;
  }
  return true;
}

// Distance at which a ray from inside the shell of altitude `top` leaves it; 0 from outside, looking away.
float distance_to_top(float h0, float mu, float top, float R) {
  float near;
  float far;
  shell_intersections(h0, mu, top, R, near, far);
  return max(far, 0.0);
}

// Altitude of the ground sphere for a ray that begins at altitude h: sea level, and for a ray that begins below
// sea level twice its depth, so that neither the air beneath it nor its horizon changes abruptly at sea level
// (docs/adr/0007-below-sea-level.md). Beyond a quarter of the radius the sphere stays where it is.
float ground_below(float h, float R) { return h < 0.0 ? min(h, max(2.0 * h, -0.5 * R)) : 0.0; }

// Cosine of the zenith angle of the horizon of sea level; 0 at and below it. The sun sets behind this horizon.
float horizon_cos(float h, float R) {
  float above = max(h, 0.0);
  return -sqrt(above * (2.0 * R + above)) / (R + above);
}

// Cosine of the zenith angle of the horizon of ground_below(); that of sea level from there upwards.
float ground_horizon_cos(float h, float R) {
  float ground = ground_below(h, R);
  return -sqrt((h - ground) * (2.0 * R + h + ground)) / (R + h);
}

bool ray_hits_ground(float h, float mu, float R) { return mu < ground_horizon_cos(h, R); }

// Distance to the ground of a ray that hits it [m]; of one that misses by a rounding error, to its perigee.
float distance_to_ground(float h, float mu, float R) {
  float near;
  float far;
  float d = -(R + h) * mu;
  if (shell_intersections(h, mu, ground_below(h, R), R, near, far)) {
    d = near;
  }
  return max(d, 0.0);
}

// The part of a ray's line, from its origin on, that lies in the atmosphere below `top`: distances start <= end
// [m]. The ground is no obstacle. False if there is none (start = end = 0).
bool segment_below_top(float h0, float mu, float top, float R, OUT(float) start, OUT(float) end) {
  start = 0.0;
  end = 0.0;
  float near;
  float far;
  if (!shell_intersections(h0, mu, top, R, near, far) || far <= 0.0) {
    return false;
  }
  if (h0 > top) {
    start = max(near, 0.0);
  }
  end = max(far, start);
  return end > start;
}

// The same before the ground, and whether the ray ends there.
bool atmosphere_segment(float h0, float mu, float top, float R, OUT(float) start, OUT(float) end,
                        OUT(bool) hits_ground) {
  hits_ground = ray_hits_ground(h0, mu, R);
  if (!segment_below_top(h0, mu, top, R, start, end)) {
    return false;
  }
  if (hits_ground) {
    end = max(distance_to_ground(h0, mu, R), start);
  }
  if (end > start) {
    return true;
  }
  start = 0.0;
  end = 0.0;
  return false;
}

// 1 where a point sun at cosine mu_s is above the geometric horizon of a point at altitude h, else 0.
float sun_visibility(float h, float mu_s, float R) { return mu_s < horizon_cos(h, R) ? 0.0 : 1.0; }

// Fraction of the sun's disc above the geometric horizon, for surfaces; the horizon is taken as straight.
float sun_disc_visibility(float h, float mu_s, float R, float angular_radius_rad) {
  float mu_h = horizon_cos(h, R);
  // Angle above the horizon to first order, which is enough within a disc of a few degrees.
  float elevation = (mu_s - mu_h) / sqrt(max(1.0 - mu_h * mu_h, 1.0e-6));
  float x = clamp(elevation / max(angular_radius_rad, 1.0e-6), -1.0, 1.0);
  return clamp(0.5 + (x * sqrt(max(1.0 - x * x, 0.0)) + asin(x)) * 0.318309886183791, 0.0, 1.0);
}

#endif
