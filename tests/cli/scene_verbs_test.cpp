// `render`, `bench` and `devices` with all kinds of errors: one line, the right status, and no files left behind.
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "image/image.hpp"
#include "run_tyndall.hpp"

namespace tyndall::cli {
namespace {

// Sets environment variables for subsequent runs, and restores the old values at the end.
class Environment {
 public:
  Environment(std::initializer_list<std::pair<const char*, std::string>> values) {
    for (const auto& [name, value] : values) {
      const char* const before = std::getenv(name);
      saved_.emplace_back(name, before != nullptr ? std::optional<std::string>(before) : std::nullopt);
      ::setenv(name, value.c_str(), 1);
    }
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
  ~Environment() {
    for (const auto& [name, value] : saved_) {
      if (value) {
        ::setenv(name, value->c_str(), 1);
      } else {
        ::unsetenv(name);
      }
    }
  }

 private:
  std::vector<std::pair<const char*, std::optional<std::string>>> saved_;
};

class CliScenes : public testing::Test {
 protected:
  // Returns the number of files in the folder.
  [[nodiscard]] std::size_t files() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(scratch_.at(""))) ++count;
    return count;
  }
  ProcessResult render(std::vector<std::string> more) const {
    more.insert(more.begin(), {"render", "--size", "16x9", "-o", scratch_.at("out.png")});
    return run_tyndall(more);
  }

  Scratch scratch_;
};

TEST_F(CliScenes, ScenesThatCannotBeRead) {
  const std::string cut = scratch_.write("cut.toml", "[camera]\nposition_m = [0.0, 5600.0,");
  const std::string binary = scratch_.write("binary.toml", std::string("\x89PNG\0\0", 6));
  const std::string unknown = scratch_.write("unknown.toml", "[camera]\nyaw = 3\n");
  for (const char* const verb : {"render", "bench"}) {
    std::vector<std::string> more = {verb};
    if (std::string(verb) == "render") more.insert(more.end(), {"-o", scratch_.at("out.png")});
    const auto with = [&](const std::string& scene) {
      std::vector<std::string> arguments = more;
      arguments.push_back(scene);
      return run_tyndall(arguments);
    };
    expect_one_line(with("/nonexistent.toml"), 2, "'/nonexistent.toml': cannot read");
    expect_one_line(with("/"), 2, "Is a directory");
    expect_one_line(with(cut), 2, "not valid TOML");
    expect_one_line(with(binary), 2, "not a text file");
    expect_one_line(with(unknown), 2, "unknown parameter 'camera.yaw'");
  }
  EXPECT_EQ(files(), 3U);
}

TEST_F(CliScenes, SizesCountsAndOutputs) {
  for (const char* const size : {"0x0", "100000x100000", "16x", "16385x1"}) {
    expect_one_line(run_tyndall({"render", "--size", size, "-o", scratch_.at("a.png")}), 2, "invalid size");
    expect_one_line(run_tyndall({"bench", "--size", size}), 2, "invalid size");
  }
  expect_one_line(render({"--frames", "0"}), 2, "invalid count '0'");
  expect_one_line(render({"--frames", "2"}), 2, "2 frames in one file");
  expect_one_line(run_tyndall({"bench", "--frames", "0"}), 2, "invalid count '0'");
  expect_one_line(run_tyndall({"render"}), 2, "no output file");
  expect_one_line(run_tyndall({"render", "-o", scratch_.at("a.jpg")}), 2, "unknown format");
  expect_one_line(run_tyndall({"render", "-o", scratch_.at("none/a.png")}), 1, "No such file or directory");
  ASSERT_TRUE(std::filesystem::create_directory(scratch_.at("folder.png")));
  expect_one_line(run_tyndall({"render", "-o", scratch_.at("folder.png")}), 1, "folder.png");
  EXPECT_EQ(files(), 1U);
}

TEST_F(CliScenes, InvalidElevationFilesAreReported) {
  std::string grid = "ncols 8\nnrows 8\nxllcorner 0\nyllcorner 0\ncellsize 500\n";
  for (int i = 0; i < 64; ++i) grid += std::to_string(100 * (i % 7)) + (i % 8 == 7 ? "\n" : " ");
  // The first bytes of a TIFF, without the directory that they refer to.
  const std::pair<std::string, std::string> sources[] = {
      {"/nonexistent.tif", "does not exist"},
      {scratch_.at(""), "is a directory"},
      {scratch_.write("empty.tif", ""), "is empty"},
      {scratch_.write("cut.tif", std::string("II*\0\x08\0\0\0", 8)), "cut.tif"},
      {scratch_.write("cut.asc", grid.substr(0, grid.size() / 2)), "cut.asc"},
      {scratch_.write("text.tif", "no elevations"), "text.tif"},
      {scratch_.write("narrow.asc", "ncols 1\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 500\n1\n2\n3\n4\n"),
       "narrow.asc"},
      {scratch_.write("holes.asc",
                      "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 500\nNODATA_value -1\n-1 -1\n-1 -1\n"),
       "holes.asc"},
  };
  for (const auto& [source, part] : sources) {
    const ProcessResult process = render({"--set", "terrain.source=" + source});
    EXPECT_TRUE(process.status == 1 || process.status == 2);
    expect_one_line(process, process.status, part);
    EXPECT_FALSE(std::filesystem::exists(scratch_.at("out.png")));
  }
}

TEST_F(CliScenes, OutputsAreNotWrittenOverInputs) {
  const std::string dem = scratch_.write("dem.png", "an elevation file");
  const std::string gltf =
      scratch_.write("model.gltf", R"({"images": [{"uri": "wood%20grain.png"}], "buffers": [{"uri": "data:,"}]})");
  const std::string texture = scratch_.write("wood grain.png", "a texture");
  const std::string scene = scratch_.write("scene.exr", "[camera]\nyaw_deg = 1.0\n");
  const std::string frame = scratch_.write("out.0003.png", "a frame that is an elevation file");
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& why) {
    const ProcessResult process = run_tyndall(arguments);
    EXPECT_EQ(process.status, 2) << process.err;
    EXPECT_NE(process.err.find(why), std::string::npos) << process.err;
  };
  refused({"render", "--set", "terrain.source=" + dem, "-o", dem}, "is terrain.source of this run; expected");
  refused({"render", "--set", "meshes.source=" + gltf, "-o", texture},
          "is a file of meshes.source of this run; expected");
  // A virtual raster that refers to a virtual raster, which refers to a grid.
  const std::string grid =
      scratch_.write("grid.png", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 500\n1 2\n3 4\n");
  const auto raster_of = [](const std::string& file) {
    return "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><VRTRasterBand dataType=\"Float32\" band=\"1\">"
           "<SimpleSource><SourceFilename relativeToVRT=\"1\">" +
           file +
           "</SourceFilename><SourceBand>1</SourceBand>"
           "</SimpleSource></VRTRasterBand></VRTDataset>";
  };
  const std::string inner = scratch_.write("inner.png", raster_of("grid.png"));
  const std::string outer = scratch_.write("outer.vrt", raster_of("inner.png"));
  for (const std::string& file : {grid, inner}) {
    refused({"render", "--set", "terrain.source=" + outer, "-o", file},
            "is a file of terrain.source of this run; expected");
  }
  refused({"render", scene, "-o", scene}, "is the scene file of this run; expected");
  refused({"render", "--set", "terrain.source=" + frame, "--frames", "5", "-o", scratch_.at("out.%04d.png")},
          "is terrain.source of this run; expected");
  refused({"sky", scene, "-o", scene, "--sun-elevation-deg", "5", "--sun-azimuth-deg", "5"},
          "is the scene file of this run; expected");
  const std::string queries =
      scratch_.write("q.csv", "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n0,0,0,0\n");
  refused({"probe", "--queries", queries, "-o", queries}, "is the file of queries of this run; expected");
  EXPECT_EQ(contents_of(dem), "an elevation file");
  EXPECT_EQ(contents_of(texture), "a texture");
  EXPECT_EQ(contents_of(frame), "a frame that is an elevation file");
}

// Values outside their sets are rejected like other bad input, before a device is opened.
TEST_F(CliScenes, InvalidRangesAreBadInput) {
  for (const std::string& setting : {std::string("scattering.downscale=3"), std::string("tables.size=32,127,64,16")}) {
    const ProcessResult process =
        run_tyndall({"render", "--device", "no such device", "--set", setting, "-o", scratch_.at("a.png")});
    EXPECT_EQ(process.status, 2);
    EXPECT_EQ(process.err.find("no such device"), std::string::npos) << process.err;
    EXPECT_NE(process.err.find("expected"), std::string::npos) << process.err;
  }
}

TEST_F(CliScenes, InvalidMeshFilesAreReported) {
  const std::pair<std::string, std::string> sources[] = {
      {"/nonexistent.glb", "/nonexistent.glb"},
      {scratch_.at(""), "Is a directory"},
      {scratch_.write("empty.gltf", ""), "is not a glTF file"},
      {scratch_.write("text.gltf", "no meshes"), "is not a glTF file"},
      {scratch_.write("cut.glb", std::string("glTF\2\0\0\0\x40\0\0\0", 12)),
       "cut.glb: is a .glb that states 64 bytes and has 12"},
      {scratch_.write("bare.gltf", R"({"asset":{"version":"2.0"}})"), "no triangles"},
      {scratch_.write("outside.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":12,"uri":"none.bin"}]})"),
       "none.bin"},
  };
  for (const auto& [source, part] : sources) {
    const ProcessResult process = render({"--set", "terrain.source=none", "--set", "meshes.source=" + source});
    EXPECT_TRUE(process.status == 1 || process.status == 2);
    expect_one_line(process, process.status, part);
    EXPECT_FALSE(std::filesystem::exists(scratch_.at("out.png")));
  }
  // Models other than the effect only draw terrain and sky.
  expect_one_line(render({"--set", "meshes.source=hall", "--set", "scattering.model=homogeneous"}), 2,
                  "scattering.model");
}

TEST_F(CliScenes, WithoutADeviceThereIsOneLine) {
  const Environment none(
      {{"VK_ICD_FILENAMES", scratch_.at("none.json")}, {"VK_DRIVER_FILES", scratch_.at("none.json")}});
  const std::string queries =
      scratch_.write("q.csv", "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n0,1,2,3\n");
  expect_one_line(render({}), 1, "expected a Vulkan 1.3 driver");
  expect_one_line(run_tyndall({"bench"}), 1, "expected a Vulkan 1.3 driver");
  expect_one_line(run_tyndall({"devices"}), 1, "expected a Vulkan 1.3 driver");
  expect_one_line(run_tyndall({"probe", "--queries", queries}), 1, "expected a Vulkan 1.3 driver");
  EXPECT_FALSE(std::filesystem::exists(scratch_.at("out.png")));
  // Verbs that need no device work without one: the reference, and the sky.
  EXPECT_EQ(run_tyndall({"probe", "--queries", queries, "--model", "reference", "--samples", "64"}).status, 0);
  const std::string sky =
      scratch_.write("sky.csv", "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n0,sky,2,\n");
  EXPECT_EQ(run_tyndall({"probe", "--queries", sky, "--model", "single"}).status, 0);
}

TEST_F(CliScenes, DevicesAreListedAndWrongOnesNamed) {
  const ProcessResult text = run_tyndall({"devices"});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("* "), std::string::npos);
  const ProcessResult json = run_tyndall({"devices", "--json"});
  ASSERT_EQ(json.status, 0) << json.err;
  const nlohmann::json list = nlohmann::json::parse(json.out);
  EXPECT_EQ(std::count_if(list.begin(), list.end(), [](const auto& row) { return row["used"] == true; }), 1);
  for (const char* const wrong : {"99", "no such device"}) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"devices"}, {"bench"}, {"render", "-o", scratch_.at("out.png")}}) {
      std::vector<std::string> all = arguments;
      all.insert(all.end(), {"--device", wrong});
      expect_one_line(run_tyndall(all), 2, list[0]["name"].get<std::string>());
    }
  }
  EXPECT_EQ(files(), 0U);
}

// A limit on the file size simulates a disk that fills up while the picture is written.
TEST_F(CliScenes, AFailedWritePreservesTheOldPicture) {
  const std::string before = scratch_.write("out.png", "before");
  std::string grid = "ncols 4\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 500\n";
  for (int i = 0; i < 16; ++i) grid += "100" + std::string(i % 4 == 3 ? "\n" : " ");
  const std::vector<std::string> quick = {"--set", "terrain.source=" + scratch_.write("g.asc", grid),
                                          "--set", "planet.radius_m=20000",
                                          "--set", "tables.size=4,4,4,4",
                                          "--set", "tables.orders=1",
                                          "--set", "shadows.cascades=1",
                                          "--set", "shadows.first_marched=0"};
  rlimit unlimited = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &unlimited), 0);
  rlimit small = unlimited;
  small.rlim_cur = 512;  // a PNG of this size with its metadata is larger
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const ProcessResult process = render(quick);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &unlimited), 0);
  EXPECT_EQ(process.status, 1);
  EXPECT_NE(process.err.find(": cannot write: "), std::string::npos) << process.err;
  EXPECT_EQ(contents_of(before), "before");
  EXPECT_EQ(files(), 2U);
  // With enough space the file is replaced.
  EXPECT_EQ(render(quick).status, 0);
  EXPECT_EQ(contents_of(before).substr(1, 3), "PNG");
}

// The metadata of each frame of a flight has the frame's own parameters.
TEST_F(CliScenes, FlightsArePlayed) {
  const std::string scene =
      scratch_.write("flight.toml", "planet.radius_m = 20000\ntables = { size = [4, 4, 4, 4], orders = 1 }\n"
                                    "shadows = { cascades = 1, first_marched = 0, resolution = 512 }\n"
                                    "[[path]]\ntime_s = 0\nyaw_deg = 350\nsun_elevation_deg = 60\n"
                                    "[[path]]\ntime_s = 2\nyaw_deg = 30\nsun_elevation_deg = 1\n");
  const ProcessResult process = run_tyndall(
      {"render", scene, "--size", "16x9", "--frames", "3", "--time-step", "1", "-o", scratch_.at("f%d.png")});
  ASSERT_EQ(process.status, 0) << process.err;
  const auto has = [&](int frame, const std::string& key, const std::string& value) {
    const std::string png = contents_of(scratch_.at("f" + std::to_string(frame) + ".png"));
    return png.find("tyndall." + key + std::string(1, '\0') + value) != std::string::npos;
  };
  EXPECT_TRUE(has(0, "camera.yaw_deg", "350"));
  EXPECT_TRUE(has(1, "camera.yaw_deg", "10"));
  EXPECT_TRUE(has(2, "camera.yaw_deg", "30"));
  EXPECT_TRUE(has(1, "sun.elevation_deg", "30.5"));
  EXPECT_TRUE(has(1, "frame.exposure", ""));
}

// A frame reports its exposure value, which gives the same exposure again.
TEST_F(CliScenes, ExposureValuesAreThoseOfThePicture) {
  const auto render_with = [&](std::vector<std::string> more) {
    const std::vector<std::string> quick = {"render",
                                            "-o",
                                            scratch_.at("out.exr"),
                                            "--size",
                                            "16x9",
                                            "--set",
                                            "planet.radius_m=60000",
                                            "--set",
                                            "tables.size=4,4,4,4",
                                            "--set",
                                            "tables.orders=1",
                                            "--set",
                                            "shadows.cascades=1",
                                            "--set",
                                            "shadows.first_marched=0",
                                            "--set",
                                            "scattering.color=spectral"};
    more.insert(more.begin(), quick.begin(), quick.end());
    const ProcessResult process = run_tyndall(more);
    EXPECT_EQ(process.status, 0) << process.err;
    EXPECT_EQ(process.err, "");
    const Result<image::File> file = image::read(scratch_.at("out.exr"));
    EXPECT_TRUE(file.ok());
    std::map<std::string, std::string> found;
    if (file) found.insert(file.value().metadata.begin(), file.value().metadata.end());
    return found;
  };
  const std::map<std::string, std::string> automatic = render_with({});
  const double ev100 = std::stod(automatic.at("tyndall.frame.ev100"));
  EXPECT_NE(automatic.at("tyndall.unit").find("times whiteLuminance it is cd/m^2"), std::string::npos);
  const auto fixed = render_with({"--set", "tonemap.exposure_ev100=" + automatic.at("tyndall.frame.ev100")});
  EXPECT_NEAR(std::stod(fixed.at("tyndall.frame.exposure")), std::stod(automatic.at("tyndall.frame.exposure")),
              1e-4 * std::stod(fixed.at("tyndall.frame.exposure")));
  // f/16 and 1/100 s are 14.64 at ISO 100.
  const auto camera = render_with({"--set", "tonemap.aperture=16", "--set", "tonemap.shutter_s=0.01"});
  EXPECT_NEAR(std::stod(camera.at("tyndall.frame.ev100")), 14.644, 0.001);
  EXPECT_NEAR(std::stod(camera.at("tyndall.frame.exposure")) / std::stod(fixed.at("tyndall.frame.exposure")),
              std::exp2(ev100 - 14.644), 0.001 * std::exp2(ev100 - 14.644));
  expect_one_line(render({"--set", "tonemap.aperture=16"}), 2, "tonemap.aperture: the camera has no exposure time");
  expect_one_line(render({"--primaries", "xyz"}), 2, "--primaries: a PNG holds display values");
}

// A flight by date needs a place on the Earth. Without one in the scene file, it is that of the elevation file.
TEST_F(CliScenes, ElevationFilesGiveFlightsTheirPlace) {
  std::string grid = "ncols 4\nnrows 4\nxllcorner 35.4\nyllcorner 31.4\ncellsize 0.01\n";
  for (int i = 0; i < 16; ++i) grid += "100" + std::string(i % 4 == 3 ? "\n" : " ");
  const std::string dates = "date = \"2026-06-21T09:30:00Z\"\n";
  const std::string scene =
      scratch_.write("flight.toml", "[[path]]\ntime_s = 0\n" + dates + "[[path]]\ntime_s = 2\n" + dates);
  const std::string file = scratch_.write("g.asc", grid);
  const std::string out = scratch_.at("out.exr");
  const std::vector<std::string> common = {"render", scene,
                                           "-o",     out,
                                           "--size", "16x9",
                                           "--set",  "tables.size=4,4,4,4",
                                           "--set",  "tables.orders=1",
                                           "--set",  "shadows.cascades=1",
                                           "--set",  "shadows.first_marched=0",
                                           "--set",  "shadows.resolution=512"};
  EXPECT_EQ(run_tyndall(common).status, 2) << "procedural terrain is nowhere";
  std::vector<std::string> placed = common;
  placed.insert(placed.end(), {"--set", "terrain.source=" + file});
  const ProcessResult process = run_tyndall(placed);
  ASSERT_EQ(process.status, 0) << process.err;
  // On the longest day, shortly before noon, the sun is 81.8 degrees high near Jerusalem. `sky --at 31.42,35.42`
  // computes the same.
  const std::string header = contents_of(out);
  const std::size_t at = header.find("tyndall.sun.elevation_deg");
  ASSERT_NE(at, std::string::npos);
  const double elevation =
      std::stod(header.substr(at + std::string("tyndall.sun.elevation_deg").size() + 1 + 7 + 4, 12));
  EXPECT_GT(elevation, 80.0);
  EXPECT_LT(elevation, 83.0);
  // Coordinates in metres do not define a place.
  placed.insert(placed.end(), {"--set", "terrain.units=metres"});
  EXPECT_EQ(run_tyndall(placed).status, 2);
}

TEST_F(CliScenes, PresetsAreScenes) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TYNDALL_PRESETS)) {
    expect_one_line(run_tyndall({"bench", entry.path().string(), "--device", "nonesuch"}), 2, "--device");
    ++count;
  }
  EXPECT_EQ(count, 7U);
}

TEST_F(CliScenes, BenchPrintsTheDocumentedValues) {
  const ProcessResult process =
      run_tyndall({"bench", "--json", "--size", "16x9", "--frames", "2", "--set", "planet.radius_m=20000", "--set",
                   "tables.size=4,4,4,4", "--set", "tables.orders=1", "--set", "scattering.color=spectral", "--set",
                   "camera.samples=4"});
  ASSERT_EQ(process.status, 0) << process.err;
  // The passes of the first sample are measured, among them the shadow maps.
  EXPECT_NE(process.err.find("bench measures pictures with one sample per pixel"), std::string::npos) << process.err;
  EXPECT_NE(process.out.find("\"shadow_maps\""), std::string::npos) << process.out;
  const nlohmann::json report = nlohmann::json::parse(process.out);
  EXPECT_GT(report["illuminance_lux"]["sky"].get<double>(), 100.0);
  EXPECT_GT(report["illuminance_lux"]["sun"].get<double>(), report["illuminance_lux"]["sun_horizontal"].get<double>());
  for (const char* const key : {"device", "size", "frames", "passes", "effect_ms", "frame_ms", "floor_ms", "exposure",
                                "counters", "memory_bytes"}) {
    EXPECT_TRUE(report.contains(key)) << key;
  }
  EXPECT_EQ(report["size"], nlohmann::json({16, 9}));
  EXPECT_EQ(report["frames"], 2);
  double effect_ms = 0.0;
  for (const nlohmann::json& pass : report["passes"]) {
    EXPECT_GT(pass["median_ms"].get<double>(), 0.0);
    EXPECT_GE(pass["p95_ms"].get<double>(), pass["median_ms"].get<double>());
    if (pass["in_effect"] == true) effect_ms += pass["median_ms"].get<double>();
  }
  EXPECT_GT(effect_ms, 0.0);
  EXPECT_GT(report["effect_ms"].get<double>(), 0.0);
  EXPECT_GT(report["floor_ms"].get<double>(), 0.0);
  EXPECT_GE(report["frame_ms"].get<double>(), report["effect_ms"].get<double>());
  for (const char* const key : {"samples_marched", "march_steps", "tree_nodes_visited", "shadow_map_fetches"}) {
    EXPECT_GT(report["counters"][key].get<std::uint64_t>(), 0U) << key;
  }
  EXPECT_EQ(report["counters"]["pixels_corrected"], 0);
  std::uint64_t bytes = 0;
  for (const auto& [name, size] : report["memory_bytes"]["effect_resources"].items())
    bytes += size.get<std::uint64_t>();
  EXPECT_EQ(report["memory_bytes"]["effect_persistent"], bytes);
}

// Marching runs once per cascade. Its reported time is the sum, so that the passes of a frame add up to the effect.
TEST_F(CliScenes, BenchAddsUpPassesThatRunSeveralTimes) {
  const ProcessResult process = run_tyndall({"bench", "--json", "--size", "64x36", "--frames", "1", "--set",
                                             "planet.radius_m=20000", "--set", "tables.size=4,4,4,4", "--set",
                                             "tables.orders=1", "--set", "shadows.cascade_processing=multi-pass"});
  ASSERT_EQ(process.status, 0) << process.err;
  const nlohmann::json report = nlohmann::json::parse(process.out);
  double effect_ms = 0.0;
  for (const nlohmann::json& pass : report["passes"]) {
    if (pass["in_effect"] == true) effect_ms += pass["median_ms"].get<double>();
  }
  EXPECT_NEAR(effect_ms, report["effect_ms"].get<double>(), 1e-6);
}

}  // namespace
}  // namespace tyndall::cli
