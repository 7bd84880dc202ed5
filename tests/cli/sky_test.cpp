// `tyndall sky`, and the map and the sun's disc in it: directions, and conservation of light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "effect/medium.hpp"
#include "files/csv.hpp"
#include "files/text.hpp"
#include "image/image.hpp"
#include "models/single_scattering.hpp"
#include "run_tyndall.hpp"
#include "sky_map.hpp"

namespace tyndall::cli {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRadPerDeg = kPi / 180.0;

// Integrates a map over the whole sphere or, if `horizontal`, over the upper half and times the cosine.
std::array<double, 3> integral(const image::Image& image, bool horizontal) {
  SkyMap map;
  map.width = image.width;
  map.height = image.height;
  std::array<double, 3> sum = {};
  for (std::uint32_t y = 0; y < image.height; ++y) {
    const double cosine = std::cos(kPi * (y + 0.5) / image.height);
    const double weight = map.pixel_solid_angle(y) * (horizontal ? std::max(cosine, 0.0) : 1.0);
    for (std::uint32_t x = 0; x < image.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * image.pixel(x, y)[c];
    }
  }
  return sum;
}

SkyMap map_of(std::uint32_t width, std::uint32_t height, double elevation_deg, double azimuth_deg,
              double altitude_m = 0.0) {
  return {width, height, altitude_m, elevation_deg * kRadPerDeg, azimuth_deg * kRadPerDeg};
}

const SunFace kFace = {0.2667 * kRadPerDeg, {0.4, 0.5, 0.6}, {10.0, 10.0, 10.0}};

TEST(CliSkyMap, PixelsCoverTheSphereAndLookWhereTheyShould) {
  double sum = 0.0;
  const SkyMap map = map_of(36, 18, 35.0, 125.0);
  for (std::uint32_t y = 0; y < map.height; ++y) sum += map.width * map.pixel_solid_angle(y);
  EXPECT_NEAR(sum, 4.0 * kPi, 1e-12);
  // Zenith angle 55, azimuth 125 are the centre of column 12 (120 to 130) and row 5 (50 to 60).
  EXPECT_NEAR(models::ray_from_query(map.query(12, 5)).cos_view_sun, 1.0, 1e-12);
  EXPECT_NEAR(models::ray_from_query(map.query(30, 12)).cos_view_sun, -1.0, 1e-12);
  EXPECT_NEAR(models::ray_from_query(map.query(0, 0)).cos_view_zenith, std::cos(5.0 * kRadPerDeg), 1e-12);
  // 10 deg clockwise is the next column to the right.
  EXPECT_NEAR(models::ray_from_query(map.query(13, 5)).cos_view_sun,
              models::ray_from_query(map.query(11, 5)).cos_view_sun, 1e-12);
}

TEST(CliSkyMap, FacesAndFishEyesLookWhereTheyShould) {
  SkyMap cube = map_of(33, 198, 35.0, 125.0);
  cube.projection = Projection::cube;
  const auto middle = [&](std::uint32_t face) { return cube.direction(16, 33 * face + 16); };
  constexpr double kAzimuth[] = {90.0, -90.0, 0.0, 0.0, 180.0, 0.0};
  for (std::uint32_t face = 0; face < 6; ++face) {
    EXPECT_NEAR(middle(face).zenith, (face == 2 ? 0.0 : face == 3 ? 1.0 : 0.5) * kPi, 1e-7) << face;
    if (face == 2 || face == 3) continue;
    EXPECT_NEAR(std::cos(middle(face).azimuth - kAzimuth[face] * kRadPerDeg), 1.0, 1e-12) << face;
  }
  // On the face to the east, the left edge looks to the south-east.
  EXPECT_NEAR(cube.direction(0, 16).azimuth, 135.0 * kRadPerDeg, 0.04);
  EXPECT_LT(cube.direction(16, 0).zenith, 50.0 * kRadPerDeg);  // the top row looks up
  double sum = 0.0;
  for (std::uint32_t y = 0; y < cube.height; ++y) {
    for (std::uint32_t x = 0; x < cube.width; ++x) sum += cube.direction(x, y).solid_angle;
  }
  EXPECT_NEAR(sum, 4.0 * kPi, 1e-10);

  SkyMap fisheye = map_of(101, 101, 35.0, 125.0);
  fisheye.projection = Projection::fisheye;
  EXPECT_NEAR(fisheye.direction(50, 50).zenith, 0.0, 1e-9);
  EXPECT_NEAR(fisheye.direction(50, 0).zenith, 0.5 * kPi * 100.0 / 101.0, 1e-9);
  EXPECT_NEAR(fisheye.direction(50, 0).azimuth, 0.0, 1e-9);                // north
  EXPECT_NEAR(fisheye.direction(0, 50).azimuth, 90.0 * kRadPerDeg, 1e-9);  // east
  EXPECT_EQ(fisheye.direction(0, 0).solid_angle, 0.0);
  sum = 0.0;
  for (std::uint32_t y = 0; y < 101; ++y) {
    for (std::uint32_t x = 0; x < 101; ++x) sum += fisheye.direction(x, y).solid_angle;
  }
  EXPECT_NEAR(sum, 2.0 * kPi, 0.01 * kPi);
}

TEST(CliSkyMap, TheDiscHoldsTheDirectSunAtEverySize) {
  const shared::Medium medium = medium_from_params({});
  for (const auto& [width, height] :
       {std::pair(2U, 1U), std::pair(16U, 8U), std::pair(333U, 77U), std::pair(2048U, 1024U)}) {
    // The sun is inside the map, at its seam, at the zenith, and near the zenith.
    for (const auto& [elevation, azimuth] : {std::pair(30.0, 100.0), std::pair(45.0, 0.0), std::pair(20.0, -720.05),
                                             std::pair(90.0, 40.0), std::pair(89.9, 200.0)}) {
      const SkyMap map = map_of(width, height, elevation, azimuth);
      image::Image image(width, height);
      add_sun(image, map, kFace, medium);
      const std::array<double, 3> found = integral(image, false);
      const std::array<double, 3> passed = models::sun_transmittance(medium, 0.0, std::sin(elevation * kRadPerDeg));
      for (std::size_t c = 0; c < 3; ++c) {
        // Pixels are floats, and the transmittance varies slightly over the disc.
        EXPECT_NEAR(found[c], 10.0 * passed[c], 2e-5 * 10.0) << width << ' ' << elevation << ' ' << azimuth;
      }
    }
  }
}

TEST(CliSkyMap, TheHorizonCutsTheDisc) {
  Params vacuum;
  vacuum.atmosphere.custom_coefficients = true;
  vacuum.atmosphere.rayleigh_scattering = {0, 0, 0};
  vacuum.atmosphere.aerosol_density = 0;
  vacuum.atmosphere.ozone_absorption = {0, 0, 0};
  const shared::Medium medium = medium_from_params(vacuum);
  const auto flux = [&](double elevation_deg, double altitude_m) {
    const SkyMap map = map_of(720, 360, elevation_deg, 10.0, altitude_m);
    image::Image image(map.width, map.height);
    add_sun(image, map, {0.2667 * kRadPerDeg, {}, {10.0, 10.0, 10.0}}, medium);
    return integral(image, false)[1];
  };
  EXPECT_NEAR(flux(0.0, 0.0), 5.0, 0.01);  // half of a uniform disc
  // A chord at half the radius leaves 1/2 + (x sqrt(1 - x^2) + asin x) / pi.
  EXPECT_NEAR(flux(0.13335, 0.0), 10.0 * (0.5 + (0.5 * std::sqrt(0.75) + std::asin(0.5)) / kPi), 0.02);
  EXPECT_EQ(flux(-0.27, 0.0), 0.0);
  // From a greater altitude the horizon is lower.
  EXPECT_NEAR(flux(-0.27, 1000.0), 10.0, 1e-4);
  EXPECT_NEAR(flux(-10.0, 400000.0), 10.0, 1e-4);
  EXPECT_EQ(flux(-30.0, 400000.0), 0.0);
}

class CliSky : public testing::Test {
 protected:
  image::File make(std::vector<std::string> arguments) {
    const std::string path = scratch_.at("sky.exr");
    arguments.insert(arguments.begin(), {"sky", "-o", path});
    const ProcessResult process = run_tyndall(arguments);
    EXPECT_EQ(process.status, 0) << process.err;
    EXPECT_EQ(process.err, "");
    out_ = process.out;
    Result<image::File> file = image::read(path);
    EXPECT_TRUE(file.ok());
    return file ? std::move(file).value() : image::File();
  }
  std::array<double, 3> probe(const std::string& ray, std::vector<std::string> more = {}) {
    const std::string header = "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n";
    more.insert(more.begin(), {"probe", "--json", "--queries", scratch_.write("q.csv", header + ray + "\n")});
    const ProcessResult process = run_tyndall(more);
    EXPECT_EQ(process.status, 0) << process.err;
    return nlohmann::json::parse(process.out)["answers"][0]["L"];
  }

  Scratch scratch_;
  std::string out_;
};

const std::vector<std::string> kSingle = {"--model", "single"};
std::vector<std::string> with_single(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), kSingle.begin(), kSingle.end());
  return arguments;
}

TEST_F(CliSky, TheUpperHalfHoldsTheIrradianceOfTheSky) {
  for (const double elevation : {60.0, 15.0, 0.0, -4.0}) {
    for (const double altitude : {0.0, 9000.0}) {
      // The sun's irradiance is 10 and the scale is 0.5.
      const image::File file =
          make(with_single({"--size", "180x360", "--sun-elevation-deg", files::number_text(elevation),
                            "--sun-azimuth-deg", "77", "--altitude", files::number_text(altitude), "--disc", "false"}));
      const std::array<double, 3> found = integral(file.image, true);
      const std::array<double, 3> truth =
          probe(files::number_text(altitude) + ",sky," + files::number_text(90.0 - elevation) + ",", kSingle);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(found[c], 5.0 * truth[c], 0.005 * 5.0 * truth[c]) << elevation << ' ' << altitude << ' ' << c;
      }
    }
  }
}

TEST_F(CliSky, EveryProjectionHoldsTheReportedIrradiance) {
  const std::vector<std::string> sun = {"--sun-elevation-deg", "25", "--sun-azimuth-deg", "200", "--json"};
  const auto sky = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), sun.begin(), sun.end());
    return make(with_single(arguments));
  };
  const auto reported = [&](const char* key) -> std::array<double, 3> { return nlohmann::json::parse(out_)[key]; };
  const image::File whole = sky({"--size", "360x180"});
  const std::array<double, 3> sky_light = reported("sky_irradiance"), sun_light = reported("sun_horizontal_irradiance");
  const std::array<double, 3> direct = reported("sun_irradiance");
  const std::array<double, 3> found = integral(whole.image, true);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(found[c], sky_light[c] + sun_light[c], 0.005 * found[c]);
    EXPECT_NEAR(sun_light[c], direct[c] * std::sin(25.0 * kRadPerDeg), 1e-3 * direct[c]);
    const std::array<double, 3> passed =
        models::sun_transmittance(medium_from_params({}), 0.0, std::sin(25.0 * kRadPerDeg));
    EXPECT_NEAR(direct[c], 5.0 * passed[c], 1e-3 * direct[c]);
  }
  const image::File cube = sky({"--size", "48x288", "--projection", "cube", "--sun", "none"});
  const std::array<double, 3> of_cube = reported("sky_irradiance");
  const image::File fisheye = sky({"--size", "120x120", "--projection", "fisheye", "--sun", "split"});
  const std::array<double, 3> of_fisheye = reported("sky_irradiance");
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(of_cube[c], sky_light[c], 0.005 * sky_light[c]);
    EXPECT_NEAR(of_fisheye[c], sky_light[c], 0.005 * sky_light[c]);
    EXPECT_EQ(fisheye.image.pixel(0, 0)[c], 0.0F);
  }
  const nlohmann::json light = nlohmann::json::parse(contents_of(scratch_.at("sky.sun.json")));
  EXPECT_NEAR(light["direction"][0].get<double>(), std::cos(25.0 * kRadPerDeg) * std::sin(200.0 * kRadPerDeg), 1e-9);
  EXPECT_NEAR(light["direction"][1].get<double>(), std::sin(25.0 * kRadPerDeg), 1e-9);
  EXPECT_NEAR(light["direction"][2].get<double>(), -std::cos(25.0 * kRadPerDeg) * std::cos(200.0 * kRadPerDeg), 1e-9);
  EXPECT_NEAR(light["angular_radius_deg"].get<double>(), 0.2667, 1e-6);
  EXPECT_EQ(light["irradiance"].get<std::vector<double>>(), std::vector<double>(direct.begin(), direct.end()));
}

// The illuminance of a map, from its pixels and the header, is the reported one, in every projection and unit.
TEST_F(CliSky, MapsHoldTheReportedIlluminance) {
  const auto sky = [&](std::vector<std::string> arguments) {
    const std::vector<std::string> sun = {
        "--sun-elevation-deg",       "25",    "--sun-azimuth-deg",       "200", "--json", "--set",
        "scattering.color=spectral", "--set", "planet.ground_albedo=0.2"};
    arguments.insert(arguments.end(), sun.begin(), sun.end());
    return make(with_single(arguments));
  };
  const auto reported = [&](const char* key) -> double { return nlohmann::json::parse(out_)[key]; };
  const auto luminance_of = [](const std::array<double, 3>& rgb) {
    return 0.2126729 * rgb[0] + 0.7151522 * rgb[1] + 0.0721750 * rgb[2];
  };
  const image::File whole = sky({"--size", "360x180"});
  const double sky_lux = reported("sky_illuminance_lux"), sun_lux = reported("sun_horizontal_illuminance_lux");
  const double all_lux = luminance_of(integral(whole.image, true)) * reported("white_luminance_cd_per_m2");
  EXPECT_NEAR(all_lux, sky_lux + sun_lux, 0.005 * all_lux);
  EXPECT_NEAR(sun_lux, std::sin(25.0 * kRadPerDeg) * reported("sun_illuminance_lux"), 1e-3 * sun_lux);
  // A clear sky and a sun at 25 degrees.
  EXPECT_GT(sky_lux, 3000.0);
  EXPECT_LT(sky_lux, 15000.0);
  EXPECT_GT(reported("sun_illuminance_lux"), 70000.0);
  EXPECT_LT(reported("sun_illuminance_lux"), 110000.0);
  // In cd/m^2 and XYZ, the second channel is the luminance.
  const image::File absolute =
      sky({"--size", "360x180", "--unit", "luminance", "--primaries", "xyz", "--sun", "split"});
  EXPECT_NEAR(integral(absolute.image, true)[1], sky_lux, 0.005 * sky_lux);
  EXPECT_EQ(reported("white_luminance_cd_per_m2"), 1.0);
  const nlohmann::json light = nlohmann::json::parse(contents_of(scratch_.at("sky.sun.json")));
  EXPECT_NEAR(light["illuminance_lux"].get<double>(), reported("sun_illuminance_lux"), 1e-9 * sun_lux);
  EXPECT_NEAR(light["irradiance"][1].get<double>(), reported("sun_illuminance_lux"), 1e-3 * sun_lux);
  const std::map<std::string, std::string> metadata(absolute.metadata.begin(), absolute.metadata.end());
  EXPECT_EQ(metadata.at("tyndall.unit"), "cd/m^2");
  EXPECT_EQ(metadata.at("tyndall.primaries"), "xyz");
  EXPECT_EQ(metadata.at("tyndall.sky.sun"), "split");
  EXPECT_EQ(metadata.at("tyndall.sky.clamp"), "false");
  sky({"--size", "4x4", "--projection", "fisheye", "--sun", "none"});
  EXPECT_NEAR(reported("sky_illuminance_lux"), sky_lux, 1e-9 * sky_lux);
}

TEST_F(CliSky, UnitsNeedASpectrum) {
  const ProcessResult process =
      run_tyndall(with_single({"sky", "-o", scratch_.at("sky.exr"), "--size", "4x4", "--sun-elevation-deg", "25",
                               "--sun-azimuth-deg", "0", "--unit", "luminance"}));
  EXPECT_EQ(process.status, 2);
  EXPECT_NE(process.err.find("--unit: three channels have no unit 'luminance'; expected scattering.color = spectral"),
            std::string::npos)
      << process.err;
  EXPECT_FALSE(std::filesystem::exists(scratch_.at("sky.exr")));
}

TEST_F(CliSky, PixelsAreRays) {
  const image::File file =
      make(with_single({"--size", "36x18", "--sun-elevation-deg", "30", "--sun-azimuth-deg", "40", "--altitude",
                        "400000", "--set", "sun.irradiance=2", "--set", "scattering.scale=1"}));
  for (const auto& [x, y] : {std::pair(4U, 11U), std::pair(20U, 17U), std::pair(7U, 5U)}) {
    const std::string ray =
        "400000," + files::number_text(5.0 + 10.0 * y) + ",60," + files::number_text(5.0 + 10.0 * x - 40.0);
    const std::array<double, 3> truth = probe(ray, kSingle);
    for (std::size_t c = 0; c < 3; ++c) {
      // The sun is in row 5 (zenith angles 50 to 60) or 6, and in column 3 or 4.
      EXPECT_NEAR(file.image.pixel(x, y)[c], 2.0 * truth[c], 2e-5 * truth[c]) << x << ' ' << y;
    }
  }
  const auto value = [&](const std::string& name) {
    for (const auto& [key, text] : file.metadata) {
      if (key == name) return text;
    }
    return std::string("none");
  };
  EXPECT_EQ(value("tyndall.sun.elevation_deg"), "30");
  EXPECT_EQ(value("tyndall.sun.azimuth_deg"), "40");
  EXPECT_EQ(value("tyndall.camera.altitude_m"), "4e+05");
  EXPECT_EQ(value("tyndall.sky.disc"), "true");
  EXPECT_EQ(value("tyndall.sky.model"), "single");
}

TEST_F(CliSky, DiscsBeyondHalfPrecisionAreNoted) {
  const std::vector<std::string> sky = with_single({"sky", "-o", scratch_.at("sky.exr"), "--size", "2048x1024",
                                                    "--sun-elevation-deg", "60", "--sun-azimuth-deg", "0"});
  const ProcessResult noted = run_tyndall(sky);
  EXPECT_EQ(noted.status, 0);
  EXPECT_NE(noted.err.find("tyndall: note: the sun's disc has values up to "), std::string::npos) << noted.err;
  EXPECT_NE(noted.err.find("65504"), std::string::npos);
  std::vector<std::string> clamped = sky;
  clamped.insert(clamped.end(), {"--clamp", "true"});
  EXPECT_NE(run_tyndall(clamped).err.find(" were clamped to 65504"), std::string::npos);
  const Result<image::File> limited = image::read(scratch_.at("sky.exr"));
  ASSERT_TRUE(limited.ok());
  EXPECT_EQ(*std::max_element(limited.value().image.rgb.begin(), limited.value().image.rgb.end()), 65504.0F);
  std::vector<std::string> without = sky;
  without.insert(without.end(), {"--disc", "false"});
  EXPECT_EQ(run_tyndall(without).err, "");
}

TEST_F(CliSky, TheGroundMatchesTheReference) {
  const image::File file =
      make(with_single({"--size", "4x6", "--sun-elevation-deg", "40", "--sun-azimuth-deg", "45", "--altitude", "5000",
                        "--disc", "false", "--set", "planet.ground_albedo=0.4", "--set", "sun.irradiance=2,4,0.5"}));
  constexpr double kSun[] = {1.0, 2.0, 0.25};  // times the scale of 0.5
  for (const auto& [x, y] : {std::pair(0U, 5U), std::pair(2U, 4U), std::pair(1U, 3U)}) {
    const std::string ray = "5000," + files::number_text(15.0 + 30.0 * y) + ",50," + files::number_text(90.0 * x);
    const std::array<double, 3> truth = probe(
        ray, {"--model", "reference", "--orders", "1", "--samples", "20000", "--set", "planet.ground_albedo=0.4"});
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(file.image.pixel(x, y)[c], kSun[c] * truth[c], 0.004 * kSun[c] * truth[c]) << x << ' ' << y;
  }
}

TEST_F(CliSky, TheDefaultMatchesAllOrdersOfTheReference) {
  // Rows at 15, 45, 75 and 105 degrees from the zenith. The error of these small tables is below the tolerance.
  const std::vector<std::string> tables = {"--set", "tables.size=16,64,32,8"};
  for (const double elevation : {35.0, -2.0}) {
    const std::string sun = files::number_text(90.0 - elevation);
    std::vector<std::string> arguments = {"--size",
                                          "4x6",
                                          "--sun-elevation-deg",
                                          files::number_text(elevation),
                                          "--sun-azimuth-deg",
                                          "45",
                                          "--altitude",
                                          "2000",
                                          "--disc",
                                          "false",
                                          "--set",
                                          "sun.irradiance=2"};
    arguments.insert(arguments.end(), tables.begin(), tables.end());
    const image::File file = make(arguments);
    for (const auto& [x, y] : {std::pair(0U, 0U), std::pair(1U, 1U), std::pair(2U, 2U), std::pair(3U, 3U)}) {
      const std::string ray =
          "2000," + files::number_text(15.0 + 30.0 * y) + "," + sun + "," + files::number_text(90.0 * x);
      const std::array<double, 3> truth = probe(ray, {"--model", "reference", "--samples", "60000"});
      const double brightest = *std::max_element(truth.begin(), truth.end());
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(file.image.pixel(x, y)[c], truth[c], 0.03 * brightest) << x << ' ' << y << ' ' << elevation;
    }
  }
}

TEST_F(CliSky, TheSunByPlaceAndTime) {
  const image::File file =
      make({"--size", "360x180", "--at", "39.742476,-105.1786", "--time", "2003-10-17T12:30:30-07:00", "--json"});
  const nlohmann::json out = nlohmann::json::parse(out_);
  EXPECT_NEAR(out["sun_elevation_deg"].get<double>(), 39.87205, 0.0005);
  EXPECT_NEAR(out["sun_azimuth_deg"].get<double>(), 194.34024, 0.0005);
  // The brightest pixel contains the sun.
  std::size_t best = 0;
  for (std::size_t i = 0; i < file.image.rgb.size() / 3; ++i) {
    if (file.image.rgb[3 * i] > file.image.rgb[3 * best]) best = i;
  }
  EXPECT_EQ(best % 360, 194U);
  EXPECT_EQ(best / 360, 50U);
}

// The metadata describes the map, whatever a scene says of the sun.
TEST_F(CliSky, TheOptionsHoldInsteadOfTheScenesSun) {
  const std::string path = scratch_.at("sky.exr");
  const ProcessResult process =
      run_tyndall({"sky", "-o", path, "--size", "64x32", "--sun-elevation-deg", "1", "--sun-azimuth-deg", "90", "--set",
                   "sun.refraction=true", "--altitude", "-100", "--set", "camera.altitude_m=500", "--set",
                   "sun.place=46,7", "--set", "sun.time=2026-06-21T12:00Z"});
  ASSERT_EQ(process.status, 0) << process.err;
  EXPECT_NE(process.err.find("have no effect on sky"), std::string::npos) << process.err;
  Result<image::File> file = image::read(path);
  ASSERT_TRUE(file.ok());
  std::map<std::string, std::string> found(file.value().metadata.begin(), file.value().metadata.end());
  EXPECT_EQ(found["tyndall.sun.place"] + found["tyndall.sun.time"], "");
  EXPECT_EQ(found["tyndall.camera.altitude_m"] + " " + found["tyndall.camera.position_m"], "-1 0,-100,0");
  EXPECT_EQ(found["tyndall.sun.refraction"] + found["tyndall.sun.elevation_deg"], "false1");
}

TEST_F(CliSky, ErrorsAreReported) {
  const std::string either = "; expected either --sun-elevation-deg E --sun-azimuth-deg A or --at LAT,LON --time "
                             "ISO8601, or --list LIST.csv\n";
  const auto error = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "sky");
    arguments.insert(arguments.end(), {"-o", scratch_.at("none.exr"), "--size", "4x2"});
    const ProcessResult process = run_tyndall(arguments);
    EXPECT_EQ(process.status, 2) << process.err;
    EXPECT_EQ(std::count(process.err.begin(), process.err.end(), '\n'), 1);
    return process.err;
  };
  EXPECT_EQ(error({}), "tyndall: error: tyndall sky: missing position of the sun" + either);
  const std::vector<std::string> angles = {"--sun-elevation-deg", "3", "--sun-azimuth-deg", "3"};
  const auto wrong = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), angles.begin(), angles.end());
    return error(arguments);
  };
  EXPECT_EQ(wrong({"--projection", "cube"}),
            "tyndall: error: --sun: a cube map has no sun's disc; expected split or none\n");
  EXPECT_EQ(wrong({"--projection", "fisheye", "--sun", "none"}),
            "tyndall: error: --size: invalid size '4x2' of a fisheye map; expected 4x4\n");
  EXPECT_EQ(wrong({"--disc", "false", "--sun", "split"}),
            "tyndall: error: --disc: the sun's disc is given by --sun and by --disc; expected one of them\n");
  EXPECT_EQ(error({"--sun-elevation-deg", "3"}),
            "tyndall: error: tyndall sky: missing option --sun-azimuth-deg" + either);
  EXPECT_EQ(error({"--sun-azimuth-deg", "3"}),
            "tyndall: error: tyndall sky: missing option --sun-elevation-deg" + either);
  EXPECT_EQ(error({"--at", "1,2"}), "tyndall: error: tyndall sky: missing option --time" + either);
  EXPECT_EQ(error({"--time", "2000-01-01T00:00Z"}), "tyndall: error: tyndall sky: missing option --at" + either);
  EXPECT_EQ(error({"--sun-azimuth-deg", "3", "--time", "2000-01-01T00:00Z"}),
            "tyndall: error: tyndall sky: the sun is given both by angles and by place and time" + either);
  EXPECT_NE(
      error({"--at", "91,0", "--time", "2000-01-01T00:00Z"}).find("--at: '91,0' is out of range; expected LAT,LON"),
      std::string::npos);
  EXPECT_NE(error({"--at", "1,0", "--time", "2001-02-29T00:00Z"})
                .find("--time: '2001-02-29T00:00Z' has no such day; expected"),
            std::string::npos);
  const std::vector<std::string> sun = {"--sun-elevation-deg", "3", "--sun-azimuth-deg", "4"};
  const auto with_sun = [&](std::vector<std::string> more) {
    more.insert(more.begin(), sun.begin(), sun.end());
    return error(more);
  };
  EXPECT_NE(with_sun({"--altitude", "-11001"})
                .find("--altitude: invalid number '-11001'; expected a number, -11000 to 1e+09"),
            std::string::npos);
  EXPECT_NE(with_sun({"--disc", "maybe"}).find("--disc: unknown value 'maybe'; expected one of true, false"),
            std::string::npos);
  EXPECT_NE(with_sun({"--model", "reference"}).find("--model: unknown value 'reference'; expected one of "),
            std::string::npos);
  EXPECT_NE(with_sun({"--set", "sun.irradiance=-1"}).find("sun.irradiance"), std::string::npos);
  const ProcessResult png = run_tyndall({"sky", "-o", scratch_.at("a.png"), sun[0], sun[1], sun[2], sun[3]});
  EXPECT_EQ(png.status, 2);
  EXPECT_NE(png.err.find("expected a name that ends in .exr"), std::string::npos);
  const ProcessResult lost = run_tyndall({"sky", "-o", scratch_.at("no/a.exr"), sun[0], sun[1], sun[2], sun[3]});
  EXPECT_EQ(lost.status, 1);
  EXPECT_FALSE(std::filesystem::exists(scratch_.at("none.exr")));
}

}  // namespace
}  // namespace tyndall::cli
