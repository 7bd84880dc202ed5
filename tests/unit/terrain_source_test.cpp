// Elevation files as terrain. It passes through the samples, is smooth, is level where the file is level, and has no
// cliff where procedural terrain begins.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/elevation/elevation_source.hpp"
#include "terrain_files.hpp"

namespace tyndall::scene {
namespace {

constexpr int kSamples = 200;
constexpr double kSpacing_m = 100.0;

// Returns a source for a file without a coordinate system, whose samples are therefore not resampled.
ElevationSource make(const TestFolder& folder, const std::function<double(int, int)>& value,
                     double exaggeration = 1.0) {
  TestFile file;
  file.epsg = 0;
  file.width = file.height = kSamples;
  ElevationDesc desc;
  desc.source = folder.write(file, value).string();
  desc.exaggeration = exaggeration;
  Result<ElevationSource> source = ElevationSource::create(desc);
  EXPECT_TRUE(source.ok()) << (source.ok() ? "" : source.error().message);
  return source.ok() ? std::move(source).value() : ElevationSource{};
}

double place(int sample) { return (sample + 0.5 - 0.5 * kSamples) * kSpacing_m; }

double waves(int x, int y) { return 1500.0 + 400.0 * std::sin(0.11 * x) + 300.0 * std::cos(0.07 * y + 0.05 * x); }

TEST(ElevationSource, PassesThroughTheSamples) {
  const TestFolder folder;
  const ElevationSource source = make(folder, waves);
  ASSERT_TRUE(source.from_file());
  for (int y = 60; y < 140; y += 7) {
    for (int x = 60; x < 140; x += 7) EXPECT_NEAR(source.height_m(place(x), place(y), kSpacing_m), waves(x, y), 0.01);
  }
}

TEST(ElevationSource, IsSmoothBetweenTheSamples) {
  const TestFolder folder;
  const ElevationSource source = make(folder, waves);
  // Slopes on both sides of a sample are equal.
  for (int x = 70; x < 130; x += 11) {
    const double at = place(x);
    const double here = source.height_m(at, 40.0, kSpacing_m);
    const double left = (here - source.height_m(at - 1.0, 40.0, kSpacing_m)) / 1.0;
    const double right = (source.height_m(at + 1.0, 40.0, kSpacing_m) - here) / 1.0;
    EXPECT_NEAR(left, right, 0.02);
  }
}

TEST(ElevationSource, CoarseSpacingsReadMeans) {
  const TestFolder folder;
  const ElevationSource source = make(folder, [](int x, int y) { return 1000.0 + ((x + y) % 2 == 0 ? 0.0 : 200.0); });
  for (const double spacing_m : {200.0, 400.0, 1600.0})
    EXPECT_NEAR(source.height_m(33.0, -71.0, spacing_m), 1100.0, 0.1);
}

TEST(ElevationSource, WaterStaysLevelAndSlopesGetDetail) {
  const TestFolder folder;
  const ElevationSource source =
      make(folder, [](int x, int) { return x < kSamples / 2 ? 372.0 : 372.0 + 60.0 * (x - kSamples / 2); });
  double detail = 0.0;
  for (int i = 0; i < 400; ++i) {
    EXPECT_NEAR(source.height_m(-3000.0 + 3.0 * i, 17.0 * i - 3400.0, 4.0), 372.0, 0.01);
    const double x = 500.0 + 5.0 * i;
    const double smooth = source.height_m(x, 100.0, kSpacing_m);
    detail = std::max(detail, std::abs(source.height_m(x, 100.0, 4.0) - smooth));
  }
  EXPECT_GT(detail, 1.0);
  EXPECT_LT(detail, 40.0);
}

TEST(ElevationSource, BlendsIntoProceduralTerrainWithoutACliff) {
  const TestFolder folder;
  // The file is 2 km higher than all procedural terrain, which must rise to meet it.
  const ElevationSource source = make(folder, [](int x, int y) { return 2000.0 + waves(x, y); });
  const ElevationSource alone = ElevationSource::create({}).value();
  double steepest = 0.0;
  double steepest_alone = 0.0;
  for (const double z : {-4000.0, 0.0, 5500.0}) {
    for (double x = 0.0; x < 40000.0; x += 100.0) {
      steepest =
          std::max<double>(steepest, std::abs(source.height_m(x + 100.0, z, 100.0) - source.height_m(x, z, 100.0)));
      steepest_alone =
          std::max<double>(steepest_alone, std::abs(alone.height_m(x + 100.0, z, 100.0) - alone.height_m(x, z, 100.0)));
    }
  }
  EXPECT_LT(steepest, steepest_alone + 60.0);
  // Far away the terrain is procedural.
  EXPECT_NEAR(source.height_m(1.5e6, 2e5, 500.0), alone.height_m(1.5e6, 2e5, 500.0), 30.0);
}

TEST(ElevationSource, BoundsHoldEverywhere) {
  const TestFolder folder;
  for (const double exaggeration : {1.0, 2.5}) {
    const ElevationSource source = make(folder, waves, exaggeration);
    for (int i = 0; i < 20000; ++i) {
      const double x = 20000.0 * std::sin(12.9898 * i);
      const double z = 20000.0 * std::sin(78.233 * i + 1.0);
      const double spacing_m = std::exp2(i % 12);
      const float h = source.height_m(x, z, spacing_m);
      ASSERT_GE(h, source.min_height_m());
      ASSERT_LE(h, source.max_height_m());
    }
  }
}

TEST(ElevationSource, AtlasHoldsEveryLevel) {
  const TestFolder folder;
  const ElevationSource source = make(folder, waves);
  const ElevationAtlas& atlas = source.atlas();
  EXPECT_EQ(atlas.width, 300);
  EXPECT_GE(atlas.height, 200);
  EXPECT_EQ(atlas.texels.size(), static_cast<std::size_t>(atlas.width) * atlas.height);
  EXPECT_EQ(source.constants().raster_levels, 9);  // 200 100 50 25 13 7 4 2 1
  EXPECT_NEAR(atlas.texels[200], 0.25 * (waves(0, 0) + waves(1, 0) + waves(0, 1) + waves(1, 1)), 0.001);
}

TEST(ElevationSource, InvalidPositionsAreHarmless) {
  const TestFolder folder;
  const ElevationSource source = make(folder, waves);
  for (const double x : {1e300, -1e300, std::nan(""), std::numeric_limits<double>::infinity(), 3e7}) {
    for (const double spacing_m : {0.0, -1.0, 1e-9, 1e7}) EXPECT_TRUE(std::isfinite(source.height_m(x, x, spacing_m)));
  }
}

TEST(ElevationSource, ErrorsAreForwarded) {
  ElevationDesc desc;
  desc.source = "no such file.tif";
  const Result<ElevationSource> missing = ElevationSource::create(desc);
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().message.find("no such file.tif does not exist"), std::string::npos);
  desc = {};
  desc.exaggeration = std::nan("");
  EXPECT_FALSE(ElevationSource::create(desc).ok());
}

TEST(ElevationSource, RealMassifJoinsTheRest) {
  if (!std::filesystem::exists(real_file())) GTEST_SKIP() << "no data";
  ElevationDesc desc;
  desc.source = real_file().string();
  const ElevationSource source = ElevationSource::create(desc).value();
  EXPECT_NEAR(source.height_m(0.0, 0.0, 92.0), 4760.0, 80.0);
  EXPECT_LT(std::abs(source.constants().outside_offset_m), 1500.0F);
}

}  // namespace
}  // namespace tyndall::scene
