// `tyndall bench`: measures GPU milliseconds per pass of the demo scene, after a warm-up.
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

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
  for (const auto& [name, value] : report["counters"].items()) {
    std::snprintf(line, sizeof line, "  %-20s %10llu\n", name.c_str(), value.get<unsigned long long>());
    text += line;
  }
  return text;
}

}  // namespace

int run_bench(Args args) {
  CommonOptions options;
  options.frames = 5;
  Arguments arguments("bench");
  add_common(arguments, options, kScene | kSet | kDevice | kSize | kFrames | kJson);
  if (const std::optional<int> status = arguments.parse(args)) return *status;
  if (Result<void> r = resolve(options); !r) return fail(r.error());

  Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({options.device, false});
  if (!host) return fail(host.error());
  const tables::PipelineStore pipelines(*host.value(), table_cache(options.settings.scene));
  if (!host.value()->timestamps()) {
    return fail(Error{ErrorCode::unsupported_device, "the queue of the Vulkan device '" + host.value()->device_name() +
                                                         "' cannot measure passes; expected one with timestamps"});
  }
  scene::SceneDesc desc;
  desc.extent = {options.size.width, options.size.height};
  desc.timings = true;
  desc.counters = true;
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
  for (std::uint32_t frame = 0; frame < kWarmUpFrames + options.frames; ++frame) {
    progress.update(frame, kWarmUpFrames + options.frames);
    if (Result<void> r = scene.value()->render(0.0, true); !r) return fail(r.error());
    if (frame < kWarmUpFrames) continue;
    double effect_ms = 0.0;
    double frame_ms = 0.0;
    std::map<std::string, double> of_frame;  // a pass may run several times
    for (const scene::PassTime& pass : scene.value()->timings()) {
      if (pass.name == "floor") {
        floor.ms.push_back(pass.ms);
        continue;
      }
      if (!passes.contains(pass.name)) order.push_back(pass.name);
      passes[pass.name].in_effect = pass.in_effect;
      of_frame[pass.name] += pass.ms;
      frame_ms += pass.ms;
      if (pass.in_effect) effect_ms += pass.ms;
    }
    for (const auto& [name, ms] : of_frame) passes[name].ms.push_back(ms);
    effect.ms.push_back(effect_ms);
    frame_total.ms.push_back(frame_ms);
  }

  for (const std::string& text : scene.value()->notes()) note(text);
  const scene::Scene::Memory memory = scene.value()->memory();
  nlohmann::ordered_json out;
  out["device"] = host.value()->device_name();
  out["size"] = {options.size.width, options.size.height};
  out["frames"] = options.frames;
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
  const Counters counters = scene.value()->counters();
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
  if (options.json) return print(out.dump(2) + "\n");
  return print(as_text(out));
}

}  // namespace tyndall::cli
