// What the shaders of the meshes and of the bare ground read of one view (std430). Filled by src/scene/mesh/meshes.cpp.
// Places and directions are in the local frame of src/scene/view/local_frame.hpp. The fields up to `cascade` are those
// that sun_shadow.glsl needs.
struct MeshConstants {
  vec3 camera_position;
  float shadow_resolution;
  vec3 camera_forward;
  uint cascade_count;
  vec3 direction_to_sun;
  uint smooth_shadows;
  uint best_cascade;
  uint show_cascades;
  uint has_glass;  // the maps of colours are there
  float planet_radius_m;
  mat4 shadow_from_local[8];
  vec4 cascade[8];  // far view depth [m], texel x [m], texel y [m], depth range [m]
  vec3 sun_irradiance;
  float atmosphere_height_m;
  vec3 ground_albedo;
  float sky_light;       // part of the sky's light that reaches the meshes
  mat4 local_from_site;  // from the frame of the instances, at the place where the meshes stand
};

// One placed mesh.
struct MeshInstance {
  mat4 site_from_mesh;
  vec4 normal_x;  // columns of the inverse transpose; w: -1 where the placement mirrors
  vec4 normal_y;
  vec4 normal_z;
};
