// Meshes on the GPU, with or without terrain, and the bare ground if there is no terrain. They are drawn into the view,
// into the shadow cascades and, if they transmit light, into the maps of shadow colours.
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
  // Loads or generates the meshes that `params` names, and places them on `terrain`.
  static Result<std::unique_ptr<Meshes>> create(gpu::Host& host, const MeshParams& params, const Terrain& terrain,
                                                double radius_m, VkFormat color_format, VkFormat depth_format,
                                                VkFormat shadow_color_format);

  [[nodiscard]] bool any() const { return !data_.instances.empty(); }
  // Returns whether some meshes transmit light, so that maps of shadow colours are needed.
  [[nodiscard]] bool has_glass() const { return has_glass_; }
  // Returns `ground` with the heights of the meshes and, without terrain, with the meshes as the only casters.
  [[nodiscard]] Ground ground(Ground ground, const glm::dvec3& camera) const;
  [[nodiscard]] const std::vector<std::string>& notes() const { return data_.notes; }
  [[nodiscard]] VkDeviceSize bytes() const;

  // Writes the constants of a frame. Call it before recording the draws.
  void prepare(const View& view, const LocalFrame& frame, const ShadowParams& shadows,
               const std::vector<CascadeFit>& cascades, const TerrainLight& light, float sky_light);
  // Record draws into a rendering scope with colour and depth: first opaque surfaces, later clear glass in front of
  // them.
  Result<void> draw_view(VkCommandBuffer cmd, const View& view, const TerrainLight& light);
  Result<void> draw_clear_glass(VkCommandBuffer cmd, const View& view, const TerrainLight& light);
  // Record draws into a layer of the shadow maps, and into a layer of the shadow colours, which is cleared to one.
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
  MeshData data_;  // the vertices, indices and texels have been released after the upload
  // East, up and south at the position of the meshes, turned by meshes.yaw_deg. Instances are placed in this frame,
  // near its origin, so that rounding is small.
  glm::dmat4 world_from_site_ = glm::dmat4(1.0);
  glm::dmat4 site_from_model_ = glm::dmat4(1.0);
  LocalFrame frame_;  // the frame of the current view
  // Bounds in the frame of the meshes, mesh by mesh: one box for each part if the mesh has a single instance, otherwise
  // one for each instance.
  std::vector<Box> boxes_;
  std::array<glm::dvec3, 8> corners_ = {};  // corners of the bounds of all meshes, in world space
  double lowest_m_ = 0.0, highest_m_ = 0.0;

  gpu::Pipeline surfaces_, multiply_, add_, shadow_, shadow_mask_, colors_, ground_;
  gpu::UploadRing constants_;
  gpu::Buffer vertices_, indices_, instances_;
  std::vector<gpu::Image> textures_;                        // the last is white
  std::map<MeshSampler, gpu::Handle<VkSampler>> samplers_;  // one for each distinct MeshSampler of the materials
};

}  // namespace tyndall::scene
