// Brute force in the modes that read the scattering tables, drawn through the public interface. They are compared with
// integration, whose shafts effect_shafts_test.cpp tests, and with each other. All cases share one build of small
// tables.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "effect_frame.hpp"

namespace tyndall {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;
constexpr double kFar_m = 60.0e3;   // end of the only cascade
constexpr double kMap_m = 160.0e3;  // width of its map
// Error relative to integration. It is caused by the small size of the tables, and by subtracting two of their values
// from each other.
constexpr double kTableTolerance = 0.03;
// Error caused by adding and subtracting the same look-ups in another order.
constexpr double kRoundingTolerance = 1e-4;

using Pixels = std::vector<glm::dvec3>;

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

// The mean and the largest difference of two pictures, relative to the pixels of a third.
struct Difference {
  double mean = 0.0, worst = 0.0;
};
Difference difference(const Pixels& a, const Pixels& b, const Pixels& scale) {
  Difference out;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (largest(scale[i]) == 0.0) continue;
    const double error = largest(glm::abs(a[i] - b[i])) / largest(scale[i]);
    out.mean += error / static_cast<double>(a.size());
    out.worst = std::max(out.worst, error);
  }
  return out;
}

Pixels sum(const Pixels& a, const Pixels& b) {
  Pixels out = a;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] += b[i];
  return out;
}

// Returns a frame at an altitude of 6 km that looks across the sun's rays, above and below the horizon. The lower half
// of the picture shows surfaces within the map and above the ground.
TestFrame frame_from_the_air() {
  TestFrame frame;
  frame.extent = {16, 8};
  frame.view = TestView::at(6000.0, 90.0 * kRad, 0.0, 0.3);
  frame.view.tan_half_height = 0.1;
  const double elevation = 15.0 * kRad;
  frame.to_sun = {0.0, std::sin(elevation), -std::cos(elevation)};
  frame.shadow_resolution = 512;
  frame.distance_m = [](std::uint32_t, std::uint32_t y) { return y < 4 ? 0.0 : 0.9 * kFar_m; };
  return frame;
}

// Adds one cascade around the view. `dark` returns whether the sun is hidden at a distance east of the camera.
void add_shadow(TestFrame& frame, const std::function<bool(double east_m)>& dark) {
  const glm::dvec3 sun = frame.to_sun;
  const glm::dvec3 rows[3] = {glm::dvec3(1.0, 0.0, 0.0) / kMap_m, glm::dvec3(0.0, -sun.z, sun.y) / kMap_m,
                              -sun / kMap_m};
  Cascade cascade;
  cascade.far_m = static_cast<float>(kFar_m);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) cascade.shadow_from_world.m[4 * c + r] = static_cast<float>(rows[r][c]);
    cascade.shadow_from_world.m[12 + r] = static_cast<float>(0.5 - glm::dot(rows[r], frame.view.position));
  }
  frame.cascades = {cascade};
  frame.shadow_depth = [=](std::uint32_t, double u, double) { return dark((u - 0.5) * kMap_m) ? 0.0F : 1.0F; };
}

bool nowhere(double) { return false; }
bool everywhere(double) { return true; }
// Returns whether a distance is in shadow, with two lit sections: 0 to 8 km and 20 to 36 km.
bool two_shafts(double east_m) { return !(east_m < 8.0e3 || (east_m > 20.0e3 && east_m < 36.0e3)); }
// Returns whether a distance is in shadow, with one lit section: 12 to 30 km.
bool one_shaft(double east_m) { return !(east_m > 12.0e3 && east_m < 30.0e3); }

class EffectTables : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (HasFatalFailure()) return;
    params_ = precise_params();
    params_.tables.size = {24, 64, 32, 8};
    params_.tables.orders = 2;
    EffectDesc desc;
    desc.max_extent = {16, 8};
    desc.output_format = OutputFormat::rgba32f;
    Result<Effect> effect = Effect::create(info(), desc, params_);
    ASSERT_OK(effect);
    effect_ = std::make_unique<Effect>(std::move(effect).value());
    while (!effect_->precompute_progress().complete()) {
      ASSERT_OK(host().run([&](VkCommandBuffer cmd) -> Result<void> {
        Result<Progress> recorded = effect_->record_precompute(cmd, 16);
        if (!recorded) return std::move(recorded).error();
        return {};
      }));
    }
  }
  void TearDown() override {
    effect_.reset();
    GpuTest::TearDown();
  }

  Pixels draw(const TestFrame& frame, SingleScattering single, MultipleScattering multiple,
              LitSections sections = LitSections::each) {
    params_.scattering.single = single;
    params_.scattering.multiple = multiple;
    params_.scattering.sections = sections;
    EXPECT_OK(effect_->set_params(params_));
    EXPECT_TRUE(effect_->precompute_progress().complete()) << "modes need no new tables";
    Result<Pixels> image = render(host(), *effect_, frame);
    EXPECT_OK(image);
    const std::size_t count = static_cast<std::size_t>(frame.extent.width) * frame.extent.height;
    return image.ok() ? std::move(image).value() : Pixels(count);
  }

  Params params_;
  std::unique_ptr<Effect> effect_;
};

using S = SingleScattering;
using M = MultipleScattering;

TEST_F(EffectTables, SingleAndMultipleAddUp) {
  TestFrame frame = frame_from_the_air();
  const auto check = [&](const char* what, bool shadows) {
    const Pixels none = draw(frame, S::none, M::none);
    EXPECT_TRUE(std::all_of(none.begin(), none.end(), [](const glm::dvec3& p) { return largest(p) == 0.0; })) << what;
    for (const M multiple : {M::occluded, M::unoccluded}) {
      const Pixels high = draw(frame, S::none, multiple);
      for (const S single : {S::integration, S::table}) {
        const Pixels whole = draw(frame, single, multiple);
        const Pixels parts = sum(draw(frame, single, M::none), high);
        EXPECT_LE(difference(whole, parts, whole).worst, kRoundingTolerance) << what;
      }
      const double brightest = largest(high.front());
      EXPECT_GT(brightest, 1e-4) << what;
    }
    const Pixels occluded = draw(frame, S::none, M::occluded);
    const Pixels open = draw(frame, S::none, M::unoccluded);
    const Difference d = difference(occluded, open, open);
    if (shadows) {
      EXPECT_GT(d.mean, 0.1) << what;
    } else {
      EXPECT_LE(d.worst, kRoundingTolerance) << what;
    }
  };
  check("no shadow maps", false);
  add_shadow(frame, nowhere);
  check("all lit", false);
  add_shadow(frame, two_shafts);
  check("two shafts", true);
}

TEST_F(EffectTables, OrderOneIsTheIntegral) {
  const TestFrame frame = frame_from_the_air();
  const Pixels integral = draw(frame, S::integration, M::none);
  EXPECT_LE(difference(draw(frame, S::table, M::none), integral, integral).worst, kTableTolerance);
}

TEST_F(EffectTables, AllLitEqualsNoShadows) {
  TestFrame frame = frame_from_the_air();
  const Pixels single = draw(frame, S::table, M::none);
  const Pixels high = draw(frame, S::none, M::occluded);
  add_shadow(frame, nowhere);
  for (const LitSections sections : {LitSections::contiguous, LitSections::each}) {
    EXPECT_LE(difference(draw(frame, S::table, M::none, sections), single, single).worst, kRoundingTolerance);
    EXPECT_LE(difference(draw(frame, S::none, M::occluded, sections), high, high).worst, kRoundingTolerance);
  }
}

TEST_F(EffectTables, AllInShadowShowsOnlyLightFromBeyondTheMap) {
  TestFrame frame = frame_from_the_air();
  const Pixels open = draw(frame, S::integration, M::none);
  const Pixels open_high = draw(frame, S::none, M::unoccluded);
  add_shadow(frame, everywhere);
  const Pixels beyond = draw(frame, S::integration, M::none);
  for (const LitSections sections : {LitSections::contiguous, LitSections::each}) {
    const Pixels single = draw(frame, S::table, M::none, sections);
    const Pixels high = draw(frame, S::none, M::occluded, sections);
    EXPECT_LE(difference(single, beyond, open).worst, kTableTolerance);
    for (std::size_t i = 0; i < single.size(); ++i) {
      // The rays of the lower half end on surfaces within the map.
      const bool ends_in_map = i >= single.size() / 2;
      EXPECT_EQ(largest(single[i]) == 0.0, ends_in_map) << i;
      EXPECT_EQ(largest(high[i]) == 0.0, ends_in_map) << i;
    }
  }
  // Unoccluded multiple scattering ignores shadows.
  EXPECT_EQ(draw(frame, S::none, M::unoccluded), open_high);
}

TEST_F(EffectTables, EachSectionIsTheIntegralAndOneContiguousIsNot) {
  TestFrame frame = frame_from_the_air();
  const Pixels open = draw(frame, S::integration, M::none);
  add_shadow(frame, two_shafts);
  const Pixels truth = draw(frame, S::integration, M::none);
  const Difference each = difference(draw(frame, S::table, M::none, LitSections::each), truth, open);
  const Difference contiguous = difference(draw(frame, S::table, M::none, LitSections::contiguous), truth, open);
  EXPECT_GT(difference(truth, open, open).mean, 0.2) << "the frame has shafts";
  EXPECT_LE(each.worst, kTableTolerance);
  EXPECT_GT(contiguous.mean, 2.0 * each.mean);
  // The lit length is the same, but at slightly different distances.
  EXPECT_LE(contiguous.worst, 0.15);
  // Higher orders are treated in the same way.
  const Pixels high_each = draw(frame, S::none, M::occluded, LitSections::each);
  const Pixels high_contiguous = draw(frame, S::none, M::occluded, LitSections::contiguous);
  const Pixels high_open = draw(frame, S::none, M::unoccluded);
  EXPECT_LE(difference(high_each, high_contiguous, high_open).worst, 0.15);
  for (std::size_t i = 0; i < open.size(); ++i) {
    // The shadow reduces them by about the same fraction.
    EXPECT_NEAR(high_each[i].y / high_open[i].y, truth[i].y / open[i].y, 0.1) << i;
  }
}

TEST_F(EffectTables, OneShaftIsTheSameEitherWay) {
  TestFrame frame = frame_from_the_air();
  const Pixels open = draw(frame, S::integration, M::none);
  frame.distance_m = [](std::uint32_t, std::uint32_t) { return 0.9 * kFar_m; };
  add_shadow(frame, one_shaft);
  const Pixels truth = draw(frame, S::integration, M::none);
  for (const LitSections sections : {LitSections::contiguous, LitSections::each}) {
    EXPECT_LE(difference(draw(frame, S::table, M::none, sections), truth, open).worst, kTableTolerance);
  }
}

TEST_F(EffectTables, WithoutLightShaftsTheMapsAreNotRead) {
  TestFrame frame = frame_from_the_air();
  const Pixels single = draw(frame, S::table, M::none);
  const Pixels high = draw(frame, S::none, M::occluded);
  add_shadow(frame, two_shafts);
  params_.scattering.light_shafts = false;
  EXPECT_EQ(draw(frame, S::table, M::none), single);
  EXPECT_EQ(draw(frame, S::none, M::occluded), high);
  params_.scattering.light_shafts = true;
  EXPECT_NE(draw(frame, S::table, M::none), single);
  EXPECT_NE(draw(frame, S::none, M::occluded), high);
}

TEST_F(EffectTables, FromSpaceOrderOneIsTheIntegral) {
  for (const double elevation_deg : {40.0, 5.0, -15.0}) {
    TestFrame frame;
    frame.extent = {16, 8};
    // The limb is 19.8 degrees below the horizontal; the picture spans 20 degrees.
    frame.view = TestView::at(400000.0, 0.0, -22.0 * kRad, 0.18);
    frame.to_sun = {0.0, std::sin(elevation_deg * kRad), -std::cos(elevation_deg * kRad)};
    const Pixels integral = draw(frame, S::integration, M::none);
    // Errors of dark pixels are relative to a hundredth of the brightest pixel.
    Pixels scale = integral;
    double brightest = 0.0;
    for (const glm::dvec3& p : integral) brightest = std::max(brightest, largest(p));
    for (glm::dvec3& p : scale) p = largest(p) > 0.0 ? glm::dvec3(std::max(largest(p), 0.01 * brightest)) : p;
    const Difference d = difference(draw(frame, S::table, M::none), integral, scale);
    EXPECT_GT(brightest, 1e-3) << "the picture shows lit air, sun at " << elevation_deg;
    EXPECT_LE(d.mean, 0.5 * kTableTolerance) << "sun at " << elevation_deg;
    EXPECT_LE(d.worst, 4.0 * kTableTolerance) << "sun at " << elevation_deg;
  }
}

}  // namespace
}  // namespace tyndall
