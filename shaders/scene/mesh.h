// The constants of one view for the shaders of meshes and of the bare ground (std430). src/scene/mesh/meshes.cpp fills
// them. Points and directions are in the local frame of src/scene/view/local_frame.hpp. sun_shadow.glsl reads the
// fields up to `cascade`.
struct MeshConstants {
  vec3 camera_position;
  float shadow_resolution;
  vec3 camera_forward;
  uint cascade_count;
  vec3 direction_to_sun;
  uint smooth_shadows;
  uint best_cascade;
  uint show_cascades;
  uint has_glass;  // 1: the colour maps exist
  float planet_radius_m;
  mat4 shadow_from_local[8];
  vec4 cascade[8];  // far view depth [m], texel x [m], texel y [m], depth range [m]
  vec3 sun_irradiance;
  float atmosphere_height_m;
  vec3 ground_albedo;
  float sky_light;       // fraction of the sky's light that reaches the meshes
  mat4 local_from_site;  // from the frame of the instances, at the place where the meshes stand
};

// One instance of a mesh.
struct MeshInstance {
  mat4 site_from_mesh;
  vec4 normal_x;  // columns of the inverse transpose; w is -1 if the transform mirrors
  vec4 normal_y;
  vec4 normal_z;
};
