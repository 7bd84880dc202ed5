// The executable as scripts see it: exit statuses, one line per error, help, params.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "config/settings.hpp"
#include "run_tyndall.hpp"
#include "tyndall/version.hpp"

namespace tyndall::cli {
namespace {

struct Refused {
  std::vector<std::string> arguments;
  std::string message;
};

void expect_error(const Outcome& outcome, int status, const std::string& message) {
  EXPECT_EQ(outcome.status, status);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "tyndall: error: " + message + "\n");
}

TEST(Cli, HelpAndVersion) {
  const Outcome version = run_tyndall({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.out, "tyndall " TYNDALL_VERSION_STRING "\n");
  for (const std::vector<std::string>& ask : {std::vector<std::string>{"--help"}, {"-h"}, {"help"}}) {
    const Outcome help = run_tyndall(ask);
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(help.err, "");
    for (const char* const verb : {"\n  compare ", "\n  params "}) EXPECT_NE(help.out.find(verb), std::string::npos);
  }
  const Outcome verb_help = run_tyndall({"params", "--help"});
  EXPECT_EQ(verb_help.status, 0);
  EXPECT_EQ(verb_help.out.rfind("Usage: tyndall params [SCENE.toml] [OPTIONS]\n", 0), 0U) << verb_help.out;
  EXPECT_NE(verb_help.out.find("--format NAME"), std::string::npos);
  EXPECT_EQ(run_tyndall({"help", "params"}).out, verb_help.out);
}

TEST(Cli, BadUsageIsOneLineAndTwo) {
  const Refused cases[] = {
      {{}, "no verb is given, command line, 'tyndall --help' lists them"},
      {{"parms"}, "unknown verb 'parms', command line, did you mean 'params'?"},
      {{"--json", "params"}, "unknown option '--json', before the verb, allowed are --help and --version"},
      {{"params", "--frmat", "json"}, "unknown option '--frmat', tyndall params, did you mean '--format'?"},
      {{"params", "--format", "yaml"}, "unknown value 'yaml', --format, allowed is toml, json, markdown"},
      {{"params", "--format"}, "'--format' needs a value, tyndall params, 'tyndall params --help' says which"},
      {{"params", "--format", "json", "--format", "toml"},
       "'--format' is given 2 times, tyndall params, allowed is once"},
      {{"params", "a.toml", "b.toml"},
       "unexpected argument 'b.toml', tyndall params, 'tyndall params --help' lists what is allowed"},
      {{"params", ""}, "'' names no file, tyndall params, needed is SCENE.toml"},
      {{"params", "--set", "atmosphere.mie_gg=1"},
       "unknown parameter 'atmosphere.mie_gg', --set, did you mean 'atmosphere.mie_g'?"},
      {{"params", "--set", "camera.fov_deg=nan"},
       "'camera.fov_deg' = 'nan' is not a finite number, --set, allowed is 1 to 170 deg"},
      {{"params", "--set", "shadows.cascades=2", "--set", "shadows.first_marched=5"},
       "'shadows.first_marched' = 5 is no cascade, with 'shadows.cascades' = 2, allowed is 0 to 1"},
      {{"params", "/nonexistent/scene.toml"},
       "cannot read '/nonexistent/scene.toml', No such file or directory, needed is a readable file"},
      {{"params", "/"}, "cannot read '/', Is a directory, needed is a readable file"},
      {{"compare", "only-one.png"}, "B is missing, tyndall compare, 'tyndall compare --help' says what is needed"},
      {{"compare", "a", "b", "--json=1"},
       "'--json' takes no value, tyndall compare, 'tyndall compare --help' says which"},
      {{"compare", "a", "b", "--psnr-min", "high"},
       "'high' is not allowed, --psnr-min, allowed is a number, 0 to 1e+06"},
      {{"compare", "a", "b", "--diff", "d.jpg"}, "unknown image format, 'd.jpg', allowed is a name in .png or .exr"},
  };
  for (const Refused& refused : cases) expect_error(run_tyndall(refused.arguments), 2, refused.message);
}

TEST(Cli, MessagesStayOneLineWhateverIsGiven) {
  for (const std::string& odd : {std::string("a\nb\x1b[31m"), std::string("\xff\xfe"), std::string(100000, 'x')}) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{odd}, {"params", odd}, {"params", "--" + odd}, {"params", "--set", odd + "=1"}}) {
      const Outcome outcome = run_tyndall(arguments);
      EXPECT_EQ(outcome.status, 2);
      EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
      EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos);
      EXPECT_LT(outcome.err.size(), 1000U);
    }
  }
}

TEST(Cli, ScenesOfEveryKindOfBadness) {
  const Scratch scratch;
  const std::pair<std::string, std::string> scenes[] = {
      {"[camera]\nyaw_dge = 3\n", "unknown parameter 'camera.yaw_dge', FILE:2, did you mean 'camera.yaw_deg'?"},
      {"[cmaera]\nyaw_deg = 3\n", "unknown table [cmaera], FILE:1, did you mean [camera]?"},
      {"[camera]\nyaw_deg = '3'\n", "'camera.yaw_deg' is a string, FILE:2, allowed is -3600 to 3600 deg"},
      {"[camera]\nyaw_deg = inf\n",
       "'camera.yaw_deg' = 'inf' is not a finite number, FILE:2, allowed is -3600 to 3600 deg"},
      {std::string("\x7f"
                   "ELF\x80\xff",
                   6),
       "not a text file, FILE, allowed is a scene file: TOML in UTF-8"},
  };
  for (const auto& [text, message] : scenes) {
    const std::string path = scratch.write("scene.toml", text);
    std::string expected = message;
    expected.replace(expected.find("FILE"), 4, path);
    expect_error(run_tyndall({"params", path}), 2, expected);
  }
  const Outcome cut = run_tyndall({"params", scratch.write("scene.toml", "[camera]\nposition_m = [1, 2")});
  EXPECT_EQ(cut.status, 2);
  EXPECT_EQ(cut.err.rfind("tyndall: error: not valid TOML: ", 0), 0U) << cut.err;
  EXPECT_EQ(run_tyndall({"params", scratch.write("scene.toml", "")}).status, 0);
}

TEST(Cli, ParamsRoundTrip) {
  const Scratch scratch;
  const Outcome defaults = run_tyndall({"params"});
  EXPECT_EQ(defaults.status, 0);
  EXPECT_EQ(run_tyndall({"params", "--format", "toml"}).out, defaults.out);
  const Outcome changed =
      run_tyndall({"params", "--set", "sun.elevation_deg=1.1", "--set", "sun.elevation_deg=-0.1", "--set",
                   "atmosphere.rayleigh_scattering=5.8e-6,13.5e-6,33.3e-6", "--set", "terrain.source=a \"b\".tif"});
  ASSERT_EQ(changed.status, 0) << changed.err;
  EXPECT_NE(changed.out.find("\nelevation_deg = -0.1\n"), std::string::npos);
  EXPECT_NE(changed.out.find("\nrayleigh_scattering = [5.8e-06, 1.35e-05, 3.33e-05]\n"), std::string::npos);
  const std::string scene = scratch.write("scene.toml", changed.out);
  EXPECT_EQ(run_tyndall({"params", scene}).out, changed.out);
  // --set wins over the scene, wherever it stands.
  EXPECT_EQ(run_tyndall({"params", "--set", "sun.elevation_deg=-0.1", "--set=terrain.source=a \"b\".tif", scene}).out,
            changed.out);
  EXPECT_NE(run_tyndall({"params", "--set", "sun.elevation_deg=6", scene}).out, changed.out);
}

TEST(Cli, ParamsAsJsonIsTheWholeTable) {
  const Outcome outcome = run_tyndall({"params", "--format", "json", "--set", "camera.position_m=1,2.5,-3"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json document = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(document["version"], TYNDALL_VERSION_STRING);
  const nlohmann::json& list = document["parameters"];
  ASSERT_EQ(list.size(), config::rows().size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const config::Row& row = config::rows()[i];
    EXPECT_EQ(list[i]["name"], row.key());
    EXPECT_EQ(list[i]["doc"], row.info.doc);
    if (row.info.type == ParamType::float32) {
      EXPECT_GE(list[i]["default"].get<float>(), list[i]["min"].get<float>()) << row.key();
      EXPECT_LE(list[i]["default"].get<float>(), list[i]["max"].get<float>()) << row.key();
    }
    if (row.key() == "camera.position_m") {
      EXPECT_EQ(list[i]["value"], nlohmann::json({1, 2.5, -3}));
    }
    if (row.key() == "atmosphere.mie_phase") {
      EXPECT_EQ(list[i]["choices"], nlohmann::json({"cornette-shanks", "henyey-greenstein"}));
    }
  }
}

TEST(Cli, AFullStandardOutputIsAFailure) {
  const Outcome outcome = run_tyndall({"params"}, "/dev/full");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err, "tyndall: error: cannot write, standard output, it has to be open and have room\n");
}

}  // namespace
}  // namespace tyndall::cli
