// Models other than the effect that draw the frame (scattering.model): each lights the ground through its own air
// and draws the sky on a mesh around the camera, straight into the scene's colour. What they share
// is here: the mesh, the pipelines, the drawing. A model adds five shaders and what those read.
//
// Shaders. Ground: over scene/terrain_vertex.glsl, scene/terrain_point.glsl and, to light it, scene/terrain_pixel.glsl
// (bindings 0 to 5 and 8, locations 0 and 1 are the terrain's). What the vertices find of the air goes from further
// locations into images, air_0 and on, which the pass that lights reads; evaluated per pixel, that pass finds it
// itself, and the ground is drawn as for the effect. Sky: over scene/sky_mesh.glsl and scene/sun_disc.glsl (bindings 0
// and 1). The model's own constants are the block `model_block` at binding 6; further resources come at 7 and from 9.
// Specialisation constant 0 is 1 with scattering.evaluate = pixel; a model may have variants by constants of its own.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "scene/terrain/terrain.hpp"

namespace tyndall::scene {

// What a model reads of a frame. All of it outlives the recording of the frame.
struct ModelFrame {
  const View& view;
  const LocalFrame& local;  // in which everything on the device is
  const TerrainLight& light;
  const Params& params;
  const SceneParams& scene;
  VkExtent2D extent;
};

class SkyModel {
 public:
  virtual ~SkyModel() = default;
  SkyModel(const SkyModel&) = delete;
  SkyModel& operator=(const SkyModel&) = delete;

  // Writes the constants of a frame: before its draws are recorded, and with none in flight.
  Result<void> prepare(const ModelFrame& frame);
  // Inside a rendering scope with colour, `attachments()` and depth: see Terrain::draw_view.
  Result<void> draw_ground(VkCommandBuffer cmd, Terrain& terrain, const ModelFrame& frame);
  // Outside of it, with colour and air() in GENERAL layout: radiance of the ground behind the air.
  Result<void> light_ground(VkCommandBuffer cmd, Terrain& terrain, const ModelFrame& frame, VkImageView color);
  // Inside a rendering scope with colour and depth. `background` holds the sun's disc.
  Result<void> draw_sky(VkCommandBuffer cmd, VkBuffer background);

  [[nodiscard]] const ModelEvaluation& evaluation() const { return evaluation_; }
  // Images of what the vertices of the ground find of the air; one texel each where pixels find it.
  [[nodiscard]] std::span<const gpu::Image> air() const { return air_; }
  // Those of air() that the ground is drawn into.
  [[nodiscard]] std::span<const gpu::Image> attachments() const {
    return evaluation_ == ModelEvaluation::vertex ? air() : std::span<const gpu::Image>();
  }
  [[nodiscard]] VkDeviceSize bytes() const;
  // Whether the terrain is the ground; the sky pipeline draws what lies below the horizon otherwise.
  [[nodiscard]] virtual bool draws_terrain(const SceneParams& scene) const {
    static_cast<void>(scene);
    return true;
  }

 protected:
  struct Shaders {
    const gpu::Shader* ground_vertex;
    const gpu::Shader* ground_fragment;
    const gpu::Shader* ground_light;
    std::uint32_t air_images;  // that the fragment writes after the place on the ground
    const gpu::Shader* sky_vertex;
    const gpu::Shader* sky_fragment;
  };
  SkyModel() = default;
  Result<void> create_objects(gpu::Host& host, const Shaders& shaders, ModelEvaluation evaluation,
                              std::size_t constants_bytes, VkFormat color_format, VkFormat depth_format,
                              std::span<const std::span<const gpu::Constant>> variants = {});

  // Fills `model_block`, constants_bytes long.
  virtual Result<void> fill(const ModelFrame& frame, void* constants) = 0;
  // Which of the variants that create_objects was given draws the frame that has been filled.
  [[nodiscard]] virtual std::size_t variant() const { return 0; }
  // What the shaders read beyond model_block.
  [[nodiscard]] virtual std::vector<gpu::NamedResource> more_resources() const { return {}; }

  gpu::Host* host_ = nullptr;

 private:
  void fill_mesh(const ModelFrame& frame);
  Result<void> create_air(VkExtent2D extent);
  [[nodiscard]] std::vector<gpu::NamedResource> own_resources() const;

  ModelEvaluation evaluation_ = ModelEvaluation::vertex;
  std::vector<gpu::Pipeline> ground_, light_, sky_;  // by variant; of the ground none where pixels find the air
  std::vector<gpu::Image> air_;
  VkFormat air_format_ = VK_FORMAT_UNDEFINED;
  gpu::Buffer mesh_, indices_, constants_;
};

// The model that scattering.model names; not for `atmosphere`, which is the effect's.
Result<std::unique_ptr<SkyModel>> create_sky_model(gpu::Host& host, const SceneParams& scene, VkFormat color_format,
                                                   VkFormat depth_format);

}  // namespace tyndall::scene
