// Meshes on the CPU side, as the demo scene draws them: one array of vertices, one of indices, parts with a material
// each, and instances that place the meshes. Filled from glTF files (gltf_file.hpp) or in code (hall.hpp).
#pragma once

#include <compare>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

namespace tyndall::scene {

// More than these is refused: what a picture on an ordinary device can hold.
constexpr std::uint64_t kMaxMeshVertices = 1U << 24U;
constexpr std::uint64_t kMaxMeshIndices = 3U << 25U;
constexpr std::uint64_t kMaxMeshInstances = 1U << 18U;
constexpr std::uint32_t kMaxTextureSide = 8192;
constexpr std::uint64_t kMaxTextureBytes = std::uint64_t{1} << 30U;  // of all textures together, without mip levels

// As shaders/scene/mesh_vertex.glsl reads it: nine words without padding.
struct MeshVertex {
  glm::vec3 position = {};
  glm::vec3 normal = {0, 1, 0};  // unit length
  glm::vec2 uv = {};
  std::uint32_t color = 0xFFFFFFFFU;  // RGBA8, linear, red lowest; multiplies the material's colour
};
static_assert(sizeof(MeshVertex) == 36);

enum class SurfaceKind : std::uint32_t {
  opaque,
  mask,   // texels with alpha below the cutoff are holes
  blend,  // light passes in the part 1 - alpha, tinted
  glass,  // light passes, multiplied by the colour
};

enum class TextureWrap : std::uint32_t { repeat, mirrored_repeat, clamp_to_edge };
enum class MipFilter : std::uint32_t { none, nearest, linear };  // none: only the picture itself is sampled

// How a texture is sampled. The default repeats it and filters between texels and mip levels.
struct MeshSampler {
  TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
  bool mag_linear = true, min_linear = true;  // nearest otherwise
  MipFilter mip = MipFilter::linear;
  auto operator<=>(const MeshSampler&) const = default;
};

struct MeshMaterial {
  std::string name;
  glm::vec4 color = glm::vec4(1.0F);  // linear
  int texture = -1;                   // sRGB; multiplies the colour
  MeshSampler sampler;                // of the texture
  SurfaceKind kind = SurfaceKind::opaque;
  float alpha_cutoff = 0.5F;
  float transmission = 0.0F;  // of glass: the part of the light that is not reflected diffusely
  float roughness = 1.0F;     // glass from kRoughGlass on diffuses what passes, clearer glass is seen through
  bool double_sided = false;
  [[nodiscard]] bool transmits() const { return kind == SurfaceKind::blend || kind == SurfaceKind::glass; }
  [[nodiscard]] bool diffuses() const;
};
constexpr float kRoughGlass = 0.5F;
inline bool MeshMaterial::diffuses() const { return kind == SurfaceKind::glass && roughness >= kRoughGlass; }

struct MeshTexture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // colour in sRGB, rows from the top
};

// Triangles of one material, counter-clockwise seen from the front.
struct MeshPart {
  std::uint32_t first_index = 0, index_count = 0;
  std::uint32_t material = 0;
};

// Parts that are placed together, and how often: instances [first_instance, first_instance + instance_count).
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
  std::vector<std::uint32_t> indices;  // into vertices
  std::vector<MeshPart> parts;
  std::vector<Mesh> meshes;
  std::vector<glm::mat4> instances;  // model from mesh, by mesh
  std::vector<MeshMaterial> materials;
  std::vector<MeshTexture> textures;
  std::vector<std::string> notes;  // remarks for the user, one line each
  Box bounds;                      // of all that is placed, in the model's coordinates [m]
};

}  // namespace tyndall::scene
