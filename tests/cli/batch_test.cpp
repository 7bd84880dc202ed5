// --shard, --resume and `tyndall merge`: the parts of a run give the same bytes as one run.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "../sanitizers.hpp"
#include "manifest.hpp"
#include "merge_tables.hpp"
#include "run_tyndall.hpp"
#include "shard.hpp"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;

TEST(CliBatch, ShardsAreDisjointAndComplete) {
  for (const std::uint64_t total : {0U, 1U, 5U, 12U}) {
    for (std::uint32_t count = 1; count < 8; ++count) {
      std::vector<int> taken(total, 0);
      for (std::uint32_t index = 0; index < count; ++index) {
        for (const std::uint64_t item : Shard{index, count}.items(total)) {
          ++taken.at(item);
          EXPECT_EQ(item % count + 1, index + 1);
        }
      }
      EXPECT_EQ(std::count(taken.begin(), taken.end(), 1), static_cast<std::ptrdiff_t>(total));
    }
  }
}

TEST(CliBatch, ShardsAreParsed) {
  const Result<Shard> shard = parse_shard("2/4", "--shard");
  ASSERT_TRUE(shard.ok());
  EXPECT_EQ(shard.value(), (Shard{1, 4}));
  EXPECT_EQ(shard.value().text(), "2/4");
  for (const char* const text : {"", "1", "0/4", "5/4", "-1/4", "1/0", "1/4/4", "a/b", "1.5/2", "1/1000001"}) {
    const Result<Shard> bad = parse_shard(text, "--shard");
    ASSERT_FALSE(bad.ok()) << text;
    EXPECT_EQ(bad.error().message, std::string("--shard: invalid shard '") + text +
                                       "'; expected I/N with whole numbers, 1 <= I <= N <= 1000000");
  }
}

TEST(CliBatch, ManifestsAreReadBack) {
  Manifest manifest;
  manifest.verb = "render";
  manifest.version = "1.2.3";
  manifest.device = "a device";
  manifest.shard = {1, 3};
  manifest.total = 8;
  manifest.complete = true;
  manifest.inputs = {{"camera.yaw_deg", "12.5"}, {"--size", "8x4"}};
  manifest.items = {{1, "", {{"f_1.png", {12, "0123456789abcdef"}}}, 0.5}, {4, "a \"name\"", {}, 0.25, "fedc"}};
  const std::string text = to_json(manifest);
  const Result<Manifest> read = parse_manifest(text, "m.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(to_json(read.value()), text);
  EXPECT_EQ(read.value().shard, manifest.shard);
  EXPECT_EQ(read.value().inputs, manifest.inputs);
  EXPECT_EQ(read.value().items[0].files[0].sum, manifest.items[0].files[0].sum);
  EXPECT_EQ(read.value().items[1].name, "a \"name\"");
  EXPECT_EQ(read.value().items[1].inputs_hash, "fedc");
  EXPECT_EQ(read.value().input("--size"), "8x4");
  EXPECT_EQ(first_difference(manifest.inputs, {{"camera.yaw_deg", "12.5"}, {"--size", "8x5"}}), "--size");
  EXPECT_EQ(first_difference(manifest.inputs, {{"camera.yaw_deg", "12.5"}}), "--size");
  EXPECT_EQ(first_difference(manifest.inputs, manifest.inputs), "");
  // A changed parameter does not match the hash.
  std::string changed = text;
  changed.replace(changed.find("12.5"), 4, "13.5");
  for (const std::string& bad : {std::string(), std::string("[]"), std::string("{}"), text.substr(0, 100), changed}) {
    EXPECT_FALSE(parse_manifest(bad, "m.json").ok()) << bad;
  }
  const auto replaced = [&](const char* from, const char* to) {
    std::string out = text;
    return out.replace(out.find(from), std::strlen(from), to);
  };
  for (const std::string& bad :
       {replaced("\"total\": 8", "\"total\": -8"), replaced("\"total\": 8", "\"total\": 8.5"),
        replaced("\"item\": 4", "\"item\": 1"), replaced("\"seconds\": 0.5", "\"seconds\": -1"),
        replaced("\"bytes\": 12", "\"bytes\": 1e300"), replaced("\"verb\": \"render\"", "\"verb\": \"print\"")}) {
    EXPECT_FALSE(parse_manifest(bad, "m.json").ok()) << bad;
  }
  EXPECT_EQ(manifest_path("out/f_%d.png", {1, 3}), "out/f_%d.png.shard-2-of-3.json");
}

// Reading takes a time that grows with the square of the names in an object, and deep nesting needs memory.
TEST(CliBatch, ManifestsHaveLimits) {
  std::string names = R"({"format": 1, "inputs": {)";
  for (int i = 0; i < 500000; ++i) names += "\"" + std::to_string(i) + "\": \"\", ";
  names += "\"\": \"\"}}";
  const std::string deep = R"({"format": )" + std::string(5000000, '[') + std::string(5000000, ']') + "}";
  const auto begin = std::chrono::steady_clock::now();
  for (const std::string& text : {names, deep}) {
    const Result<Manifest> read = parse_manifest(text, "m.json");
    ASSERT_FALSE(read.ok());
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

TEST(CliBatch, RowsAreJoinedInTheirOrder) {
  const Result<std::string> joined = join_rows({{"n,\"a, b\"\n0,x\n2,\"z,\"\"\"\n", "1"}, {"n,\"a, b\"\n1,y\n", "2"}});
  ASSERT_TRUE(joined.ok()) << joined.error().message;
  EXPECT_EQ(joined.value(), "n,\"a, b\"\n0,x\n1,y\n2,\"z,\"\"\"\n");
  EXPECT_FALSE(join_rows({{"n\n0\n", "1"}, {"m\n1\n", "2"}}).ok());
  EXPECT_FALSE(join_rows({{"n\n0\n", "1"}, {"n\n1\n3\n", "2"}}).ok());
}

TEST(CliBatch, InfiniteMeansAreRefused) {
  const std::string good = "n,L_r,stderr_r\n0,1,inf\n", bad = "n,L_r,stderr_r\n0,inf,1\n";
  EXPECT_TRUE(combine_estimates({{good, "a", 10}, {good, "b", 10}}).ok());
  const Result<std::string> refused = combine_estimates({{good, "a", 10}, {bad, "b", 10}});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("'inf' is not a number"), std::string::npos) << refused.error().message;
}

TEST(CliBatch, EstimatesAreWeightedByTheirPaths) {
  const std::string header = "q,L_r,L_g,L_b,T_r,stderr_r,stderr_g,stderr_b\n";
  const Result<std::string> text = combine_estimates(
      {{header + "a,1,2,3,0.5,0.3,0.1,0\n", "1", 100}, {header + "a,5,2,7,0.5,0.1,0.1,inf\n", "2", 300}});
  ASSERT_TRUE(text.ok()) << text.error().message;
  const auto number = [](double value) { return nlohmann::json(value).dump(); };
  // Variances of means add as n^2 s^2.
  const double red = std::sqrt(0.25 * 0.25 * 0.3 * 0.3 + 0.75 * 0.75 * 0.1 * 0.1);
  ASSERT_EQ(text.value().rfind(header + "a,4,2,6,0.5,", 0), 0U) << text.value();
  const std::string errors = text.value().substr(header.size() + 12);
  EXPECT_NEAR(std::stod(errors), red, 1e-15);
  EXPECT_NE(errors.find(",inf"), std::string::npos) << number(red) << errors;
  EXPECT_FALSE(
      combine_estimates({{header + "a,1,2,3,0.5,0.3,0.1,0\n", "1", 1}, {header + "b,1,2,3,0.5,0.3,0.1,0\n", "2", 1}})
          .ok());
}

class CliBatchRuns : public testing::Test {
 protected:
  static ProcessResult good(const std::vector<std::string>& arguments) {
    ProcessResult process = run_tyndall(arguments);
    EXPECT_EQ(process.status, 0) << process.err;
    return process;
  }
  static std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  Scratch scratch_;
};

const std::vector<std::string> kSmall = {"--set", "tables.size=4,16,12,6", "--set", "tables.orders=1"};

TEST_F(CliBatchRuns, TablesOfShardsAndSeeds) {
  std::string queries = "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg,tag\n";
  for (int i = 0; i < 5; ++i) queries += std::to_string(i * 700 - 300) + "," + std::to_string(20 * i) + ",50,3,t\n";
  const std::string file = scratch_.write("q.csv", queries);
  const std::vector<std::string> probe = {"probe", "--queries", file, "--model", "reference", "--samples", "200"};
  good(with(probe, {"-o", scratch_.at("whole.csv")}));
  const std::string out = scratch_.at("r.csv");
  std::vector<std::string> merge = {"merge", out};
  for (int i = 1; i <= 2; ++i) {
    good(with(probe, {"-o", out, "--shard", std::to_string(i) + "/2"}));
    merge.push_back(out + ".shard-" + std::to_string(i) + "-of-2.json");
  }
  good(merge);
  EXPECT_EQ(contents_of(out), contents_of(scratch_.at("whole.csv")));

  expect_one_line(run_tyndall({"merge", out, merge[2]}), 2, "shard 2/2 with seed 1 is missing");
  expect_one_line(run_tyndall({"merge", out, merge[2], merge[2], merge[3]}), 2, "shard 1/2 with seed 1 is given twice");
  expect_one_line(run_tyndall({"merge", out, file}), 2, "q.csv: it is not a JSON object; expected a manifest");
  expect_one_line(run_tyndall({"merge", out, scratch_.at("no")}), 2, "No such file");
  expect_one_line(run_tyndall({"merge", scratch_.at("r.png"), merge[2], merge[3]}), 2,
                  "for shards of probe; expected a name that ends in .csv");
  expect_one_line(run_tyndall({"merge", scratch_.at("r.csv.shard-1-of-2.csv"), merge[2], merge[3]}), 2, "is a result");
  // Other parameters, and a table that somebody changed.
  good(with(probe, {"-o", scratch_.at("other.csv"), "--shard", "2/2", "--set", "atmosphere.mie_g=0.5"}));
  expect_one_line(run_tyndall({"merge", out, merge[2], scratch_.at("other.csv.shard-2-of-2.json")}), 2,
                  "the parameter atmosphere.mie_g is not that of");
  scratch_.write("r.csv.shard-2-of-2.csv", "x\n");
  expect_one_line(run_tyndall(merge), 2, "is missing, or not as it was written");
  // --resume makes it again, and leaves the other one.
  const auto time = fs::last_write_time(scratch_.at("r.csv.shard-1-of-2.csv"));
  for (int i = 1; i <= 2; ++i) good(with(probe, {"-o", out, "--resume", "--shard", std::to_string(i) + "/2"}));
  good(merge);
  EXPECT_EQ(contents_of(out), contents_of(scratch_.at("whole.csv")));
  EXPECT_EQ(fs::last_write_time(scratch_.at("r.csv.shard-1-of-2.csv")), time);

  // Two seeds are one estimate with a smaller error.
  std::vector<std::string> seeds = {"merge", scratch_.at("seeds.csv")};
  for (const char* const seed : {"7", "8"}) {
    const std::string table = scratch_.at(std::string("seed") + seed + ".csv");
    good(with(probe, {"-o", table, "--resume", "--seed", seed}));
    seeds.push_back(table + ".shard-1-of-1.json");
  }
  good(seeds);
  EXPECT_NE(contents_of(seeds[1]), contents_of(scratch_.at("seed7.csv")));
  EXPECT_EQ(contents_of(seeds[1]).find('\n'), contents_of(scratch_.at("seed7.csv")).find('\n'));
}

TEST_F(CliBatchRuns, OptionsThatDoNotFit) {
  const std::string queries =
      scratch_.write("q.csv", "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n0,1,2,3\n");
  const auto error = [&](const std::vector<std::string>& arguments, const std::string& part) {
    expect_one_line(run_tyndall(arguments), 2, part);
  };
  error({"render", "--shard", "3/2", "-o", scratch_.at("a.png")}, "--shard: invalid shard '3/2'");
  error({"probe", "--queries", queries, "--resume"}, "-o: no output file; expected -o FILE with --shard or --resume");
  error({"probe", "--queries", queries, "--resume", "--json", "-o", scratch_.at("r.csv")}, "--json: ");
  error({"validate", "--resume", "--json"}, "-o: no output file");
  error({"validate", "--shard", "1/2", "-o", scratch_.at("a.html"), "--markdown", scratch_.at("a.md")}, "--markdown: ");
  fs::create_directory(scratch_.at("0"));
  error({"render", "--frames", "2", "--resume", "-o", scratch_.at("%d/a.png")}, "in the name of a folder");
  error({"merge"}, "missing argument OUT");
  error({"merge", "a.csv"}, "missing argument IN");
}

// A pipe can be read only once, so that --resume could not notice other contents.
TEST_F(CliBatchRuns, PipesAreRefused) {
  const std::string pipe = scratch_.at("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::vector<std::string>& option : {std::vector<std::string>{"--resume"}, {"--shard", "1/2"}}) {
    std::thread writer(
        [&] { std::ofstream(pipe) << "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n0,60,50,30\n"; });
    std::vector<std::string> all = {"probe", "--queries", pipe, "--model", "homogeneous", "-o", scratch_.at("r.csv")};
    all.insert(all.end(), option.begin(), option.end());
    const ProcessResult result = run_tyndall(all);
    writer.join();
    expect_one_line(result, 2, "--queries: cannot be read twice; expected a regular file with --shard and --resume");
  }
}

TEST_F(CliBatchRuns, ListsOfSkies) {
  const auto sky = [&](const std::string& list, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"sky", "--list", list, "--size", "8x4", "--model", "single"};
    return run_tyndall(with(with(arguments, more), kSmall));
  };
  const auto error = [&](const std::string& rows, const std::string& part) {
    expect_one_line(sky(scratch_.write("bad.csv", rows), {"-o", scratch_.at("bad_%d.exr")}), 2, part);
  };
  error("latitude_deg,longitude_deg\n1,2\n",
        "bad.csv: no column 'time'; expected latitude_deg, longitude_deg, time or");
  error("sun_elevation_deg,sun_azimuth_deg,altitude_m\n1,2,3\n", "bad.csv: unknown column 'altitude_m'");
  error("sun_elevation_deg,sun_azimuth_deg\n1,2\n91,2\n",
        "bad.csv:3: column 'sun_elevation_deg': invalid number '91'; expected a number, -90 to 90");
  error("latitude_deg,longitude_deg,time\n1,2,yesterday\n", "bad.csv:2: column 'time': 'yesterday'");
  error("latitude_deg,longitude_deg,time\n99,2,2026-06-01T12:00Z\n", "bad.csv:2: column 'latitude_deg, longitude_deg'");
  error("sun_elevation_deg,sun_azimuth_deg\n", "bad.csv: 0 rows; expected 1 to 1000000");
  error("sun_elevation_deg,sun_azimuth_deg,time\n1,2,3\n", "given both by angles and by place and time");
  const std::string list = scratch_.write("list.csv", "latitude_deg,longitude_deg,time,name\n"
                                                      "48,11,2026-06-01T12:00Z,noon\n48,11,2026-06-01T18:00Z,evening\n"
                                                      "-30,100,2026-06-01T03:00Z,\"south, far\"\n");
  expect_one_line(sky(list, {"-o", scratch_.at("one.exr")}), 2, "3 maps in one file");
  expect_one_line(sky(list, {"-o", scratch_.at("a_%d.exr"), "--time", "x"}), 2, "--list: the sun is given both by");
  const ProcessResult whole = sky(list, {"-o", scratch_.at("a_%02d.exr"), "--sun", "split", "--json"});
  ASSERT_EQ(whole.status, 0) << whole.err;
  const nlohmann::json maps = nlohmann::json::parse(whole.out);
  ASSERT_EQ(maps.size(), 3U);
  EXPECT_EQ(maps[2]["name"], "south, far");
  EXPECT_GT(maps[0]["sun_elevation_deg"], maps[1]["sun_elevation_deg"]);
  std::vector<std::string> merge = {"merge", scratch_.at("all.json")};
  for (int i = 1; i <= 2; ++i) {
    const ProcessResult part =
        sky(list, {"-o", scratch_.at("b_%02d.exr"), "--sun", "split", "--shard", std::to_string(i) + "/2"});
    ASSERT_EQ(part.status, 0) << part.err;
    merge.push_back(scratch_.at("b_%02d.exr.shard-" + std::to_string(i) + "-of-2.json"));
  }
  for (const char* const end : {"00.exr", "01.exr", "02.exr", "00.sun.json", "02.sun.json"}) {
    ASSERT_FALSE(contents_of(scratch_.at(std::string("b_") + end)).empty()) << end;
    EXPECT_EQ(contents_of(scratch_.at(std::string("a_") + end)), contents_of(scratch_.at(std::string("b_") + end)));
  }
  good(merge);
  const nlohmann::json all = nlohmann::json::parse(contents_of(scratch_.at("all.json")));
  ASSERT_EQ(all["items"].size(), 3U);
  EXPECT_EQ(all["items"][1]["files"][1]["file"], "b_01.sun.json");
  EXPECT_EQ(all["items"][1]["name"], "evening");
  fs::remove(scratch_.at("b_01.sun.json"));
  expect_one_line(run_tyndall(merge), 2, "its file 'b_01.sun.json' is missing");
}

TEST_F(CliBatchRuns, OnlyChangedRowsOfAListAreMadeAgain) {
  const std::string header = "sun_elevation_deg,sun_azimuth_deg,name\n";
  const auto run = [&](const std::string& rows) {
    return good(with({"sky", "--list", scratch_.write("list.csv", header + rows), "--size", "8x4", "--model", "single",
                      "-o", scratch_.at("c_%d.exr"), "--resume"},
                     kSmall));
  };
  const auto map = [&](int number) { return scratch_.at("c_" + std::to_string(number) + ".exr"); };
  run("60,10,a\n30,20,b\n10,30,c\n");
  std::array<fs::file_time_type, 3> times;
  std::array<std::string, 3> maps;
  for (int i = 0; i < 3; ++i) {
    times[i] = fs::last_write_time(map(i));
    maps[i] = contents_of(map(i));
  }
  // The second row has another sun, and a row is added.
  run("60,10,a\n31,20,b\n10,30,c\n5,40,d\n");
  EXPECT_EQ(fs::last_write_time(map(0)), times[0]);
  EXPECT_NE(contents_of(map(1)), maps[1]);
  EXPECT_EQ(fs::last_write_time(map(2)), times[2]);
  EXPECT_TRUE(fs::exists(map(3)));
  const nlohmann::json manifest = nlohmann::json::parse(contents_of(scratch_.at("c_%d.exr.shard-1-of-1.json")));
  EXPECT_EQ(manifest["complete"], true);
  ASSERT_EQ(manifest["items"].size(), 4U);
  EXPECT_NE(manifest["items"][0]["inputs_hash"], manifest["items"][1]["inputs_hash"]);
  // The name is part of the map's metadata. The old second row makes the old map.
  run("60,10,other\n30,20,b\n10,30,c\n5,40,d\n");
  EXPECT_NE(contents_of(map(0)), maps[0]);
  EXPECT_EQ(contents_of(map(1)), maps[1]);
  EXPECT_EQ(fs::last_write_time(map(2)), times[2]);
}

TEST_F(CliBatchRuns, ReportsOfShards) {
  const std::vector<std::string> validate =
      with({"validate", "--rays", "18", "--samples", "2", "--orders", "1"}, kSmall);
  good(with(validate, {"-o", scratch_.at("whole.html"), "--markdown", scratch_.at("whole.md")}));
  std::vector<std::string> parts;
  for (int i = 1; i <= 2; ++i) {
    good(with(validate, {"-o", scratch_.at("r.html"), "--shard", std::to_string(i) + "/2"}));
    parts.push_back(scratch_.at("r.html.shard-" + std::to_string(i) + "-of-2.json"));
  }
  for (const char* const ending : {".html", ".md"}) {
    good(with({"merge", scratch_.at(std::string("merged") + ending)}, parts));
    EXPECT_EQ(contents_of(scratch_.at(std::string("merged") + ending)),
              contents_of(scratch_.at(std::string("whole") + ending)));
  }
}

// Starts tyndall and returns its process.
pid_t start(const std::vector<std::string>& arguments, const std::string& errors) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  const int file = ::open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (::dup2(file, STDERR_FILENO) < 0) ::_exit(127);
  std::vector<char*> argv = {const_cast<char*>("tyndall")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  ::execv(TYNDALL_EXECUTABLE, argv.data());
  ::_exit(127);
}

TEST_F(CliBatchRuns, InterruptedFramesAreResumed) {
  const std::vector<std::string> render =
      with({"render", "--size", "16x9", "--frames", "16", "--time-step", "2", "--set", "tonemap.light_adaptation=false",
            "--set", "terrain.source=none", "--set", "sun.animate=true"},
           kSmall);
  good(with(render, {"-o", scratch_.at("whole_%02d.png")}));
  const std::vector<std::string> part = with(render, {"-o", scratch_.at("f_%02d.png"), "--resume", "--shard", "1/2"});
  const pid_t child = start(part, scratch_.at("errors"));
  ASSERT_GT(child, 0);
  for (int i = 0; i < 3000 && !fs::exists(scratch_.at("f_02.png")); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const auto then = std::chrono::steady_clock::now();
  ::kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_LT(std::chrono::steady_clock::now() - then, std::chrono::seconds(kSanitizers ? 20 : 1));
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) << status;
  const std::string errors = contents_of(scratch_.at("errors"));
  EXPECT_NE(errors.find("tyndall: interrupted: "), std::string::npos) << errors;
  EXPECT_NE(errors.find(" of 8 frames are finished; --resume makes the others\n"), std::string::npos) << errors;

  // The finished frames stay as they are, and the others are made.
  const std::string first = scratch_.at("f_00.png");
  const auto time = fs::last_write_time(first);
  const std::string manifest = scratch_.at("f_%02d.png.shard-1-of-2.json");
  const nlohmann::json interrupted = nlohmann::json::parse(contents_of(manifest));
  EXPECT_EQ(interrupted["complete"], false);
  EXPECT_GE(interrupted["items"].size(), 2U);
  EXPECT_LT(interrupted["items"].size(), 8U);
  good(part);
  EXPECT_EQ(fs::last_write_time(first), time);
  good(with(render, {"-o", scratch_.at("f_%02d.png"), "--shard", "2/2"}));
  good({"merge", scratch_.at("all.json"), manifest, scratch_.at("f_%02d.png.shard-2-of-2.json")});
  for (int i = 0; i < 16; ++i) {
    const std::string number = std::to_string(100 + i).substr(1);
    ASSERT_FALSE(contents_of(scratch_.at("f_" + number + ".png")).empty());
    EXPECT_EQ(contents_of(scratch_.at("f_" + number + ".png")), contents_of(scratch_.at("whole_" + number + ".png")));
  }
  // Other parameters: everything is made again, and a note says why.
  const ProcessResult other = good(with(part, {"--set", "camera.yaw_deg=7"}));
  EXPECT_NE(other.err.find("has other parameters (camera.yaw_deg); everything is made again"), std::string::npos)
      << other.err;
  EXPECT_NE(fs::last_write_time(first), time);
}

}  // namespace
}  // namespace tyndall::cli
