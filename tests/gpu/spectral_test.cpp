// scattering.color = spectral: frames against the models in double precision, epipolar sampling against brute force,
// and changes between both modes.
#include <cmath>
#include <limits>

#include "atmosphere_points.hpp"
#include "effect/spectral_medium.hpp"
#include "effect/wavelengths.hpp"
#include "models/spectral.hpp"
#include "shared_effect.hpp"
#include "tyndall/atmosphere.hpp"

namespace tyndall {
namespace {

class Spectral : public SharedEffect {
 protected:
  static Params spectral_params() {
    Params params = small_params();
    params.scattering.color = ColorMode::spectral;
    return params;
  }
  // Sets the parameters and builds their tables.
  void prepare(const Params& params) {
    ASSERT_OK(effect().set_params(params));
    while (!effect().precompute_progress().complete()) {
      ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
        const Result<Progress> built = effect().record_precompute(cmd);
        if (!built.ok()) return built.error();
        return {};
      }));
    }
  }
};

BoxScene evening() {
  BoxScene scene;
  scene.name = "evening";
  return scene;
}

// Returns the colour that the model in double precision gives for a ray of single scattering.
glm::dvec3 expected_color(const Params& params, const RayAngles& ray) {
  const models::Answer answer =
      models::in_all_channels(params, spectral_medium_from_params(params), [&](const shared::Medium& medium) {
        return models::single_scattering(medium, {ray.altitude_m, ray.cos_view, ray.cos_sun, ray.cos_view_sun});
      });
  const std::array<double, 3> color = color_of_light(models::radiance_of(answer));
  return {std::max(color[0], 0.0), std::max(color[1], 0.0), std::max(color[2], 0.0)};
}

TEST_F(Spectral, TheSkyHasTheColourOfTheModel) {
  TestFrame sky;
  sky.to_sun = glm::normalize(glm::dvec3(0.3, 0.1, -1.0));
  show(sky);
  Params params = spectral_params();
  params.scattering.technique = Technique::brute_force;
  params.scattering.single = SingleScattering::integration;
  params.scattering.multiple = MultipleScattering::none;
  params.scattering.scale = 1.0F;
  prepare(params);
  const Picture picture = draw(params, "sky");
  for (std::uint32_t y = 0; y < sky.extent.height; ++y) {
    for (std::uint32_t x = 0; x < sky.extent.width; ++x) {
      const glm::dvec3 expected = expected_color(params, sky.ray(x, y, params.planet.radius_m));
      const glm::dvec3& found = picture[y * sky.extent.width + x];
      // The renderer's integration has coarser steps: lib/single_scattering.glsl.
      const double largest = std::max({expected.x, expected.y, expected.z});
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 0.01 * largest) << x << ' ' << y;
    }
  }
}

TEST_F(Spectral, EpipolarSamplingMatchesBruteForce) {
  show(evening());
  Params params = spectral_params();
  prepare(params);
  expect_alike("spectral, unoccluded", params, 44.0);
  params.scattering.multiple = MultipleScattering::occluded;
  expect_alike("spectral, occluded", params, 44.0);
  params.scattering.single = SingleScattering::integration;
  expect_alike("spectral, integrated", params, 44.0);
  params.scattering.downscale = 2;
  expect_alike("spectral, half resolution", params, 40.0);
  params.scattering.downscale = 1;
  params.scattering.medium = MediumKind::homogeneous;
  expect_alike("spectral, homogeneous", params, 44.0);
}

TEST_F(Spectral, FroxelsMatchBruteForce) {
  BoxScene scene = evening();
  scene.extent = {48, 27};
  TestFrame frame = frame_of(scene);
  frame.background = Vec3(0.4F, 0.2F, 0.05F);
  show(frame);
  Params params = spectral_params();
  params.scattering.technique = Technique::froxels;
  params.froxels.columns = frame.extent.width;
  params.froxels.rows = frame.extent.height;
  prepare(params);
  expect_alike("spectral, froxels", params, 40.0);
  // The look-ups that engines make.
  std::vector<Query> queries;
  const double distance = 900.0;
  for (std::uint32_t x = 0; x < frame.extent.width; ++x) {
    queries.push_back(query(through_froxels, {(x + 0.5) / frame.extent.width, 0.5 / frame.extent.height, distance},
                            {0.4, 0.2, 0.05}));
  }
  AtmosphereInputs inputs;
  inputs.sun.irradiance = frame.irradiance;
  const std::vector<Answer> looked_up = evaluate_points(host(), effect(), params, inputs, queries);
  frame.distance_m = [distance](std::uint32_t, std::uint32_t) { return distance; };
  show(frame);
  const Picture expected = draw(by_brute_force(params), "brute force");
  for (std::uint32_t x = 0; x < frame.extent.width; ++x) {
    EXPECT_LE(relative_error(looked_up[x].light, expected[x]), 0.003) << "column " << x;
  }
}

// The state of rays between passes is stored with all channels.
TEST_F(Spectral, CascadesInSeveralPassesGiveTheSamePicture) {
  show(evening());
  Params params = spectral_params();
  params.scattering.multiple = MultipleScattering::occluded;
  params.scattering.sections = LitSections::each;
  prepare(params);
  const Picture together = draw(params, "one pass");
  for (const CascadeProcessing processing : {CascadeProcessing::multi_pass, CascadeProcessing::multi_pass_instanced}) {
    params.shadows.cascade_processing = processing;
    const Likeness likeness = compare(draw(params, "several passes"), together, frame().extent);
    EXPECT_GE(likeness.psnr_db, 60.0);
  }
}

TEST_F(Spectral, ClearAirLeavesTheBackgroundAsItIs) {
  TestFrame frame;
  frame.background = {0.7F, 0.2F, 0.05F};
  frame.distance_m = [](std::uint32_t, std::uint32_t) { return 50000.0; };
  show(frame);
  Params params = spectral_params();
  params.atmosphere.custom_coefficients = true;
  params.atmosphere.rayleigh_scattering = Vec3(0.0F);
  params.atmosphere.mie_scattering = Vec3(0.0F);
  params.atmosphere.mie_absorption = Vec3(0.0F);
  params.atmosphere.ozone_absorption = Vec3(0.0F);
  prepare(params);
  for (const Technique technique : {Technique::brute_force, Technique::epipolar}) {
    params.scattering.technique = technique;
    for (const glm::dvec3& pixel : draw(params, "clear air")) {
      EXPECT_NEAR(pixel.x, 0.7, 1e-3);
      EXPECT_NEAR(pixel.y, 0.2, 1e-3);
      EXPECT_NEAR(pixel.z, 0.05, 1e-3);
    }
  }
}

// Returns the colour of a background behind a homogeneous medium that scatters no light.
glm::dvec3 expected_behind(const Params& params, const Vec3& background, double distance_m) {
  const shared::SpectralMedium m = spectral_medium_from_params(params);
  const double extinction[4] = {m.rayleigh_scattering.x + m.mie_extinction.x,
                                m.rayleigh_scattering.y + m.mie_extinction.y,
                                m.rayleigh_scattering.z + m.mie_extinction.z, m.fourth_channel.x + m.fourth_channel.z};
  FourChannels behind = {};
  for (std::size_t i = 0; i < 4; ++i) {
    const double spectrum = static_cast<double>(background.x) * (&shared::kLiftRed.x)[i] +
                            static_cast<double>(background.y) * (&shared::kLiftGreen.x)[i] +
                            static_cast<double>(background.z) * (&shared::kLiftBlue.x)[i];
    behind[i] =
        spectrum * std::exp(-extinction[i] * static_cast<double>(params.homogeneous_medium.density) * distance_m);
  }
  const std::array<double, 3> color = color_of_light(behind);
  return {color[0], color[1], color[2]};
}

// The medium of a long run of tests/soak. The froxel volume interpolates transmittances of half precision.
TEST_F(Spectral, TheBackgroundHasTheColourOfTheModel) {
  TestFrame frame;
  frame.view = TestView::at(1000.0, 0.0, 0.6, 0.4);  // froxels end at the planet
  frame.background = {5.0F, 3.0F, 4.0F};
  frame.irradiance = Vec3(0.0F);
  Params params = spectral_params();
  params.scattering.medium = MediumKind::homogeneous;
  params.atmosphere.aerosol_density = 1.647702F;
  params.atmosphere.angstrom_exponent = 4.0F;
  params.atmosphere.single_scattering_albedo = {0.000147F, 1.0F, 0.471840F};
  prepare(params);
  for (const double distance : {1.0, 100.0, 3000.0}) {
    frame.distance_m = [=](std::uint32_t, std::uint32_t) { return distance; };
    show(frame);
    const glm::dvec3 expected = expected_behind(params, frame.background, distance);
    for (const Technique technique : {Technique::brute_force, Technique::epipolar, Technique::froxels}) {
      params.scattering.technique = technique;
      const double tolerance = technique == Technique::froxels ? 1.0e-3 : 2.0e-6;
      for (const glm::dvec3& found : draw(params, "a coloured background")) {
        for (int c = 0; c < 3; ++c) {
          ASSERT_NEAR(found[c], expected[c], tolerance * expected[c]) << static_cast<int>(technique) << ' ' << distance;
        }
      }
    }
  }
}

// A sun's disc that half floats store as infinite is as bright as the largest of them, and not black.
TEST_F(Spectral, InfiniteBackgroundsAreBright) {
  TestFrame frame = frame_of(evening());
  for (const ColorMode mode : {ColorMode::spectral, ColorMode::rgb}) {
    Params params = spectral_params();
    params.scattering.color = mode;
    prepare(params);
    for (const Technique technique : {Technique::brute_force, Technique::epipolar}) {
      params.scattering.technique = technique;
      const auto picture = [&](float background) {
        frame.background = Vec3(background);
        show(frame);
        return draw(params, "bright background");
      };
      const Picture infinite = picture(std::numeric_limits<float>::infinity());
      const Picture largest = picture(65504.0F);
      for (std::size_t i = 0; i < largest.size(); ++i) ASSERT_EQ(infinite[i], largest[i]) << i;
    }
  }
}

// In-scattered light has the colour of the sun times that of the same light under a white sun. The background is
// independent of the sun.
TEST_F(Spectral, TheColourOfTheSunDoesNotChangeTheBackground) {
  TestFrame frame = frame_of(evening());
  show(frame);
  Params params = spectral_params();
  prepare(params);
  const auto picture = [&](const Vec3& sun, const Vec3& background) {
    frame.irradiance = sun;
    frame.background = background;
    show(frame);
    return draw(params, "coloured sun");
  };
  const Vec3 background = {0.4F, 0.3F, 0.2F};
  const Vec3 sun = {1.0F, 0.5F, 0.2F};
  for (const Technique technique : {Technique::brute_force, Technique::epipolar}) {
    params.scattering.technique = technique;
    const Picture light = picture(Vec3(1.0F), Vec3(0.0F));
    const Picture both = picture(Vec3(1.0F), background);
    const Picture colored = picture(sun, background);
    for (std::size_t i = 0; i < light.size(); ++i) {
      const glm::dvec3 expected = glm::dvec3(sun.x, sun.y, sun.z) * light[i] + (both[i] - light[i]);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(colored[i][c], expected[c], 2.0e-3 * both[i][c]) << i << ' ' << c;
    }
  }
}

// Until the tables of the other mode are complete, frames are drawn with those that exist.
TEST_F(Spectral, ChangesOfTheModeShowNoUnfinishedTables) {
  show(evening());
  prepare(small_params());
  const Picture rgb = draw(small_params(), "rgb");
  EXPECT_EQ(draw(spectral_params(), "spectral without tables"), rgb);
  EXPECT_FALSE(effect().precompute_progress().complete());
  prepare(spectral_params());
  const Picture spectral = draw(spectral_params(), "spectral");
  EXPECT_NE(spectral, rgb);
  EXPECT_EQ(draw(small_params(), "rgb without tables"), spectral);
  // The larger buffers are in use until the new tables are complete, and are freed by the next change after that.
  const VkDeviceSize large = effect().memory().persistent;
  prepare(small_params());
  EXPECT_EQ(effect().memory().persistent, large);
  EXPECT_EQ(draw(small_params(), "rgb again"), rgb);
  const Result<MemoryUsage> planned = query_memory(info(), SharedEffect::desc(), small_params());
  ASSERT_OK(planned);
  EXPECT_EQ(effect().memory().persistent, planned.value().persistent);
  EXPECT_LT(planned.value().persistent, large);
  // Until tables of another size are complete, frames read the old ones with their own coordinates.
  Params other = small_params();
  other.tables.size = {6, 24, 12, 4};
  EXPECT_EQ(draw(other, "without tables of this size"), rgb);
  prepare(small_params());
}

// While other tables are built, table_params() and picture_color() describe the tables in use. Engines need these
// values to decode the tables and to light their scene.
TEST_F(Spectral, WhatIsGivenOutFollowsTheTablesInUse) {
  const Params rgb = small_params();
  prepare(rgb);
  const auto constants = [&] {
    const Result<AtmosphereConstants> made = atmosphere_constants(table_params(effect()), {});
    EXPECT_OK(made);
    return made.value().bytes;
  };
  const auto before = constants();
  Params other = spectral_params();
  other.atmosphere.aerosol_density = 3.0F;
  other.planet.ground_albedo = Vec3(0.4F);
  other.tables.size = {6, 24, 12, 4};
  ASSERT_OK(effect().set_params(other));
  for (const std::uint32_t budget : {0U, 3U}) {
    ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
      const Result<Progress> built = effect().record_precompute(cmd, budget);
      if (!built.ok()) return built.error();
      return {};
    }));
    EXPECT_EQ(picture_color(effect()), ColorMode::rgb);
    EXPECT_EQ(sun_color(table_params(effect())), Vec3(1.0F));
    EXPECT_EQ(table_params(effect()).planet.ground_albedo, rgb.planet.ground_albedo);
    EXPECT_TRUE(constants() == before);
  }
  prepare(other);
  EXPECT_EQ(picture_color(effect()), ColorMode::spectral);
  EXPECT_EQ(sun_color(table_params(effect())), sun_color(other));
  EXPECT_EQ(affected(table_params(effect()), other), 0U);
  EXPECT_FALSE(constants() == before);
  // Parameters that do not affect the tables are those of the last set_params().
  other.scattering.scale = 2.5F;
  ASSERT_OK(effect().set_params(other));
  EXPECT_EQ(table_params(effect()).scattering.scale, 2.5F);
}

// Pictures that read no tables need not wait for them.
TEST_F(Spectral, TheModeChangesAtOnceIfNoTablesAreRead) {
  show(evening());
  Params rgb = small_params();
  rgb.scattering.single = SingleScattering::integration;
  rgb.scattering.multiple = MultipleScattering::none;
  prepare(rgb);
  const Picture before = draw(rgb, "rgb");
  Params params = rgb;
  params.scattering.color = ColorMode::spectral;
  const Picture after = draw(params, "spectral");
  EXPECT_EQ(picture_color(effect()), ColorMode::spectral);
  EXPECT_EQ(table_params(effect()).scattering.color, ColorMode::rgb);
  EXPECT_NE(after, before);
  prepare(params);
  EXPECT_EQ(draw(params, "spectral with tables"), after);
  EXPECT_EQ(draw(rgb, "rgb again"), before);
}

// Half floats, and tables that another effect has saved.
TEST_F(Spectral, HalfFloatsAndSavedTablesShowTheSamePicture) {
  show(evening());
  prepare(spectral_params());
  const Picture expected = draw(spectral_params(), "single precision");
  EffectDesc half = SharedEffect::desc();
  half.output_format = OutputFormat::rgba16f;
  half.max_extent = frame().extent;
  Result<Effect> made = Effect::create(info(), half, spectral_params());
  ASSERT_OK(made);
  EXPECT_EQ(made.value().table_key(), effect().table_key());
  EXPECT_EQ(made.value().table_bytes(), effect().table_bytes());
  Result<gpu::Buffer> saved =
      gpu::create_buffer(host().device(), "saved", effect().table_bytes(),
                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryKind::device);
  ASSERT_OK(saved);
  const VkBuffer buffer = saved.value().buffer.get();
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) { return effect().record_save_tables(cmd, buffer); }));
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) { return made.value().record_load_tables(cmd, buffer); }));
  EXPECT_TRUE(made.value().precompute_progress().complete());
  const Result<Picture> drawn = render(host(), made.value(), frame(), OutputFormat::rgba16f);
  ASSERT_OK(drawn);
  // Half floats have 11 significant bits, and Vulkan leaves the direction of rounding to the device.
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(drawn.value()[i][c], expected[i][c], expected[i][c] * 0x1p-10 + 0x1p-24) << i;
    }
  }
}

TEST_F(Spectral, MemoryGrowsByATenthAtMost) {
  EffectDesc desc;
  desc.max_extent = {1280, 720};
  Params params;
  const Result<MemoryUsage> rgb = query_memory(info(), desc, params);
  params.scattering.color = ColorMode::spectral;
  const Result<MemoryUsage> spectral = query_memory(info(), desc, params);
  ASSERT_TRUE(rgb.ok() && spectral.ok());
  const auto ratio = [](VkDeviceSize a, VkDeviceSize b) { return static_cast<double>(a) / static_cast<double>(b); };
  EXPECT_LE(ratio(spectral.value().persistent, rgb.value().persistent), 1.1);
  EXPECT_LE(ratio(spectral.value().transient, rgb.value().transient), 1.1);
  prepare(spectral_params());
  const MemoryUsage used = effect().memory();
  const Result<MemoryUsage> planned = query_memory(info(), SharedEffect::desc(), spectral_params());
  ASSERT_OK(planned);
  EXPECT_EQ(used.persistent, planned.value().persistent);
}

}  // namespace
}  // namespace tyndall
