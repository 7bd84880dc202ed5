// The vertices of meshes, for the view and for the shadow maps.
#ifndef TYNDALL_MESH_VERTEX_GLSL
#define TYNDALL_MESH_VERTEX_GLSL

#include "scene/mesh.h"
#include "scene/mesh_push.glsl"

layout(std430, binding = 0) readonly buffer mesh_block { MeshConstants mesh; };
layout(std430, binding = 1) readonly buffer vertices_block { uint vertex_words[]; };
layout(std430, binding = 2) readonly buffer instances_block { MeshInstance instances[]; };

// MeshVertex of src/scene/mesh/mesh_data.hpp: ten words per vertex.
struct MeshVertex {
  vec3 position;  // in the local frame
  vec3 normal;    // likewise, unit length
  vec2 uv;
  vec4 color;
  float handed;
};

vec3 vertex_vec3(uint word) {
  return vec3(uintBitsToFloat(vertex_words[word]), uintBitsToFloat(vertex_words[word + 1u]),
              uintBitsToFloat(vertex_words[word + 2u]));
}

MeshVertex mesh_vertex(uint vertex, uint instance) {
  uint word = vertex * 10u;
  MeshInstance placed = instances[instance];
  MeshVertex v;
  v.position = (mesh.local_from_site * vec4((placed.site_from_mesh * vec4(vertex_vec3(word), 1.0)).xyz, 1.0)).xyz;
  vec3 n = vertex_vec3(word + 3u);
  vec3 normal = placed.normal_x.xyz * n.x + placed.normal_y.xyz * n.y + placed.normal_z.xyz * n.z;
  v.normal = normalize(mat3(mesh.local_from_site) * normal);
  v.uv = vec2(uintBitsToFloat(vertex_words[word + 6u]), uintBitsToFloat(vertex_words[word + 7u]));
  v.color = vec4(unpackUnorm2x16(vertex_words[word + 8u]), unpackUnorm2x16(vertex_words[word + 9u]));
  v.handed = placed.normal_x.w;
  return v;
}

#endif
