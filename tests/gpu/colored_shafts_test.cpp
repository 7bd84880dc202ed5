// Light shafts through stained glass: FrameInputs::shadow_colors in every mode and both techniques.
#include <algorithm>
#include <functional>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "shared_effect.hpp"

namespace tyndall {
namespace {

class ColoredShafts : public SharedEffect {
 public:
  static void SetUpTestSuite() {
    with_colors_ = true;
    SharedEffect::SetUpTestSuite();
  }

 protected:
  static BoxScene colored() {
    BoxScene scene;
    scene.panes_m = 900.0;
    return scene;
  }
};

struct Mode {
  const char* name;
  SingleScattering single;
  MultipleScattering multiple;
  LitSections sections;
};
constexpr Mode kModes[] = {
    {"integration", SingleScattering::integration, MultipleScattering::none, LitSections::contiguous},
    {"table", SingleScattering::table, MultipleScattering::none, LitSections::contiguous},
    {"table, each section", SingleScattering::table, MultipleScattering::none, LitSections::each},
    {"integration, occluded", SingleScattering::integration, MultipleScattering::occluded, LitSections::contiguous},
    {"table, occluded, each section", SingleScattering::table, MultipleScattering::occluded, LitSections::each},
    {"table, unoccluded", SingleScattering::table, MultipleScattering::unoccluded, LitSections::contiguous},
};
Params params_of(const Mode& mode) {
  Params params = small_params();
  params.scattering.single = mode.single;
  params.scattering.multiple = mode.multiple;
  params.scattering.sections = mode.sections;
  return params;
}

TEST_F(ColoredShafts, EveryModeIsLikeBruteForce) {
  for (const double yaw_deg : {0.0, 150.0}) {
    BoxScene scene = colored();
    scene.extent = {128, 72};
    scene.yaw_deg = yaw_deg;
    show(scene);
    const std::string where = yaw_deg == 0.0 ? ", towards the sun" : ", away from it";
    for (const Mode& mode : kModes) expect_alike(mode.name + where, params_of(mode), 40.0);
  }
}

TEST_F(ColoredShafts, TreesFormatsAndOrderOfCascadesChangeNothing) {
  for (const bool reached : {true, false}) {
    BoxScene scene = colored();
    scene.extent = {96, 54};
    scene.shadow_resolution = reached ? 512 : 1024;  // the tree covers all of the map, or a part of it
    show(scene);
    for (const Mode& mode : {kModes[0], kModes[1], kModes[4]}) {
      Params params = params_of(mode);
      const Picture picture = draw(params, mode.name);
      const std::uint64_t read_with_tree = counters().shadow_map_fetches;
      const auto same = [&](const std::string& name, const std::function<void(Params&)>& change) {
        Params other = params;
        change(other);
        const Likeness likeness = compare(draw(other, name), picture, frame().extent);
        EXPECT_LE(likeness.worst_relative_error, 1e-3) << mode.name << ", " << name;
        RecordProperty("worst: " + std::string(mode.name) + ", " + name, std::to_string(likeness.worst_relative_error));
      };
      same("no tree", [](Params& p) { p.epipolar.min_max_tree = false; });
      // The tree skips only cells in shadow.
      EXPECT_LT(read_with_tree, counters().shadow_map_fetches) << mode.name;
      same("float32", [](Params& p) { p.epipolar.min_max_format = MinMaxFormat::float32; });
      same("multi-pass", [](Params& p) { p.shadows.cascade_processing = CascadeProcessing::multi_pass; });
      same("instanced", [](Params& p) { p.shadows.cascade_processing = CascadeProcessing::multi_pass_instanced; });
    }
  }
}

// At half and a quarter of the resolution, coloured shafts are marched, corrected and upscaled in both media.
TEST_F(ColoredShafts, AreDownscaled) {
  BoxScene scene = colored();
  scene.extent = {320, 180};
  show(scene);
  for (const MediumKind medium : {MediumKind::atmosphere, MediumKind::homogeneous}) {
    for (const CascadeProcessing processing :
         {CascadeProcessing::single_pass, CascadeProcessing::multi_pass, CascadeProcessing::multi_pass_instanced}) {
      Params params = params_of(kModes[0]);
      params.epipolar.slices = 256;
      params.epipolar.samples = 128;
      params.scattering.medium = medium;
      params.shadows.cascade_processing = processing;
      const std::string name = std::string(medium == MediumKind::atmosphere ? "atmosphere" : "homogeneous") +
                               ", processing " + std::to_string(static_cast<int>(processing));
      const Picture full = draw(params, name);
      for (const std::uint32_t downscale : {2U, 4U}) {
        params.scattering.downscale = downscale;
        const Likeness likeness = compare(draw(params, name), full, scene.extent);
        EXPECT_GE(likeness.psnr_db, downscale == 2 ? 40.0 : 35.0) << name << ", downscale " << downscale;
        RecordProperty("dB: " + name + ", downscale " + std::to_string(downscale), hundredths(likeness.psnr_db));
      }
    }
  }
}

// Glass of one colour everywhere gives the same picture as a sun of that colour, and clear glass changes nothing.
TEST_F(ColoredShafts, OneColorScalesTheLight) {
  BoxScene scene = colored();
  scene.extent = {96, 54};
  scene.pitch_deg = -26.0;  // without sky, every ray ends within the maps, beyond which there are no colours
  TestFrame glass = frame_of(scene);
  TestFrame bare = glass;
  bare.shadow_color = nullptr;
  for (const Mode& mode : kModes) {
    if (mode.multiple == MultipleScattering::unoccluded) continue;  // glass does not affect unoccluded light
    for (const Technique technique : {Technique::epipolar, Technique::brute_force}) {
      Params params = params_of(mode);
      params.scattering.technique = technique;
      params.scattering.only = true;
      const std::string name = std::string(mode.name) + (technique == Technique::epipolar ? "" : ", brute force");
      show(bare);
      const Picture white = draw(params, name + ", no glass", true);
      for (const glm::dvec3& color : {glm::dvec3(1.0), glm::dvec3(0.25, 0.5, 0.75)}) {
        glass.shadow_color = [color](std::uint32_t, double, double) { return color; };
        show(glass);
        const Picture picture = draw(params, name, true);
        double worst = 0.0;
        double brightest = 0.0;
        for (std::size_t i = 0; i < picture.size(); ++i) {
          const glm::dvec3 off = glm::abs(picture[i] - color * white[i]);
          worst = std::max({worst, off.x, off.y, off.z});
          brightest = std::max({brightest, white[i].x, white[i].y, white[i].z});
        }
        RecordProperty("off: " + name + (color.x == 1.0 ? ", clear" : ", coloured"), std::to_string(worst / brightest));
        // Brute force has one more rounding. Epipolar sampling stores source functions in half precision.
        EXPECT_LE(worst / brightest, technique == Technique::epipolar ? 1.5e-3 : 2e-6) << name << " " << color.x;
      }
    }
  }
}

// With the depth of the glass, the medium on its sunward side is not coloured. Glass above everything colours all
// light, glass below everything colours none, and between them it colours the light below it. Both techniques agree.
TEST_F(ColoredShafts, OnlyTheMediumBehindTheGlassIsColored) {
  for (const bool reversed : {false, true}) {
    BoxScene scene = colored();
    scene.extent = {128, 72};
    scene.shadow_depth_reversed = reversed;
    own_effect_.reset();
    if (reversed) {
      EffectDesc with = desc();
      with.shadow_depth_reversed = true;
      make(own_effect_, with);
    }
    TestFrame frame = frame_of(scene);
    // Returns the depth at which a position of a map is at an altitude above the origin.
    const auto level = [cascades = frame.cascades](double height_m) {
      return [cascades, height_m](std::uint32_t c, double u, double v) {
        glm::dmat4 shadow_from_world;
        for (int i = 0; i < 16; ++i)
          shadow_from_world[i / 4][i % 4] = static_cast<double>(cascades[c].shadow_from_world.m[i]);
        const glm::dmat4 world_from_shadow = glm::inverse(shadow_from_world);
        const double near = (world_from_shadow * glm::dvec4(u, v, 0.0, 1.0)).y;
        const double far = (world_from_shadow * glm::dvec4(u, v, 1.0, 1.0)).y;
        return static_cast<float>(std::clamp((height_m - near) / (far - near), 0.0, 1.0));
      };
    };
    for (const Mode& mode : {kModes[0], kModes[1], kModes[4]}) {
      Params params = params_of(mode);
      params.scattering.only = true;
      const std::string name = std::string(mode.name) + (reversed ? ", reversed" : "");
      show(frame);
      const Picture everywhere = draw(params, name + ", everywhere", true);
      frame.glass_depth = level(1e6);
      show(frame);
      EXPECT_LE(compare(draw(params, name + ", glass above all", true), everywhere, scene.extent).worst_relative_error,
                1e-6)
          << name;
      TestFrame bare = frame;
      bare.shadow_color = nullptr;
      show(bare);
      const Picture white = draw(params, name + ", no glass", true);
      frame.glass_depth = level(-1e6);
      show(frame);
      const Likeness below = compare(draw(params, name + ", glass below all", true), white, scene.extent);
      // Cells are read one by one instead of as whole nodes, so the sums are rounded differently.
      EXPECT_LE(below.worst_relative_error, 2e-3) << name;
      // A plane across the direction of the sun, 4 km in front of the camera.
      const glm::dvec3 place = frame.view.position + 4000.0 * frame.to_sun;
      frame.glass_depth = [cascades = frame.cascades, place](std::uint32_t c, double, double) {
        const Mat4& m = cascades[c].shadow_from_world;
        return static_cast<float>(static_cast<double>(m.m[2]) * place.x + static_cast<double>(m.m[6]) * place.y +
                                  static_cast<double>(m.m[10]) * place.z + static_cast<double>(m.m[14]));
      };
      show(frame);
      expect_alike(name + ", glass before the camera", params, 40.0);
      const Picture some = draw(params, name, true);
      EXPECT_LT(compare(some, everywhere, scene.extent).psnr_db, 35.0) << name;
      EXPECT_LT(compare(some, white, scene.extent).psnr_db, 35.0) << name;
      frame.glass_depth = nullptr;
    }
  }
  own_effect_.reset();
}

TEST_F(ColoredShafts, ShaftsAreColored) {
  BoxScene scene = colored();
  show(scene);
  Params params = params_of(kModes[0]);
  params.scattering.only = true;
  const Picture colored_picture = draw(params, "panes", true);
  TestFrame bare = frame_of(scene);
  bare.shadow_color = nullptr;
  show(bare);
  const Picture white = draw(params, "no glass", true);
  std::size_t redder = 0;
  std::size_t bluer = 0;
  for (std::size_t i = 0; i < white.size(); ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_LE(colored_picture[i][c], white[i][c] * 1.01 + 1e-6);
    if (white[i].x <= 0.0 || white[i].z <= 0.0) continue;
    const double ratio = (colored_picture[i].x / white[i].x) / (colored_picture[i].z / white[i].z);
    redder += ratio > 1.2 ? 1 : 0;
    bluer += ratio < 0.8 ? 1 : 0;
  }
  EXPECT_GT(redder, white.size() / 50);
  EXPECT_GT(bluer, white.size() / 50);
  RecordProperty("redder, bluer", std::to_string(redder) + " " + std::to_string(bluer));
}

// The last case, because the others need the tables of rgb.
TEST_F(ColoredShafts, SpectralPicturesAreLikeBruteForce) {
  BoxScene scene = colored();
  scene.extent = {128, 72};
  show(scene);
  Params params = small_params();
  params.scattering.color = ColorMode::spectral;
  ASSERT_OK(effect().set_params(params));
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    const Result<Progress> built = effect().record_precompute(cmd);
    if (!built.ok()) return built.error();
    return {};
  }));
  expect_alike("spectral", params, 40.0);
  // Yellow glass takes light away at every wavelength.
  TestFrame frame = frame_of(scene);
  frame.shadow_color = [](std::uint32_t, double, double) { return glm::dvec3(1.0); };
  frame.glass_depth = {};
  show(frame);
  params = by_brute_force(params);
  const Picture clear = draw(params, "clear glass");
  frame.shadow_color = [](std::uint32_t, double, double) { return glm::dvec3(1.0, 1.0, 0.0); };
  show(frame);
  const Picture yellow = draw(params, "yellow glass");
  double least = 1.0;
  for (std::size_t i = 0; i < clear.size(); ++i) {
    const auto luminance = [](const glm::dvec3& c) { return glm::dot(c, glm::dvec3(0.2126, 0.7152, 0.0722)); };
    EXPECT_LE(luminance(yellow[i]), luminance(clear[i]) * 1.0001) << i;
    least = std::min(least, yellow[i].z / clear[i].z);
  }
  EXPECT_LT(least, 0.9) << "no glass was in the way of the light";
}

}  // namespace
}  // namespace tyndall
