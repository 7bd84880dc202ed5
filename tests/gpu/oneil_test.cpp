// O'Neil's model on the device: its functions compared with double precision, and scenes drawn with it.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "effect/medium.hpp"
#include "gpu_test.hpp"
#include "image/metrics.hpp"
#include "models/gpu_probe.hpp"
#include "shared_scene.hpp"

namespace tyndall {
namespace {

constexpr double kPi = std::numbers::pi;

class GpuOneil : public GpuTest {};

TEST_F(GpuOneil, AgreesWithDoublePrecision) {
  std::mt19937 engine(2005);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<models::Ray> rays;
  for (int i = 0; i < 1500; ++i) {
    const double altitude = (i % 4 == 3 ? 5000.0e3 : i % 2 == 0 ? 3000.0 : 79000.0) * uniform(engine);
    rays.push_back(models::ray_from_angles(altitude, std::acos(1.0 - 2.0 * uniform(engine)),
                                           100.0 / 180.0 * kPi * uniform(engine), 2.0 * kPi * uniform(engine)));
  }
  for (const models::OneilIntegralMethod method :
       {models::OneilIntegralMethod::computed, models::OneilIntegralMethod::published,
        models::OneilIntegralMethod::table}) {
    for (const bool by_density : {false, true}) {
      models::OneilSettings settings;
      settings.integral_method = method;
      settings.space_by_density = by_density;
      shared::Medium medium = medium_from_params({});
      if (method == models::OneilIntegralMethod::published) {  // valid only for its own planet
        medium.atmosphere_height_m = 159.0e3F;
        medium.rayleigh_scale_height_m = medium.mie_scale_height_m = 39750.0F;
        medium.rayleigh_scattering = {1.1e-6F, 1.9e-6F, 3.9e-6F};
        medium.mie_scattering = medium.mie_extinction = Vec3(7.9e-8F);
      }
      const models::OneilModel model = models::make_oneil(medium, settings);
      const Result<std::vector<models::Answer>> answers = models::oneil_on_gpu(host(), model, rays);
      ASSERT_OK(answers);
      double mean = 0.0;
      double worst = 0.0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const models::Answer truth = models::oneil(model, rays[i]);
        const double brightest = std::max({truth.radiance[0], truth.radiance[1], truth.radiance[2]});
        if (brightest < 1.0e-9) continue;
        // For steep rays past the planet, the published polynomial amplifies light and also rounding errors.
        if (*std::max_element(truth.transmittance.begin(), truth.transmittance.end()) > 1.0001) continue;
        double error = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
          error = std::max(error, std::abs(answers.value()[i].radiance[c] - truth.radiance[c]) / brightest);
          EXPECT_NEAR(answers.value()[i].transmittance[c], truth.transmittance[c], 1.0e-4);
        }
        mean += error / static_cast<double>(rays.size());
        worst = std::max(worst, error);
      }
      // At the edge of the planet's shadow, the ends of the lit part have few significant digits in single precision.
      EXPECT_LT(mean, 2.0e-4) << static_cast<int>(method) << by_density;
      EXPECT_LT(worst, 0.01) << static_cast<int>(method) << by_density;
    }
  }
}

namespace s = scene;

// The planet of O'Neil's demo in a small picture.
struct DemoPlanet {
  Params params;
  s::SceneParams scene;

  DemoPlanet() {
    params.tables.size = {8, 32, 32, 4};
    params.tables.orders = 1;  // the model does not read the tables
    params.atmosphere.height_m = 159.0e3F;
    params.atmosphere.rayleigh_scale_height_m = 39750.0F;
    params.atmosphere.mie_scale_height_m = 39750.0F;
    params.atmosphere.custom_coefficients = true;
    params.atmosphere.rayleigh_scattering = {1.1e-6F, 1.9e-6F, 3.9e-6F};
    params.atmosphere.mie_scattering = Vec3(7.9e-8F);
    params.atmosphere.mie_absorption = Vec3(0.0F);
    scene.scattering.model = s::ScatteringModel::oneil;
    scene.oneil.ground = s::OneilGround::sphere;
    scene.sun.elevation_deg = 30.0F;
    scene.sun.azimuth_deg = 60.0F;
    scene.camera.position_m = {0.0F, 159.0e3F, 0.0F};
    scene.camera.yaw_deg = 0.0F;
    scene.camera.pitch_deg = -20.0F;
    scene.shadows.resolution = 512;
    scene.shadows.cascades = 1;
    scene.shadows.first_marched = 0;
  }
};

class GpuOneilScene : public s::SharedSceneTest {
 protected:
  static s::Scene* make(const DemoPlanet& setup, VkExtent2D extent = {96, 64}) {
    return shared_scene(extent, setup.params, setup.scene);
  }
  static image::Image draw(s::Scene& scene, const s::SceneParams& params) {
    EXPECT_OK(scene.set_scene(params));
    EXPECT_OK(scene.render(0.0));
    Result<image::Image> radiance = scene.radiance();
    EXPECT_OK(radiance);
    if (!radiance.ok()) return {};
    for (const float value : radiance.value().rgb) EXPECT_TRUE(std::isfinite(value) && value >= 0.0F);
    return std::move(radiance).value();
  }
};

double largest(const image::Image& image) { return *std::max_element(image.rgb.begin(), image.rgb.end()); }

double largest_difference(const image::Image& a, const image::Image& b) {
  double out = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i)
    out = std::max(out, static_cast<double>(std::abs(a.rgb[i] - b.rgb[i])));
  return out;
}

// The picture is the same one metre below and above the top of the atmosphere. Only the thin atmosphere just above the
// horizontal and the rows of the mesh differ.
TEST_F(GpuOneilScene, CrossesTheTopWithoutAJump) {
  DemoPlanet setup;
  s::Scene* const scene = make(setup);
  ASSERT_NE(scene, nullptr);
  for (const s::ModelEvaluation evaluate : {s::ModelEvaluation::pixel, s::ModelEvaluation::vertex}) {
    s::SceneParams params = setup.scene;
    params.scattering.evaluate = evaluate;
    params.camera.position_m.y = 159.0e3F - 1.0F;
    const image::Image below = draw(*scene, params);
    params.camera.position_m.y = 159.0e3F + 1.0F;
    const image::Image above = draw(*scene, params);
    EXPECT_LT(largest_difference(below, above), 0.02 * largest(below)) << static_cast<int>(evaluate);
  }
}

// The picture does not jump over Earth either, with fitted functions, with the table, and with points spaced by density
// integral.
TEST_F(GpuOneilScene, CrossesTheTopOfEarthsAtmosphereWithoutAJump) {
  DemoPlanet setup;
  setup.params = Params();
  setup.params.tables.size = {8, 32, 32, 4};
  setup.params.tables.orders = 1;
  setup.scene.oneil.scale_function = s::OneilScaleFunction::computed;
  setup.scene.camera.pitch_deg = -8.0F;
  for (const s::ScatteringModel model : {s::ScatteringModel::oneil, s::ScatteringModel::oneil_table}) {
    setup.scene.scattering.model = model;
    s::Scene* const scene = make(setup);
    ASSERT_NE(scene, nullptr);
    for (const s::OneilSpacing spacing : {s::OneilSpacing::uniform, s::OneilSpacing::column}) {
      for (const s::ModelEvaluation evaluate : {s::ModelEvaluation::pixel, s::ModelEvaluation::vertex}) {
        s::SceneParams params = setup.scene;
        params.oneil.spacing = spacing;
        params.scattering.evaluate = evaluate;
        params.camera.position_m.y = 80.0e3F - 1.0F;
        const image::Image below = draw(*scene, params);
        params.camera.position_m.y = 80.0e3F + 1.0F;
        const image::Image above = draw(*scene, params);
        EXPECT_GT(largest(below), 0.1);
        EXPECT_LT(largest_difference(below, above), 0.02 * largest(below))
            << static_cast<int>(model) << " " << static_cast<int>(spacing) << " " << static_cast<int>(evaluate);
      }
    }
  }
}

TEST_F(GpuOneilScene, VerticesAreFineEnough) {
  DemoPlanet setup;
  s::Scene* const scene = make(setup);
  ASSERT_NE(scene, nullptr);
  for (const float altitude : {100.0F, 30.0e3F, 159.0e3F, 6000.0e3F}) {
    s::SceneParams params = setup.scene;
    params.camera.altitude_m = altitude;
    params.camera.pitch_deg = altitude > 1.0e6F ? -65.0F : -10.0F;
    params.scattering.evaluate = s::ModelEvaluation::pixel;
    const image::Image pixel = draw(*scene, params);
    params.scattering.evaluate = s::ModelEvaluation::vertex;
    const image::Image vertex = draw(*scene, params);
    const image::Metrics metrics = image::compare(vertex, pixel);
    EXPECT_GT(largest(pixel), 0.1) << altitude;
    EXPECT_LT(metrics.rmse, 0.004 * largest(pixel)) << altitude;
  }
}

// At the limb, neighbouring rays end in space and on the ground, but no pixel differs from its surroundings, also
// opposite to the sun, where the columns of the mesh are far apart.
TEST_F(GpuOneilScene, NoPixelOfTheLimbSparkles) {
  DemoPlanet setup;
  setup.params = Params();
  setup.params.tables.size = {8, 32, 32, 4};
  setup.params.tables.orders = 1;
  setup.scene.oneil.samples = 8;
  setup.scene.oneil.spacing = s::OneilSpacing::column;
  s::Scene* const scene = make(setup, {160, 90});
  ASSERT_NE(scene, nullptr);
  std::vector<image::Image> pictures[2];
  for (const s::ModelEvaluation evaluate : {s::ModelEvaluation::pixel, s::ModelEvaluation::vertex}) {
    for (const float altitude : {100.0e3F, 400.0e3F}) {
      const double horizon_deg = std::acos(6.36e6 / (6.36e6 + static_cast<double>(altitude))) * 180.0 / kPi;
      for (const auto& [yaw, fov] : {std::pair{60.0F, 30.0F}, {240.0F, 30.0F}, {150.0F, 3.0F}}) {
        s::SceneParams params = setup.scene;
        params.camera.position_m.y = altitude;
        params.camera.yaw_deg = yaw;
        params.camera.pitch_deg = static_cast<float>(-horizon_deg);
        params.camera.fov_deg = fov;
        params.scattering.evaluate = evaluate;
        pictures[evaluate == s::ModelEvaluation::vertex ? 1 : 0].push_back(draw(*scene, params));
      }
    }
  }
  for (std::size_t i = 0; i < pictures[0].size(); ++i) {
    // The remaining difference is that of interpolation over the ground.
    EXPECT_LT(largest_difference(pictures[0][i], pictures[1][i]), 0.05 * largest(pictures[0][i])) << i;
  }
}

// In a dense atmosphere, a ray that grazes the ground has a large optical depth. There is no seam, and all values are
// finite.
TEST_F(GpuOneilScene, DenseAtmosphereHasNoSeamAtTheHorizon) {
  DemoPlanet setup;
  setup.params.planet.radius_m = 2575.0e3F;
  setup.params.atmosphere.height_m = 450.0e3F;
  setup.params.atmosphere.mie_scattering = Vec3(2.0e-5F);
  setup.scene.oneil.spacing = s::OneilSpacing::column;
  setup.scene.camera.position_m = {0.0F, 6000.0e3F, 0.0F};
  setup.scene.camera.pitch_deg = -72.5F;
  setup.scene.camera.fov_deg = 4.0F;
  setup.scene.sun.azimuth_deg = 0.0F;
  s::Scene* const scene = make(setup);
  ASSERT_NE(scene, nullptr);
  for (const s::ModelEvaluation evaluate : {s::ModelEvaluation::vertex, s::ModelEvaluation::pixel}) {
    s::SceneParams params = setup.scene;
    params.scattering.evaluate = evaluate;
    const image::Image image = draw(*scene, params);
    for (std::size_t y = 1; y + 1 < 64; ++y) {  // the middle column, across the horizon
      const auto at = [&](std::size_t row) { return static_cast<double>(image.rgb[(row * 96 + 48) * 3]); };
      EXPECT_GT(at(y), 0.7 * std::min(at(y - 1), at(y + 1))) << y;
    }
    EXPECT_GT(largest(image), 0.1);
  }
}

TEST_F(GpuOneilScene, NightSideIsBlack) {
  DemoPlanet setup;
  setup.scene.sun.elevation_deg = -90.0F;
  setup.scene.camera.position_m = {0.0F, 6000.0e3F, 0.0F};
  setup.scene.camera.pitch_deg = -90.0F;
  setup.scene.camera.fov_deg = 20.0F;
  s::Scene* const scene = make(setup);
  ASSERT_NE(scene, nullptr);
  for (const s::ModelEvaluation evaluate : {s::ModelEvaluation::vertex, s::ModelEvaluation::pixel}) {
    s::SceneParams params = setup.scene;
    params.scattering.evaluate = evaluate;
    EXPECT_LT(largest(draw(*scene, params)), 1.0e-6);
  }
}

// Near the horizon, the atmosphere attenuates the full moon, blue more than red. From space the moon is not attenuated.
TEST_F(GpuOneilScene, MoonIsAttenuatedByTheAtmosphere) {
  DemoPlanet setup;
  setup.scene.sun.elevation_deg = -3.0F;
  setup.scene.sun.azimuth_deg = 180.0F;
  setup.scene.moon.visible = true;
  setup.scene.moon.elevation_deg = 5.0F;
  setup.scene.moon.azimuth_deg = 0.0F;
  setup.scene.moon.angular_radius_deg = 4.0F;
  setup.scene.camera.position_m = {0.0F, 10.0F, 0.0F};
  setup.scene.camera.pitch_deg = 5.0F;
  setup.scene.camera.fov_deg = 10.0F;
  s::Scene* const scene = make(setup);
  ASSERT_NE(scene, nullptr);
  const auto moonlight = [&](bool air) {
    Params params = setup.params;
    params.scattering.enabled = air;
    EXPECT_OK(scene->set_params(params));
    s::SceneParams with = setup.scene;
    s::SceneParams without = setup.scene;
    without.moon.visible = false;
    const image::Image a = draw(*scene, with);
    const image::Image b = draw(*scene, without);
    std::array<double, 3> out = {};
    const std::size_t middle = (32 * 96 + 48) * 3;
    for (std::size_t c = 0; c < 3; ++c)
      out[c] = static_cast<double>(a.rgb[middle + c]) - static_cast<double>(b.rgb[middle + c]);
    return out;
  };
  const std::array<double, 3> clear = moonlight(false);
  const std::array<double, 3> hazy = moonlight(true);
  const models::OneilModel model = models::make_oneil(medium_from_params(setup.params), {});
  const models::Answer truth = models::oneil(model, models::ray_from_angles(10.0, 85.0 * kPi / 180.0, 1.6, kPi));
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_GT(clear[c], 0.01);
    EXPECT_NEAR(hazy[c] / clear[c], truth.transmittance[c], 0.02);
  }
  EXPECT_LT(hazy[2] / clear[2], hazy[0] / clear[0]);
}

}  // namespace
}  // namespace tyndall
