// Marches sections of a ray through the shadow cascades, in all modes of scattering.single and scattering.multiple. The
// shadow map is read once per texel that the ray crosses, so that no shadow boundary is missed.
// The including file defines RAY_SECTIONS, the number of sections of a ray that lie in one cascade, besides the first
// sections in each cascade; and MIN_READS, the smallest number of reads of a section from which the tables are looked
// up.
#ifndef TYNDALL_MARCH_RAY_GLSL
#define TYNDALL_MARCH_RAY_GLSL

#include "frame/constants.glsl"
#include "frame/clouds.glsl"
#include "frame/counters.glsl"
#include "frame/glass.glsl"
#include "frame/homogeneous_medium.glsl"
#include "frame/shadow_maps.glsl"
#include "frame/table_light.glsl"
#include "frame/view_ray.glsl"
#include "lib/single_scattering.glsl"

const int kReadsPerStep = 8;  // shadow-map reads per evaluation of the medium
// The largest number of reads of a ray. Some CPU devices end all loops of an invocation after 65 535 iterations in
// total.
const int kMaxReads = 60000;

uint reads_done = 0u;
uint steps_done = 0u;

// The largest number of reads of a section of the ray in a cascade.
float reads_per_cascade() {
  return float(kMaxReads) / float(RAY_SECTIONS + frame.cascade_count - frame.first_marched_cascade);
}

// The section of a ray in a cascade that is read, as fractions of its part in the cascade. A map can be much smaller
// than the part of the view that its cascade covers, because a camera that looks up sees little of the ground to which
// maps are fitted. Rays then cross more texels than can be read, most of them outside the map. Everything there is lit.
// `texels`: the number of texels along each axis.
vec2 section_to_read(vec3 uvz_from, vec3 uvz_to, vec2 texels) {
  if (max(texels.x, texels.y) <= reads_per_cascade()) return vec2(0.0, 1.0);
  const float kBeyond = 1.0;  // texels beyond the border that filtering may read
  float margin = kBeyond / float(frame.shadow_resolution);
  vec2 change = uvz_to.xy - uvz_from.xy;
  change = vec2(abs(change.x) > 1e-12 ? change.x : 1e-12, abs(change.y) > 1e-12 ? change.y : 1e-12);
  vec2 a = (-margin - uvz_from.xy) / change;
  vec2 b = (1.0 + margin - uvz_from.xy) / change;
  float from = clamp(max(min(a.x, b.x), min(a.y, b.y)), 0.0, 1.0);
  return vec2(from, clamp(min(max(a.x, b.x), max(a.y, b.y)), from, 1.0));
}

// The state of the march: density integrals from the camera [m], and per species the integral of density times the
// transmittance from the sun to the eye [m].
struct March {
  vec3 integral;
  Spectrum rayleigh;
  Spectrum mie;
  Spectrum plain_rayleigh;  // kCloudFraction: the same without clouds and glass
  Spectrum plain_mie;
};

March nothing_marched() { return March(vec3(0.0), Spectrum(0.0), Spectrum(0.0), Spectrum(0.0), Spectrum(0.0)); }

const bool kTinted = kColors || kClouds;

// Returns the sunlight behind clouds at a read of the shadow map; `change`: of the map of clouds per read.
Spectrum clouds_before(vec3 place, vec3 change) { return kClouds ? cloud_light(place, change.z) : Spectrum(1.0); }

// Marches [from, to] inside one cascade. `ray` holds altitudes and cosines at the camera.
void march_cascade(uint cascade, Ray ray, float from, float to, float steps_per_m, inout March march) {
  float radius = medium.planet_radius_m;
  vec3 uvz_from = shadow_uvz(cascades[cascade].shadow_from_world, frame.camera_position + ray.direction * from);
  vec3 uvz_to = shadow_uvz(cascades[cascade].shadow_from_world, frame.camera_position + ray.direction * to);
  vec2 texels = abs(uvz_to.xy - uvz_from.xy) * float(frame.shadow_resolution);
  if (kClouds) {
    texels.x = max(texels.x, cloud_steps(cloud_change(ray.direction), to - from, kCloudSteps));
  }
  // A ray towards the sun stays in one texel but crosses many densities: limit the climb per group of reads to half the
  // aerosol's scale height.
  float h_from = altitude_along(ray.altitude, ray.cos_zenith, from, radius);
  float h_to = altitude_along(ray.altitude, ray.cos_zenith, to, radius);
  float wanted = max(max(max(texels.x, texels.y) / float(kReadsPerStep), (to - from) * steps_per_m),
                     abs(h_to - h_from) / (0.5 * medium.mie_scale_height_m));
  // The density varies slowly, shadows abruptly: read the map at every texel, but the density once per group of texels.
  // Within a group the arriving light is nearly linear, and multiplying it by the mean lit fraction errs by less than
  // the map's own resolution.
  float most = min(2.0 * float(frame.shadow_resolution), reads_per_cascade() / float(kReadsPerStep + 1));
  int groups = int(clamp(ceil(wanted), 1.0, most));
  float dt = (to - from) / float(groups);
  vec3 duvz = (uvz_to - uvz_from) / float(groups * kReadsPerStep);
  vec3 uvz = uvz_from + 0.5 * duvz;
  vec3 dcloud = kClouds ? cloud_change(ray.direction) * (dt / float(kReadsPerStep)) : vec3(0.0);
  vec3 cloud = kClouds ? cloud_camera() + cloud_change(ray.direction) * from + 0.5 * dcloud : vec3(0.0);
  float altitude = h_from;
  vec3 density = densities(medium, altitude);
  for (int i = 0; i < groups; ++i) {
    float lit = 0.0;
    Spectrum tint = Spectrum(0.0);
    for (int k = 0; k < kReadsPerStep; ++k) {
      float lit_fraction = texture(shadow_maps, vec4(uvz.xy, float(cascade), clamp(uvz.z, 0.0, 1.0)));
      lit += lit_fraction;
      if (kTinted) tint += lit_fraction * glass_color(uvz.xy, uvz.z, cascade) * clouds_before(cloud, dcloud);
      uvz += duvz;
      cloud += dcloud;
    }
    float next_altitude = altitude_along(ray.altitude, ray.cos_zenith, from + (float(i) + 1.0) * dt, radius);
    vec3 next_density = densities(medium, next_altitude);
    vec3 mean = mean_densities(medium, density, next_density, next_altitude - altitude);
    if (lit > 0.0) {
      float t = from + (float(i) + 0.5) * dt;
      float altitude_here = altitude_along(ray.altitude, ray.cos_zenith, t, radius);
      float cos_sun = cos_sun_zenith_along(ray, t, radius);
      float lit_reads = lit;
      lit *= sun_visibility(altitude_here, cos_sun, radius) / float(kReadsPerStep);
      vec3 integral = march.integral + 0.5 * dt * mean + density_integral_to_top(medium, altitude_here, cos_sun);
      Spectrum arriving = (lit * dt) * transmittance(medium, integral);
      if (kCloudFraction) {
        march.plain_rayleigh += mean.x * arriving;
        march.plain_mie += mean.y * arriving;
      }
      if (kTinted) arriving *= tint / lit_reads;
      march.rayleigh += mean.x * arriving;
      march.mie += mean.y * arriving;
    }
    march.integral += mean * dt;
    altitude = next_altitude;
    density = next_density;
  }
  steps_done += uint(groups);
  reads_done += uint(groups * kReadsPerStep);
}

// Reads the map at every texel between two distances inside one cascade, for in-scattering from the tables.
void walk_cascade(uint cascade, Ray ray, TableRay path, float start, float from, float to, inout LitSections lit) {
  mat4 shadow_from_world = cascades[cascade].shadow_from_world;
  vec3 uvz_from = shadow_uvz(shadow_from_world, frame.camera_position + ray.direction * from);
  vec3 uvz_to = shadow_uvz(shadow_from_world, frame.camera_position + ray.direction * to);
  vec2 texels = abs(uvz_to.xy - uvz_from.xy) * float(frame.shadow_resolution);
  vec2 part = section_to_read(uvz_from, uvz_to, texels);
  float read_from = mix(from, to, part.x);
  float read_to = mix(from, to, part.y);
  float wanted = max(max(texels.x, texels.y) * (part.y - part.x), float(MIN_READS));
  int reads = int(clamp(ceil(wanted), 1.0, reads_per_cascade()));
  float step_m = (read_to - read_from) / float(reads);
  vec3 duvz = (uvz_to - uvz_from) * ((part.y - part.x) / float(reads));
  vec3 uvz = mix(uvz_from, uvz_to, part.x) + 0.5 * duvz;
  if (part.x > 0.0) add_section(lit, from, read_from, 1.0, Spectrum(1.0));
  int i = 0;
  while (i <= reads) {
    for (; i < reads && lit.closed_at < 0.0; ++i) {
      float lit_fraction = texture(shadow_maps, vec4(uvz.xy, float(cascade), clamp(uvz.z, 0.0, 1.0)));
      float here = read_from + float(i) * step_m;
      // With clouds, cloud_fraction() contains the colour.
      add_section(lit, here, here + step_m, lit_fraction,
                  kClouds ? Spectrum(1.0) : glass_color(uvz.xy, uvz.z, cascade));
      uvz += duvz;
    }
    if (i >= reads && lit.closed_at < 0.0) {
      ++i;
      if (part.y < 1.0) add_section(lit, read_to, to, 1.0, Spectrum(1.0));
      if (kSections == kEach && lit.since >= 0.0) lit.closed_at = to;
    }
    close_section(lit, path, start);
  }
  steps_done += uint(reads);
  reads_done += uint(reads);
}

// Adds the in-scattering of a homogeneous medium between two distances, where nothing is in shadow.
void add_lit_homogeneous(vec3 direction, float from, float to, float length_m, inout Spectrum light,
                         inout Spectrum before) {
  if (kClouds) {
    add_clouded_homogeneous(direction, from, to, kCloudSteps, light, before);
    return;
  }
  Spectrum transmittance, opacity;
  homogeneous_attenuation(length_m, transmittance, opacity);
  light += before * opacity;
  before *= transmittance;
}

// Adds the in-scattering of a homogeneous medium between two distances inside one cascade to `light`, without the
// factor of homogeneous_phase(). `before`: the transmittance from the eye.
void march_homogeneous(uint cascade, Ray ray, float from, float to, inout Spectrum light, inout Spectrum before) {
  Spectrum transmittance, opacity;
  mat4 shadow_from_world = cascades[cascade].shadow_from_world;
  vec3 uvz_from = shadow_uvz(shadow_from_world, frame.camera_position + ray.direction * from);
  vec3 uvz_to = shadow_uvz(shadow_from_world, frame.camera_position + ray.direction * to);
  vec2 texels = abs(uvz_to.xy - uvz_from.xy) * float(frame.shadow_resolution);
  vec2 part = section_to_read(uvz_from, uvz_to, texels);
  float wanted = max(max(texels.x, texels.y) * (part.y - part.x), float(MIN_READS));
  if (kClouds) {
    wanted = max(wanted, cloud_steps(cloud_change(ray.direction), (to - from) * (part.y - part.x), kCloudSteps));
  }
  int reads = int(clamp(ceil(wanted), 1.0, reads_per_cascade()));
  add_lit_homogeneous(ray.direction, from, mix(from, to, part.x), (to - from) * part.x, light, before);
  homogeneous_attenuation((to - from) * ((part.y - part.x) / float(reads)), transmittance, opacity);
  vec3 duvz = (uvz_to - uvz_from) * ((part.y - part.x) / float(reads));
  vec3 uvz = mix(uvz_from, uvz_to, part.x) + 0.5 * duvz;
  vec3 dcloud = kClouds ? cloud_change(ray.direction) * ((to - from) * (part.y - part.x) / float(reads)) : vec3(0.0);
  vec3 cloud =
      kClouds ? cloud_camera() + cloud_change(ray.direction) * mix(from, to, part.x) + 0.5 * dcloud : vec3(0.0);
  for (int i = 0; i < reads; ++i) {
    float lit_fraction = texture(shadow_maps, vec4(uvz.xy, float(cascade), clamp(uvz.z, 0.0, 1.0)));
    light += lit_fraction * glass_color(uvz.xy, uvz.z, cascade) * clouds_before(cloud, dcloud) * before * opacity;
    before *= transmittance;
    uvz += duvz;
    cloud += dcloud;
  }
  add_lit_homogeneous(ray.direction, mix(from, to, part.y), to, (to - from) * (1.0 - part.y), light, before);
  steps_done += uint(reads);
  reads_done += uint(reads);
}

#endif
