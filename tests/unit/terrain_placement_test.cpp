// Elevation files that are placed by other means than a transform and a coordinate system of the Earth.
#include <cmath>
#include <fstream>

#include <ogr_spatialref.h>

#include "terrain_file_fixture.hpp"

namespace tyndall::scene {
namespace {

// Four control points at the corners, as the transform of TestFile has them, the last one displaced by this much.
void set_corners(GDALDataset& data, double displaced_m) {
  OGRSpatialReference srs;
  srs.importFromEPSG(32632);
  std::array<GDAL_GCP, 4> corners = {};
  GDALInitGCPs(4, corners.data());
  for (int i = 0; i < 4; ++i) {
    GDAL_GCP& corner = corners[static_cast<std::size_t>(i)];
    corner.dfGCPPixel = i % 2 * 64.0;
    corner.dfGCPLine = static_cast<double>(i / 2) * 64.0;
    corner.dfGCPX = 500000.0 + 100.0 * corner.dfGCPPixel + (i == 3 ? displaced_m : 0.0);
    corner.dfGCPY = 5000000.0 - 100.0 * corner.dfGCPLine;
  }
  EXPECT_EQ(data.SetGCPs(4, corners.data(), &srs), CE_None);
  GDALDeinitGCPs(4, corners.data());
}

TEST_F(ElevationFile, ControlPointsPlaceTheSamplesLikeATransform) {
  TestFile file;
  const ElevationRaster usual = read(folder_.write(file, hill));
  file.name = "points.tif";
  file.placed = false;
  file.epsg = 0;
  file.prepare = [](GDALDataset& data) { set_corners(data, 0.0); };
  const ElevationRaster points = read(folder_.write(file, hill));
  EXPECT_TRUE(points.notes.empty()) << points.notes.front();
  ASSERT_EQ(points.width, usual.width);
  ASSERT_EQ(points.height, usual.height);
  EXPECT_NEAR(points.spacing_m, usual.spacing_m, 1e-6);
  for (const int i : {5, 30, 60}) EXPECT_NEAR(at(points, i, i / 2), at(usual, i, i / 2), 0.01F) << i;
  ASSERT_TRUE(points.centre.has_value());
  EXPECT_NEAR(points.centre->latitude_deg, usual.centre->latitude_deg, 1e-9);
}

TEST_F(ElevationFile, ControlPointsThatNoTransformFitsAreRefused) {
  TestFile file;
  file.placed = false;
  file.epsg = 0;
  file.prepare = [](GDALDataset& data) { set_corners(data, 1500.0); };
  EXPECT_NE(error(folder_.write(file, hill))
                .find("is placed by 4 ground control points that no affine transform fits; expected a raster that "
                      "gdalwarp has resampled"),
            std::string::npos);
}

TEST_F(ElevationFile, ArraysOfCoordinatesAreRefused) {
  TestFile file;
  file.name = "swath.vrt";
  file.driver = "VRT";
  file.placed = false;
  file.epsg = 0;
  const std::string samples = folder_.write({.name = "samples.tif", .placed = false, .epsg = 0}, hill).string();
  GDALDataset* const source = GDALDataset::FromHandle(GDALOpen(samples.c_str(), GA_ReadOnly));
  ASSERT_NE(source, nullptr);
  const std::filesystem::path path = folder_.path("swath.vrt");
  GDALDataset* const swath = GetGDALDriverManager()->GetDriverByName("VRT")->CreateCopy(path.c_str(), source, FALSE,
                                                                                        nullptr, nullptr, nullptr);
  ASSERT_NE(swath, nullptr);
  swath->SetMetadataItem("X_DATASET", samples.c_str(), "GEOLOCATION");
  swath->SetMetadataItem("Y_DATASET", samples.c_str(), "GEOLOCATION");
  GDALClose(swath);
  GDALClose(source);
  EXPECT_NE(error(path).find("is placed by arrays of coordinates; expected a raster that gdalwarp has resampled"),
            std::string::npos);
}

// Local coordinates in feet, as in a survey of a construction site.
TEST_F(ElevationFile, LocalCoordinatesAreConvertedToMetres) {
  TestFile file;
  file.epsg = 0;
  file.definition = R"(LOCAL_CS["site",UNIT["US survey foot",0.304800609601219]])";
  const ElevationRaster feet = read(folder_.write(file, hill));
  EXPECT_NEAR(feet.spacing_m, 100.0 * 1200.0 / 3937.0, 1e-3);
  EXPECT_TRUE(noted(feet, "local coordinates in the unit 'US survey foot' are converted to metres"));
  // The transform of a file without a coordinate system has no unit.
  file.definition = R"(LOCAL_CS["site",UNIT["metre",1]])";
  file.name = "metres.tif";
  EXPECT_NEAR(read(folder_.write(file, hill)).spacing_m, 100.0, 1e-3);
  file.definition.clear();
  file.name = "none.tif";
  EXPECT_NEAR(read(folder_.write(file, hill)).spacing_m, 100.0, 1e-3);
}

// The vertical axis of "MSL depth" points down.
TEST_F(ElevationFile, DepthsAreNegativeHeights) {
  TestFile file;
  file.epsg = 0;
  file.definition = "EPSG:32632+5715";
  const ElevationRaster depths = read(folder_.write(file, hill));
  EXPECT_TRUE(noted(depths, "depths are converted to heights"));
  EXPECT_LT(depths.max_m, -999.0F);
  EXPECT_GT(depths.min_m, -1800.0F);
}

TEST_F(ElevationFile, ScalesWithoutAMeaningAreRefused) {
  TestFile file;
  file.scale = 0.0;
  EXPECT_NE(error(folder_.write(file, hill)).find("has the scale 0.000000"), std::string::npos);
  file.name = "nan.tif";
  file.scale = std::nan("");
  EXPECT_NE(error(folder_.write(file, hill)).find("expected finite numbers, and a scale other than 0"),
            std::string::npos);
}

// Transparent samples of Terrain-RGB tiles are holes, and not 10 km deep.
TEST_F(ElevationFile, TransparentColoursAreHoles) {
  for (const bool terrarium : {false, true}) {
    TestFile file;
    file.name = terrarium ? "terrarium.png" : "terrain_rgb.png";
    file.driver = "PNG";
    file.bands = 4;
    file.type = GDT_Byte;
    file.placed = false;
    file.epsg = 0;
    file.prepare = [terrarium](GDALDataset& data) {
      constexpr std::array<GDALColorInterp, 4> kColours = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand};
      const std::array<std::uint8_t, 3> at_500_m =
          terrarium ? std::array<std::uint8_t, 3>{129, 244, 0} : std::array<std::uint8_t, 3>{1, 154, 40};
      for (int b = 0; b < 4; ++b) {
        std::vector<std::uint8_t> samples(std::size_t{64} * 64);
        for (std::size_t i = 0; i < samples.size(); ++i) {
          const bool hole = i % 64 < 20;
          samples[i] = hole ? 0 : b == 3 ? 255 : at_500_m[static_cast<std::size_t>(b)];
        }
        GDALRasterBand& band = *data.GetRasterBand(b + 1);
        band.SetColorInterpretation(kColours[static_cast<std::size_t>(b)]);
        EXPECT_EQ(band.RasterIO(GF_Write, 0, 0, 64, 64, samples.data(), 64, 64, GDT_Byte, 0, 0, nullptr), CE_None);
      }
    };
    const ElevationRaster tile = read(folder_.write(file, [](int, int) { return 0.0; }));
    EXPECT_NEAR(tile.min_m, 500.0F, 0.1F) << file.name;
    EXPECT_NEAR(tile.max_m, 500.0F, 0.1F) << file.name;
    EXPECT_TRUE(noted(tile, "filled 1280 samples without data"));
  }
}

// In a file that is read at less than its resolution, impossible heights are not averaged with others.
TEST_F(ElevationFile, ImpossibleHeightsAreHolesAtAnyResolution) {
  TestFile file;
  file.width = file.height = 256;
  for (const double value : {-30000.0, 65535.0, 3.4028234663852886e38}) {
    const auto height = [value](int x, int y) { return (x + y) % 3 == 0 ? value : 1000.0; };
    const ElevationRaster reduced = read(folder_.write(file, height), 100);
    EXPECT_NEAR(reduced.min_m, 1000.0F, 0.1F) << value;
    EXPECT_NEAR(reduced.max_m, 1000.0F, 0.1F) << value;
  }
}

// Samples are searched for undeclared holes in blocks. A row of this file is longer than a block.
TEST_F(ElevationFile, HolesAreFoundInLongRows) {
  TestFile file;
  file.width = 1500000;
  file.height = 3;
  file.transform = {500000.0, 0.01, 0.0, 5000000.0, 0.0, -100.0};
  file.type = GDT_Int16;
  const auto height = [](int x, int) { return x >= 1420000 && x < 1450000 ? -9999.0 : 1000.0; };
  const ElevationRaster reduced = read(folder_.write(file, height), 100);
  EXPECT_NEAR(reduced.min_m, 1000.0F, 0.1F);
  EXPECT_NEAR(reduced.max_m, 1000.0F, 0.1F);
  EXPECT_TRUE(noted(reduced, "90000 samples of -9999 are far from all others and treated as holes"));
}

// A small file can declare more samples than could be read in a day.
TEST_F(ElevationFile, FilesWithTooManySamplesAreRefused) {
  for (const char* const size :
       {"rasterXSize=\"2000000000\" rasterYSize=\"2000000000\"", "rasterXSize=\"100001\" rasterYSize=\"100000\""}) {
    const std::filesystem::path path = folder_.path("huge.vrt");
    std::ofstream(path) << "<VRTDataset " << size << "><SRS>EPSG:32632</SRS><GeoTransform>500000,0.01,0,5000000,0,-0.01"
                        << "</GeoTransform><VRTRasterBand dataType=\"Float32\" band=\"1\"/></VRTDataset>";
    EXPECT_NE(error(path).find("samples; expected at most 10000 million"), std::string::npos);
  }
}

}  // namespace
}  // namespace tyndall::scene
