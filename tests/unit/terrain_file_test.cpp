// Elevation files: formats, projections, units, holes and sizes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "terrain_file_fixture.hpp"

namespace tyndall::scene {
namespace {

TEST_F(ElevationFile, UtmBecomesTheMap) {
  // On the central meridian, UTM is aligned with the map and 0.9996 times as large; the sphere is 0.3 % smaller than
  // the ellipsoid.
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
  // 1 arc second at 60 degrees north: cells are half as wide as high.
  TestFile file;
  file.epsg = 4326;
  const double second = 1.0 / 3600.0;
  file.transform = {10.0, second, 0.0, 60.0, 0.0, -second};
  file.width = 200;
  file.height = 100;
  const ElevationRaster r = read(folder_.write(file, hill));
  const double degree_m = kRadius_m * M_PI / 180.0;
  EXPECT_NEAR(r.width * r.spacing_m, 200.0 * second * degree_m * std::cos(59.986 * M_PI / 180.0), 2.5 * r.spacing_m);
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
  EXPECT_TRUE(noted(metres, "metres are assumed"));

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
  EXPECT_NEAR(at(read(folder_.write(file, [](int, int) { return 20000.0; })), 10, 10), 20000.0 * 1200.0 / 3937.0, 1e-3);
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

TEST_F(ElevationFile, ProjectionFilesHaveVerticalUnits) {
  TestFile file;
  file.driver = "AAIGrid";
  file.name = "feet.asc";
  file.epsg = 0;
  folder_.write(file, hill);
  const auto highest = [&](const char* unit) {
    std::ofstream(folder_.path("feet.prj")) << "Projection UTM\nZone 32\nDatum WGS84\nZunits " << unit
                                            << "\nUnits METERS\nSpheroid WGS84\nXshift 0.0\nYshift 0.0\nParameters\n";
    return read(folder_.path("feet.asc"));
  };
  EXPECT_NEAR(highest("METERS").max_m, hill(63, 63), 12.0);
  EXPECT_NEAR(highest("NO").max_m, hill(63, 63), 12.0);
  EXPECT_NEAR(highest("FEET").max_m, 0.3048 * hill(63, 63), 4.0);
  EXPECT_NEAR(highest("DECIMETERS").max_m, 0.1 * hill(63, 63), 2.0);
  EXPECT_NEAR(highest("100").max_m, 0.01 * hill(63, 63), 1.0);
  EXPECT_TRUE(noted(highest("CUBITS"), "'cubits'"));
  EXPECT_TRUE(noted(highest("INF"), "'inf'"));
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
  const ElevationRaster r = read(folder_.write(file, [](int x, int) { return x % 2 == 0 ? 0.0 : 1000.0; }), 100);
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
  // The corners are 240 m further from the equator than the middle of the edge, because parallels are curved.
  EXPECT_NEAR(r.height * r.spacing_m, 1201.0 * third * 111002.0 + 240.0, 2.0 * r.spacing_m);
}

// Old tools wrote -9999 into Esri grids where data are missing, without declaring it.
TEST_F(ElevationFile, UndeclaredHolesAreFound) {
  for (const double hole : {-9999.0, -32767.0, -999.0}) {
    TestFile file;
    file.name = "undeclared.tif";
    const auto hilly = [&](int x, int y) { return x > 20 && x < 30 && y > 20 && y < 30 ? hole : hill(x, y); };
    const ElevationRaster r = read(folder_.write(file, hilly));
    EXPECT_GT(r.min_m, 900.0F) << hole;
    EXPECT_TRUE(noted(r, "far from all others and treated as holes")) << hole;
    // The holes are also found at a lower resolution, where averages would mix them with heights.
    EXPECT_GT(read(folder_.path("undeclared.tif"), 16).min_m, 900.0F) << hole;
  }
  // A trench with real depths down to -9999 is read as one.
  TestFile trench;
  trench.name = "trench.tif";
  const ElevationRaster r = read(folder_.write(trench, [](int x, int) { return -8000.0 - 199.9 * std::min(x, 10); }));
  EXPECT_NEAR(r.min_m, -9999.0, 1.0);
  EXPECT_FALSE(noted(r, "holes"));
}

TEST_F(ElevationFile, UnitsOfCoordinatesCanBeStated) {
  TestFile file;
  file.driver = "AAIGrid";
  file.name = "survey.asc";
  file.epsg = 0;
  file.transform = {12.0, 0.5, 0.0, 48.0, 0.0, -0.5};
  const std::string path = folder_.write(file, hill).string();
  const Result<ElevationRaster> metres = read_elevation_file(path, {kRadius_m, 4096, TerrainUnits::metres});
  ASSERT_TRUE(metres.ok()) << metres.error().message;
  EXPECT_DOUBLE_EQ(metres.value().spacing_m, 0.5);
  EXPECT_TRUE(metres.value().notes.empty());
  const Result<ElevationRaster> degrees = read_elevation_file(path, {kRadius_m, 4096, TerrainUnits::degrees});
  ASSERT_TRUE(degrees.ok()) << degrees.error().message;
  EXPECT_GT(degrees.value().spacing_m, 20000.0);
  EXPECT_TRUE(noted(read(path), "terrain.units=metres selects metres"));
  // A survey that begins at 0,0 is recognised as local.
  file.transform = {0.0, 0.5, 0.0, 32.0, 0.0, -0.5};
  EXPECT_DOUBLE_EQ(read(folder_.write(file, hill)).spacing_m, 0.5);
}

// Latitudes and longitudes do not change when a file of the Earth is used on Mars, or one of Mars on the Earth.
TEST_F(ElevationFile, AnglesOfOtherBodiesArePreserved) {
  constexpr double kMars_m = 3389500.0;
  TestFile earth;
  earth.name = "earth.tif";
  earth.epsg = 4326;
  earth.transform = {7.0, 0.01, 0.0, 0.32, 0.0, -0.01};
  const std::string path = folder_.write(earth, hill).string();
  const Result<ElevationRaster> on_mars = read_elevation_file(path, {kMars_m});
  ASSERT_TRUE(on_mars.ok()) << on_mars.error().message;
  EXPECT_NEAR(on_mars.value().height * on_mars.value().spacing_m, 0.64 * kMars_m * std::acos(-1.0) / 180.0,
              2.0 * on_mars.value().spacing_m);
  EXPECT_TRUE(noted(on_mars.value(), "made for a body of radius 6378 km"));
  ASSERT_TRUE(on_mars.value().centre);
  EXPECT_NEAR(on_mars.value().centre->latitude_deg, 0.0, 1e-9);
  EXPECT_NEAR(on_mars.value().centre->longitude_deg, 7.32, 1e-9);

  TestFile mars;
  mars.driver = "AAIGrid";
  mars.name = "mars.asc";
  mars.epsg = 0;
  mars.transform = {-32000.0, 1000.0, 0.0, 32000.0, 0.0, -1000.0};
  folder_.write(mars, hill);
  std::ofstream(folder_.path("mars.prj")) << "PROJCS[\"Mars\",GEOGCS[\"Mars 2000\",DATUM[\"Mars 2000\",SPHEROID[\"Mars "
                                             "2000\",3396190.0,169.8944]],PRIMEM[\"Meridian\",0.0],"
                                             "UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Equidistant_"
                                             "Cylindrical\"],PARAMETER[\"False_Easting\",0.0],"
                                             "PARAMETER[\"False_Northing\",0.0],PARAMETER[\"Central_Meridian\",0.0],"
                                             "PARAMETER[\"Standard_Parallel_1\",0.0],UNIT[\"Meter\",1.0]]";
  const Result<ElevationRaster> on_earth = read_elevation_file(folder_.path("mars.asc").string(), {kRadius_m});
  ASSERT_TRUE(on_earth.ok()) << on_earth.error().message;
  EXPECT_NEAR(on_earth.value().spacing_m, 1000.0 * kRadius_m / 3396190.0, 10.0);
  EXPECT_FALSE(on_earth.value().centre) << "no place on the Earth";
  const Result<ElevationRaster> at_home = read_elevation_file(folder_.path("mars.asc").string(), {kMars_m});
  ASSERT_TRUE(at_home.ok()) << at_home.error().message;
  EXPECT_NEAR(at_home.value().spacing_m, 1000.0, 10.0);
}

TEST_F(ElevationFile, ImpossibleCoordinatesAreRefused) {
  TestFile file;
  file.name = "far.tif";
  file.epsg = 4326;
  file.transform = {7.0, 0.1, 0.0, 93.0, 0.0, -0.1};
  EXPECT_NE(error(folder_.write(file, hill)).find("expected -90 to 90 degrees"), std::string::npos);
  file.transform = {-180.0, 10.0, 0.0, 50.0, 0.0, -0.1};
  EXPECT_NE(error(folder_.write(file, hill)).find("expected at most 360 degrees"), std::string::npos);
  file.epsg = 32632;
  file.transform = {500000.0, 1e41, 0.0, 5000000.0, 0.0, -1e41};
  EXPECT_NE(error(folder_.write(file, hill)).find("expected at most 1e+08 m"), std::string::npos);
  file.epsg = 0;
  file.transform = {500000.0, 1e-9, 0.0, 5000000.0, 0.0, -1e-9};
  EXPECT_NE(error(folder_.write(file, hill)).find("at least 0.001 m"), std::string::npos);
  // Files with cell centres on the pole extend half a sample beyond it.
  file.epsg = 4326;
  file.transform = {7.0, 0.1, 0.0, 90.05, 0.0, -0.1};
  read(folder_.write(file, hill));
}

TEST_F(ElevationFile, ColourTilesAreDecoded) {
  // Writes an 8-bit PNG band by band: red, green and blue.
  const auto tile = [&](const char* name, const std::function<unsigned(int, int)>& colour) {
    GDALDriverManager& drivers = *GetGDALDriverManager();
    GDALDataset* data = drivers.GetDriverByName("MEM")->Create("", 64, 64, 3, GDT_Byte, nullptr);
    for (int b = 0; b < 3; ++b) {
      std::vector<unsigned char> samples;
      for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) samples.push_back(static_cast<unsigned char>(colour(x, y) >> (16 - 8 * b)));
      }
      EXPECT_EQ(
          data->GetRasterBand(b + 1)->RasterIO(GF_Write, 0, 0, 64, 64, samples.data(), 64, 64, GDT_Byte, 0, 0, nullptr),
          CE_None);
      data->GetRasterBand(b + 1)->SetColorInterpretation(static_cast<GDALColorInterp>(GCI_RedBand + b));
    }
    const std::string to = folder_.path(name).string();
    GDALClose(drivers.GetDriverByName("PNG")->CreateCopy(to.c_str(), data, FALSE, nullptr, nullptr, nullptr));
    GDALClose(data);
    return std::filesystem::path(to);
  };
  const auto height = [](int x, int y) { return -30.0 + 40.25 * x + 3.5 * y; };
  const ElevationRaster terrarium = read(tile("terrarium.png", [&](int x, int y) {
    return static_cast<unsigned>(std::lround((height(x, y) + 32768.0) * 256.0));
  }));
  EXPECT_NEAR(at(terrarium, 5, 60), height(5, 60), 0.01);
  EXPECT_TRUE(noted(terrarium, "Terrarium"));
  const ElevationRaster terrain_rgb = read(tile(
      "rgb.png", [&](int x, int y) { return static_cast<unsigned>(std::lround((height(x, y) + 10000.0) * 10.0)); }));
  EXPECT_NEAR(at(terrain_rgb, 5, 60), height(5, 60), 0.06);
  EXPECT_TRUE(noted(terrain_rgb, "Terrain-RGB"));
  EXPECT_NE(error(tile("photo.png", [](int x, int y) { return static_cast<unsigned>(x * 4 * 65536 + y * 1024 + 77); }))
                .find("without heights"),
            std::string::npos);
}

// French maps count longitudes from Paris, and some in grads.
TEST_F(ElevationFile, LongitudesFromParisAndGradsAreConverted) {
  constexpr double kParis_deg = 2.33722917;
  TestFile file;
  file.name = "lambert.tif";
  file.epsg = 27572;  // its origin is at 52 grads north
  file.transform = {596800.0, 100.0, 0.0, 2203200.0, 0.0, -100.0};
  const ElevationRaster lambert = read(folder_.write(file, hill));
  ASSERT_TRUE(lambert.centre);
  EXPECT_NEAR(lambert.centre->latitude_deg, 46.8, 1e-6);
  EXPECT_NEAR(lambert.centre->longitude_deg, kParis_deg, 1e-6);
  EXPECT_NEAR(lambert.spacing_m, 100.0, 1.0);
  EXPECT_NEAR(at(lambert, lambert.width / 2, lambert.height / 2), hill(32, 32), 12.0);

  file.name = "grads.tif";
  file.epsg = 4807;
  file.transform = {4.0, 0.001, 0.0, 52.0, 0.0, -0.001};
  const ElevationRaster grads = read(folder_.write(file, hill));
  ASSERT_TRUE(grads.centre);
  EXPECT_NEAR(grads.centre->latitude_deg, 0.9 * 51.968, 1e-6);
  EXPECT_NEAR(grads.centre->longitude_deg, 0.9 * 4.032 + kParis_deg, 1e-6);
  EXPECT_NEAR(grads.height * grads.spacing_m, 0.9 * 0.064 * kRadius_m * M_PI / 180.0, 2.0 * grads.spacing_m);
}

// Weather models use longitudes and latitudes around another pole. The equator of this one passes through 50.75 degrees
// north at 18 degrees east.
TEST_F(ElevationFile, RotatedGridsArePlaced) {
  TestFile file;
  file.definition = "+proj=ob_tran +o_proj=longlat +o_lon_p=0 +o_lat_p=39.25 +lon_0=18 +datum=WGS84 +no_defs";
  file.transform = {-0.32, 0.01, 0.0, 0.32, 0.0, -0.01};
  const ElevationRaster r = read(folder_.write(file, hill));
  ASSERT_TRUE(r.centre);
  EXPECT_NEAR(r.centre->latitude_deg, 50.75, 1e-6);
  EXPECT_NEAR(r.centre->longitude_deg, 18.0, 1e-6);
  EXPECT_NEAR(at(r, r.width / 2, r.height / 2), hill(32, 32), 12.0);
  EXPECT_GT(at(r, r.width - 14, r.height / 2), at(r, 14, r.height / 2) + 250.0F);
}

TEST_F(ElevationFile, SignedBytes) {
  TestFile file;
  file.epsg = 0;
  file.type = GDT_Byte;
  file.prepare = [](GDALDataset& data) {
    data.GetRasterBand(1)->SetMetadataItem("PIXELTYPE", "SIGNEDBYTE", "IMAGE_STRUCTURE");
  };
  const ElevationRaster r = read(folder_.write(file, [](int x, int) { return x < 32 ? 254.0 : 7.0; }));
  EXPECT_FLOAT_EQ(r.min_m, -2.0F);
  EXPECT_FLOAT_EQ(r.max_m, 7.0F);
}

// Masks and opacities mark holes.
TEST_F(ElevationFile, MaskedSamplesAreHoles) {
  const auto masked = [](int x, int y) { return x > 20 && x < 40 && y > 20 && y < 40; };
  const auto heights = [&](int x, int y) { return masked(x, y) ? -5000.0 : hill(x, y); };
  std::vector<float> shown;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) shown.push_back(masked(x, y) ? 0.0F : 255.0F);
  }
  const auto store = [&](GDALRasterBand& band) {
    EXPECT_EQ(band.RasterIO(GF_Write, 0, 0, 64, 64, shown.data(), 64, 64, GDT_Float32, 0, 0, nullptr), CE_None);
  };
  TestFile file;
  file.epsg = 0;
  file.name = "mask.tif";
  file.prepare = [&](GDALDataset& data) {
    ASSERT_EQ(data.CreateMaskBand(GMF_PER_DATASET), CE_None);
    store(*data.GetRasterBand(1)->GetMaskBand());
  };
  std::vector<std::filesystem::path> paths = {folder_.write(file, heights)};
  file.name = "alpha.tif";
  file.bands = 2;
  file.prepare = [&](GDALDataset& data) {
    data.GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand);
    store(*data.GetRasterBand(2));
  };
  paths.push_back(folder_.write(file, heights));
  for (const std::filesystem::path& path : paths) {
    const ElevationRaster r = read(path);
    EXPECT_NEAR(at(r, 30, 30), hill(30, 30), 60.0) << path;
    EXPECT_FLOAT_EQ(at(r, 60, 60), static_cast<float>(hill(60, 60))) << path;
    EXPECT_TRUE(noted(r, "filled 361 samples")) << path;
  }
}

TEST_F(ElevationFile, DamagedMasksAreRefused) {
  TestFile file;
  file.epsg = 0;
  file.name = "cut.tif";
  file.prepare = [](GDALDataset& data) {
    ASSERT_EQ(data.CreateMaskBand(GMF_PER_DATASET), CE_None);
    ASSERT_EQ(data.GetRasterBand(1)->GetMaskBand()->Fill(255.0), CE_None);
  };
  const std::filesystem::path path = folder_.write(file, hill);
  const std::filesystem::path mask = path.string() + ".msk";
  ASSERT_TRUE(std::filesystem::exists(mask));
  read(path);
  // The compressed samples are at the end of the file.
  std::fstream bytes(mask, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(-16, std::ios::end);
  for (int i = 0; i < 16; ++i) bytes.put('\xFF');
  bytes.close();
  EXPECT_NE(error(path).find("mask that cannot be read"), std::string::npos);
}

TEST_F(ElevationFile, PalettesAreRefused) {
  TestFile file;
  file.driver = "PNG";
  file.name = "palette.png";
  file.type = GDT_Byte;
  file.prepare = [](GDALDataset& data) {
    GDALColorTable palette;
    for (short i = 0; i < 256; ++i) {
      const GDALColorEntry entry = {i, static_cast<short>(255 - i), 0, 255};
      palette.SetColorEntry(i, &entry);
    }
    data.GetRasterBand(1)->SetColorInterpretation(GCI_PaletteIndex);
    data.GetRasterBand(1)->SetColorTable(&palette);
  };
  EXPECT_NE(error(folder_.write(file, [](int x, int) { return x; })).find("palette"), std::string::npos);
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
