// Geometry of a spherical planet of radius R as seen from near its surface: altitudes, horizons and shells.
// A ray is given by the altitude h0 of its origin and the cosine mu of its angle from the local vertical; d is the
// distance along the ray. In world space the planet's centre is at (0, -R, 0) and y points up.
#ifndef TYNDALL_LIB_GEOMETRY
#define TYNDALL_LIB_GEOMETRY

#include "lib/portable.glsl"

// Returns the altitude of the world position p above sea level [m].
float altitude_of(vec3 p, float R) {
  float horizontal_squared = p.x * p.x + p.z * p.z;
  float y = p.y + R;
  return (horizontal_squared + p.y * (2.0 * R + p.y)) / (sqrt(horizontal_squared + y * y) + R);
}

// Returns the altitude at distance d along the ray; d may be negative. From r^2 - r0^2 = d (2 r0 mu + d).
float altitude_along(float h0, float mu, float d, float R) {
  float r0 = R + h0;
  float rise = d * (2.0 * r0 * mu + d);
  return h0 + rise / (sqrt(max(r0 * r0 + rise, 0.0)) + r0);
}

// Returns the cosine of the ray's angle from the local vertical at distance d.
float cos_zenith_along(float h0, float mu, float d, float R) {
  float r0 = R + h0;
  float r = R + altitude_along(h0, mu, d, R);
  return clamp((r0 * mu + d) / max(r, 1.0), -1.0, 1.0);
}

// Returns the altitude of the perigee: the point of the ray's infinite line that is nearest to the planet's centre.
float perigee_altitude(float h0, float mu, float R) {
  float r0 = R + h0;
  float q0 = r0 * mu;
  return h0 - q0 * q0 / (r0 + r0 * sqrt(max((1.0 - mu) * (1.0 + mu), 0.0)));
}

// Computes the distances at which the ray's infinite line crosses the shell of altitude hs. Returns false, with near =
// far = 0, if it misses the shell. Neither root suffers from cancellation. A negative distance lies behind the origin.
bool shell_intersections(float h0, float mu, float hs, float R, OUT(float) near, OUT(float) far) {
  near = 0.0;
  far = 0.0;
  float q0 = (R + h0) * mu;
  float rise = (hs - h0) * (2.0 * R + hs + h0);
  float q_squared = q0 * q0 + rise;
  if (rise < 0.0) {
    // The origin is outside the shell. The perigee altitude is precise even where q0^2 + rise cancels.
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

// Returns the distance at which a ray from inside the shell of altitude `top` leaves the shell. For an origin outside,
// the result is the far crossing, or 0 if the shell lies behind the ray.
float distance_to_top(float h0, float mu, float top, float R) {
  float near;
  float far;
  shell_intersections(h0, mu, top, R, near, far);
  return max(far, 0.0);
}

// Returns the altitude of the ground sphere for a ray that begins at altitude h. From above sea level, the ground is
// sea level. From below sea level, it lies at twice the depth, so that neither the atmosphere below the ray nor its
// horizon changes abruptly at sea level (docs/adr/0007-below-sea-level.md). The sphere is never lower than half the
// planet's radius.
float ground_below(float h, float R) { return h < 0.0 ? min(h, max(2.0 * h, -0.5 * R)) : 0.0; }

// Returns the cosine of the zenith angle of the sea-level horizon; 0 at and below sea level. The sun sets behind this
// horizon.
float horizon_cos(float h, float R) {
  float above = max(h, 0.0);
  return -sqrt(above * (2.0 * R + above)) / (R + above);
}

// Returns the cosine of the zenith angle of the horizon of a sphere at the altitude `ground` <= h.
float sphere_horizon_cos(float h, float ground, float R) {
  return -sqrt((h - ground) * (2.0 * R + h + ground)) / (R + h);
}

// Returns the cosine of the zenith angle of the horizon of ground_below(). Above sea level this is the sea-level
// horizon.
float ground_horizon_cos(float h, float R) { return sphere_horizon_cos(h, ground_below(h, R), R); }

bool ray_hits_ground(float h, float mu, float R) { return mu < ground_horizon_cos(h, R); }

// Returns the distance to the sphere at the altitude `ground` [m] for a ray that hits it. A ray that misses it by a
// rounding error gets the distance to its perigee.
float distance_to_sphere(float h, float mu, float ground, float R) {
  float near;
  float far;
  float d = -(R + h) * mu;
  if (shell_intersections(h, mu, ground, R, near, far)) {
    d = near;
  }
  return max(d, 0.0);
}

float distance_to_ground(float h, float mu, float R) { return distance_to_sphere(h, mu, ground_below(h, R), R); }

// Computes the part of the ray that lies below `top`, as distances start <= end [m]. The ground does not end the ray.
// Returns false, with start = end = 0, if there is no such part.
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

// Computes the part of the ray that lies below `top` and before the ground, and whether the ray ends on the ground.
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

// Returns 1 if a point-sized sun at zenith cosine mu_s is above the sea-level horizon of a point at altitude h, else 0.
float sun_visibility(float h, float mu_s, float R) { return mu_s < horizon_cos(h, R) ? 0.0 : 1.0; }

// Returns the fraction of the sun's disc that is above the sea-level horizon. The horizon is treated as a straight
// line.
float sun_disc_visibility(float h, float mu_s, float R, float angular_radius_rad) {
  float mu_h = horizon_cos(h, R);
  // The angle above the horizon to first order, which is enough for a disc of a few degrees.
  float elevation = (mu_s - mu_h) / sqrt(max(1.0 - mu_h * mu_h, 1.0e-6));
  float x = clamp(elevation / max(angular_radius_rad, 1.0e-6), -1.0, 1.0);
  return clamp(0.5 + (x * sqrt(max(1.0 - x * x, 0.0)) + asin(x)) * 0.318309886183791, 0.0, 1.0);
}

#endif
