// Meshes of the demo scene on the CPU: arrays of vertices and indices, parts with one material each, and instances that
// place the meshes. Created from glTF files (gltf_file.hpp) or in code (hall.hpp).
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

namespace tyndall::scene {

// Larger models are refused. The limits suit the memory of an ordinary device.
constexpr std::uint64_t kMaxMeshVertices = 1U << 24U;
constexpr std::uint64_t kMaxMeshIndices = 3U << 25U;
constexpr std::uint64_t kMaxMeshInstances = 1U << 18U;
constexpr std::uint32_t kMaxTextureSide = 8192;
constexpr std::uint64_t kMaxTextureBytes = std::uint64_t{1} << 30U;  // total of all textures, without mip levels

using MeshColor = std::array<std::uint16_t, 4>;  // linear RGBA, 0xFFFF is 1

// The layout of shaders/scene/mesh_vertex.glsl: ten words without padding.
struct MeshVertex {
  glm::vec3 position = {};
  glm::vec3 normal = {0, 1, 0};  // unit length
  glm::vec2 uv = {};
  MeshColor color = {0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF};  // factor of the material's colour
};
static_assert(sizeof(MeshVertex) == 40);

enum class SurfaceKind : std::uint32_t {
  opaque,
  mask,   // opaque with holes
  blend,  // transmits the fraction 1 - alpha of light, tinted
  glass,  // transmits light, multiplied by the colour
};

enum class TextureWrap : std::uint32_t { repeat, mirrored_repeat, clamp_to_edge };
enum class MipFilter : std::uint32_t { none, nearest, linear };  // none: only the first level is sampled

// The wrap modes and filters of a texture. By default it repeats, and is filtered between texels and mip levels.
struct MeshSampler {
  TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
  bool mag_linear = true, min_linear = true;  // false: nearest
  MipFilter mip = MipFilter::linear;
  auto operator<=>(const MeshSampler&) const = default;
};

struct MeshMaterial {
  std::string name;
  glm::vec4 color = glm::vec4(1.0F);  // linear
  int texture = -1;                   // sRGB, multiplied by the colour; -1: none
  MeshSampler sampler;
  SurfaceKind kind = SurfaceKind::opaque;
  float alpha_cutoff = 0.0F;  // texels with a smaller alpha are holes; 0: none
  float transmission = 0.0F;  // glass only: fraction of light that is not reflected diffusely
  float roughness = 1.0F;     // glass only: from kRoughGlass on it diffuses transmitted light, below it is clear
  bool double_sided = false;
  [[nodiscard]] bool transmits() const { return kind == SurfaceKind::blend || kind == SurfaceKind::glass; }
  [[nodiscard]] bool diffuses() const;
};
constexpr float kRoughGlass = 0.5F;
inline bool MeshMaterial::diffuses() const { return kind == SurfaceKind::glass && roughness >= kRoughGlass; }

struct MeshTexture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // sRGB, rows from top to bottom
};

// Triangles with one material, counter-clockwise seen from the front.
struct MeshPart {
  std::uint32_t first_index = 0, index_count = 0;
  std::uint32_t material = 0;
};

// Parts that are placed together by the instances [first_instance, first_instance + instance_count).
struct Mesh {
  std::uint32_t first_part = 0, part_count = 0;
  std::uint32_t first_instance = 0, instance_count = 0;
};

struct Box {
  glm::dvec3 min = glm::dvec3(std::numeric_limits<double>::max());
  glm::dvec3 max = glm::dvec3(std::numeric_limits<double>::lowest());
  void add(const glm::dvec3& p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
  [[nodiscard]] bool empty() const { return min.x > max.x; }
};

struct MeshData {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;  // indices into `vertices`
  std::vector<MeshPart> parts;
  std::vector<Mesh> meshes;
  std::vector<glm::mat4> instances;  // transform a mesh to the model; ordered by mesh
  std::vector<MeshMaterial> materials;
  std::vector<MeshTexture> textures;
  std::vector<std::string> notes;  // remarks for the user, one line each
  Box bounds;                      // contains all instances; in the coordinates of the model [m]
};

}  // namespace tyndall::scene
