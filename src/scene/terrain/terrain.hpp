// The terrain on the GPU: fills the clipmap of elevations around the camera, and draws it for the view and for the
// shadow cascades.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "gpu/descriptors.hpp"
#include "gpu/host.hpp"
#include "gpu/upload_ring.hpp"
#include "scene/elevation/elevation_source.hpp"
#include "scene/terrain/terrain_lod.hpp"
#include "scene/terrain/terrain_tiles.hpp"
#include "scene/view/cascades.hpp"
#include "scene/view/local_frame.hpp"
#include "tyndall/effect.hpp"

namespace tyndall::scene {

// The inputs for shading the ground in a frame, apart from the geometry.
struct TerrainLight {
  glm::dvec3 direction_to_sun = {};
  Vec3 sun_irradiance = Vec3(0.0F);  // above the atmosphere, times scattering.scale
  double atmosphere_height_m = 0.0;
  LightTables tables;
  VkImageView shadow_maps = VK_NULL_HANDLE;
  VkSampler shadow_sampler = VK_NULL_HANDLE;
  VkImageView shadow_colors = VK_NULL_HANDLE;  // one white texel without glass
  bool has_glass = false;
  VkSampler linear = VK_NULL_HANDLE;
};

// Returns the elevation of the ground [m], in the finest detail that is drawn, in the direction `up` from the planet's
// centre.
[[nodiscard]] double ground_height(const ElevationSource& source, const glm::dvec3& up, double radius_m);

class Terrain {
 public:
  // Creates the terrain. With terrain.source = none there is nothing to draw, and the ground is at sea level.
  // `coarseness`: see TerrainLod.
  static Result<std::unique_ptr<Terrain>> create(gpu::Host& host, const TerrainParams& params, double radius_m,
                                                 VkFormat color_format, VkFormat depth_format, int coarseness = 1);

  // Reads or generates the elevations for plan_source(). May take seconds; may run on another thread.
  static Result<ElevationSource> load_source(const gpu::Device& device, const TerrainParams& params, double radius_m);
  // Uploads elevations that were loaded for these parameters and this radius, to replace the current ones.
  struct Planned;
  [[nodiscard]] Result<Planned> plan_source(const TerrainParams& params, double radius_m, ElevationSource source) const;
  // Exchanges the current and the planned elevations. A second call undoes the first.
  void swap_source(Planned& planned) noexcept;
  // Changes the level of detail; see TerrainLod::coarseness.
  Result<void> set_coarseness(int coarseness);
  // Returns a number that increases with every change of what is drawn.
  [[nodiscard]] std::uint64_t version() const { return version_; }

  // Moves the clipmap to the camera. From then on everything is drawn in `frame`, which belongs to the camera's
  // position.
  Result<void> update(const View& view, const LocalFrame& frame);

  [[nodiscard]] bool none() const { return params_.source == "none"; }
  [[nodiscard]] Ground ground() const;
  // Returns the elevation of the ground [m] in the direction `up` from the planet's centre.
  [[nodiscard]] double height_at(const glm::dvec3& up) const;
  // Returns the elevations, which are immutable and may be read from any thread.
  [[nodiscard]] std::shared_ptr<const ElevationSource> source() const { return none() ? nullptr : source_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
  // Returns where the origin of the world is on the Earth, if an elevation file says so.
  [[nodiscard]] const std::optional<Place>& place() const { return source_->place(); }
  [[nodiscard]] VkDeviceSize bytes() const;

  // Selects the blocks of a frame, fills the elevations that they need, and writes the constants. Synchronous. Call it
  // before recording the draws.
  Result<void> prepare(const View& view, std::uint32_t height_px, const ShadowParams& shadows,
                       const std::vector<CascadeFit>& cascades, const TerrainLight& light, TerrainShading shading);
  // Records the drawing of the ground into a rendering scope with colour and depth. The colour identifies the point of
  // the ground; light_view(), outside of the scope and with the image in GENERAL layout, replaces it by radiance.
  Result<void> draw_view(VkCommandBuffer cmd, const View& view);
  Result<void> light_view(VkCommandBuffer cmd, const TerrainLight& light, VkImageView color, VkExtent2D extent);
  // Record the same with pipelines of the caller, which are built on scene/terrain_vertex.glsl and
  // scene/terrain_pixel.glsl. `more` holds the resources that these read in addition to the terrain's.
  Result<void> draw_view(VkCommandBuffer cmd, const View& view, const gpu::Pipeline& pipeline,
                         std::span<const gpu::NamedResource> more);
  Result<void> light_view(VkCommandBuffer cmd, const TerrainLight& light, VkImageView color, VkExtent2D extent,
                          const gpu::Pipeline& pipeline, std::span<const gpu::NamedResource> more);
  // Records the drawing into a layer of the shadow map, inside its rendering scope.
  Result<void> draw_cascade(VkCommandBuffer cmd, const CascadeFit& cascade, std::uint32_t index);

 private:
  Result<void> create_objects(VkFormat color_format, VkFormat depth_format);
  [[nodiscard]] Result<gpu::Buffer> create_indices(int coarseness) const;
  Result<void> fill_missing();
  Result<void> draw(VkCommandBuffer cmd, const gpu::Pipeline& pipeline, std::span<const gpu::NamedResource> resources,
                    const glm::dmat4& clip_from_world, std::uint32_t range);

  [[nodiscard]] std::vector<gpu::NamedResource> geometry() const;
  [[nodiscard]] std::vector<gpu::NamedResource> lit(const TerrainLight& light) const;

  struct Range {
    std::uint32_t first = 0, count = 0;
  };

  gpu::Host* host_ = nullptr;
  TerrainParams params_;
  double radius_m_ = 0.0;
  int coarseness_ = 1;
  std::uint64_t version_ = 0;
  std::shared_ptr<const ElevationSource> source_;
  std::vector<std::string> notes_;
  TerrainLod lod_;
  LocalFrame frame_;
  TerrainTiles tiles_;
  int filled_projection_ = 0;

  gpu::Pipeline fill_;
  gpu::Pipeline view_pipeline_;
  gpu::Pipeline light_;
  gpu::Pipeline shadow_pipeline_;
  gpu::Image heights_;
  gpu::Image atlas_;
  gpu::Buffer fill_constants_;
  gpu::Buffer fill_tiles_;
  gpu::UploadRing map_projections_;
  gpu::UploadRing constants_;
  gpu::UploadRing blocks_;
  gpu::Buffer indices_;
  gpu::Handle<VkSampler> nearest_;
  std::vector<Range> ranges_;  // the blocks of the view, then those of each cascade
  std::vector<TerrainBlock> scratch_;
};

struct Terrain::Planned {
  TerrainParams params;
  double radius_m = 0.0;
  std::uint64_t version = 0;
  std::shared_ptr<const ElevationSource> source;
  std::vector<std::string> notes;
  TerrainTiles tiles;
  gpu::Image atlas;
};

}  // namespace tyndall::scene
