// A frame made by hand for tyndall::Effect, through its public interface alone: a view, distances instead of
// device depths, shadow maps from a function; and what the physics says of each of its rays, in double
// precision.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "gpu/host.hpp"
#include "gpu_test.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

struct TestView {
  glm::dvec3 position = {0, 1000, 0};
  glm::dvec3 right = {1, 0, 0}, up = {0, 1, 0}, forward = {0, 0, -1};
  double tan_half_width = 1.0, tan_half_height = 1.0;

  // Above the world's origin. Angles in rad, as camera.yaw_deg and camera.pitch_deg.
  static TestView at(double altitude_m, double yaw_rad, double pitch_rad, double tan_half);
  // Unit vector through the middle of a pixel.
  [[nodiscard]] glm::dvec3 ray(std::uint32_t x, std::uint32_t y, VkExtent2D extent) const;
};

enum class DepthConvention : std::uint32_t { reversed_infinite, standard };

// A ray as the physics takes it.
struct RayAngles {
  double altitude_m, cos_view, cos_sun, cos_view_sun;
};

// The upper left corner of the picture in each image.
struct PictureOffsets {
  VkOffset2D color = {0, 0}, depth = {0, 0}, output = {0, 0};
};

struct TestFrame {
  VkExtent2D extent = {16, 9};
  // Larger images around the picture, filled with what must not be read; 0: of the picture's size.
  VkExtent2D image_extent = {0, 0};
  PictureOffsets offsets;
  TestView view;
  DepthConvention convention = DepthConvention::reversed_infinite;
  glm::dvec3 to_sun = {0, 1, 0};
  Vec3 irradiance = Vec3(1.0F);
  Vec3 background = Vec3(0.0F);
  // Distance along the ray of a pixel to what is seen there; none: sky everywhere. 0: sky.
  std::function<double(std::uint32_t x, std::uint32_t y)> distance_m;
  std::vector<Cascade> cascades;
  std::uint32_t first_marched = 0;
  std::uint32_t shadow_resolution = 64;
  bool shadow_depth_reversed = false;  // as in EffectDesc
  // Depth in a cascade's map at texture coordinates; none: nothing casts a shadow.
  std::function<float(std::uint32_t cascade, double u, double v)> shadow_depth;
  // What glass leaves there; none: the frame has no colours.
  std::function<glm::dvec3(std::uint32_t cascade, double u, double v)> shadow_color;
  std::function<float(std::uint32_t cascade, double u, double v)> glass_depth;  // and at which depth; none: no depths

  [[nodiscard]] RayAngles ray(std::uint32_t x, std::uint32_t y, double planet_radius_m) const;
};

// Images of a frame on the device, kept so that a frame can be recorded again.
class FrameImages {
 public:
  static Result<FrameImages> create(gpu::Host& host, const TestFrame& frame, OutputFormat format);
  [[nodiscard]] FrameInputs inputs(const TestFrame& frame) const;
  Result<std::vector<std::byte>> output_bytes(gpu::Host& host);
  // Red, green, blue of each pixel of the image, which is the picture's unless TestFrame::image_extent makes it larger.
  Result<std::vector<glm::dvec3>> output(gpu::Host& host);

 private:
  OutputFormat format_ = OutputFormat::rgba32f;
  gpu::Image color_, depth_, shadows_, glass_, output_;
};

// Records the frame once with an effect that has built its tables; red, green, blue of each pixel.
Result<std::vector<glm::dvec3>> render(gpu::Host& host, Effect& effect, const TestFrame& frame,
                                       OutputFormat format = OutputFormat::rgba32f);
// The same with an effect made for this frame alone.
Result<std::vector<glm::dvec3>> render(gpu::Host& host, const Params& params, const TestFrame& frame,
                                       OutputFormat format = OutputFormat::rgba32f);
// The same with an effect that is made once for all frames of a convention and format: to create one takes seconds.
class EffectKeeper {
 public:
  Result<std::vector<glm::dvec3>> render(gpu::Host& host, const Params& params, const TestFrame& frame,
                                         OutputFormat format = OutputFormat::rgba32f);
  void clear() { kept_.clear(); }  // before the host goes

 private:
  struct Kept {
    EffectDesc desc;
    Effect effect;
  };
  std::vector<Kept> kept_;
};
[[nodiscard]] EffectDesc desc_for(const TestFrame& frame, OutputFormat format = OutputFormat::rgba32f);

// A square map along the sun's direction, depth 0 nearest to the sun.
[[nodiscard]] Cascade sun_cascade(const glm::dvec3& to_sun, const glm::dvec3& middle, double half_m, double near_m,
                                  double far_m);
// A few pixels of ground and sky under two cascades with shadows in them.
[[nodiscard]] TestFrame small_frame();

[[nodiscard]] Params with_technique(Technique technique);
// scattering.scale 1, every pixel marched by itself, and enough integration_steps for 0.1 % where nothing shadows.
[[nodiscard]] Params precise_params();

// In-scattered radiance / E0 between two distances of a ray, with the fine steps of the CPU model, and the
// transmittance of the part from the camera (or the entry into the air) to `end`.
[[nodiscard]] glm::dvec3 true_inscattering(const Params& params, const RayAngles& ray, double start, double end);
[[nodiscard]] glm::dvec3 true_transmittance(const Params& params, const RayAngles& ray, double end);
// The part of the ray in the air, to the ground or the top; nothing when it misses the air.
struct AirSegment {
  double start, end;
  bool on_ground;
};
[[nodiscard]] std::optional<AirSegment> segment_below_top(const Params& params, const RayAngles& ray);

// Largest difference of a channel, relative to the brightest channel of the truth.
[[nodiscard]] double relative_error(const glm::dvec3& value, const glm::dvec3& truth);

}  // namespace tyndall
