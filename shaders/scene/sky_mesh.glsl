// The sky mesh of src/scene/sky/sky_model.hpp, for vertex shaders: a sphere of directions around the camera. A model
// may place each vertex at any distance.
#ifndef TYNDALL_SKY_MESH_GLSL
#define TYNDALL_SKY_MESH_GLSL

layout(std430, binding = 1) readonly buffer mesh_block {
  mat4 clip_from_local;
  vec3 mesh_up;  // away from the planet's centre
  uint mesh_columns;
  vec3 mesh_ahead;  // horizontal, below or above the sun
  uint mesh_rows;
  vec3 mesh_right;
  float unused_mesh;
  float mesh_angles[];  // azimuths from mesh_ahead of columns + 1 lines, then zenith angles of rows + 1 lines [rad]
};

// Returns the zenith angle of a vertex [rad].
float sky_mesh_zenith(uint index) { return mesh_angles[mesh_columns + 1u + index / (mesh_columns + 1u)]; }

// Returns the unit vector from the camera to vertex `index` in the local frame.
vec3 sky_mesh_direction(uint index) {
  uint row = index / (mesh_columns + 1u);
  float azimuth = mesh_angles[index - row * (mesh_columns + 1u)];
  float zenith = mesh_angles[mesh_columns + 1u + row];
  return mesh_up * cos(zenith) + (mesh_ahead * cos(azimuth) + mesh_right * sin(azimuth)) * sin(zenith);
}

// Returns the clip position of a vertex at `offset` from the camera. Its depth is that of the sky at any distance.
vec4 sky_mesh_clip(vec3 offset) { return clip_from_local * vec4(offset, 0.0); }

#endif
