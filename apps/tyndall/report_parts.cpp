#include "report_parts.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>

#include "files/csv.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "report_process.hpp"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using files::concat;
using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

constexpr std::uint64_t kLargestFile = std::uint64_t{64} << 20;

// Settings of the short report that cost little.
constexpr const char* kShortTables[] = {"tables.size=16,32,32,8", "tables.orders=2"};
constexpr const char* kShortScene[] = {"shadows.resolution=512", "camera.samples=1"};

// Runs a verb on the report's device, within a share of the whole time and within what is left of it.
ProgramRun run_verb(const ReportRun& run, Words words, double share, const std::string& environment = "") {
  const std::string verb = words[0];
  const bool scene = verb == "render" || verb == "bench";
  if (run.is_short && (scene || verb == "tables" || verb == "probe")) {
    for (const char* const setting : kShortTables) words.insert(words.end(), {"--set", setting});
    for (const char* const setting : kShortScene)
      if (scene) words.insert(words.end(), {"--set", setting});
  }
  if (!run.device.empty() && words[0] != "compare") words.insert(words.end(), {"--device", run.device});
  return run_program("", words, {std::min(share * run.seconds, run.seconds_left()), run.work, environment});
}

Json parsed(const std::string& text) { return Json::parse(text, nullptr, false); }

// Compares two images. Returns what `compare --json` prints, or null.
Json compared(const ReportRun& run, const std::string& a, const std::string& b, const std::string& difference = "") {
  Words words = {"compare", a, b, "--json"};
  if (!difference.empty()) words.insert(words.end(), {"--diff", difference});
  constexpr double kShare = 0.05;
  const ProgramRun ran = run_verb(run, words, kShare);
  Json out = parsed(ran.out);
  // Without limits, `compare` only fails if a value is not finite or if it could not compare. Its numbers then mean
  // nothing.
  return ran.done() && out.is_object() ? out : Json();
}

double number_in(const Json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  return found != object.end() && found->is_number() ? found->get<double>() : std::nan("");
}

// The size of the pictures of checks: the reference is made at the same size.
constexpr const char* kReferenceSize = "320x180";
constexpr const char* kScenes[] = {"demo", "noon", "twilight", "hall"};
constexpr const char* kReportModels[] = {"precomputed", "single", "oneil"};

// The short report compares one scene, which is drawn fastest because it has no terrain, and two models.
std::span<const char* const> scenes_of(const ReportRun& run) { return std::span(kScenes).last(run.is_short ? 1 : 4); }
// The scene of the other checks and of most times.
const char* usual_scene(bool is_short) { return is_short ? "hall" : "demo"; }
std::span<const char* const> models_of(const ReportRun& run) {
  return std::span(kReportModels).first(run.is_short ? 2 : 3);
}

std::string scene_file(const ReportRun& run, const std::string& name) { return run.data + "/scenes/" + name + ".toml"; }
std::string reference_file(const ReportRun& run, const std::string& name) { return run.data + "/report/" + name; }

// Rays from the ground, from a mountain, from a flight and from space, up and down, with the sun high, low and set.
std::string rays() {
  std::string text = "altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n";
  for (const char* const altitude : {"0", "2000", "10000", "120000"}) {
    for (const char* const view : {"0", "45", "75", "88", "95", "120", "180"}) {
      for (const char* const sun : {"10", "60", "85", "93"}) {
        for (const char* const azimuth : {"0", "30", "120"}) {
          text += concat({altitude, ",", view, ",", sun, ",", azimuth, "\n"});
        }
      }
    }
  }
  return text;
}

// Returns the relative difference of the radiances in two outputs of `probe` for each ray: the sum of |a − b| over the
// channels, divided by the sum of |b|. Rays with less than a millionth of the brightest radiance are left out.
std::optional<std::vector<double>> relative_differences(const std::string& a_text, const std::string& b_text) {
  const Result<files::CsvTable> a = files::parse_csv(a_text, "answer");
  const Result<files::CsvTable> b = files::parse_csv(b_text, "reference");
  if (!a || !b || a.value().rows() != b.value().rows() || a.value().rows() == 0) return std::nullopt;
  std::vector<double> difference(a.value().rows(), 0.0);
  std::vector<double> size(a.value().rows(), 0.0);
  for (const char* const name : {"L_r", "L_g", "L_b"}) {
    const std::vector<std::size_t> column_a = a.value().find(name);
    const std::vector<std::size_t> column_b = b.value().find(name);
    if (column_a.size() != 1 || column_b.size() != 1) return std::nullopt;
    for (std::size_t row = 0; row < difference.size(); ++row) {
      double x = 0.0;
      double y = 0.0;
      (void)files::read_number(a.value().field(row, column_a[0]), x);
      (void)files::read_number(b.value().field(row, column_b[0]), y);
      difference[row] += std::abs(x - y);
      size[row] += std::abs(y);
    }
  }
  const double brightest = *std::max_element(size.begin(), size.end());
  std::vector<double> out;
  for (std::size_t row = 0; row < size.size(); ++row) {
    constexpr double kDark = 1e-6;
    if (size[row] > kDark * brightest) out.push_back(difference[row] / size[row]);
  }
  std::sort(out.begin(), out.end());
  if (out.empty()) return std::nullopt;
  return out;
}

bool same_bytes(const std::string& a, const std::string& b) {
  const Result<std::string> first = files::read_file(a, kLargestFile);
  const Result<std::string> second = files::read_file(b, kLargestFile);
  return first && second && first.value() == second.value();
}

std::string frame_size(const ReportRun& run) { return run.is_short ? "64x36" : "1280x720"; }

}  // namespace

double ReportRun::seconds_left() const {
  const double used = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return std::max(seconds - used, 0.0);
}

void ReportRun::leave_out(const std::string& part, const std::string& why) {
  json["left_out"].push_back({{"part", part}, {"why", why}});
}

void ReportRun::check(const std::string& name, bool passed, const std::string& limit, Json values) {
  json["checks"].push_back({{"name", name}, {"passed", passed}, {"limit", limit}, {"values", std::move(values)}});
}

void report_device(ReportRun& run) {
  constexpr double kShare = 0.1;
  const ProgramRun listed = run_verb(run, {"devices", "--json"}, kShare);
  const Json devices = parsed(listed.out);
  run.json["devices"] = devices.is_array() ? devices : Json::array();
  run.json["device"] = nullptr;
  for (const Json& device : run.json["devices"]) {
    if (device.value("used", false)) run.json["device"] = device;
  }
  if (run.json["device"].is_null()) run.leave_out("devices", listed.reason());
}

void report_tables(ReportRun& run, double share) {
  const ProgramRun made = run_verb(run, {"tables", "--json"}, share);
  Json tables = parsed(made.out);
  if (!made.done() || !tables.is_object()) return run.leave_out("tables", made.reason());
  for (const char* const name : {"cache", "output", "files"}) tables.erase(name);  // places on this machine
  run.json["tables"] = std::move(tables);
}

void report_probe(ReportRun& run, double share) {
  const std::string queries = run.work + "/rays.csv";
  if (!files::write_file(queries, rays())) return run.leave_out("probe", "the rays cannot be written");
  for (const char* const model : models_of(run)) {
    const std::string name = concat({"probe, model ", model});
    const Result<std::string> reference = files::read_file(reference_file(run, concat({model, ".csv"})), kLargestFile);
    if (!reference) {
      run.leave_out(name, "there are no values of the CPU device to compare with");
      continue;
    }
    const ProgramRun probed = run_verb(run, {"probe", "--model", model, "--queries", queries}, share);
    if (!probed.done()) {
      run.leave_out(name, probed.reason());
      continue;
    }
    const std::optional<std::vector<double>> difference = relative_differences(probed.out, reference.value());
    if (!difference) {
      run.leave_out(name, "the values of the CPU device are of other rays");
      continue;
    }
    double mean = 0.0;
    for (const double value : *difference) mean += value / static_cast<double>(difference->size());
    constexpr double kMaxMean = 1e-3;
    run.check(concat({name, " against the CPU device"}), mean <= kMaxMean, "mean at most 0.001",
              {{"rays", difference->size()},
               {"mean_relative_difference", mean},
               {"p95", (*difference)[difference->size() * 95 / 100]},
               {"largest", difference->back()}});
  }
}

void report_pictures(ReportRun& run, double share) {
  for (const char* const scene : scenes_of(run)) {
    const std::string name = concat({"scene ", scene});
    const std::string reference = reference_file(run, concat({scene, ".exr"}));
    std::error_code ignored;
    if (!fs::exists(reference, ignored)) {
      run.leave_out(name, "there is no picture of the CPU device to compare with");
      continue;
    }
    const std::string picture = concat({run.work, "/", scene, ".exr"});
    const ProgramRun drawn =
        run_verb(run, {"render", scene_file(run, scene), "--size", kReferenceSize, "-o", picture}, share);
    if (!drawn.done()) {
      run.leave_out(name, drawn.reason());
      continue;
    }
    const std::string difference = concat({run.folder, "/difference_", scene, ".exr"});
    const Json values = compared(run, picture, reference, run.is_short ? "" : difference);
    // Drivers may place the vertices of triangles on different fractions of a pixel and filter textures with other
    // roundings, so edges and fine textures are left out.
    constexpr double kMax = 1e-3;
    run.check(concat({name, " against the CPU device"}), number_in(values, "trimmed_relative_error") <= kMax,
              "mean relative error of the 95 % of values with the smallest errors at most 0.001", values);
  }
}

namespace {

struct Drawn {
  std::string exr, png;
  std::string why;  // empty: both were drawn
};

// Draws the demo scene at a fixed exposure, as radiance and as a picture.
Drawn draw(const ReportRun& run, const std::string& name, const Words& options, double share) {
  Drawn out = {concat({run.work, "/", name, ".exr"}), concat({run.folder, "/", name, ".png"}), ""};
  for (const std::string& file : {out.exr, out.png}) {
    Words words = {"render", scene_file(run, usual_scene(run.is_short)),
                   "--size", frame_size(run),
                   "--set",  "tonemap.auto_exposure=false",
                   "-o",     file};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramRun drawn = run_verb(run, words, share);
    if (!drawn.done()) {
      out.why = drawn.reason();
      return out;
    }
  }
  return out;
}

}  // namespace

void report_epipolar(ReportRun& run, double share) {
  const Drawn epipolar = draw(run, "epipolar", {}, share);
  if (!epipolar.why.empty()) return run.leave_out("epipolar sampling", epipolar.why);
  const Drawn again = draw(run, "again", {}, share);
  if (again.why.empty()) {
    run.check("two runs give the same bytes",
              same_bytes(epipolar.exr, again.exr) && same_bytes(epipolar.png, again.png), "identical files",
              Json::object());
  } else {
    run.leave_out("repeatability", again.why);
  }
  std::error_code ignored;
  fs::remove(again.png, ignored);

  const Drawn plain = draw(run, "without_tree", {"--set", "epipolar.min_max_tree=false"}, share);
  if (plain.why.empty()) {
    const Json values = compared(run, epipolar.exr, plain.exr);
    // Without the tree, the lengths of lit sections are added in other groups, so that single stored halves may differ
    // by one step.
    constexpr double kMaxMean = 1e-5;
    run.check("the same picture with and without the tree", number_in(values, "mean_relative_error") <= kMaxMean,
              "mean relative error at most 0.00001", values);
  } else {
    run.leave_out("with and without the tree", plain.why);
  }
  fs::remove(plain.png, ignored);

  const Drawn brute = draw(run, "brute_force", {"--set", "scattering.technique=brute-force"}, share);
  if (!brute.why.empty()) return run.leave_out("epipolar sampling against brute force", brute.why);
  Json values = compared(run, epipolar.png, brute.png);
  const Json radiance = compared(run, epipolar.exr, brute.exr);
  constexpr double kMinPsnr_db = 56.0;
  constexpr double kMaxError = 0.003;
  const double psnr_db = number_in(values, "psnr_db");
  const double error = number_in(radiance, "mean_relative_error");
  run.check("epipolar sampling against brute force", psnr_db >= kMinPsnr_db && error <= kMaxError,
            run.is_short ? "56 dB and a mean relative error of 0.003, at 1280x720 only"
                         : "at least 56 dB, mean relative error at most 0.003",
            {{"size", frame_size(run)}, {"psnr_db", values["psnr_db"]}, {"mean_relative_error", error}});
}

void report_validation(ReportRun& run, double share) {
  const ProgramRun ran = run_verb(run, {"report", "--part", "validation"}, share);
  const Json values = parsed(ran.out);
  if (!ran.done() || !values.is_object()) return run.leave_out("validation layer", ran.reason());
  run.check("no message of the validation layer", values["messages"] == 0, "0 messages", values);
}

void report_pipelines(ReportRun& run, double share) {
  const ProgramRun ran = run_verb(run, {"report", "--part", "pipelines"}, share);
  const Json values = parsed(ran.out);
  if (!ran.done() || !values.is_array()) return run.leave_out("registers, spills and code sizes", ran.reason());
  run.json["pipelines"] = values;
}

namespace {

struct Measurement {
  std::string name;
  std::string size;
  std::string scene;  // in the folder scenes
  Words settings;
};

std::vector<Measurement> measurements(bool is_short) {
  const std::string usual = is_short ? "64x36" : "1280x720";
  const char* const scene = usual_scene(is_short);
  std::vector<Measurement> out = {{"defaults", usual, scene, {}}};
  if (!is_short) {
    out.push_back({"defaults", "2560x1600", scene, {}});
    out.push_back({"defaults", "3840x2160", scene, {}});
  }
  out.push_back({"single scattering by integration", usual, scene, {"scattering.single=integration"}});
  out.push_back({"single scattering from the table", usual, scene, {"scattering.single=table"}});
  out.push_back({"without the tree", usual, scene, {"epipolar.min_max_tree=false"}});
  if (!is_short) {
    for (const char* const preset : {"high_performance", "balanced", "high_quality"}) {
      out.push_back({concat({"preset ", preset}), usual, concat({"presets/", preset}), {}});
    }
  }
  out.push_back({"brute force", usual, scene, {"scattering.technique=brute-force"}});
  if (!is_short) {
    for (const char* const size : {"2560x1600", "3840x2160"}) {
      for (const char* const preset : {"high_performance", "high_quality"}) {
        out.push_back({concat({"preset ", preset}), size, concat({"presets/", preset}), {}});
      }
    }
  }
  return out;
}

}  // namespace

void report_times(ReportRun& run) {
  run.json["times"] = Json::array();
  const std::vector<Measurement> list = measurements(run.is_short);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Measurement& one = list[i];
    const std::string name = concat({"times, ", one.name, " at ", one.size});
    // A measurement may take twice its share of the remaining time. An eighth of that is measured; the rest is for the
    // start and the warm-up.
    const double limit_s = 2.0 * run.seconds_left() / static_cast<double>(list.size() - i);
    constexpr double kUseful_s = 1.0;
    if (std::min(limit_s, run.seconds_left()) < kUseful_s) {
      run.leave_out(name, "no time was left");
      continue;
    }
    const double measure_s = run.is_short ? 0.05 : std::clamp(0.125 * limit_s, 0.5, 5.0);
    Words words = {"bench",
                   scene_file(run, one.scene),
                   "--size",
                   one.size,
                   "--json",
                   "--frames",
                   "1000",
                   "--warm-up",
                   run.is_short ? "0.01" : "1",
                   "--seconds",
                   files::number_text(measure_s)};
    for (const std::string& setting : one.settings) words.insert(words.end(), {"--set", setting});
    const ProgramRun ran = run_verb(run, words, limit_s / run.seconds);
    Json bench = parsed(ran.out);
    if (!ran.done() || !bench.is_object()) {
      run.leave_out(name, ran.reason());
      continue;
    }
    Json row = {{"name", one.name}, {"scene", one.scene}, {"settings", one.settings}};
    row.update(bench);
    run.json["times"].push_back(std::move(row));
  }
}

bool make_reference(ReportRun& run) {
  const fs::path folder = fs::path(run.data) / "report";
  std::error_code error;
  fs::create_directories(folder, error);
  const std::string queries = run.work + "/rays.csv";
  if (!files::write_file(queries, rays())) return false;
  constexpr double kWhole = 1.0;
  const auto ran = [&](const Words& words) {
    const ProgramRun result = run_verb(run, words, kWhole);
    if (!result.done()) run.leave_out(words[0], result.reason());
    return result.done();
  };
  for (const char* const model : models_of(run)) {
    if (!ran({"probe", "--model", model, "--queries", queries, "-o", (folder / concat({model, ".csv"})).string()}))
      return false;
  }
  for (const char* const scene : scenes_of(run)) {
    const std::string picture = (folder / concat({scene, ".exr"})).string();
    if (!ran({"render", scene_file(run, scene), "--size", kReferenceSize, "-o", picture})) return false;
  }
  return true;
}

}  // namespace tyndall::cli
