// The models that draw a frame instead of the effect (scattering.model). Each lights the ground through its own
// atmosphere and draws the sky on a mesh around the camera, directly into the scene's colour. This class contains what
// they have in common: the mesh, the pipelines and the drawing. A model adds five shaders and the resources that these
// read.
//
// Shaders of the ground use scene/terrain_vertex.glsl, scene/terrain_point.glsl and, for lighting, terrain_pixel.glsl.
// Bindings 0 to 5 and 8 and locations 0 and 1 belong to the terrain. The results at the vertices go through further
// locations to the images air_0, air_1 and so on, which the lighting pass reads. With evaluation per pixel, the
// lighting pass computes the atmosphere itself, and the ground is drawn as for the effect. Shaders of the sky use
// scene/sky_mesh.glsl and scene/sun_disc.glsl (bindings 0 and 1). The constants of a model are the block `model_block`
// at binding 6, and its other resources are at bindings 7 and from 9 on. Specialisation constant 0 is 1 with
// scattering.evaluate = pixel. A model may have variants that differ in other constants.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "scene/terrain/terrain.hpp"

namespace tyndall::scene {

// The inputs of a model in a frame. All of them outlive the recording of the frame.
struct ModelFrame {
  const View& view;
  const LocalFrame& local;  // the coordinate system of all positions on the device
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

  // Writes the constants of a frame. Call it before recording the draws. There may be kFramesInFlight - 1 frames in
  // flight, or none if `extent` has changed.
  Result<void> prepare(const ModelFrame& frame);
  // Records the ground into a rendering scope with colour, `attachments()` and depth: see Terrain::draw_view.
  Result<void> draw_ground(VkCommandBuffer cmd, Terrain& terrain, const ModelFrame& frame);
  // Records the lighting of the ground. Call it outside of the scope, with colour and air() in GENERAL layout.
  Result<void> light_ground(VkCommandBuffer cmd, Terrain& terrain, const ModelFrame& frame, VkImageView color);
  // Records the sky into a rendering scope with colour and depth. `background` holds the sun's disc.
  Result<void> draw_sky(VkCommandBuffer cmd, VkBuffer background);

  [[nodiscard]] const ModelEvaluation& evaluation() const { return evaluation_; }
  // Returns the images of in-scattering and transmittance that the ground's vertices write. With evaluation per pixel,
  // they have one texel each and are not written.
  [[nodiscard]] std::span<const gpu::Image> air() const { return air_; }
  // Returns the images of air() that are attachments while the ground is drawn: all or none.
  [[nodiscard]] std::span<const gpu::Image> attachments() const {
    return evaluation_ == ModelEvaluation::vertex ? air() : std::span<const gpu::Image>();
  }
  [[nodiscard]] VkDeviceSize bytes() const;
  // Returns whether the terrain is the ground; otherwise the sky's pipeline draws everything below the horizon.
  [[nodiscard]] virtual bool draws_terrain(const SceneParams& scene) const {
    static_cast<void>(scene);
    return true;
  }

 protected:
  struct Shaders {
    const gpu::Shader* ground_vertex;
    const gpu::Shader* ground_fragment;
    const gpu::Shader* ground_light;
    std::uint32_t air_images;  // number of images that the fragment shader writes after the point of the ground
    const gpu::Shader* sky_vertex;
    const gpu::Shader* sky_fragment;
  };
  SkyModel() = default;
  Result<void> create_objects(gpu::Host& host, const Shaders& shaders, ModelEvaluation evaluation,
                              std::size_t constants_bytes, VkFormat color_format, VkFormat depth_format,
                              std::span<const std::span<const gpu::Constant>> variants = {});

  // Fills `model_block`, which has constants_bytes bytes.
  virtual Result<void> fill(const ModelFrame& frame, void* constants) = 0;
  // Returns the index of the variant, as given to create_objects(), that draws the prepared frame.
  [[nodiscard]] virtual std::size_t variant() const { return 0; }
  // Returns the resources that the shaders read besides model_block.
  [[nodiscard]] virtual std::vector<gpu::NamedResource> more_resources() const { return {}; }

  gpu::Host* host_ = nullptr;

 private:
  void fill_mesh(const ModelFrame& frame);
  Result<void> create_air(VkExtent2D extent);
  [[nodiscard]] std::vector<gpu::NamedResource> own_resources() const;

  ModelEvaluation evaluation_ = ModelEvaluation::vertex;
  std::vector<gpu::Pipeline> ground_, light_, sky_;  // by variant; ground_ is empty with evaluation per pixel
  std::vector<gpu::Image> air_;
  VkFormat air_format_ = VK_FORMAT_UNDEFINED;
  gpu::Buffer indices_;
  gpu::UploadRing mesh_, constants_;
};

// Creates the model of scattering.model. Precondition: it is not `atmosphere`, which the effect draws.
Result<std::unique_ptr<SkyModel>> create_sky_model(gpu::Host& host, const SceneParams& scene, VkFormat color_format,
                                                   VkFormat depth_format);

}  // namespace tyndall::scene
