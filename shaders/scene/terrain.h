// The constants of one view for the terrain's shaders (std430; every vec3 or pair of vec2 fills 16 bytes).
// src/scene/terrain/terrain.cpp fills them. Points and directions are in the local frame of
// src/scene/view/local_frame.hpp.
struct TerrainLevel {
  ivec2 origin;  // grid index on the projection of the texture's first sample
  vec2 first_m;  // the sample's position on the map, relative to the origin of the local frame, like all map positions
                 // (map_projections.glsl)
  float cell_m;
  float range_m;
};

struct TerrainConstants {
  vec2 camera_map;  // below the camera
  float vertical_m;
  float planet_radius_m;
  vec3 direction_to_sun;
  float atmosphere_height_m;
  vec3 sun_irradiance;
  float pixel_angle_rad;
  vec3 camera_position;
  uint block_cells;  // along a side of a block
  uint layers;
  uint shading;  // a TerrainShading of scene_params.def
  uint seed;
  uint cascade_count;
  float shadow_resolution;
  uint smooth_shadows;
  uint best_cascade;
  uint show_cascades;
  vec3 camera_forward;
  uint has_glass;  // 1: the colour maps exist
  mat4 shadow_from_local[8];
  vec4 cascade[8];  // far view depth [m], texel x [m], texel y [m], depth range [m]
  TerrainLevel levels[16];
};
