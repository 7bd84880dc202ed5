// Clouds and fog of the caller, FrameInputs::clouds: against closed forms, against brute force in every mode, and
// through the look-ups of tyndall/atmosphere.glsl. All cases share an effect.
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "atmosphere_points.hpp"
#include "shared_effect.hpp"

namespace tyndall {
namespace {

glm::dmat4 wide(const Mat4& m) {
  glm::dmat4 out;
  for (int i = 0; i < 16; ++i) out[i / 4][i % 4] = static_cast<double>(m.m[i]);
  return out;
}

// Places a map of 2 half_m along the sun around the camera, in which a layer is at y = height_m.
void add_clouds(TestFrame& frame, double half_m, double height_m,
                const std::function<glm::dvec3(double u, double v)>& transmittance) {
  frame.clouds.map_from_world = sun_cascade(frame.to_sun, frame.view.position, half_m, 0.0, 1.0).shadow_from_world;
  const glm::dmat4 world_from_map = glm::inverse(wide(frame.clouds.map_from_world));
  frame.clouds.texel = [world_from_map, height_m, transmittance](double u, double v) {
    const double near = (world_from_map * glm::dvec4(u, v, 0.0, 1.0)).y;
    const double far = (world_from_map * glm::dvec4(u, v, 1.0, 1.0)).y;
    return glm::dvec4(transmittance(u, v), (height_m - near) / (far - near));
  };
}

constexpr double kAboveAll_m = 2e6;
constexpr double kBelowAll_m = -2e6;
const glm::dvec3 kGrey(0.3), kColor(0.25, 0.5, 0.75);

std::function<glm::dvec3(double, double)> everywhere(const glm::dvec3& color) {
  return [color](double, double) { return color; };
}

// Clouds a few kilometres across, and clear sky between them.
glm::dvec3 patches(double u, double v) {
  const double wave = std::sin(38.0 * u) * std::sin(31.0 * v) + 0.4 * std::sin(90.0 * u + 70.0 * v);
  return glm::mix(glm::dvec3(1.0), glm::dvec3(0.15, 0.2, 0.25), glm::smoothstep(0.0, 0.25, wave));
}

struct Mode {
  const char* name;
  SingleScattering single;
  MultipleScattering multiple;
  LitSections sections = LitSections::contiguous;
  MediumKind medium = MediumKind::atmosphere;
  CascadeProcessing processing = CascadeProcessing::single_pass;
};
constexpr Mode kModes[] = {
    {"integration", SingleScattering::integration, MultipleScattering::none},
    {"table, occluded", SingleScattering::table, MultipleScattering::occluded},
    {"occluded alone, each section", SingleScattering::none, MultipleScattering::occluded, LitSections::each},
    {"occluded, multi-pass", SingleScattering::integration, MultipleScattering::occluded, LitSections::contiguous,
     MediumKind::atmosphere, CascadeProcessing::multi_pass},
    {"occluded, instanced", SingleScattering::integration, MultipleScattering::occluded, LitSections::contiguous,
     MediumKind::atmosphere, CascadeProcessing::multi_pass_instanced},
    {"homogeneous", SingleScattering::integration, MultipleScattering::none, LitSections::contiguous,
     MediumKind::homogeneous},
};
Params params_of(const Mode& mode, Technique technique = Technique::epipolar) {
  Params params = small_params();
  params.scattering.single = mode.single;
  params.scattering.multiple = mode.multiple;
  params.scattering.sections = mode.sections;
  params.scattering.medium = mode.medium;
  params.shadows.cascade_processing = mode.processing;
  params.scattering.technique = technique;
  params.scattering.scale = 1.0F;
  params.froxels.columns = 48;
  params.froxels.rows = 28;
  params.froxels.slices = 32;
  params.froxels.far_m = 60000.0F;
  params.homogeneous_medium.extent_m = 40000.0F;
  return params;
}

class CloudsOfCaller : public SharedEffect {
 public:
  static void SetUpTestSuite() {
    with_clouds_ = true;
    SharedEffect::SetUpTestSuite();
  }

 protected:
  static BoxScene small_scene() {
    BoxScene scene;
    scene.extent = {48, 28};
    return scene;
  }
  // Returns the largest error of a channel, relative to the brightest one.
  static double worst_of(const Picture& picture, const Picture& truth) {
    double worst = 0.0, brightest = 1e-30;
    for (std::size_t i = 0; i < picture.size(); ++i) {
      const glm::dvec3 off = glm::abs(picture[i] - truth[i]);
      worst = std::max({worst, off.x, off.y, off.z});
      brightest = std::max({brightest, truth[i].x, truth[i].y, truth[i].z});
    }
    return worst / brightest;
  }
  static double mean_of(const Picture& picture, const Picture& truth) {
    double sum = 0.0, brightest = 1e-30;
    for (std::size_t i = 0; i < picture.size(); ++i) {
      const glm::dvec3 off = glm::abs(picture[i] - truth[i]);
      sum += std::max({off.x, off.y, off.z});
      brightest = std::max({brightest, truth[i].x, truth[i].y, truth[i].z});
    }
    return sum / static_cast<double>(picture.size()) / brightest;
  }
  static Picture scaled(Picture picture, const glm::dvec3& by) {
    for (glm::dvec3& p : picture) p *= by;
    return picture;
  }
};

// Behind a layer, all in-scattered light has the colour that the layer lets pass. In front of it nothing changes. The
// scene has buildings, whose shadows stay.
TEST_F(CloudsOfCaller, LightBehindALayerIsScaledAndLightInFrontOfItIsNot) {
  for (const Mode& mode : kModes) {
    for (const Technique technique : {Technique::epipolar, Technique::brute_force, Technique::froxels}) {
      SCOPED_TRACE(std::string(mode.name) + ", technique " + std::to_string(static_cast<int>(technique)));
      const bool rare = &mode != &kModes[1] && mode.medium == MediumKind::atmosphere;
      if (technique != Technique::epipolar && rare) continue;
      Params params = params_of(mode, technique);
      params.scattering.only = true;
      TestFrame frame = frame_of(small_scene());
      show(frame);
      const Picture none = draw(params, "no clouds", true);
      add_clouds(frame, 2e6, kAboveAll_m, everywhere(glm::dvec3(1.0)));
      show(frame);
      const Picture clear = draw(params, "clear", true);
      add_clouds(frame, 2e6, kBelowAll_m, everywhere(kColor));
      show(frame);
      const Picture in_front = draw(params, "in front", true);
      add_clouds(frame, 2e6, kAboveAll_m, everywhere(kColor));
      show(frame);
      const Picture behind = draw(params, "behind", true);
      // With clouds, the boundaries of shadows are read in smaller steps.
      if (mode.single != SingleScattering::table) {
        EXPECT_GE(compare(clear, none, frame.extent).psnr_db, 45.0);
      }
      EXPECT_LE(worst_of(in_front, clear), 1e-5);
      if (technique == Technique::froxels) continue;  // light beyond the volume ignores clouds
      // Epipolar sampling stores source functions in half precision.
      EXPECT_LE(worst_of(behind, scaled(clear, kColor)), technique == Technique::epipolar ? 2e-3 : 1e-5);
    }
  }
}

// A slab at 3 km covers about one half of the map. Its edge is 3.6 km from the camera, because no ray may follow the
// edge, along which texels are filtered. It lies between two texels. The light of a ray is that of its parts behind and
// beside the slab, in closed form up to the integral of unshadowed scattering, which the CPU model computes in double
// precision.
TEST_F(CloudsOfCaller, ASlabOverOneHalfDarkensTheRaysBehindIt) {
  constexpr double kHeight_m = 3000.0, kEdge = 272.0 / 512.0;
  TestFrame frame;
  frame.extent = {40, 24};
  frame.view = TestView::at(1200.0, 0.3, 0.12, 0.5);
  frame.to_sun = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));
  frame.clouds.resolution = 512;
  add_clouds(frame, 60000.0, kHeight_m, [](double u, double) { return u < kEdge ? kColor : glm::dvec3(1.0); });
  const glm::dmat4 map = wide(frame.clouds.map_from_world);
  for (const Technique technique : {Technique::epipolar, Technique::brute_force}) {
    Params params = params_of(kModes[0], technique);
    params.scattering.only = true;
    params.scattering.integration_steps = 48;
    params.epipolar.slices = params.epipolar.samples = 1024;
    params.epipolar.initial_step = 1;  // marches all samples
    show(frame);
    const Picture picture = draw(params, "slab", true);
    std::size_t darkened = 0;
    Picture truth(picture.size());
    for (std::uint32_t y = 0; y < frame.extent.height; ++y) {
      for (std::uint32_t x = 0; x < frame.extent.width; ++x) {
        const RayAngles angles = frame.ray(x, y, static_cast<double>(params.planet.radius_m));
        const std::optional<AirSegment> air = segment_below_top(params, angles);
        ASSERT_TRUE(air.has_value());
        const glm::dvec3 direction = frame.view.ray(x, y, frame.extent);
        const glm::dvec4 at = map * glm::dvec4(frame.view.position, 1.0), change = map * glm::dvec4(direction, 0.0);
        // The ray crosses the slab, its edge in the map, and the borders of the map.
        std::vector<double> places = {air->start, air->end, (kHeight_m - frame.view.position.y) / direction.y,
                                      (kEdge - at.x) / change.x};
        for (const double border : {0.0, 1.0}) {
          places.push_back((border - at.x) / change.x);
          places.push_back((border - at.y) / change.y);
        }
        for (double& place : places) place = std::clamp(place, air->start, air->end);
        std::sort(places.begin(), places.end());
        glm::dvec3 light(0.0);
        for (std::size_t i = 0; i + 1 < places.size(); ++i) {
          const double middle = 0.5 * (places[i] + places[i + 1]);
          const glm::dvec4 uvz = at + middle * change;
          const bool behind = frame.view.position.y + middle * direction.y < kHeight_m;
          const bool covered = uvz.x > 0.0 && uvz.x < kEdge && uvz.y > 0.0 && uvz.y < 1.0;
          light += (behind && covered ? kColor : glm::dvec3(1.0)) *
                   true_inscattering(params, angles, places[i], places[i + 1]);
          if (behind && covered && places[i + 1] > places[i] + 1.0) ++darkened;
        }
        truth[y * frame.extent.width + x] = light;
      }
    }
    EXPECT_GT(darkened, picture.size() / 4);
    // At the horizon, light changes between neighbouring pixels, and epipolar sampling interpolates between them.
    const bool epipolar = technique == Technique::epipolar;
    const double error = epipolar ? mean_of(picture, truth) : worst_of(picture, truth);
    RecordProperty(epipolar ? "epipolar_mean" : "brute_force_worst", std::to_string(error));
    EXPECT_LE(error, 0.003);
  }
}

// In a homogeneous medium, the light of a section [a, b] of a ray is exp(-sigma a) - exp(-sigma b). Under an opaque
// layer, only the medium beyond the layer is lit. The ray then gains the light of the whole medium minus that of the
// medium in front of the layer.
TEST_F(CloudsOfCaller, AHomogeneousMediumIsDividedInClosedForm) {
  TestFrame frame;
  frame.extent = {32, 20};
  frame.view = TestView::at(100.0, 0.3, 0.35, 0.3);  // above the horizontal
  frame.to_sun = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));
  Params params = params_of(kModes[5], Technique::brute_force);
  params.scattering.only = true;
  params.homogeneous_medium.height_m = 5000.0F;
  constexpr double kHeight_m = 1500.0;
  const auto draw_with = [&](double height_m, double transmittance) {
    add_clouds(frame, 100000.0, height_m, everywhere(glm::dvec3(transmittance)));
    show(frame);
    return draw(params, "homogeneous", true);
  };
  const Picture whole = draw_with(kAboveAll_m, 1.0);
  const Picture beyond = draw_with(kHeight_m, 0.0);
  // With a medium that ends at the layer, the picture shows the light of the part in front of the layer.
  params.homogeneous_medium.height_m = static_cast<float>(kHeight_m);
  const Picture near = draw_with(kAboveAll_m, 1.0);
  Picture truth = whole;
  for (std::size_t i = 0; i < truth.size(); ++i) truth[i] -= near[i];
  EXPECT_LE(worst_of(beyond, truth), 1e-2);
  EXPECT_GT(worst_of(whole, beyond), 0.2);
}

TEST_F(CloudsOfCaller, EveryModeIsLikeBruteForce) {
  BoxScene scene;
  scene.extent = {128, 72};
  TestFrame frame = frame_of(scene);
  frame.clouds.resolution = 256;
  add_clouds(frame, 25000.0, 3500.0, patches);
  show(frame);
  for (const Mode& mode : kModes) {
    const Params params = params_of(mode);
    expect_alike(mode.name, params, 40.0);
    if (mode.processing != CascadeProcessing::single_pass) continue;
    const Picture with_tree = draw(params, mode.name, true);
    const std::uint64_t read_with_tree = counters().shadow_map_fetches;
    Params other = params;
    other.epipolar.min_max_tree = false;
    const Likeness likeness = compare(draw(other, mode.name, true), with_tree, scene.extent);
    // Steps through clouds begin elsewhere.
    EXPECT_GE(likeness.psnr_db, 55.0) << mode.name << ", no tree";
    EXPECT_LT(read_with_tree, counters().shadow_map_fetches) << mode.name;
    RecordProperty("dB without tree: " + std::string(mode.name), hundredths(likeness.psnr_db));
  }
  // The clouds are seen.
  const Picture clouded = draw(params_of(kModes[0]), "clouds");
  frame.clouds.texel = nullptr;
  show(frame);
  EXPECT_LT(compare(draw(params_of(kModes[0]), "no clouds"), clouded, scene.extent).psnr_db, 30.0);
}

// Glass colours the light that clouds let pass. With glass of one colour, both factors are separate.
TEST_F(CloudsOfCaller, GlassAndCloudsMultiply) {
  BoxScene scene = small_scene();
  scene.pitch_deg = -26.0;  // every ray ends within the maps of glass
  TestFrame frame = frame_of(scene);
  frame.shadow_color = [](std::uint32_t, double, double) { return kGrey; };
  EffectDesc both = desc();
  both.shadow_colors = true;
  make(own_effect_, both);
  Params params = params_of(kModes[0]);
  params.scattering.only = true;
  for (const Technique technique : {Technique::epipolar, Technique::brute_force}) {
    params.scattering.technique = technique;
    add_clouds(frame, 2e6, kAboveAll_m, everywhere(glm::dvec3(1.0)));
    show(frame);
    const Picture glass = draw(params, "glass", true);
    add_clouds(frame, 2e6, kAboveAll_m, everywhere(kColor));
    show(frame);
    EXPECT_LE(worst_of(draw(params, "both", true), scaled(glass, kColor)), 2e-3);
  }
  own_effect_.reset();
}

// The froxel volume has the light that brute force computes at its points.
TEST_F(CloudsOfCaller, FroxelsHoldTheLightOfBruteForce) {
  TestFrame frame = frame_of(small_scene());
  frame.clouds.resolution = 256;
  add_clouds(frame, 25000.0, 3500.0, patches);
  for (const Mode& mode : {kModes[0], kModes[1], kModes[5]}) {
    Params params = params_of(mode, Technique::froxels);
    params.scattering.only = true;
    const FroxelParams& p = params.froxels;
    const double distance = p.near_m * (std::pow(1.0 + static_cast<double>(p.far_m) / p.near_m, 26.0 / 31.0) - 1.0);
    frame.distance_m = [distance](std::uint32_t, std::uint32_t) { return distance; };
    show(frame);
    expect_alike(mode.name, params, 40.0);
  }
}

// An effect that allows clouds draws frames without clouds like one that does not, byte for byte.
TEST_F(CloudsOfCaller, FramesWithoutCloudsAreUnchanged) {
  show(small_scene());
  std::vector<Picture> pictures[2];
  for (const bool clouds : {true, false}) {
    if (!clouds) {
      EffectDesc without = desc();
      without.clouds = false;
      make(own_effect_, without);
    }
    for (const Mode& mode : {kModes[0], kModes[1], kModes[5]}) {
      for (const Technique technique : {Technique::epipolar, Technique::brute_force, Technique::froxels}) {
        pictures[clouds ? 1 : 0].push_back(draw(params_of(mode, technique), mode.name, true));
      }
    }
  }
  EXPECT_TRUE(pictures[0] == pictures[1]);
  own_effect_.reset();
}

TEST_F(CloudsOfCaller, MemoryIsAsQueried) {
  for (const bool clouds : {false, true}) {
    EffectDesc other = desc();
    other.clouds = clouds;
    make(own_effect_, other);
    const Result<MemoryUsage> planned = query_memory(info(), other, small_params());
    ASSERT_OK(planned);
    EXPECT_EQ(planned.value().persistent, own_effect_->memory().persistent);
    EXPECT_EQ(planned.value().host, own_effect_->memory().host);
    own_effect_.reset();
  }
}

// Look-ups of tyndall/atmosphere.glsl see the same clouds: sunlight behind them is scaled, in front of them it is not,
// and so is single scattering along a path.
TEST_F(CloudsOfCaller, LookUpsAreDarkened) {
  TestFrame frame;
  frame.view = TestView::at(0.0, 0.0, 0.0, 0.5);
  frame.to_sun = glm::normalize(glm::dvec3(0.2, 0.9, -0.3));
  add_clouds(frame, 20000.0, 3000.0, [](double u, double) { return u < 0.5 ? kColor : glm::dvec3(1.0); });
  show(frame);
  ASSERT_OK(effect().set_params(small_params()));
  AtmosphereInputs inputs;
  inputs.sun.irradiance = Vec3(1.0F);
  inputs.sun.direction_to_sun = {static_cast<float>(frame.to_sun.x), static_cast<float>(frame.to_sun.y),
                                 static_cast<float>(frame.to_sun.z)};
  inputs.clouds_from_position = frame.clouds.map_from_world;
  const glm::dmat4 world_from_map = glm::inverse(wide(frame.clouds.map_from_world));
  // Returns the position at a height on the line of the sun's light through (u, 1/2) of the map.
  const auto place = [&](double u, double height_m) {
    const glm::dvec3 near = world_from_map * glm::dvec4(u, 0.5, 0.0, 1.0);
    return near - frame.to_sun * ((near.y - height_m) / frame.to_sun.y);
  };
  const double heights_m[] = {500.0, 2900.0, 3100.0, 6000.0};
  std::vector<Query> queries;
  for (const double u : {0.3, 0.7, 1.2}) {
    for (const double height_m : heights_m) queries.push_back(query(sun_irradiance, place(u, height_m), {}));
  }
  queries.push_back(query(between_shadowed, place(0.2, 500.0), place(0.4, 1500.0), 32));
  queries.push_back(query(between_shadowed, place(0.6, 500.0), place(0.8, 1500.0), 32));
  gpu::SamplerDesc sampler;
  sampler.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
  Result<gpu::Handle<VkSampler>> linear = gpu::create_sampler(host().device(), sampler);
  ASSERT_OK(linear);
  const Texture map = images().inputs(frame).clouds.map;
  const VkDescriptorImageInfo clouds = {linear.value().get(), map.view, map.layout};
  Params params = small_params();
  const std::vector<Answer> clear = evaluate_points(host(), effect(), params, inputs, queries);
  const std::vector<Answer> dark = evaluate_points(host(), effect(), params, inputs, queries, &clouds);
  for (std::size_t i = 0; i < 12; ++i) {
    const bool darkened = i < 4 && heights_m[i] < 3000.0;  // only the first line is covered
    const glm::dvec3 expected = clear[i].light * (darkened ? kColor : glm::dvec3(1.0));
    EXPECT_LE(relative_error(dark[i].light, expected), 1e-5) << i;
    EXPECT_GT(clear[i].light.x, 0.1) << i;
  }
  // Light that is scattered more than once stays.
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(dark[12].light[c], 0.95 * clear[12].light[c]);
    EXPECT_GT(dark[12].light[c], kColor[c] * clear[12].light[c]);
  }
  EXPECT_LE(relative_error(dark[13].light, clear[13].light), 1e-5);
  inputs.clouds_from_position.m[5] = std::numeric_limits<float>::quiet_NaN();
  const Result<AtmosphereConstants> refused = atmosphere_constants(params, inputs);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("clouds_from_position is not finite"), std::string::npos);
}

// Bright surfaces of one pixel, between samples, before a sky that clouds darken completely. They have the attenuation
// of their own distance, although no sample is at it.
TEST_F(CloudsOfCaller, ThinSurfacesBeforeADarkSkyAreAttenuated) {
  TestFrame frame;
  frame.extent = {96, 54};
  frame.view = TestView::at(500.0, 0.3, 0.5, 0.4);  // above the horizon
  frame.to_sun = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));
  frame.background = Vec3(1.0F);
  frame.distance_m = [](std::uint32_t x, std::uint32_t y) { return x % 12 == 5 && y % 10 == 4 ? 40000.0 : 0.0; };
  add_clouds(frame, 2e6, kAboveAll_m, everywhere(glm::dvec3(0.0)));
  show(frame);
  const Picture picture = draw(params_of(kModes[0]), "epipolar", true);
  const Picture truth = draw(by_brute_force(params_of(kModes[0])), "brute force", true);
  EXPECT_LT(truth[4 * 96 + 5].z, 0.8);
  EXPECT_LE(worst_of(picture, truth), 0.03);  // with the extinction of samples in the sky, more than 0.2
}

// The last case, because the others need the tables of rgb.
TEST_F(CloudsOfCaller, SpectralPicturesAreLikeBruteForce) {
  BoxScene scene;
  scene.extent = {128, 72};
  TestFrame frame = frame_of(scene);
  frame.clouds.resolution = 256;
  add_clouds(frame, 25000.0, 3500.0, patches);
  show(frame);
  Params params = params_of(kModes[1]);
  params.scattering.color = ColorMode::spectral;
  ASSERT_OK(effect().set_params(params));
  ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
    const Result<Progress> built = effect().record_precompute(cmd);
    return built.ok() ? Result<void>() : built.error();
  }));
  expect_alike("spectral", params, 40.0);
  params.scattering.only = true;
  TestFrame bare = frame_of(small_scene());
  for (const Technique technique : {Technique::epipolar, Technique::brute_force}) {
    params.scattering.technique = technique;
    add_clouds(bare, 2e6, kAboveAll_m, everywhere(glm::dvec3(1.0)));
    show(bare);
    const Picture clear = draw(params, "clear", true);
    add_clouds(bare, 2e6, kAboveAll_m, everywhere(kGrey));
    show(bare);
    EXPECT_LE(worst_of(draw(params, "grey", true), scaled(clear, kGrey)), 2e-3);
  }
}

}  // namespace
}  // namespace tyndall
