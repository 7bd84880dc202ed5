// Frames drawn by models other than the effect, compared pixel by pixel with the model on the CPU.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gpu_test.hpp"
#include "image/metrics.hpp"
#include "models/homogeneous.hpp"
#include "scene/description/map_projection.hpp"
#include "shared_scene.hpp"

namespace tyndall::scene {
namespace {

constexpr VkExtent2D kExtent = {96, 54};

class GpuSceneModels : public SharedSceneTest {
 protected:
  // The terrain is at sea level everywhere, so that the ground of the picture is the sphere of the model.
  void SetUp() override {
    GpuTest::SetUp();
    scene_.terrain.exaggeration = 0.0F;
    scene_.shadows.resolution = 512;
    scene_.shadows.cascades = 2;
    scene_.scattering.model = ScatteringModel::homogeneous;
    scene_.camera.position_m = {0.0F, 1500.0F, 0.0F};
    scene_.camera.pitch_deg = 0.0F;
    scene_.camera.yaw_deg = 20.0F;
    scene_.sun.elevation_deg = 25.0F;
    scene_.sun.azimuth_deg = 75.0F;
    params_.atmosphere.mie_phase = MiePhase::henyey_greenstein;
  }

  image::Image draw(VkExtent2D extent = kExtent) {
    drawn_ = shared_scene(extent, params_, scene_);
    if (drawn_ == nullptr) return {};
    EXPECT_OK(drawn_->render(0.0));
    Result<image::Image> radiance = drawn_->radiance();
    EXPECT_OK(radiance);
    return radiance.ok() ? std::move(radiance).value() : image::Image();
  }

  // Returns the radiance of a pixel over black ground, computed by the model on the CPU.
  std::array<double, 3> expected(std::uint32_t x, std::uint32_t y) const {
    const double radius = params_.planet.radius_m;
    const View view = view_from_params(scene_.camera, static_cast<double>(kExtent.width) / kExtent.height, radius);
    const double u = (2.0 * (x + 0.5) / kExtent.width - 1.0) * view.tan_half_width;
    const double v = (1.0 - 2.0 * (y + 0.5) / kExtent.height) * view.tan_half_height;
    const glm::dvec3 direction = glm::normalize(view.forward + u * view.right + v * view.up);
    const glm::dvec3 to_sun = direction_to_sun(scene_.sun);
    const glm::dvec3 up = up_of(view.position, radius);
    const models::Ray ray = {altitude_of(view.position, radius), glm::dot(direction, up), glm::dot(to_sun, up),
                             glm::dot(direction, to_sun)};
    tyndall::shared::Homogeneous medium = models::homogeneous_from_params(
        params_,
        {scene_.homogeneous.air_length_m, scene_.homogeneous.haze_length_m, scene_.homogeneous.falloff.value != 0});
    medium.sun_radius_rad = static_cast<float>(scene_.sun.angular_radius_deg * std::numbers::pi / 180.0);
    std::array<double, 3> out = models::homogeneous_light(medium, ray).radiance;
    const Vec3& sunlight = scene_.sun.irradiance;
    const std::array<float, 3> irradiance = {sunlight.x, sunlight.y, sunlight.z};
    for (std::size_t c = 0; c < 3; ++c)
      out[c] *= static_cast<double>(irradiance[c]) * static_cast<double>(params_.scattering.scale);
    return out;
  }

  // Errors of a picture of the in-scattering, relative to the brightest channel of each pixel.
  struct Errors {
    double worst = 0.0, mean = 0.0;
    double over_1_percent = 0.0;  // fraction of the values
  };
  Errors errors(const image::Image& picture) const {
    Errors out;
    for (std::uint32_t y = 0; y < kExtent.height; ++y) {
      for (std::uint32_t x = 0; x < kExtent.width; ++x) {
        const std::array<double, 3> truth = expected(x, y);
        const double brightest = *std::max_element(truth.begin(), truth.end());
        for (std::size_t c = 0; c < 3; ++c) {
          const double value = picture.rgb[3 * (static_cast<std::size_t>(y) * kExtent.width + x) + c];
          const double error = brightest > 0.0 ? std::abs(value - truth[c]) / brightest : std::abs(value);
          out.worst = std::max(out.worst, error);
          out.mean += error / (3.0 * kExtent.width * kExtent.height);
          if (error > 0.01) out.over_1_percent += 1.0 / (3.0 * kExtent.width * kExtent.height);
        }
      }
    }
    return out;
  }

  Params params_;
  SceneParams scene_;
  Scene* drawn_ = nullptr;
};

TEST_F(GpuSceneModels, HomogeneousPerPixelIsTheModel) {
  params_.scattering.only = true;
  scene_.scattering.evaluate = ModelEvaluation::pixel;
  for (const bool falloff : {false, true}) {
    scene_.homogeneous.falloff = falloff;
    // The view is level in a hazy atmosphere, or from space down to the ground.
    for (const float altitude_m : {1500.0F, 300000.0F}) {
      scene_.camera.altitude_m = altitude_m;
      scene_.camera.pitch_deg = altitude_m > 1e5F ? -60.0F : 0.0F;
      params_.atmosphere.aerosol_density = altitude_m > 1e5F ? 1.0F : 3.0F;
      const Errors found = errors(draw());
      RecordProperty("worst " + std::to_string(altitude_m) + (falloff ? " falloff" : ""), std::to_string(found.worst));
      // Distances across the horizon have single precision, and the ground consists of triangles.
      EXPECT_LT(found.mean, 3e-4) << altitude_m << " m, falloff " << falloff;
      EXPECT_LT(found.worst, 5e-3) << altitude_m << " m, falloff " << falloff;
    }
  }
}

TEST_F(GpuSceneModels, HomogeneousPerVertexIsNearPerPixel) {
  params_.scattering.only = true;
  // The sun is in the picture, where the default phase function of the aerosol is narrowest.
  scene_.sun.azimuth_deg = 25.0F;
  scene_.sun.elevation_deg = 10.0F;
  const Errors vertex = errors(draw());
  EXPECT_LT(vertex.mean, 3e-3);
  // Only pixels of the horizon with triangles that are many kilometres long may have larger errors.
  EXPECT_LT(vertex.over_1_percent, 0.002);
  EXPECT_LT(vertex.worst, 0.1);
  scene_.scattering.evaluate = ModelEvaluation::pixel;
  EXPECT_LT(errors(draw()).mean, 3e-4);
}

TEST_F(GpuSceneModels, PicturesPerVertexAreLikeThosePerPixel) {
  scene_.terrain.exaggeration = 1.0F;
  scene_.camera.altitude_m = 4000.0F;
  scene_.camera.pitch_deg = -5.0F;
  std::vector<image::Image> display;
  for (const ModelEvaluation evaluation : {ModelEvaluation::pixel, ModelEvaluation::vertex}) {
    scene_.scattering.evaluate = evaluation;
    display.push_back(draw({192, 108}));
    for (float& value : display.back().rgb) value = value / (1.0F + value);
  }
  const image::Metrics metrics = image::compare(display[1], display[0]);
  RecordProperty("dB", std::to_string(metrics.psnr_db));
  EXPECT_GE(metrics.psnr_db, 45.0);
}

TEST_F(GpuSceneModels, HomogeneousIsFiniteAnywhereAndDarkAtNight) {
  for (const bool published : {true, false}) {
    scene_.scattering.evaluate = published ? ModelEvaluation::vertex : ModelEvaluation::pixel;
    scene_.homogeneous.falloff = !published;
    for (const float altitude_m : {2.0F, 79999.0F, 80001.0F, 3.6e7F}) {
      scene_.camera.altitude_m = altitude_m;
      scene_.camera.pitch_deg = altitude_m > 1e5F ? -80.0F : -5.0F;
      for (const float sun_deg : {40.0F, -12.0F}) {
        scene_.sun.elevation_deg = sun_deg;
        const image::Image picture = draw({32, 18});
        ASSERT_FALSE(picture.rgb.empty());
        const auto [low, high] = std::minmax_element(picture.rgb.begin(), picture.rgb.end());
        ASSERT_TRUE(std::all_of(picture.rgb.begin(), picture.rgb.end(), [](float v) { return std::isfinite(v); }));
        ASSERT_GE(*low, 0.0F);
        ASSERT_TRUE(sun_deg < 10.0F || *high > 1e-3F) << altitude_m;
        // From space, distant parts of the planet may be visible where it is day.
        ASSERT_TRUE(sun_deg > -10.0F || altitude_m > 8e4F || *high == 0.0F) << altitude_m;
      }
    }
  }
}

TEST_F(GpuSceneModels, InscatteringCanBeLeftOutAndShownAlone) {
  scene_.camera.pitch_deg = -30.0F;
  const image::Image both = draw();
  params_.scattering.only = true;
  const image::Image air = draw();
  params_.scattering.only = false;
  params_.scattering.enabled = false;
  const image::Image ground = draw();
  // Equation 1: the light of the ground is attenuated, and in-scattering is added.
  for (std::size_t i = 0; i < both.rgb.size(); ++i) {
    ASSERT_GE(both.rgb[i], air.rgb[i]);
    ASSERT_LE(both.rgb[i], air.rgb[i] + ground.rgb[i] + 1e-5F);
    ASSERT_GT(ground.rgb[i], 0.0F);
  }
}

TEST_F(GpuSceneModels, ModelsChangeBetweenFrames) {
  params_.tables.size = {8, 32, 32, 4};
  params_.tables.orders = 2;
  const image::Image first = draw();
  scene_.scattering.model = ScatteringModel::atmosphere;
  EXPECT_NE(draw().rgb, first.rgb);
  scene_.scattering.model = ScatteringModel::homogeneous;
  EXPECT_EQ(draw().rgb, first.rgb);
}

}  // namespace
}  // namespace tyndall::scene
