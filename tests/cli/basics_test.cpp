// The executable's interface for scripts: exit statuses, one line per error, help, params.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "config/settings.hpp"
#include "run_tyndall.hpp"
#include "tyndall/version.hpp"

namespace tyndall::cli {
namespace {

struct Refused {
  std::vector<std::string> arguments;
  std::string message;
};

void expect_error(const ProcessResult& process, int status, const std::string& message) {
  EXPECT_EQ(process.status, status);
  EXPECT_EQ(process.out, "");
  EXPECT_EQ(process.err, "tyndall: error: " + message + "\n");
}

// Returns the contents of a file of /proc about a process, with spaces for zeros.
std::string about_process(pid_t process, const std::string& name) {
  std::string text = contents_of("/proc/" + std::to_string(process) + "/" + name);
  std::replace(text.begin(), text.end(), '\0', ' ');
  return text;
}

// A verb that uses much memory restarts itself once, with its arguments and under its name.
TEST(Cli, LargePages) {
  if (contents_of("/sys/kernel/mm/transparent_hugepage/enabled").find("[madvise]") == std::string::npos)
    GTEST_SKIP() << "this system does not grant large pages on request";
  const Scratch scratch;
  const std::string queries = scratch.at("queries.csv");  // `probe` waits until something writes to it
  ASSERT_EQ(::mkfifo(queries.c_str(), 0600), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::unsetenv("GLIBC_TUNABLES");
    const int none = ::open("/dev/null", O_WRONLY);
    if (::dup2(none, STDERR_FILENO) < 0) ::_exit(127);
    ::execl(TYNDALL_EXECUTABLE, "tyndall", "probe", "--model", "homogeneous", "--queries", queries.c_str(), nullptr);
    ::_exit(127);
  }
  int writer = -1;  // can be opened once the program reads
  for (int i = 0; i < 3000 && writer < 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    writer = ::open(queries.c_str(), O_WRONLY | O_NONBLOCK);
  }
  EXPECT_GE(writer, 0) << "the program does not read the queries";
  EXPECT_NE(about_process(child, "environ").find("GLIBC_TUNABLES=glibc.malloc.hugetlb=1 "), std::string::npos);
  EXPECT_EQ(about_process(child, "comm"), "tyndall\n");
  EXPECT_EQ(about_process(child, "cmdline"), "tyndall probe --model homogeneous --queries " + queries + " ");
  if (writer >= 0)
    ::close(writer);
  else
    ::kill(child, SIGKILL);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 2) << status;  // an empty table
}

TEST(Cli, HelpAndVersion) {
  const ProcessResult version = run_tyndall({"--version"});
  EXPECT_EQ(version.status, 0);
  // Scripts read the first line. The others list the optional parts; this build has all of them.
  EXPECT_EQ(
      version.out.rfind("tyndall " TYNDALL_VERSION_STRING "\nbuilt with: elevation files (GDAL), EXR files (OpenEXR), "
                        "viewer (GLFW, ImGui), shader reloading (shaderc)",
                        0),
      0U)
      << version.out;
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"}, {"-h"}, {"help"}}) {
    const ProcessResult help = run_tyndall(arguments);
    EXPECT_EQ(help.status, 0);
    EXPECT_EQ(help.err, "");
    for (const char* const verb : {"\n  compare ", "\n  params "}) EXPECT_NE(help.out.find(verb), std::string::npos);
  }
  const ProcessResult verb_help = run_tyndall({"params", "--help"});
  EXPECT_EQ(verb_help.status, 0);
  EXPECT_EQ(verb_help.out.rfind("Usage: tyndall params [SCENE.toml] [OPTIONS]\n", 0), 0U) << verb_help.out;
  EXPECT_NE(verb_help.out.find("--format NAME"), std::string::npos);
  EXPECT_EQ(run_tyndall({"help", "params"}).out, verb_help.out);
}

TEST(Cli, BadUsageIsOneLineAndStatusTwo) {
  const Refused cases[] = {
      {{}, "command line: missing verb; see 'tyndall --help'"},
      {{"parms"}, "command line: unknown verb 'parms'; did you mean 'params'?"},
      {{"--json", "params"}, "before the verb: unknown option '--json'; expected --help or --version"},
      {{"params", "--frmat", "json"}, "tyndall params: unknown option '--frmat'; did you mean '--format'?"},
      {{"params", "--format", "yaml"}, "--format: unknown value 'yaml'; expected one of toml, json, markdown"},
      {{"params", "--format"}, "tyndall params: missing value for '--format'; see 'tyndall params --help'"},
      {{"params", "--format", "json", "--format", "toml"},
       "tyndall params: option '--format' given 2 times; expected it at most once"},
      {{"params", "a.toml", "b.toml"}, "tyndall params: unexpected argument 'b.toml'; see 'tyndall params --help'"},
      {{"params", ""}, "tyndall params: empty file name ''; expected SCENE.toml"},
      {{"params", "--set", "atmosphere.mie_gg=1"},
       "--set: unknown parameter 'atmosphere.mie_gg'; did you mean 'atmosphere.mie_g'?"},
      {{"params", "--set", "camera.fov_deg=nan"},
       "--set: 'camera.fov_deg' = 'nan' is not a finite number; expected 1 to 170 deg"},
      {{"params", "--set", "shadows.cascades=2", "--set", "shadows.first_marched=5"},
       "shadows.first_marched: 5 is not below shadows.cascades = 2; expected 0 to 1"},
      {{"params", "/nonexistent/scene.toml"},
       "'/nonexistent/scene.toml': cannot read: No such file or directory; expected a readable file"},
      {{"params", "/"}, "'/': cannot read: Is a directory; expected a readable file"},
      {{"compare", "only-one.png"}, "tyndall compare: missing argument B; see 'tyndall compare --help'"},
      {{"compare", "a", "b", "--json=1"},
       "tyndall compare: unexpected value for '--json'; see 'tyndall compare --help'"},
      {{"compare", "a", "b", "--psnr-min", "high"}, "--psnr-min: invalid number 'high'; expected a number, 0 to 1e+06"},
      {{"compare", "a", "b", "--diff", "d.jpg"},
       "'d.jpg': unknown image format; expected a name that ends in .png or .exr"},
  };
  for (const Refused& refused : cases) expect_error(run_tyndall(refused.arguments), 2, refused.message);
}

TEST(Cli, MessagesAreOneLineForAnyInput) {
  for (const std::string& odd : {std::string("a\nb\x1b[31m"), std::string("\xff\xfe"), std::string(100000, 'x')}) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{odd}, {"params", odd}, {"params", "--" + odd}, {"params", "--set", odd + "=1"}}) {
      const ProcessResult process = run_tyndall(arguments);
      EXPECT_EQ(process.status, 2);
      EXPECT_EQ(std::count(process.err.begin(), process.err.end(), '\n'), 1) << process.err;
      EXPECT_EQ(process.err.find('\x1b'), std::string::npos);
      EXPECT_LT(process.err.size(), 1000U);
    }
  }
}

TEST(Cli, InvalidScenesAreReportedInOneLine) {
  const Scratch scratch;
  const std::pair<std::string, std::string> scenes[] = {
      {"[camera]\nyaw_dge = 3\n", "FILE:2: unknown parameter 'camera.yaw_dge'; did you mean 'camera.yaw_deg'?"},
      {"[cmaera]\nyaw_deg = 3\n", "FILE:1: unknown table [cmaera]; did you mean [camera]?"},
      {"[camera]\nyaw_deg = '3'\n", "FILE:2: 'camera.yaw_deg' is a string; expected -3600 to 3600 deg"},
      {"[camera]\nyaw_deg = inf\n",
       "FILE:2: 'camera.yaw_deg' = 'inf' is not a finite number; expected -3600 to 3600 deg"},
      {std::string("\x7f"
                   "ELF\x80\xff",
                   6),
       "FILE: not a text file; expected a scene file: TOML in UTF-8"},
  };
  for (const auto& [text, message] : scenes) {
    const std::string path = scratch.write("scene.toml", text);
    std::string expected = message;
    expected.replace(expected.find("FILE"), 4, path);
    expect_error(run_tyndall({"params", path}), 2, expected);
  }
  const ProcessResult cut = run_tyndall({"params", scratch.write("scene.toml", "[camera]\nposition_m = [1, 2")});
  EXPECT_EQ(cut.status, 2);
  EXPECT_NE(cut.err.find("scene.toml:2: not valid TOML: "), std::string::npos) << cut.err;
  EXPECT_EQ(run_tyndall({"params", scratch.write("scene.toml", "")}).status, 0);
}

TEST(Cli, ParamsRoundTrip) {
  const Scratch scratch;
  const ProcessResult defaults = run_tyndall({"params"});
  EXPECT_EQ(defaults.status, 0);
  EXPECT_EQ(run_tyndall({"params", "--format", "toml"}).out, defaults.out);
  const ProcessResult changed =
      run_tyndall({"params", "--set", "sun.elevation_deg=1.1", "--set", "sun.elevation_deg=-0.1", "--set",
                   "atmosphere.rayleigh_scattering=5.8e-6,13.5e-6,33.3e-6", "--set", "terrain.source=a \"b\".tif"});
  ASSERT_EQ(changed.status, 0) << changed.err;
  EXPECT_NE(changed.out.find("\nelevation_deg = -0.1\n"), std::string::npos);
  EXPECT_NE(changed.out.find("\nrayleigh_scattering = [5.8e-06, 1.35e-05, 3.33e-05]\n"), std::string::npos);
  const std::string scene = scratch.write("scene.toml", changed.out);
  EXPECT_EQ(run_tyndall({"params", scene}).out, changed.out);
  // --set overrides the scene, in any order of the arguments.
  EXPECT_EQ(run_tyndall({"params", "--set", "sun.elevation_deg=-0.1", "--set=terrain.source=a \"b\".tif", scene}).out,
            changed.out);
  EXPECT_NE(run_tyndall({"params", "--set", "sun.elevation_deg=6", scene}).out, changed.out);
}

TEST(Cli, ParamsAsJsonIsTheWholeTable) {
  const ProcessResult process = run_tyndall({"params", "--format", "json", "--set", "camera.position_m=1,2.5,-3"});
  ASSERT_EQ(process.status, 0) << process.err;
  const nlohmann::json document = nlohmann::json::parse(process.out);
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
      EXPECT_EQ(list[i]["choices"], nlohmann::json({"cornette-shanks", "henyey-greenstein", "draine", "table"}));
    }
  }
}

TEST(Cli, AFullStandardOutputIsAFailure) {
  const ProcessResult process = run_tyndall({"params"}, "/dev/full");
  EXPECT_EQ(process.status, 1);
  EXPECT_EQ(process.err, "tyndall: error: standard output: cannot write; expected an open stream with free space\n");
}

}  // namespace
}  // namespace tyndall::cli
