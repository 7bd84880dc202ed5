// Models other than the effect that draw the frame (scattering.model): each shades the ground with its own
// pipeline and draws the sky on a mesh around the camera, straight into the scene's colour. What they share
// is here: the mesh, the pipelines, the drawing. A model adds four shaders and what those read.
//
// Shaders. Ground: over scene/terrain_vertex.glsl and scene/terrain_inputs.glsl (bindings 0 to 5 and locations 0
// to 4 are the terrain's). Sky: over scene/sky_mesh.glsl and scene/sun_disc.glsl (bindings 0 and 1). The model's
// own constants are the block `model_block` at binding 6 in all four; further resources come after it.
// Specialisation constant 0 is 1 with scattering.evaluate = pixel; a model may have variants by constants of its own.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "scene/terrain.hpp"

namespace tyndall::scene {

// What a model reads of a frame. All of it outlives the recording of the frame.
struct ModelFrame {
  const View& view;
  const TerrainLight& light;
  const Params& params;
  const SceneParams& scene;
};

class SkyModel {
 public:
  virtual ~SkyModel() = default;
  SkyModel(const SkyModel&) = delete;
  SkyModel& operator=(const SkyModel&) = delete;

  // Writes the constants of a frame: before its draws are recorded.
  Result<void> prepare(const ModelFrame& frame);
  // Inside a rendering scope with colour and depth, the ground first. `background` holds the sun's disc.
  Result<void> draw_ground(VkCommandBuffer cmd, Terrain& terrain, const ModelFrame& frame);
  Result<void> draw_sky(VkCommandBuffer cmd, VkBuffer background);

  [[nodiscard]] const ModelEvaluation& evaluation() const { return evaluation_; }
  [[nodiscard]] VkDeviceSize bytes() const { return mesh_.bytes + constants_.bytes + indices_.bytes; }

 protected:
  struct Shaders {
    const gpu::Shader* ground_vertex;
    const gpu::Shader* ground_fragment;
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
  // Whether the terrain is the ground; the sky pipeline draws what lies below the horizon otherwise.
  [[nodiscard]] virtual bool draws_terrain(const ModelFrame& frame) const {
    static_cast<void>(frame);
    return true;
  }
  // What the shaders read beyond model_block.
  [[nodiscard]] virtual std::vector<gpu::NamedResource> more_resources() const { return {}; }

  gpu::Host* host_ = nullptr;

 private:
  void fill_mesh(const ModelFrame& frame);

  ModelEvaluation evaluation_ = ModelEvaluation::vertex;
  std::vector<gpu::Pipeline> ground_, sky_;  // by variant
  gpu::Buffer mesh_, indices_, constants_;
};

// The model that scattering.model names; not for `atmosphere`, which is the effect's.
Result<std::unique_ptr<SkyModel>> create_sky_model(gpu::Host& host, const SceneParams& scene, VkFormat color_format,
                                                   VkFormat depth_format);

}  // namespace tyndall::scene
