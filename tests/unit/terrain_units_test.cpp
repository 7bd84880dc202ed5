// Units of elevation files that their coordinate systems state, and longitudes beyond a turn.
#include "terrain_file_fixture.hpp"

namespace tyndall::scene {
namespace {

// Returns UTM zone 32 with a vertical axis.
std::string utm_with_heights(const char* axis, const char* unit) {
  return std::string(R"(PROJCRS["x",BASEGEOGCRS["WGS 84",DATUM["World Geodetic System 1984",)"
                     R"(ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]]]],)"
                     R"(CONVERSION["UTM zone 32N",METHOD["Transverse Mercator",ID["EPSG",9807]],)"
                     R"(PARAMETER["Latitude of natural origin",0,ANGLEUNIT["degree",0.0174532925199433]],)"
                     R"(PARAMETER["Longitude of natural origin",9,ANGLEUNIT["degree",0.0174532925199433]],)"
                     R"(PARAMETER["Scale factor at natural origin",0.9996,SCALEUNIT["unity",1]],)"
                     R"(PARAMETER["False easting",500000,LENGTHUNIT["metre",1]],)"
                     R"(PARAMETER["False northing",0,LENGTHUNIT["metre",1]]],CS[Cartesian,3],)"
                     R"(AXIS["easting",east,ORDER[1],LENGTHUNIT["metre",1]],)"
                     R"(AXIS["northing",north,ORDER[2],LENGTHUNIT["metre",1]],AXIS[")") +
         axis + ",ORDER[3],LENGTHUNIT[" + unit + "]]]";
}

TEST_F(ElevationFile, TheThirdAxisHasAUnitAndADirection) {
  TestFile file;
  file.epsg = 0;
  file.definition = utm_with_heights(R"(ellipsoidal height",up)", R"("metre",1)");
  const float metres = at(read(folder_.write(file, hill)), 10, 10);
  file.definition = utm_with_heights(R"(ellipsoidal height",up)", R"("foot",0.3048)");
  EXPECT_NEAR(at(read(folder_.write(file, hill)), 10, 10), 0.3048F * metres, 0.01F);
  file.definition = utm_with_heights(R"(depth",down)", R"("metre",1)");
  const ElevationRaster depths = read(folder_.write(file, hill));
  EXPECT_NEAR(at(depths, 10, 10), -metres, 0.01F);
  EXPECT_TRUE(noted(depths, "depths are converted to heights"));
}

// State plane coordinates, for example, in which heights often have the same unit.
TEST_F(ElevationFile, MetresThatAreAssumedBesideFeetAreNoted) {
  TestFile file;
  file.epsg = 0;
  file.definition = "+proj=utm +zone=32 +datum=WGS84 +units=us-ft";
  const ElevationRaster assumed = read(folder_.write(file, hill));
  EXPECT_TRUE(noted(assumed, "the unit of the heights is not declared; metres are assumed, although"));
  EXPECT_NEAR(at(assumed, 10, 10), hill(10, 10), 12.0);
  file.unit = "us survey foot";
  const ElevationRaster declared = read(folder_.write(file, hill));
  EXPECT_FALSE(noted(declared, "metres are assumed"));
  EXPECT_NEAR(declared.max_m, 0.3048 * hill(63, 63), 4.0);
  EXPECT_FALSE(noted(read(folder_.write({}, hill)), "metres are assumed"));
}

TEST_F(ElevationFile, LongitudesMayTurnSeveralTimes) {
  TestFile file;
  file.epsg = 4326;
  file.transform = {-0.032, 0.001, 0.0, 46.032, 0.0, -0.001};
  const ElevationRaster expected = read(folder_.write(file, hill));
  for (const double longitude : {180.0, -180.0, 360.0, 540.0, -540.0, 700.0}) {
    file.transform[0] = longitude - 0.032;
    const ElevationRaster found = read(folder_.write(file, hill));
    ASSERT_EQ(found.heights.size(), expected.heights.size()) << longitude;
    for (std::size_t i = 0; i < expected.heights.size(); ++i)
      ASSERT_NEAR(found.heights[i], expected.heights[i], 0.05F) << longitude;
  }
}

}  // namespace
}  // namespace tyndall::scene
