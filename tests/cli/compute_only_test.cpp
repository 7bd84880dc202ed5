// Devices whose queues only compute and have no timestamps: probe, tables, sky and validate work on them without a
// validation message, and the verbs that draw or measure refuse them. The layer of tests/layers hides the rest of a
// device, below the validation layer.
#include <nlohmann/json.hpp>

#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

const std::vector<std::string> kSmallTables = {"--set", "tables.size=8,16,16,4", "--set", "tables.orders=2",
                                               "--set", "tables.cache=off"};

class ComputeOnly : public testing::Test {
 protected:
  void SetUp() override { hide_graphics(true); }
  void TearDown() override { hide_graphics(false); }

  static void hide_graphics(bool hide) {
    if (hide) {
      ::setenv("VK_ADD_LAYER_PATH", TYNDALL_TEST_LAYERS, 1);
      ::setenv("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation:VK_LAYER_TYNDALL_compute_only", 1);
    } else {
      ::unsetenv("VK_ADD_LAYER_PATH");
      ::unsetenv("VK_INSTANCE_LAYERS");
    }
  }
  static ProcessResult run(const std::vector<std::string>& arguments) {
    ProcessResult result = run_tyndall(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ((result.out + result.err).find("VUID"), std::string::npos) << result.out << result.err;
    return result;
  }
};

TEST_F(ComputeOnly, ItsDevicesAreListedAsSuch) {
  const auto devices = nlohmann::json::parse(run({"devices", "--json"}).out);
  ASSERT_FALSE(devices.empty());
  for (const auto& device : devices) {
    EXPECT_FALSE(device["graphics"].get<bool>());
    EXPECT_TRUE(device["missing"].empty()) << device;
  }
  hide_graphics(false);
  EXPECT_TRUE(nlohmann::json::parse(run({"devices", "--json"}).out)[0]["graphics"].get<bool>());
}

TEST_F(ComputeOnly, ProbeAnswersAsOnTheWholeDevice) {
  const Scratch scratch;
  const std::string queries = scratch.write("queries.csv", "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n"
                                                           "10,60,40,30\n"
                                                           "2000,95,70,120\n"
                                                           "0,sky,50,0\n");
  for (const char* model : {"precomputed", "single"}) {
    std::vector<std::string> command = {"probe", "--queries", queries, "--model", model};
    command.insert(command.end(), kSmallTables.begin(), kSmallTables.end());
    hide_graphics(true);
    const ProcessResult computing = run(command);
    hide_graphics(false);
    EXPECT_EQ(computing.out, run(command).out) << model;
    EXPECT_NE(computing.out.find("L_r"), std::string::npos);
  }
}

TEST_F(ComputeOnly, TablesAreBuiltWithoutTimes) {
  std::vector<std::string> command = {"tables", "--json"};
  command.insert(command.end(), kSmallTables.begin(), kSmallTables.end());
  const ProcessResult built = run(command);
  EXPECT_TRUE(nlohmann::json::parse(built.out)["stages"].empty());
  EXPECT_NE(built.err.find("no timestamps"), std::string::npos) << built.err;
}

TEST_F(ComputeOnly, SkyMapsAreTheSame) {
  const Scratch scratch;
  const auto sky = [&](const std::string& name) {
    run({"sky", "-o", scratch.at(name), "--size", "32x16", "--sun-elevation-deg", "20", "--sun-azimuth-deg", "100",
         "--model", "single"});
    return contents_of(scratch.at(name));
  };
  const std::string computing = sky("sky.exr");
  hide_graphics(false);
  EXPECT_EQ(computing, sky("sky.exr"));
}

TEST_F(ComputeOnly, DrawingAndMeasuringAreRefused) {
  const Scratch scratch;
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"render", "-o", scratch.at("out.png"), "--size", "16x16"}, {"bench"}}) {
    const ProcessResult refused = run_tyndall(command);
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find("expected a queue with graphics"), std::string::npos) << refused.err;
  }
}

}  // namespace
}  // namespace tyndall::cli
