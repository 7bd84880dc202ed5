// Sunlight behind the clouds of the caller, and in-scattering of the parts of a ray that no shadow map covers. A ray
// is divided into steps of about a texel of the map of clouds. The light of a step is that of its middle. A step that
// crosses the layer is darkened in proportion to the part behind the layer.
#ifndef TYNDALL_CLOUDS_GLSL
#define TYNDALL_CLOUDS_GLSL

#include "frame/constants.glsl"
#include "frame/homogeneous_medium.glsl"
#include "frame/modes.glsl"
#include "frame/view_ray.glsl"
#include "lib/cloud_map.glsl"
#include "lib/single_scattering.glsl"

layout(constant_id = kCloudsId) const bool kClouds = false;
layout(binding = 21) uniform sampler2D clouds;

// True if orders of scattering >= 2 are darkened, by the same fraction as single scattering.
const bool kCloudFraction = kClouds && kOccluded && !kHomogeneous;

const float kCloudSteps = 512.0;  // the largest number of steps of a section of a ray

// Returns the change of (u, v, depth) per metre along a direction.
vec3 cloud_change(vec3 direction) {
  return vec3(dot(frame.cloud_u, direction), dot(frame.cloud_v, direction), dot(frame.cloud_depth, direction));
}

vec3 cloud_camera() { return vec3(frame.cloud_camera_u, frame.cloud_camera_v, frame.cloud_camera_depth); }

// Returns the number of texels that a ray crosses per metre.
float cloud_texels_per_m(vec3 change) {
  vec2 texels = abs(change.xy) * vec2(textureSize(clouds, 0));
  return max(texels.x, texels.y);
}

// Returns the number of steps of a section of a ray, `max_steps` or fewer. A ray may cross the layer within one texel,
// so there is also a minimum number.
float cloud_steps(vec3 change, float length_m, float max_steps) {
  return clamp(ceil(length_m * cloud_texels_per_m(change)), max_steps / 16.0, max_steps);
}

// Returns the fraction of sunlight that reaches a step. `middle`: (u, v, depth); `change`: of the depth.
Spectrum cloud_light(vec3 middle, float change) {
  vec4 texel = textureLod(clouds, middle.xy, 0.0);
  return mix(Spectrum(1.0), FILTER(texel.rgb), behind_clouds(texel.a, middle.z, change));
}

// Computes the part of [from, to] that is inside the map. It is empty, a = b = to, if there is none.
void cloud_section(vec3 change, float from, float to, out float a, out float b) {
  vec2 camera = vec2(frame.cloud_camera_u, frame.cloud_camera_v);
  vec2 texel = 1.0 / vec2(textureSize(clouds, 0));
  vec2 slope = vec2(abs(change.x) > 1e-20 ? change.x : 1e-20, abs(change.y) > 1e-20 ? change.y : 1e-20);
  vec2 low = (-texel - camera) / slope;
  vec2 high = (1.0 + texel - camera) / slope;
  a = max(max(min(low.x, high.x), min(low.y, high.y)), from);
  b = min(min(max(low.x, high.x), max(low.y, high.y)), to);
  if (b <= a) a = b = to;
}

// Returns the mean of the sunlight behind clouds over [from, to]. [a, b] is the part of the ray inside the map.
Spectrum mean_cloud_light(vec3 change, float from, float to, float a, float b, float steps_per_m) {
  float p = clamp(from, a, b);
  float q = clamp(to, a, b);
  if (q <= p) return Spectrum(1.0);
  float steps = max(ceil((q - p) * steps_per_m), 1.0);
  float step_m = (q - p) / steps;
  Spectrum sum = Spectrum(0.0);
  for (int k = 0; k < int(steps); ++k) {
    sum += cloud_light(cloud_camera() + change * (p + (float(k) + 0.5) * step_m), change.z * step_m);
  }
  return 1.0 + (sum / steps - 1.0) * ((q - p) / (to - from));
}

// Adds the single scattering of [from, to], where no shadow map is, to `light`, and what it would be without clouds to
// `plain`. The quadrature is that of single_scattering(): each node stands for a section of its panel, whose light is
// multiplied by the mean of the sunlight behind clouds. Inside the map panels are shorter, because that mean is exact
// only where the source of a section is constant.
void add_clouded(Ray ray, float from, float to, float max_steps, inout Spectrum light, inout Spectrum plain) {
  vec3 change = cloud_change(ray.direction);
  float a, b;
  cloud_section(change, from, to, a, b);
  float steps_per_m = cloud_steps(change, b - a, max_steps) / max(b - a, 1.0);
  float h0 = ray.altitude;
  float mu = ray.cos_zenith;
  float nu = ray.cos_view_sun;
  float R = medium.planet_radius_m;
  int panels = int(frame.integration_steps) / 3;
  int max_panels = 24 + 18 * panels;
  Spectrum rayleigh = RAYLEIGH_SCATTERING(medium) * rayleigh_phase(nu);
  Spectrum mie = mie_scattering_towards(medium, nu);
  vec4 node = vec4(0.069431844202974, 0.330009478207572, 0.669990521792428, 0.930568155797026);
  vec4 weight = vec4(0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727);
  float dark_from, dark_to;
  bool dark = shadow_segment(h0, mu, ray.cos_sun_zenith, nu, R, dark_from, dark_to);
  for (int part = 0; part < 2; ++part) {  // in front of the planet's shadow, and behind it
    float d = part == 0 ? from : dark ? clamp(dark_to, from, to) : to;
    float end = part == 0 && dark ? clamp(dark_from, from, to) : to;
    float tau = 0.0;
    for (int panel = 0; panel < max_panels; ++panel) {
      if (end - d <= 0.0 || tau > 40.0) break;
      bool inside = d >= a && d < b;
      float fineness = (inside ? 3.0 : 12.0) / float(max(panels, 1));
      float stop = min(end, d < a ? a : inside ? b : end);
      float left = stop - d;
      float span = panel_length(medium, h0, mu, ray.cos_sun_zenith, nu, d, fineness, tau);
      span = max(span, left / float(max_panels - panel));
      span = span > 0.9 * left ? left : span > 0.5 * left ? 0.5 * left : span;
      float section = d;
      for (int i = 0; i < 4; ++i) {
        float x = d + node[i] * span;
        float h = altitude_along(h0, mu, x, R);
        float sun = clamp(((R + h0) * ray.cos_sun_zenith + x * nu) / max(R + h, 1.0), -1.0, 1.0);
        vec3 integral = density_integral_along(medium, h0, mu, x) + density_integral_to_top(medium, h, sun);
        vec3 density = densities(medium, h);
        Spectrum source = weight[i] * span * transmittance(medium, integral) * (rayleigh * density.x + mie * density.y);
        light += source * mean_cloud_light(change, section, section + weight[i] * span, a, b, steps_per_m);
        plain += source;
        section += weight[i] * span;
      }
      tau += LARGEST(optical_depth(
          medium, density_integral_along(medium, altitude_along(h0, mu, d, R), cos_zenith_along(h0, mu, d, R), span)));
      d = span < left ? d + span : stop;
    }
  }
}

// Adds the in-scattering of a homogeneous medium over [from, to], where no shadow map is, without the factor of
// homogeneous_phase(). `before`: the transmittance from the eye, which advances to `to`.
void add_clouded_homogeneous(vec3 direction, float from, float to, float max_steps, inout Spectrum light,
                             inout Spectrum before) {
  if (to <= from) return;
  vec3 change = cloud_change(direction);
  float steps = cloud_steps(change, to - from, max_steps);
  float step_m = (to - from) / steps;
  Spectrum transmittance, opacity;
  homogeneous_attenuation(step_m, transmittance, opacity);
  for (int k = 0; k < int(steps); ++k) {
    vec3 place = cloud_camera() + change * (from + (float(k) + 0.5) * step_m);
    light += cloud_light(place, change.z * step_m) * before * opacity;
    before *= transmittance;
  }
}

// Returns the fraction of single scattering that remains behind clouds and glass.
Spectrum cloud_fraction(Spectrum light, Spectrum plain) {
  Spectrum fraction = clamp(light / max(plain, Spectrum(1e-30)), Spectrum(0.0), Spectrum(1.0));
  return mix(Spectrum(1.0), fraction, greaterThan(plain, Spectrum(1e-30)));
}

#endif
