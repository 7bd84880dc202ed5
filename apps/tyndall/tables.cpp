// `tyndall tables`: builds the scattering tables, reports the time of each stage, and exports them.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "arguments.hpp"
#include "cli.hpp"
#include "files/file_cache.hpp"
#include "files/text.hpp"
#include "gpu/host.hpp"
#include "interruption.hpp"
#include "make_tables.hpp"
#include "models/precomputed.hpp"
#include "models/table_values.hpp"
#include "table_export.hpp"
#include "tables/pipeline_store.hpp"

namespace tyndall::cli {
namespace {

std::string line(const char* name, double value, const char* format) {
  char number[64];
  std::snprintf(number, sizeof number, format, value);
  return files::concat(
      {"  ", name, std::string(std::max<std::size_t>(24 - std::string_view(name).size(), 1), ' '), number, "\n"});
}

std::string as_text(const nlohmann::ordered_json& report) {
  const auto text = [&](const char* key) { return report[key].get<std::string>(); };
  std::string size;
  for (const nlohmann::ordered_json& side : report["size"]) size += (size.empty() ? "" : "x") + side.dump();
  std::string out = files::concat({text("device"), ", ", size, " texels, ", report["orders"].dump(), " orders\n"});
  for (const nlohmann::ordered_json& stage : report["stages"])
    out += line(stage["name"].get<std::string>().c_str(), stage["ms"].get<double>(), "%10.1f ms");
  out += line("all stages", report["stages_ms"].get<double>(), "%10.1f ms");
  out += line("with submissions", report["total_ms"].get<double>(), "%10.1f ms");
  for (const auto& [name, bytes] : report["memory_bytes"].items())
    out += line(name.c_str(), bytes.get<double>() / 1048576.0, "%10.2f MiB");
  if (!report["cache"].is_null()) out += files::concat({"stored in ", text("cache"), "\n"});
  if (!report["files"].is_null()) out += files::concat({report["files"].dump(), " files in ", text("output"), "\n"});
  return out;
}

}  // namespace

int run_tables(Args args) {
  Interruption interruption;
  CommonOptions options;
  bool export_wanted = false;
  Arguments arguments("tables");
  add_common(arguments, options, kScene | kSet | kDevice | kJson);
  arguments.value("-o,--output", "DIR",
                  "export the tables as EXR files and tables.json to this directory, which is created if missing",
                  [&](const std::string& text) {
                    options.output = text;
                    export_wanted = true;
                    return Result<void>();
                  });
  if (const std::optional<int> status = arguments.parse(args)) return *status;
  if (Result<void> r = resolve(options); !r) return fail(r.error());
  if (export_wanted) {
    if (options.output.empty()) return fail(files::input_error("empty directory name", "-o", "expected -o DIR"));
    if (Result<void> r = check_export(options.output, options.settings.effect); !r) return fail(r.error());
  }

  const Params& params = options.settings.effect;
  Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({.device = options.device, .graphics = false});
  if (!host) return fail(host.error());
  const tables::PipelineStore pipelines(*host.value(), table_cache(options.settings.scene));
  if (!pipelines.note().empty()) note(pipelines.note());
  tables::MakeReady how = make_tables(options.settings.scene);
  how.rebuild = true;
  Result<models::PrecomputedModel> model = models::PrecomputedModel::create(*host.value(), params, how);
  if (!model) return fail(model.error());
  interruption.describe_by([export_wanted] {
    return std::string(export_wanted ? "the tables are built, and not exported" : "the tables are built");
  });
  Effect& effect = model.value().effect();
  const tables::Report& made = model.value().origin();
  for (const std::string& text : made.notes) note(text);
  if (!host.value()->timestamps()) note("the device has no timestamps, so the stages are not measured");

  nlohmann::ordered_json report;
  report["device"] = host.value()->device_name();
  report["size"] = {params.tables.size.x, params.tables.size.y, params.tables.size.z, params.tables.size.w};
  report["orders"] = params.tables.orders;
  report["stages"] = nlohmann::ordered_json::array();
  double sum_ms = 0.0;
  for (const PassTiming& stage : effect.precompute_timings()) {
    report["stages"].push_back({{"name", stage.name}, {"ms", stage.gpu_ms}});
    sum_ms += stage.gpu_ms;
  }
  report["stages_ms"] = sum_ms;
  report["total_ms"] = made.milliseconds;
  nlohmann::ordered_json& memory = report["memory_bytes"];
  for (std::uint32_t i = 0; i < kTableCount; ++i) {
    const auto id = static_cast<TableId>(i);
    memory[models::table_name(id)] = gpu::image_bytes(host.value()->device(), table_desc(id, params));
  }
  memory["while_building"] = effect.memory().transient;
  // The directory that now holds the tables; null if they are not cached.
  report["cache"] = nullptr;
  const std::string cache = files::cache_directory(how.cache.place);
  if (!cache.empty() && made.notes.empty()) report["cache"] = files::one_line(cache, 1000);
  report["output"] = nullptr;
  report["files"] = nullptr;
  if (export_wanted) {
    Progress progress("export");
    const Result<std::size_t> files =
        export_tables(options.output, *host.value(), effect, options.settings,
                      [&](std::size_t done, std::size_t total) { progress.update(done, total); });
    if (!files) return fail(files.error());
    report["output"] = files::one_line(options.output, 1000);
    report["files"] = files.value();
  }
  return print(options.json ? report.dump(2) + "\n" : as_text(report));
}

}  // namespace tyndall::cli
