// The program on two Vulkan drivers: the one that the loader finds, and SwiftShader, which tools/second_driver.sh
// fetches. Both compile the same shaders with different compilers, so results agree closely, but not byte for byte:
// Vulkan allows errors of a few units in the last place for division, square roots and transcendental functions.
#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>

#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

class SecondDriver : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(TYNDALL_SECOND_DRIVER)) {
      GTEST_SKIP() << "the second Vulkan driver is missing; tools/second_driver.sh fetches it";
    }
  }
  void TearDown() override { use_second(false); }

  static void use_second(bool second) {
    for (const char* variable : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
      second ? ::setenv(variable, TYNDALL_SECOND_DRIVER, 1) : ::unsetenv(variable);
    }
  }
  static ProcessResult run(const std::vector<std::string>& arguments) {
    ProcessResult result = run_tyndall(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    return result;
  }
  static std::vector<double> numbers_of(const std::string& csv) {
    std::vector<double> out;
    std::istringstream lines(csv);
    std::string line, cell;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      while (std::getline(cells, cell, ',')) out.push_back(cell == "sky" ? 0.0 : std::stod(cell));
    }
    return out;
  }
};

TEST_F(SecondDriver, NothingIsMissing) {
  use_second(true);
  const auto devices = nlohmann::json::parse(run({"devices", "--json"}).out);
  ASSERT_EQ(devices.size(), 1U);
  EXPECT_NE(devices[0]["name"].get<std::string>().find("SwiftShader"), std::string::npos);
  EXPECT_TRUE(devices[0]["missing"].empty()) << devices;
}

// Single scattering is computed in single precision. Vulkan allows exp(x) an error of 3 + 2|x| units in the last place:
// 1.1e-6 for an optical depth of 8. The relative density, the density integral towards the sun and the transmittance of
// the ray each contain one exponential.
TEST_F(SecondDriver, ProbeAgrees) {
  const Scratch scratch;
  const std::string queries = scratch.write("queries.csv", "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n"
                                                           "10,60,40,30\n"
                                                           "2000,95,70,120\n"
                                                           "0,89,85,10\n"
                                                           "60000,100,95,170\n"
                                                           "0,sky,50,0\n");
  const std::vector<std::string> command = {"probe", "--queries", queries, "--model", "single"};
  const std::vector<double> first = numbers_of(run(command).out);
  use_second(true);
  const std::vector<double> second = numbers_of(run(command).out);
  ASSERT_EQ(first.size(), second.size());
  EXPECT_EQ(first.size(), 50U);
  constexpr double kBound = 5.0e-6;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_LE(std::abs(first[i] - second[i]), kBound * std::abs(first[i]) + 1.0e-9)
        << i << ": " << first[i] << " and " << second[i];
  }
}

// The tables are built and read without an error, and the sky has its light.
TEST_F(SecondDriver, TablesAreBuilt) {
  const Scratch scratch;
  const std::string queries =
      scratch.write("queries.csv", "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n10,60,40,30\n0,sky,50,0\n");
  const std::vector<std::string> command = {
      "probe", "--queries",       queries, "--set",           "tables.size=8,16,16,4",
      "--set", "tables.orders=2", "--set", "tables.cache=off"};
  const std::vector<double> first = numbers_of(run(command).out);
  use_second(true);
  const std::vector<double> second = numbers_of(run(command).out);
  ASSERT_EQ(first.size(), 20U);
  ASSERT_EQ(second.size(), 20U);
  // Texels are rounded to half precision, whose steps are up to 2^-10 of a value. A difference in the last place moves
  // some texels by one step, both in the table that is read and in that of the previous order, from which it was made.
  constexpr double kBound = 2.0 / 1024.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_LE(std::abs(first[i] - second[i]), kBound * std::abs(first[i]) + 1.0e-9)
        << i << ": " << first[i] << " and " << second[i];
  }
}

// Without terrain, both drivers have the same depth. Pictures with geometry differ by more (0.2 % in the mean at
// 160 x 90), because drivers may place the vertices of triangles on different fractions of a pixel.
TEST_F(SecondDriver, PicturesAgree) {
  const Scratch scratch;
  const std::vector<std::string> scene = {"render",
                                          "--size",
                                          "64x36",
                                          "--set",
                                          "terrain.source=none",
                                          "--set",
                                          "camera.pitch_deg=-5",
                                          "--set",
                                          "tables.size=8,16,16,4",
                                          "--set",
                                          "tables.orders=2",
                                          "--set",
                                          "epipolar.slices=64",
                                          "--set",
                                          "epipolar.samples=64",
                                          "--set",
                                          "tables.cache=" + scratch.at("cache")};
  for (const bool second : {false, true}) {
    use_second(second);
    std::vector<std::string> command = scene;
    command.insert(command.end(), {"-o", scratch.at(second ? "second.exr" : "first.exr")});
    run(command);
  }
  use_second(false);
  run({"compare", scratch.at("first.exr"), scratch.at("second.exr"), "--mre-max", "0.001"});
}

}  // namespace
}  // namespace tyndall::cli
