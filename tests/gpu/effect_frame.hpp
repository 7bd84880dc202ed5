// A synthetic frame for the public interface of tyndall::Effect, made of a view, distances instead of device depths,
// and shadow maps given by a function. Also computes the expected light of its rays in double precision.
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
  glm::dvec2 jitter_px = {0, 0};  // of temporal anti-aliasing: the rays pass beside the centres of the pixels

  // Returns a view from above the origin of the world. The angles correspond to camera.yaw_deg and camera.pitch_deg.
  static TestView at(double altitude_m, double yaw_rad, double pitch_rad, double tan_half);
  // Returns the direction of a pixel's ray as a unit vector.
  [[nodiscard]] glm::dvec3 ray(std::uint32_t x, std::uint32_t y, VkExtent2D extent) const;
};

enum class DepthConvention : std::uint32_t { reversed_infinite, standard };

// A ray as the functions of shaders/lib take it.
struct RayAngles {
  double altitude_m, cos_view, cos_sun, cos_view_sun;
};

// The upper left corner of the picture in each image.
struct PictureOffsets {
  VkOffset2D color = {0, 0}, depth = {0, 0}, output = {0, 0};
};

struct TestClouds {
  // Returns the transmittance of clouds and, in w, the depth of their layer. Without the function, there are none.
  std::function<glm::dvec4(double u, double v)> texel;
  Mat4 map_from_world;
  std::uint32_t resolution = 64;
};

struct TestFrame {
  VkExtent2D extent = {16, 9};
  // Size of the images, which may be larger than the picture; the rest must not be read. 0: size of the picture.
  VkExtent2D image_extent = {0, 0};
  PictureOffsets offsets;
  TestView view;
  DepthConvention convention = DepthConvention::reversed_infinite;
  glm::dvec3 to_sun = {0, 1, 0};
  Vec3 irradiance = Vec3(1.0F);
  Vec3 background = Vec3(0.0F);
  // Returns the distance along the ray of a pixel to the visible surface; 0: sky. Without the function, all is sky.
  std::function<double(std::uint32_t x, std::uint32_t y)> distance_m;
  std::vector<Cascade> cascades;
  std::uint32_t first_marched = 0;
  std::uint32_t shadow_resolution = 64;
  double lowest_ground_m = 0.0;
  bool shadow_depth_reversed = false;  // as in EffectDesc
  // Returns the depth in the map of a cascade. Without the function, nothing casts a shadow.
  std::function<float(std::uint32_t cascade, double u, double v)> shadow_depth;
  // Returns the transmission of glass there. Without the function, the frame has no shadow colours.
  std::function<glm::dvec3(std::uint32_t cascade, double u, double v)> shadow_color;
  std::function<float(std::uint32_t cascade, double u, double v)> glass_depth;  // depth of the glass, if known
  TestClouds clouds;

  [[nodiscard]] RayAngles ray(std::uint32_t x, std::uint32_t y, double planet_radius_m) const;
};

// The images of a frame on the device. The frame can be recorded repeatedly.
class FrameImages {
 public:
  static Result<FrameImages> create(gpu::Host& host, const TestFrame& frame, OutputFormat format);
  [[nodiscard]] FrameInputs inputs(const TestFrame& frame) const;
  // Draws the map of clouds.
  Result<void> draw_clouds(gpu::Host& host, const TestFrame& frame);
  // Draws the shadow maps again, with those of another frame of the same resolution and number of cascades.
  Result<void> draw_shadows(gpu::Host& host, const TestFrame& frame);
  Result<std::vector<std::byte>> output_bytes(gpu::Host& host);
  // Returns red, green and blue of each pixel of the image, which TestFrame::image_extent may make larger than the
  // picture.
  Result<std::vector<glm::dvec3>> output(gpu::Host& host);

 private:
  OutputFormat format_ = OutputFormat::rgba32f;
  gpu::Image color_, depth_, shadows_, glass_, clouds_, output_;
};

// Draws the frame with an effect that has built its tables. Returns red, green and blue of each pixel.
Result<std::vector<glm::dvec3>> render(gpu::Host& host, Effect& effect, const TestFrame& frame,
                                       OutputFormat format = OutputFormat::rgba32f);
// Draws the frame with a new effect.
Result<std::vector<glm::dvec3>> render(gpu::Host& host, const Params& params, const TestFrame& frame,
                                       OutputFormat format = OutputFormat::rgba32f);
// Draws frames with one effect per depth convention and format, because creating an effect takes seconds.
class EffectCache {
 public:
  Result<std::vector<glm::dvec3>> render(gpu::Host& host, const Params& params, const TestFrame& frame,
                                         OutputFormat format = OutputFormat::rgba32f);
  void clear() { cached_.clear(); }  // must be called before the host is destroyed

 private:
  struct Cached {
    EffectDesc desc;
    Effect effect;
  };
  std::vector<Cached> cached_;
};
[[nodiscard]] EffectDesc desc_for(const TestFrame& frame, OutputFormat format = OutputFormat::rgba32f);

// Returns a cascade with a square map along the direction of the sun. Depth 0 is nearest to the sun.
[[nodiscard]] Cascade sun_cascade(const glm::dvec3& to_sun, const glm::dvec3& middle, double half_m, double near_m,
                                  double far_m);
// Returns a frame with a few pixels of ground and sky, and two cascades with shadows.
[[nodiscard]] TestFrame small_frame();

[[nodiscard]] Params with_technique(Technique technique);
// Returns parameters with scattering.scale 1, brute force, and enough integration_steps for 0.1 % without shadows.
[[nodiscard]] Params precise_params();

// Return the in-scattered radiance / E0 between two distances of a ray, computed by the CPU model with fine steps, and
// the transmittance from the camera (or the entry into the atmosphere) to `end`.
[[nodiscard]] glm::dvec3 true_inscattering(const Params& params, const RayAngles& ray, double start, double end);
[[nodiscard]] glm::dvec3 true_transmittance(const Params& params, const RayAngles& ray, double end);
// The part of a ray in the atmosphere, to the ground or the top.
struct AirSegment {
  double start, end;
  bool on_ground;
};
[[nodiscard]] std::optional<AirSegment> segment_below_top(const Params& params, const RayAngles& ray);

// Returns the largest difference of a channel, relative to the brightest channel of the true value.
[[nodiscard]] double relative_error(const glm::dvec3& value, const glm::dvec3& truth);

}  // namespace tyndall
