// The radiance of the ground under sun and sky, for any model of scattering. The including file defines
//   void ground_light(float altitude_m, float cos_sun_zenith, out vec3 sun, out vec3 sky);
// which computes the sun's irradiance on a surface that faces it and the open sky's irradiance on level ground, both
// relative to the sun's irradiance above the atmosphere.
#ifndef TYNDALL_TERRAIN_GROUND_GLSL
#define TYNDALL_TERRAIN_GROUND_GLSL

#include "scene/map_projections.glsl"
#include "scene/terrain_shadow.glsl"
#include "scene/terrain_materials.glsl"

// A point on the ground, as terrain_vertex.glsl computes it at the vertices.
struct GroundPoint {
  vec3 position;   // in the local frame
  vec3 direction;  // the point of the unit sphere below it, minus the one over the local origin
  vec2 offset_m;   // on the map, from the local origin
  ivec2 units;     // on the own projection [1/64 m]
  float altitude_m;
  vec2 texel;         // in the level's texture
  vec2 parent_texel;  // in that of the next coarser level
  float morph;        // towards that level
  uint layer;
};

void ground_light(float altitude_m, float cos_sun_zenith, out vec3 sun, out vec3 sky);

// Returns the ground's material, with its normal in the local frame. Blends the map projections whose terrain counts
// here.
TerrainMaterial ground_material(GroundPoint point, ProjectionAxes axes, vec3 normal, float bend, float footprint_m) {
  float weights[6];
  uint rest = projection_weights(point.direction, weights);
  TerrainMaterial ground;
  ground.albedo = vec3(0.0);
  ground.normal = vec3(0.0);
  while (rest != 0u) {
    uint projection = uint(findLSB(rest));
    rest &= rest - 1u;
    bool own = projection == map_projections.own;
    ProjectionAxes a = axes;
    if (!own) a = projection_axes(projection, point.direction);
    TerrainMaterial m = terrain_ground(
        terrain.shading, own ? point.units : projection_units(projection, point.direction), point.altitude_m,
        map_from_local(normal, a), bend, footprint_m, terrain_projection_seed(terrain.seed, projection));
    ground.albedo += weights[projection] * m.albedo;
    ground.normal += weights[projection] * local_from_map(m.normal, a);
  }
  ground.normal = normalize(ground.normal);
  return ground;
}

// Returns the radiance of the ground towards the eye, without the medium in front of it.
vec3 ground_radiance(GroundPoint point) {
  vec3 shape = surface_shape(point.texel, point.layer);
  if (point.morph > 0.0) shape = mix(shape, surface_shape(point.parent_texel, point.layer + 1u), point.morph);
  vec2 gradient = shape.xy;

  vec3 to_eye = terrain.camera_position - point.position;
  float distance_m = length(to_eye);
  ProjectionAxes axes = projection_axes(map_projections.own, point.direction);
  vec3 up = axes.up;
  vec3 smooth_normal = normal_from_gradient(gradient, axes);
  float pixel_m = distance_m * terrain.pixel_angle_rad;
  // A pixel's width on the ground is longer where the ground is seen at a slant; use the geometric mean.
  float facing = max(dot(smooth_normal, to_eye) / distance_m, 0.05);
  float footprint_m = max(pixel_m / sqrt(facing), 0.01);
  TerrainMaterial ground = ground_material(point, axes, smooth_normal, shape.z, footprint_m);
  vec3 normal = ground.normal;

  uint cascade;
  float lit = sun_light_at(point.position, smooth_normal, cascade);
  float sun_cosine = max(dot(normal, terrain.direction_to_sun), 0.0);
  // Relief too fine for the shadow maps must not light a slope that faces away from the sun.
  lit *= clamp(dot(smooth_normal, terrain.direction_to_sun) * 8.0 + 0.5, 0.0, 1.0);
  // A crest seen against the sun has a sunlit rim that is often thinner than a pixel: the crest turns out of sight
  // within facing^2 / 2 of its radius. Counting the rim as a whole pixel would produce a string of bright dots.
  float turn_per_m = 2.0 * max(-shape.z, 0.0) / terrain.levels[point.layer].cell_m;
  float rim = clamp(facing * facing / (2.0 * turn_per_m * pixel_m + 1e-6), 0.3, 1.0);
  lit *= mix(1.0, rim, smoothstep(0.4, 0.8, -dot(to_eye, terrain.direction_to_sun) / distance_m));

  vec3 sun_on_plane, open_sky;
  ground_light(point.altitude_m, dot(up, terrain.direction_to_sun), sun_on_plane, open_sky);
  vec3 sun = sun_on_plane * (lit * sun_cosine);
#ifdef SHADOW_COLORS
  if (lit > 0.0) sun *= sun_color_at(point.position, smooth_normal, cascade, false);
#endif
  float visible = sky_visibility(point.offset_m, point.altitude_m, point.layer);
  vec3 sky = open_sky * (visible * 0.5 * (1.0 + dot(normal, up)));
  // The rest of the hemisphere is other ground under the same sky, lit on average like flat ground.
  vec3 sun_on_flat = sun_on_plane * max(dot(up, terrain.direction_to_sun), 0.0);
  vec3 bounced = ground.albedo * (open_sky + sun_on_flat) * (1.0 - visible * 0.5 * (1.0 + dot(normal, up)));

  vec3 albedo = ground.albedo;
  if (terrain.show_cascades != 0u && cascade < terrain.cascade_count)
    albedo = 0.75 * albedo + 0.25 * cascade_color(cascade);
  return albedo * 0.318309886 * (sun + sky + bounced) * terrain.sun_irradiance;
}

#endif
