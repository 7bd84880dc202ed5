// Meshes on the GPU, beside the terrain or instead of it, and the bare ground where there is no terrain. Drawn into
// the view, into the shadow cascades and, where light passes through them, into the maps of colours.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>

#include "scene/mesh/cull.hpp"
#include "scene/mesh/mesh_data.hpp"
#include "scene/terrain/terrain.hpp"

namespace tyndall::scene {

class Meshes {
 public:
  // Loads or makes what `params` names; the meshes stand on `terrain`.
  static Result<std::unique_ptr<Meshes>> create(gpu::Host& host, const MeshParams& params, const Terrain& terrain,
                                                double radius_m, VkFormat color_format, VkFormat depth_format,
                                                VkFormat shadow_color_format);

  [[nodiscard]] bool any() const { return !data_.instances.empty(); }
  // Whether light passes through some of them: the maps of colours are wanted.
  [[nodiscard]] bool has_glass() const { return has_glass_; }
  // `ground` with the meshes' heights and, without terrain, with them as the only casters.
  [[nodiscard]] Ground ground(Ground ground, const glm::dvec3& camera) const;
  [[nodiscard]] const std::vector<std::string>& notes() const { return data_.notes; }
  [[nodiscard]] VkDeviceSize bytes() const;

  // Writes the constants: before the draws are recorded.
  void prepare(const View& view, const LocalFrame& frame, const ShadowParams& shadows,
               const std::vector<CascadeFit>& cascades, const TerrainLight& light, float sky_light);
  // Inside a rendering scope with colour and depth: first what hides, then, over what lies behind, clear glass.
  Result<void> draw_view(VkCommandBuffer cmd, const View& view, const TerrainLight& light);
  Result<void> draw_clear_glass(VkCommandBuffer cmd, const View& view, const TerrainLight& light);
  // With a layer of the shadow maps; with a layer of the maps of colours, cleared to one.
  Result<void> draw_cascade(VkCommandBuffer cmd, const CascadeFit& cascade);
  Result<void> draw_colors(VkCommandBuffer cmd, const CascadeFit& cascade);

 private:
  Result<void> load(const MeshParams& params, const Terrain& terrain);
  Result<void> create_pipelines(VkFormat color_format, VkFormat depth_format, VkFormat shadow_color_format);
  Result<void> create_buffers();
  void find_boxes();
  [[nodiscard]] std::vector<gpu::NamedResource> resources(const TerrainLight* light) const;
  template <typename Choose>
  Result<void> draw(VkCommandBuffer cmd, const gpu::Pipeline& pipeline, const glm::dmat4& clip_from_world,
                    const TerrainLight* light, const Choose& choose);

  gpu::Host* host_ = nullptr;
  double radius_m_ = 0.0;
  bool bare_ground_ = false;
  bool has_glass_ = false;
  MeshData data_;  // without vertices, indices and texels once they are on the device
  // East, up and south where the meshes stand, turned by meshes.yaw_deg: instances are placed in this frame, so that
  // what is rounded is near its origin.
  glm::dmat4 world_from_site_ = glm::dmat4(1.0);
  glm::dmat4 site_from_model_ = glm::dmat4(1.0);
  LocalFrame frame_;  // of the view
  // In the site's frame. Of meshes that are placed once those of their parts, of others those of their instances; mesh
  // by mesh.
  std::vector<Box> boxes_;
  std::array<glm::dvec3, 8> corners_ = {};  // of the bounds, in the world
  double lowest_m_ = 0.0, highest_m_ = 0.0;

  gpu::Pipeline surfaces_, multiply_, add_, shadow_, shadow_mask_, colors_, ground_;
  gpu::Buffer constants_, vertices_, indices_, instances_;
  std::vector<gpu::Image> textures_;                        // the last is white
  std::map<MeshSampler, gpu::Handle<VkSampler>> samplers_;  // of the materials
};

}  // namespace tyndall::scene
