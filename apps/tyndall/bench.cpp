// `tyndall bench`: measures GPU milliseconds per pass of the demo scene, after a warm-up.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "arguments.hpp"
#include "cli.hpp"
#include "files/text.hpp"
#include "gpu/host.hpp"
#include "make_tables.hpp"
#include "scene/scene.hpp"
#include "tables/pipeline_store.hpp"

namespace tyndall::cli {
namespace {

constexpr std::uint32_t kWarmUpFrames = 2;

// Decides which frames are measured. The warm-up takes kWarmUpFrames frames, or the time of --warm-up, because GPUs
// raise their clocks during the first second. Then frames are measured until there are --frames of them, or until the
// time of --seconds is over.
class Schedule {
 public:
  Schedule(std::uint32_t frames, double warm_up_s, double measure_s)
      : frames_(frames), warm_up_s_(warm_up_s), measure_s_(measure_s) {}

  [[nodiscard]] bool finished() const {
    return measured_ > 0 && (measured_ >= frames_ || (measure_s_ > 0.0 && seconds_since(measured_from_) >= measure_s_));
  }
  // Counts a frame that has been rendered. Returns whether it is measured.
  bool count() {
    if (measured_ == 0 && !warm()) {
      ++warmed_;
      measured_from_ = Clock::now();
      return false;
    }
    ++measured_;
    return true;
  }
  [[nodiscard]] std::uint32_t measured() const { return measured_; }
  [[nodiscard]] std::uint32_t total() const { return kWarmUpFrames + frames_; }
  [[nodiscard]] std::uint32_t done() const { return std::min(warmed_, kWarmUpFrames) + measured_; }

 private:
  using Clock = std::chrono::steady_clock;
  static double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }
  [[nodiscard]] bool warm() const {
    return warm_up_s_ > 0.0 ? warmed_ > 0 && seconds_since(started_) >= warm_up_s_ : warmed_ >= kWarmUpFrames;
  }

  std::uint32_t frames_, warmed_ = 0, measured_ = 0;
  double warm_up_s_, measure_s_;
  Clock::time_point started_ = Clock::now(), measured_from_ = started_;
};

struct Series {
  std::vector<double> ms;
  bool in_effect = false;

  // Returns the nearest-rank quantile.
  [[nodiscard]] double quantile(double q) const {
    std::vector<double> sorted = ms;
    std::sort(sorted.begin(), sorted.end());
    const auto rank = static_cast<std::size_t>(std::lround(q * static_cast<double>(sorted.size() - 1)));
    return sorted[std::min(rank, sorted.size() - 1)];
  }
};

double median_or_zero(const Series& series) { return series.ms.empty() ? 0.0 : series.quantile(0.5); }

std::string as_text(const nlohmann::ordered_json& report) {
  std::string text = files::concat({report["device"].get<std::string>(), ", ", report["size"][0].dump(), "x",
                                    report["size"][1].dump(), ", median of ", report["frames"].dump(), " frames\n"});
  char line[160];
  for (const nlohmann::ordered_json& pass : report["passes"]) {
    std::snprintf(line, sizeof line, "  %-20s %10.3f ms  p95 %10.3f ms%s\n", pass["name"].get<std::string>().c_str(),
                  pass["median_ms"].get<double>(), pass["p95_ms"].get<double>(),
                  pass["in_effect"].get<bool>() ? "  (effect)" : "");
    text += line;
  }
  std::snprintf(line, sizeof line, "  effect %.3f ms, frame %.3f ms, floor %.3f ms\n",
                report["effect_ms"].get<double>(), report["frame_ms"].get<double>(), report["floor_ms"].get<double>());
  text += line;
  if (const nlohmann::ordered_json& exposure = report["exposure"]; !exposure["ev100"].is_null()) {
    std::snprintf(line, sizeof line, "  exposure %.4g, EV100 %.2f\n", exposure["scale"].get<double>(),
                  exposure["ev100"].get<double>());
    text += line;
  }
  for (const auto& [name, value] : report["counters"].items()) {
    std::snprintf(line, sizeof line, "  %-20s %10llu\n", name.c_str(), value.get<unsigned long long>());
    text += line;
  }
  return text;
}

// Adds the exposure, the illuminance and the counters of the last frame, and the memory.
void add_counters(const scene::Scene& scene, nlohmann::ordered_json& out) {
  const scene::Scene::Exposure exposure = scene.exposure();
  out["exposure"] = {{"scale", exposure.scale}, {"ev100", exposure.ev100 ? nlohmann::json(*exposure.ev100) : nullptr}};
  if (exposure.illuminance) {
    out["illuminance_lux"] = {{"sun", exposure.illuminance->sun_lux},
                              {"sun_horizontal", exposure.illuminance->sun_horizontal_lux},
                              {"sky", exposure.illuminance->sky_lux}};
  }
  const scene::Scene::Memory memory = scene.memory();
  const Counters counters = scene.counters();
  out["counters"] = {{"samples_marched", counters.samples_marched},
                     {"march_steps", counters.march_steps},
                     {"tree_nodes_visited", counters.tree_nodes_visited},
                     {"shadow_map_fetches", counters.shadow_map_fetches},
                     {"pixels_corrected", counters.pixels_corrected}};
  out["memory_bytes"] = {
      {"total", memory.effect_persistent + memory.effect_transient + memory.effect_host + memory.scene},
      {"effect_persistent", memory.effect_persistent},
      {"effect_transient", memory.effect_transient},
      {"effect_host", memory.effect_host},
      {"scene", memory.scene}};
  for (const ResourceMemory& row : memory.effect_resources)
    out["memory_bytes"]["effect_resources"][row.name] = row.bytes;
}

// The times of a picture with several samples would be those of the last sample, which reuses the shadow maps.
void take_one_sample(scene::CameraParams& camera) {
  if (camera.samples == 1) return;
  note("camera.samples is " + std::to_string(camera.samples) + "; bench measures pictures with one sample per pixel");
  camera.samples = 1;
}

}  // namespace

int run_bench(Args args) {
  CommonOptions options;
  options.frames = 5;
  double warm_up_s = 0.0;
  double measure_s = 0.0;
  Arguments arguments("bench");
  add_common(arguments, options, kScene | kSet | kDevice | kSize | kFrames | kJson);
  arguments.number("--warm-up", warm_up_s, 0.0, 3600.0, "seconds of frames before the first measured one; 0: 2 frames");
  arguments.number("--seconds", measure_s, 0.0, 3600.0,
                   "end after this time or --frames, whichever is first; 0: --frames");
  if (const std::optional<int> status = arguments.parse(args)) return *status;
  if (Result<void> r = resolve(options); !r) return fail(r.error());

  take_one_sample(options.settings.scene.camera);
  Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({options.device, false});
  if (!host) return fail(host.error());
  const tables::PipelineStore pipelines(*host.value(), table_cache(options.settings.scene));
  if (!pipelines.note().empty()) note(pipelines.note());
  if (!host.value()->timestamps()) {
    return fail(Error{ErrorCode::unsupported_device, "the queue of the Vulkan device '" + host.value()->device_name() +
                                                         "' cannot measure passes; expected one with timestamps"});
  }
  scene::SceneDesc desc;
  desc.extent = {options.size.width, options.size.height};
  desc.timings = true;
  desc.counters = true;
  desc.illuminance = true;
  desc.reuse_shadows = false;  // draw the shadow maps in every frame, as an application with a moving camera must
  desc.pipeline_threads = gpu::Host::pipeline_threads();
  desc.make_tables = make_tables(options.settings.scene);
  Result<std::unique_ptr<scene::Scene>> scene =
      scene::Scene::create(*host.value(), desc, options.settings.effect, options.settings.scene);
  if (!scene) return fail_input(scene.error());

  std::vector<std::string> order;
  std::map<std::string, Series> passes;
  Series effect;
  Series frame_total;
  Series floor;
  Progress progress("bench");
  Schedule schedule(options.frames, warm_up_s, measure_s);
  while (!schedule.finished()) {
    progress.update(schedule.done(), schedule.total());
    if (Result<void> r = scene.value()->render(0.0, true); !r) return fail(r.error());
    if (!schedule.count()) continue;
    double effect_ms = 0.0;
    double frame_ms = 0.0;
    std::optional<double> whole_ms;          // time of the whole effect, where it is measured in one scope
    std::map<std::string, double> of_frame;  // a pass may run several times
    for (const scene::PassTime& pass : scene.value()->timings()) {
      if (pass.name == "floor") {
        floor.ms.push_back(pass.ms);
        continue;
      }
      if (pass.name == "effect") {
        whole_ms = pass.ms;
        continue;
      }
      if (!passes.contains(pass.name)) order.push_back(pass.name);
      passes[pass.name].in_effect = pass.in_effect;
      of_frame[pass.name] += pass.ms;
      frame_ms += pass.ms;
      if (pass.in_effect) effect_ms += pass.ms;
    }
    for (const auto& [name, ms] : of_frame) passes[name].ms.push_back(ms);
    effect.ms.push_back(whole_ms.value_or(effect_ms));
    frame_total.ms.push_back(frame_ms + (whole_ms ? *whole_ms - effect_ms : 0.0));
  }

  for (const std::string& text : scene.value()->notes()) note(text);
  nlohmann::ordered_json out;
  out["device"] = host.value()->device_name();
  out["size"] = {options.size.width, options.size.height};
  out["frames"] = schedule.measured();
  out["passes"] = nlohmann::ordered_json::array();
  for (const std::string& name : order) {
    const Series& series = passes[name];
    out["passes"].push_back({{"name", name},
                             {"median_ms", series.quantile(0.5)},
                             {"p95_ms", series.quantile(0.95)},
                             {"in_effect", series.in_effect}});
  }
  out["effect_ms"] = median_or_zero(effect);
  out["frame_ms"] = median_or_zero(frame_total);
  out["floor_ms"] = median_or_zero(floor);
  add_counters(*scene.value(), out);
  if (options.json) return print(out.dump(2) + "\n");
  return print(as_text(out));
}

}  // namespace tyndall::cli
