// `tyndall probe`: evaluates a model for given rays. docs/probe.md describes the tables.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "arguments.hpp"
#include "cli.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "input_files.hpp"
#include "make_tables.hpp"
#include "probe_models.hpp"
#include "probe_table.hpp"

namespace tyndall::cli {
namespace {

constexpr std::uint32_t kMaxOrders = 256;  // limit of the path tracer

bool is_spectral(const Params& params) { return params.scattering.color == ColorMode::spectral; }

// Returns numbers as a JSON array. An infinite number, such as the standard error of a single block of paths, becomes
// null, because JSON has no infinity.
nlohmann::json numbers_as_json(const std::array<double, 3>& numbers) {
  nlohmann::json out = nlohmann::json::array();
  for (const double number : numbers) {
    out.push_back(std::isfinite(number) ? nlohmann::json(number) : nlohmann::json());
  }
  return out;
}

std::string as_json(const scene::ModelInfo& model, const ProbeSettings& settings,
                    std::span<const ProbeAnswer> answers) {
  nlohmann::ordered_json out;
  out["model"] = model.name;
  if (model.random) {
    out["orders"] = settings.orders;
    out["samples"] = settings.samples;
    out["seed"] = settings.seed;
  }
  out["answers"] = nlohmann::ordered_json::array();
  for (const ProbeAnswer& answer : answers) {
    nlohmann::ordered_json row;
    row["L"] = numbers_as_json(answer.radiance);
    row["T"] = numbers_as_json(answer.transmittance);
    if (model.random) row["stderr"] = numbers_as_json(answer.standard_error);
    if (is_spectral(settings.params)) row["XYZ"] = numbers_as_json(answer.xyz);
    out["answers"].push_back(std::move(row));
  }
  return out.dump(1) + "\n";
}

}  // namespace

int run_probe(Args args) {
  CommonOptions options;
  ProbeSettings settings;
  std::string queries;
  std::string model_name(scene::model_registry().front().name);
  std::vector<std::string> model_names;
  for (const scene::ModelInfo& model : scene::model_registry()) model_names.emplace_back(model.name);

  Arguments arguments("probe");
  add_common(arguments, options, kScene | kSet | kDevice | kOutput | kJson);
  arguments.text("--queries", queries, "FILE",
                 "rays as CSV: altitude_m, view_zenith_deg (or sky), sun_zenith_deg, azimuth_deg");
  arguments.choice("--model", model_name, model_names,
                   "model; the ground is black with single and reflects light with reference");
  arguments.count("--orders", settings.orders, 1, kMaxOrders, "orders of scattering of the reference");
  arguments.count("--samples", settings.samples, 1, UINT32_MAX, "paths per ray of the reference");
  arguments.count("--seed", settings.seed, 0, UINT32_MAX, "seed of the random numbers of the reference");
  if (const std::optional<int> status = arguments.parse(args)) return *status;
  if (queries.empty()) {
    return fail(files::input_error("missing queries", "tyndall probe", "expected --queries FILE"));
  }
  const std::span<const scene::ModelInfo> models = scene::model_registry();
  const scene::ModelInfo& model = *std::find_if(models.begin(), models.end(),
                                                [&](const scene::ModelInfo& info) { return info.name == model_name; });
  if (Result<void> r = resolve(options); !r) return fail(r.error());
  const Result<ProbeTable> table = read_queries(queries);
  if (!table) return fail(table.error());
  for (std::size_t row = 0; row < table.value().queries.size(); ++row) {
    const double altitude_m = table.value().queries[row].altitude_m;
    if (altitude_m >= 0.0) continue;
    const std::string where = files::concat(
        {files::one_line(queries, 200), ":", std::to_string(table.value().input.lines[row]), ": column 'altitude_m'"});
    if (Result<void> r = check_altitude(altitude_m, options.settings.effect, where); !r) return fail(r.error());
  }
  if (!options.output.empty()) {
    std::vector<InputFile> inputs = input_files(options);
    inputs.push_back({"the file of queries", queries});
    if (Result<void> r = check_not_input(options.output, "-o", inputs); !r) return fail(r.error());
    if (Result<void> r = files::check_writable(options.output); !r) return fail(r.error());
  }

  settings.params = options.settings.effect;
  settings.scene = options.settings.scene;
  settings.device = options.device;
  settings.table_cache = table_cache(options.settings.scene);
  std::vector<std::string> notes;
  settings.note = [&](const std::string& text) { notes.push_back(text); };
  Result<std::vector<ProbeAnswer>> answers = std::vector<ProbeAnswer>();
  {
    Progress progress("probe");
    constexpr std::uint64_t kSteps = 10000;
    settings.progress = [&](double done) {
      progress.update(static_cast<std::uint64_t>(done * static_cast<double>(kSteps)), kSteps);
    };
    answers = evaluate_model(model.id, settings, table.value().queries);
  }
  for (const std::string& text : notes) note(text);
  if (!answers) return fail(answers.error());
  const bool to_file = !options.output.empty();
  if (to_file || !options.json) {
    const std::string text =
        answers_as_csv(table.value(), answers.value(), {model.random, is_spectral(settings.params)});
    if (!to_file) return print(text);
    if (Result<void> r = files::write_file(options.output, text); !r) return fail(r.error());
  }
  return options.json ? print(as_json(model, settings, answers.value())) : kDone;
}

}  // namespace tyndall::cli
