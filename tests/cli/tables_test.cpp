// `tyndall tables`: its report, its export, and all kinds of errors; and the cache of the tables, which all verbs
// share.
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <nlohmann/json.hpp>
#include <numbers>

#include "files/text.hpp"
#include "image/image.hpp"
#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

constexpr double kPi = std::numbers::pi;

const std::vector<std::string> kSmall = {"--set", "tables.size=4,16,12,6", "--set", "tables.orders=1"};
const std::vector<std::string> kTwoOrders = {"--set", "tables.orders=2"};

class CliTables : public testing::Test {
 protected:
  // Runs a verb with small tables and a separate cache.
  [[nodiscard]] ProcessResult run(const std::string& verb, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), kSmall.begin(), kSmall.end());
    more.insert(more.begin(), verb);
    more.insert(more.end(), {"--set", "tables.cache=" + scratch_.at("cache")});
    return run_tyndall(more);
  }
  static std::vector<std::string> names(const std::string& directory) {
    std::vector<std::string> out;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(directory, missing))
      out.push_back(entry.path().filename());
    std::sort(out.begin(), out.end());
    return out;
  }
  [[nodiscard]] std::vector<std::string> cached() const { return names(scratch_.at("cache")); }
  static image::Image picture(const std::string& path) {
    Result<image::File> file = image::read(path);
    EXPECT_TRUE(file.ok()) << path;
    return file ? std::move(file).value().image : image::Image(1, 1);
  }

  Scratch scratch_;
};

TEST_F(CliTables, EveryStageHasATime) {
  const ProcessResult process = run("tables", {"--json", kTwoOrders[0], kTwoOrders[1]});
  ASSERT_EQ(process.status, 0) << process.err;
  EXPECT_EQ(process.err, "");
  const nlohmann::json report = nlohmann::json::parse(process.out);
  EXPECT_EQ(report["size"], nlohmann::json({4, 16, 12, 6}));
  EXPECT_EQ(report["orders"], 2);
  EXPECT_EQ(report["stages"].size(), 10U);
  double sum = 0.0;
  for (const nlohmann::json& stage : report["stages"]) {
    EXPECT_GT(stage["ms"].get<double>(), 0.0) << stage["name"];
    sum += stage["ms"].get<double>();
  }
  EXPECT_NEAR(report["stages_ms"].get<double>(), sum, 1e-6 * sum);
  EXPECT_GT(report["total_ms"].get<double>(), 0.0);
  for (const char* const table : {"single_rayleigh", "single_mie", "high_orders"})
    EXPECT_GE(report["memory_bytes"][table], 8 * 4 * 16 * 12 * 6) << table;
  EXPECT_GE(report["memory_bytes"]["sun_transmittance"], 8 * 64 * 256);
  EXPECT_GE(report["memory_bytes"]["sky_irradiance"], 8 * 64 * 256);
  EXPECT_GT(report["memory_bytes"]["while_building"], 0);
  EXPECT_EQ(report["cache"], scratch_.at("cache"));
  EXPECT_TRUE(report["files"].is_null());
  const ProcessResult text = run("tables", kTwoOrders);
  EXPECT_EQ(text.status, 0);
  for (const nlohmann::json& stage : report["stages"])
    EXPECT_NE(text.out.find("  " + stage["name"].get<std::string>()), std::string::npos);
  EXPECT_NE(text.out.find("\nstored in " + scratch_.at("cache") + "\n"), std::string::npos);
}

// An export of tables, and queries of `probe` whose results its texels must equal.
struct Export {
  struct Texel {
    std::uint32_t altitude, view, sun, angle;
  };
  std::string name;  // for messages
  nlohmann::json axes;
  std::vector<std::vector<image::Image>> tables;
  std::vector<Texel> texels;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> lights;  // texels of the 2D look-up tables

  [[nodiscard]] std::string scattering_queries();
  [[nodiscard]] std::string light_queries();
  void expect_scattering(const nlohmann::json& answers) const;
  void expect_light(const nlohmann::json& answers) const;
};

// Adds the texels of the scattering tables that correspond to rays of `probe`, and returns these rays.
std::string Export::scattering_queries() {
  std::string queries;
  const nlohmann::json& scattering = axes["scattering"];
  for (std::uint32_t a = 0; a < 4; ++a) {
    const nlohmann::json& views = scattering["view_zenith_by_altitude"][a];
    EXPECT_EQ(views["cosine"].size(), 16U);
    for (std::uint32_t v = 0; v < 16; ++v) {
      const double mu = views["cosine"][v];
      EXPECT_NEAR(std::cos(views["deg"][v].get<double>() * kPi / 180.0), mu, 1e-12);
      // At the horizon itself, rounding decides on which side a ray is.
      if (v == 0 || v == 15 || views["ends_on_ground"][v - 1] != views["ends_on_ground"][v] ||
          views["ends_on_ground"][v + 1] != views["ends_on_ground"][v]) {
        continue;
      }
      // Leave out the darkest sun: devices filter with limited precision, so the next and much brighter sun contributes
      // to it.
      for (std::uint32_t s = 1; s < 12; ++s) {
        for (std::uint32_t n = 0; n < 6; ++n) {
          const double nu = scattering["view_sun"]["cosine"][n];
          // The table has the sun's zenith angle at the density-weighted mean distance, the query that at the ray's
          // origin.
          const double r = 6360000.0 + scattering["altitude_m"][a].get<double>();
          const double d = views["mean_distance_m"][v];
          const double r_middle = std::sqrt(r * r + d * d + 2.0 * r * d * mu);
          const double mu_s = (r_middle * scattering["sun_zenith"]["cosine"][s].get<double>() - d * nu) / r;
          if (std::abs(mu_s) >= 1.0) continue;
          const double spread = std::sqrt((1.0 - mu * mu) * (1.0 - mu_s * mu_s));
          if (spread < 1e-3 || std::abs(nu - mu * mu_s) > 0.999 * spread) continue;
          texels.push_back({a, v, s, n});
          queries += files::number_text(scattering["altitude_m"][a].get<double>()) + "," +
                     files::number_text(views["deg"][v].get<double>()) + "," +
                     files::number_text(std::acos(mu_s) * 180.0 / kPi) + "," +
                     files::number_text(std::acos((nu - mu * mu_s) / spread) * 180.0 / kPi) + "\n";
        }
      }
    }
  }
  return queries;
}

// Adds some texels of the sky irradiance look-up table, and returns the queries of `probe` that correspond to them.
std::string Export::light_queries() {
  std::string queries;
  const nlohmann::json& light = axes["light"];
  for (std::uint32_t x = 0; x < 64; x += 9) {
    for (std::uint32_t y = 60; y < 256; y += 14) {
      const double cosine = light["cos_horizon"][x].get<double>() + light["cos_sun_from_horizon"][y].get<double>();
      if (std::abs(cosine) > 1.0) continue;
      lights.emplace_back(x, y);
      queries += files::number_text(light["altitude_m"][x].get<double>()) + ",sky," +
                 files::number_text(std::acos(cosine) * 180.0 / kPi) + ",\n";
    }
  }
  return queries;
}

void Export::expect_scattering(const nlohmann::json& answers) const {
  const double g = 0.76;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const Texel& t = texels[i];
    const double nu = axes["scattering"]["view_sun"]["cosine"][t.angle];
    const double rayleigh = 3.0 / (16.0 * kPi) * (1.0 + nu * nu);
    // Cornette and Shanks (1992).
    const double mie =
        3.0 / (8.0 * kPi) * (1.0 - g * g) / (2.0 + g * g) * (1.0 + nu * nu) / std::pow(1.0 + g * g - 2.0 * g * nu, 1.5);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto value = [&](std::size_t table) {
        return double{tables[table][t.altitude].pixel(t.sun + 12 * t.angle, t.view)[c]};
      };
      const double expected = rayleigh * value(0) + mie * value(1) + value(2);
      EXPECT_NEAR(answers[i]["L"][c].get<double>(), expected, 0.01 * expected + 1e-9)
          << name << ' ' << t.altitude << ' ' << t.view << ' ' << t.sun << ' ' << t.angle << ' ' << c;
    }
  }
}

void Export::expect_light(const nlohmann::json& answers) const {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto [x, y] = lights[i];
    const nlohmann::json& answer = answers[texels.size() + i];
    for (std::size_t c = 0; c < 3; ++c) {
      const double sky = tables[4][0].pixel(x, y)[c];
      EXPECT_NEAR(answer["L"][c].get<double>(), sky, 0.002 * sky + 1e-9) << x << ' ' << y;
      // The sun's disc is not a point at the horizon.
      if (std::abs(axes["light"]["cos_sun_from_horizon"][y].get<double>()) < 0.01) continue;
      const double sun = tables[3][0].pixel(x, y)[c];
      EXPECT_NEAR(answer["T"][c].get<double>(), sun, 0.002 * sun + 1e-6) << x << ' ' << y;
    }
  }
}

// The exported values equal the results of `probe` for the rays that tables.json describes.
TEST_F(CliTables, TheExportHoldsWhatTheRendererReads) {
  for (const std::string parameterization : {"yusov", "bruneton", "linear"}) {
    const std::string directory = scratch_.at(parameterization);
    const std::vector<std::string> set = {"--set", "tables.parameterization=" + parameterization, kTwoOrders[0],
                                          kTwoOrders[1]};
    std::vector<std::string> arguments = set;
    arguments.insert(arguments.end(), {"-o", directory});
    const ProcessResult process = run("tables", arguments);
    ASSERT_EQ(process.status, 0) << process.err;
    const nlohmann::json index = nlohmann::json::parse(contents_of(directory + "/tables.json"));
    EXPECT_EQ(index["format"], "tyndall tables 1");
    EXPECT_EQ(index["parameters"]["tables.parameterization"], parameterization);
    EXPECT_FALSE(index["parameters"].contains("tables.cache"));
    // These affect the tables among others.
    EXPECT_EQ(index["parameters"]["atmosphere.mie_phase"], "cornette-shanks");
    EXPECT_EQ(index["parameters"]["scattering.color"], "rgb");
    EXPECT_EQ(index["channels_nm"], nlohmann::json({680.0, 550.0, 440.0}));
    Export exported;
    exported.name = parameterization;
    exported.axes = index["axes"];
    const nlohmann::json& axes = index["axes"]["scattering"];
    ASSERT_EQ(axes["altitude_m"].size(), 4U);
    ASSERT_EQ(axes["view_zenith_by_altitude"].size(), 4U);
    ASSERT_EQ(axes["sun_zenith"]["cosine"].size(), 12U);
    ASSERT_EQ(axes["view_sun"]["cosine"].size(), 6U);

    // Exactly these files are exported.
    std::vector<std::string> files = {"tables.json"};
    for (const nlohmann::json& table : index["tables"]) {
      exported.tables.emplace_back();
      for (const nlohmann::json& file : table["files"]) {
        files.push_back(file["file"]);
        exported.tables.back().push_back(picture(directory + "/" + files.back()));
      }
    }
    std::sort(files.begin(), files.end());
    EXPECT_EQ(names(directory), files);
    ASSERT_EQ(exported.tables.size(), 5U);

    const std::string queries = "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n" +
                                exported.scattering_queries() + exported.light_queries();
    ASSERT_GT(exported.texels.size(), 100U);
    arguments = set;
    arguments.insert(arguments.end(), {"--json", "--queries", scratch_.write("q.csv", queries)});
    const ProcessResult probed = run("probe", arguments);
    ASSERT_EQ(probed.status, 0) << probed.err;
    const nlohmann::json answers = nlohmann::json::parse(probed.out)["answers"];
    ASSERT_EQ(answers.size(), exported.texels.size() + exported.lights.size());
    exported.expect_scattering(answers);
    exported.expect_light(answers);
  }
}

TEST_F(CliTables, ExportsAreCompleteOrMissing) {
  const std::string directory = scratch_.at("out");
  const auto with_limit = [&](rlim_t bytes) {
    rlimit unlimited = {};
    EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &unlimited), 0);
    rlimit small = unlimited;
    small.rlim_cur = bytes;
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    // The cache is off, because the limit would also prevent it from being written.
    ProcessResult process = run_tyndall(
        {"tables", "-o", directory, kSmall[0], kSmall[1], kSmall[2], kSmall[3], "--set", "tables.cache=off"});
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &unlimited), 0);
    return process;
  };
  expect_one_line(with_limit(6000), 1, "cannot write");
  EXPECT_FALSE(std::filesystem::exists(directory));
  ASSERT_EQ(run("tables", {"-o", directory}).status, 0);
  const std::vector<std::string> before = names(directory);
  const std::string index = contents_of(directory + "/tables.json");
  const std::string table = contents_of(directory + "/high_orders_0002.exr");
  ASSERT_EQ(before.size(), 15U);
  expect_one_line(with_limit(6000), 1, "cannot write");
  EXPECT_EQ(names(directory), before);
  EXPECT_EQ(contents_of(directory + "/tables.json"), index);
  EXPECT_EQ(contents_of(directory + "/high_orders_0002.exr"), table);
  // A second export to the same directory writes the same bytes.
  ASSERT_EQ(run("tables", {"-o", directory + "/"}).status, 0);
  EXPECT_EQ(contents_of(directory + "/tables.json"), index);
  EXPECT_EQ(contents_of(directory + "/high_orders_0002.exr"), table);
}

TEST_F(CliTables, ErrorsAreReported) {
  const std::string file = scratch_.write("file", "x");
  expect_one_line(run("tables", {"-o", file}), 1, "it is a file");
  expect_one_line(run("tables", {"-o", file + "/below"}), 1, "cannot write");
  expect_one_line(run("tables", {"-o", scratch_.at("none/below")}), 1, "No such file or directory");
  expect_one_line(run("tables", {"-o", ""}), 2, "-o: empty directory name; expected -o DIR");
  expect_one_line(run_tyndall({"tables", "-o"}), 2, "-o");
  expect_one_line(run("tables", {"--size", "3x4"}), 2, "--size");
  expect_one_line(run("tables", {"--device", "none such"}), 2, "no Vulkan device 'none such'");
  expect_one_line(run_tyndall({"tables", "--set", "tables.size=8,15,8,8"}), 2, "tables.size");
  expect_one_line(run_tyndall({"tables", "--set", "tables.size=4096,4096,4096,4096"}), 2, "tables.size");
  expect_one_line(run_tyndall({"tables", "--set", "tables.cache="}), 2,
                  "tables.cache: empty value; expected auto, off or a directory");
  expect_one_line(run_tyndall({"tables", "--set", "tables.cache_limit_mib=0"}), 2, "tables.cache_limit_mib");
  // The files have three channels.
  expect_one_line(run("tables", {"-o", scratch_.at("out"), "--set", "scattering.color=spectral"}), 2,
                  "-o: scattering.color = spectral has tables at four wavelengths; expected scattering.color = rgb");
  EXPECT_EQ(names(scratch_.at("")), std::vector<std::string>{"file"});
}

class CliTableCache : public CliTables {
 protected:
  // Returns {"from", "ms"}, or null after a failure.
  nlohmann::json sky(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"-o", scratch_.at("sky.exr"), "--size", "8x4", "--json", "--sun-elevation-deg", "20",
                               "--sun-azimuth-deg", "0"});
    const ProcessResult process = run("sky", more);
    EXPECT_EQ(process.status, 0) << process.err;
    err_ = process.err;
    return process.status == 0 ? nlohmann::json::parse(process.out)["tables"] : nlohmann::json();
  }
  std::string err_;
};

TEST_F(CliTableCache, AllVerbsShareIt) {
  EXPECT_EQ(sky()["from"], "build");
  EXPECT_EQ(err_, "");
  ASSERT_EQ(cached().size(), 1U);
  EXPECT_EQ(sky()["from"], "cache");
  const std::string built = contents_of(scratch_.at("sky.exr"));
  // A cached file that is used is not rewritten.
  struct stat before {};
  const std::string path = scratch_.at("cache/" + cached()[0]);
  ASSERT_EQ(::stat(path.c_str(), &before), 0);
  const std::string queries =
      scratch_.write("q.csv", "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n0,1,2,3\n");
  EXPECT_EQ(run("probe", {"--queries", queries}).status, 0);
  EXPECT_EQ(run("render", {"--size", "16x9", "-o", scratch_.at("a.png")}).status, 0);
  EXPECT_EQ(run("bench", {"--size", "16x9", "--frames", "1"}).status, 0);
  ASSERT_EQ(cached().size(), 1U);
  struct stat after {};
  ASSERT_EQ(::stat(path.c_str(), &after), 0);
  EXPECT_EQ(after.st_ino, before.st_ino);
  // `tables` always builds, and stores the result.
  EXPECT_EQ(run("tables").status, 0);
  ASSERT_EQ(cached().size(), 1U);
  ASSERT_EQ(::stat(path.c_str(), &after), 0);
  EXPECT_NE(after.st_ino, before.st_ino);
  // Another medium or another table size uses another file.
  EXPECT_EQ(sky({"--set", "atmosphere.mie_g=0.7"})["from"], "build");
  EXPECT_EQ(sky({"--set", "tables.parameterization=linear"})["from"], "build");
  EXPECT_EQ(cached().size(), 3U);
  EXPECT_EQ(sky({"--set", "sun.irradiance=3", "--set", "tables.cache_limit_mib=5"})["from"], "cache");
  EXPECT_EQ(cached().size(), 3U);
}

TEST_F(CliTableCache, ItsFolderCanBeChosen) {
  const std::string own = ::getenv("XDG_CACHE_HOME");
  ::setenv("XDG_CACHE_HOME", scratch_.at("xdg").c_str(), 1);
  std::vector<std::string> arguments = {"tables", "--json"};
  arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
  EXPECT_EQ(run_tyndall(arguments).status, 0);
  EXPECT_EQ(names(scratch_.at("xdg/tyndall")).size(), 1U);
  std::filesystem::remove_all(scratch_.at("xdg"));
  arguments.insert(arguments.end(), {"--set", "tables.cache=off"});
  const ProcessResult off = run_tyndall(arguments);
  EXPECT_EQ(off.status, 0);
  EXPECT_TRUE(nlohmann::json::parse(off.out)["cache"].is_null());
  EXPECT_FALSE(std::filesystem::exists(scratch_.at("xdg/tyndall")));
  ::setenv("XDG_CACHE_HOME", own.c_str(), 1);
}

TEST_F(CliTableCache, DamagedFilesAreReportedInOneLineAndRebuilt) {
  sky();
  const std::string good = contents_of(scratch_.at("sky.exr"));
  ASSERT_EQ(cached().size(), 1U);
  const std::string name = "cache/" + cached()[0];
  std::string bytes = contents_of(scratch_.at(name));
  bytes[bytes.size() / 2] ^= 8;
  for (const auto& [contents, why] : {std::pair(bytes, "damaged"), std::pair(bytes.substr(0, 100000), "truncated")}) {
    scratch_.write(name, contents);
    EXPECT_EQ(sky()["from"], "build");
    EXPECT_EQ(err_, "tyndall: note: the cached file " + scratch_.at(name) + " is " + why + " and is rebuilt\n");
    EXPECT_EQ(contents_of(scratch_.at("sky.exr")), good);
  }
  EXPECT_EQ(sky()["from"], "cache");
  EXPECT_EQ(err_, "");
  // A cache that cannot be written also gives one line, for every verb.
  const std::string blocked = "tables.cache=" + scratch_.write("blocked", "");
  const std::string queries =
      scratch_.write("q.csv", "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n0,1,2,3\n");
  const std::vector<std::vector<std::string>> verbs = {{"tables"},
                                                       {"probe", "--queries", queries},
                                                       {"render", "--size", "16x9", "-o", scratch_.at("a.png")},
                                                       {"bench", "--size", "16x9", "--frames", "1"}};
  for (std::vector<std::string> arguments : verbs) {
    arguments.insert(arguments.end(), kSmall.begin(), kSmall.end());
    arguments.insert(arguments.end(), {"--set", blocked});
    const ProcessResult process = run_tyndall(arguments);
    EXPECT_EQ(process.status, 0) << process.err;
    EXPECT_EQ(process.err.rfind("tyndall: note: nothing is cached: ", 0), 0U) << arguments[0] << process.err;
    EXPECT_EQ(std::count(process.err.begin(), process.err.end(), '\n'), 1) << process.err;
  }
}

TEST_F(CliTableCache, ProcessesShareIt) {
  const std::string queries =
      scratch_.write("q.csv", "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n0,70,50,3\n");
  std::vector<std::future<ProcessResult>> running;
  for (int i = 0; i < 3; ++i)
    running.push_back(std::async(std::launch::async, [&] { return run("probe", {"--queries", queries}); }));
  std::vector<ProcessResult> results;
  for (std::future<ProcessResult>& one : running) results.push_back(one.get());
  results.push_back(run("probe", {"--queries", queries}));
  for (const ProcessResult& process : results) {
    EXPECT_EQ(process.status, 0);
    EXPECT_EQ(process.err, "");
    EXPECT_EQ(process.out, results[0].out);
  }
  EXPECT_EQ(cached().size(), 1U);  // no temporary file is left
}

TEST_F(CliTableCache, OneOfSeveralProcessesBuildsTheTables) {
  std::vector<std::future<ProcessResult>> running;
  for (int i = 0; i < 3; ++i) {
    running.push_back(std::async(std::launch::async, [this, i] {
      return run("sky", {"-o", scratch_.at(std::to_string(i) + ".exr"), "--size", "8x4", "--json",
                         "--sun-elevation-deg", "20", "--sun-azimuth-deg", "0"});
    }));
  }
  int built = 0;
  for (std::future<ProcessResult>& one : running) {
    const ProcessResult process = one.get();
    ASSERT_EQ(process.status, 0) << process.err;
    EXPECT_EQ(process.err, "");
    if (nlohmann::json::parse(process.out)["tables"]["from"] == "build") ++built;
  }
  EXPECT_EQ(built, 1);
  EXPECT_EQ(cached().size(), 1U);
}

}  // namespace
}  // namespace tyndall::cli
