// Elevation files: formats, projections, units, holes, sizes, and everything that can be wrong with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "scene/elevation/elevation_file.hpp"
#include "terrain_files.hpp"

namespace tyndall::scene {
namespace {

constexpr double kRadius_m = 6360000.0;

double hill(int x, int y) { return 1000.0 + 8.0 * x + 3.0 * y; }

class ElevationFile : public ::testing::Test {
 protected:
  ElevationRaster read(const std::filesystem::path& path, int max_samples = kMaxElevationSamples) {
    testing::internal::CaptureStderr();
    Result<ElevationRaster> result = read_elevation_file(path, kRadius_m, max_samples);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return result.ok() ? std::move(result).value() : ElevationRaster{};
  }
  std::string error(const std::filesystem::path& path) {
    testing::internal::CaptureStderr();
    Result<ElevationRaster> result = read_elevation_file(path, kRadius_m);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_FALSE(result.ok()) << path;
    if (result.ok()) return {};
    const std::string message = result.error().message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find(path.filename().string()), std::string::npos) << message;
    return message;
  }
  static float at(const ElevationRaster& r, int x, int y) {
    return r.heights[static_cast<std::size_t>(y) * r.width + x];
  }
  static bool noted(const ElevationRaster& r, const std::string& text) {
    return std::any_of(r.notes.begin(), r.notes.end(),
                       [&](const std::string& note) { return note.find(text) != std::string::npos; });
  }

  TestFolder folder_;
};

TEST_F(ElevationFile, UtmBecomesTheMap) {
  // On the central meridian UTM is aligned with the map and 0.9996 times as large; the sphere is 0.3 %
  // smaller than the ellipsoid.
  const ElevationRaster r = read(folder_.write({}, hill));
  EXPECT_NEAR(r.width, 64, 2);
  EXPECT_NEAR(r.height, 64, 2);
  EXPECT_NEAR(r.spacing_m, 100.0, 1.0);
  EXPECT_NEAR(at(r, r.width / 2, r.height / 2), hill(32, 32), 12.0);
  EXPECT_GT(at(r, 50, 30), at(r, 10, 30) + 250.0F) << "east is to the right";
  EXPECT_GT(at(r, 30, 50), at(r, 30, 10) + 90.0F) << "north is the first row";
  EXPECT_NEAR(r.min_m, hill(0, 0), 12.0);
  EXPECT_NEAR(r.max_m, hill(63, 63), 12.0);
  EXPECT_TRUE(r.notes.empty());
}

TEST_F(ElevationFile, DegreesAreStretchedByLatitude) {
  // 1 arc second at 60° north: cells half as wide as high.
  TestFile file;
  file.epsg = 4326;
  const double second = 1.0 / 3600.0;
  file.transform = {10.0, second, 0.0, 60.0, 0.0, -second};
  file.width = 200;
  file.height = 100;
  const ElevationRaster r = read(folder_.write(file, hill));
  const double degree_m = kRadius_m * M_PI / 180.0;
  EXPECT_NEAR(r.width * r.spacing_m, 200.0 * second * degree_m * std::cos(59.986 * M_PI / 180.0),
              2.5 * r.spacing_m);
  EXPECT_NEAR(r.height * r.spacing_m, 100.0 * second * degree_m, 2.5 * r.spacing_m);
}

TEST_F(ElevationFile, SouthUpFilesAreTurned) {
  TestFile file;
  file.transform = {500000.0, 100.0, 0.0, 5000000.0, 0.0, 100.0};
  const ElevationRaster r = read(folder_.write(file, hill));
  EXPECT_LT(at(r, 30, 50), at(r, 30, 10) - 90.0F) << "row 0 of the file is its south";
}

TEST_F(ElevationFile, AsciiGridWithoutCoordinateSystem) {
  TestFile file;
  file.driver = "AAIGrid";
  file.name = "grid.asc";
  file.epsg = 0;
  file.type = GDT_Float32;
  const ElevationRaster metres = read(folder_.write(file, hill));
  EXPECT_EQ(metres.width, 64);
  EXPECT_DOUBLE_EQ(metres.spacing_m, 100.0);
  EXPECT_FLOAT_EQ(at(metres, 5, 7), static_cast<float>(hill(5, 7)));
  EXPECT_TRUE(noted(metres, "taken as metres"));

  file.name = "degrees.asc";
  file.transform = {7.0, 0.001, 0.0, 46.0, 0.0, -0.001};
  const ElevationRaster degrees = read(folder_.write(file, hill));
  EXPECT_NEAR(degrees.height * degrees.spacing_m, 64 * 0.001 * 111002.0, 2.0 * degrees.spacing_m);
  EXPECT_TRUE(noted(degrees, "degrees"));
}

TEST_F(ElevationFile, PngWithoutGeoreferencing) {
  TestFile file;
  file.driver = "PNG";
  file.name = "plain.png";
  file.type = GDT_UInt16;
  file.placed = false;
  file.epsg = 0;
  const ElevationRaster r = read(folder_.write(file, hill));
  EXPECT_EQ(r.width, 64);
  EXPECT_EQ(r.height, 64);
  EXPECT_DOUBLE_EQ(r.spacing_m, 30.0);
  EXPECT_FLOAT_EQ(at(r, 3, 60), static_cast<float>(hill(3, 60)));
  EXPECT_TRUE(noted(r, "30 m apart"));
}

TEST_F(ElevationFile, VerticalUnitsScaleAndOffset) {
  TestFile file;
  file.epsg = 0;
  file.unit = "ft";
  EXPECT_NEAR(at(read(folder_.write(file, hill)), 10, 10), 0.3048 * hill(10, 10), 1e-3);
  file.unit = "US survey foot";
  EXPECT_NEAR(at(read(folder_.write(file, [](int, int) { return 20000.0; })), 10, 10),
              20000.0 * 1200.0 / 3937.0, 1e-3);
  file.unit = "";
  file.scale = 0.1;
  file.offset = -500.0;
  EXPECT_NEAR(at(read(folder_.write(file, hill)), 10, 10), 0.1 * hill(10, 10) - 500.0, 1e-3);
  file.scale = 1.0;
  file.offset = 0.0;
  file.unit = "fathom";
  const ElevationRaster unknown = read(folder_.write(file, hill));
  EXPECT_NEAR(at(unknown, 10, 10), hill(10, 10), 1e-3);
  EXPECT_TRUE(noted(unknown, "fathom"));
}

TEST_F(ElevationFile, HolesAreFilledFromTheirBorders) {
  TestFile file;
  file.epsg = 0;
  file.width = file.height = 300;
  file.has_no_data = true;
  file.no_data = -32768.0;
  const auto holed = [](int x, int y) {
    if (x > 20 && x < 40 && y > 20 && y < 40) return -32768.0;
    if (x == 100 && y == 100) return std::numeric_limits<double>::quiet_NaN();
    if (x == 120 && y == 100) return 1e38;
    if (x == 140 && y == 100) return -std::numeric_limits<double>::infinity();
    if (x > 150 && y > 2 && y < 290) return -32768.0;  // far wider than GDAL's reach
    return hill(x, y);
  };
  const ElevationRaster r = read(folder_.write(file, holed));
  EXPECT_NEAR(at(r, 30, 30), hill(30, 30), 60.0);
  for (const int x : {100, 120, 140}) EXPECT_NEAR(at(r, x, 100), hill(x, 100), 10.0) << x;
  EXPECT_FLOAT_EQ(at(r, 60, 60), static_cast<float>(hill(60, 60)));
  for (const float h : r.heights) {
    ASSERT_TRUE(std::isfinite(h));
    ASSERT_GT(h, 990.0F);
    ASSERT_LT(h, 4300.0F);
  }
  EXPECT_TRUE(noted(r, "without data"));
}

TEST_F(ElevationFile, LargeFilesAreReadCoarser) {
  TestFile file;
  file.epsg = 0;
  file.width = 400;
  file.height = 100;
  const ElevationRaster r =
      read(folder_.write(file, [](int x, int) { return x % 2 == 0 ? 0.0 : 1000.0; }), 100);
  EXPECT_EQ(r.width, 100);
  EXPECT_EQ(r.height, 25);
  EXPECT_DOUBLE_EQ(r.spacing_m, 400.0);
  EXPECT_NEAR(at(r, 50, 12), 500.0, 1.0) << "averaged, not picked";
  EXPECT_TRUE(noted(r, "400 x 100"));
}

TEST_F(ElevationFile, SeveralBandsUseTheFirst) {
  TestFile file;
  file.bands = 3;
  EXPECT_TRUE(noted(read(folder_.write(file, hill)), "3 bands"));
}

TEST_F(ElevationFile, SrtmTile) {
  TestFile file;
  file.driver = "SRTMHGT";
  file.name = "N45E006.hgt";
  file.type = GDT_Int16;
  file.epsg = 4326;
  file.width = file.height = 1201;
  const double third = 1.0 / 1200.0;
  file.transform = {6.0 - third / 2.0, third, 0.0, 46.0 + third / 2.0, 0.0, -third};
  const ElevationRaster r = read(folder_.write(file, [](int x, int y) { return x + y; }));
  // The corners lie 240 m further from the equator than the middle of the edge: parallels are curved.
  EXPECT_NEAR(r.height * r.spacing_m, 1201.0 * third * 111002.0 + 240.0, 2.0 * r.spacing_m);
}

TEST_F(ElevationFile, ErrorsAreOneLine) {
  EXPECT_NE(error(folder_.path("missing.tif")).find("does not exist"), std::string::npos);
  std::filesystem::create_directory(folder_.path("folder.tif"));
  EXPECT_NE(error(folder_.path("folder.tif")).find("directory"), std::string::npos);
  std::ofstream(folder_.path("empty.tif")).close();
  EXPECT_NE(error(folder_.path("empty.tif")).find("empty"), std::string::npos);
  std::ofstream(folder_.path("text.tif")) << "no elevations here\n";
  EXPECT_NE(error(folder_.path("text.tif")).find("no format"), std::string::npos);

  TestFile narrow;
  narrow.name = "narrow.tif";
  narrow.width = 1;
  EXPECT_NE(error(folder_.write(narrow, hill)).find("1 x 64 samples"), std::string::npos);
  TestFile complex;
  complex.name = "complex.tif";
  complex.type = GDT_CFloat32;
  EXPECT_NE(error(folder_.write(complex, hill)).find("complex"), std::string::npos);
  TestFile holes;
  holes.name = "holes.tif";
  EXPECT_NE(error(folder_.write(holes, [](int, int) { return 1e30; })).find("every sample is a hole"),
            std::string::npos);
}

TEST_F(ElevationFile, TruncatedFiles) {
  TestFile file;
  file.name = "whole.tif";
  file.width = file.height = 256;
  const std::filesystem::path whole = folder_.write(file, hill);
  const auto size = std::filesystem::file_size(whole);
  for (const double part : {0.02, 0.3, 0.6, 0.95}) {
    const std::filesystem::path cut = folder_.path("cut.tif");
    std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, static_cast<std::uintmax_t>(static_cast<double>(size) * part));
    error(cut);
  }
}

TEST_F(ElevationFile, RealMassif) {
  if (!std::filesystem::exists(real_file())) GTEST_SKIP() << "no data";
  const ElevationRaster r = read(real_file());
  EXPECT_NEAR(r.spacing_m, 92.7, 0.6);
  EXPECT_NEAR(r.width, 660, 15);
  EXPECT_NEAR(at(r, r.width / 2, r.height / 2), 4790.0, 80.0) << "the summit is at the centre";
  EXPECT_GT(r.min_m, 440.0F);
  EXPECT_LT(r.max_m, 4811.0F);
}

}  // namespace
}  // namespace tyndall::scene
