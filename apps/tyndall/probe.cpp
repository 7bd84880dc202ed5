// `tyndall probe`: evaluates a model for given rays. docs/probe.md describes the tables.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "arguments.hpp"
#include "batch.hpp"
#include "cli.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "input_files.hpp"
#include "interruption.hpp"
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

struct ProbeOptions {
  CommonOptions common;
  ProbeSettings settings;
  BatchOptions batch;
  std::string queries;
  std::string model_name;
};

std::optional<int> parse_probe(Args args, ProbeOptions& options) {
  options.model_name = scene::model_registry().front().name;
  std::vector<std::string> model_names;
  for (const scene::ModelInfo& model : scene::model_registry()) model_names.emplace_back(model.name);
  ProbeSettings& settings = options.settings;
  Arguments arguments("probe");
  add_common(arguments, options.common, kScene | kSet | kDevice | kOutput | kJson);
  arguments.text("--queries", options.queries, "FILE",
                 "rays as CSV: altitude_m, view_zenith_deg (or sky), sun_zenith_deg, azimuth_deg");
  arguments.choice("--model", options.model_name, model_names,
                   "model; the ground is black with single and reflects light with reference");
  arguments.count("--orders", settings.orders, 1, kMaxOrders, "orders of scattering of the reference");
  arguments.count("--samples", settings.samples, 1, UINT32_MAX, "paths per ray of the reference");
  arguments.count("--seed", settings.seed, 0, UINT32_MAX, "seed of the random numbers of the reference");
  add_batch_options(arguments, options.batch, "rows of queries");
  return arguments.parse(args);
}

// Checks the options against each other, and the output. `path` is the file that the run writes; empty for stdout.
Result<void> check_probe(const ProbeOptions& options, const std::string& path) {
  if (options.batch.active() && path.empty())
    return files::input_error("no output file", "-o", "expected -o FILE with --shard or --resume");
  if (options.batch.active() && options.common.json)
    return files::input_error("a part of a table is not printed", "--json", "expected no --shard and no --resume");
  if (path.empty()) return {};
  std::vector<InputFile> inputs = input_files(options.common);
  inputs.push_back({"the file of queries", options.queries});
  if (Result<void> r = check_not_input(path, "-o", inputs); !r) return r;
  return files::check_writable(path);
}

// Starts the batch, which has one item: the table of the shard.
Result<Batch> begin_batch(const ProbeOptions& options, const scene::ModelInfo& model, std::size_t rows) {
  const BatchOptions& batch = options.batch;
  BatchDesc desc = {batch, "probe", "tables", options.common.output, rows, {batch.shard.index}, {}};
  if (batch.active()) {
    desc.inputs = common_inputs(options.common);
    desc.inputs.emplace_back("--model", model.name);
    if (model.random) {
      desc.inputs.emplace_back("--orders", std::to_string(options.settings.orders));
      desc.inputs.emplace_back("--samples", std::to_string(options.settings.samples));
      desc.inputs.emplace_back("--seed", std::to_string(options.settings.seed));
    }
    add_file(desc.inputs, "--queries", options.queries);
  }
  return Batch::begin(std::move(desc));
}

// Returns the table, whose notes are printed. Rows that are not part of the run are removed from `table`.
Result<std::vector<ProbeAnswer>> evaluate(ProbeSettings& settings, const scene::ModelInfo& model, const Shard& shard,
                                          ProbeTable& table) {
  settings.first = shard.index;
  settings.stride = shard.count;
  std::vector<std::string> notes;
  settings.note = [&](const std::string& text) { notes.push_back(text); };
  Result<std::vector<ProbeAnswer>> answers = std::vector<ProbeAnswer>();
  {
    Progress progress("probe");
    constexpr std::uint64_t kSteps = 10000;
    settings.progress = [&](double done) {
      progress.update(static_cast<std::uint64_t>(done * static_cast<double>(kSteps)), kSteps);
    };
    answers = evaluate_model(model.id, settings, table.queries);
  }
  for (const std::string& text : notes) note(text);
  select_rows(table, shard);
  return answers;
}

}  // namespace

int run_probe(Args args) {
  Interruption interruption;
  ProbeOptions given;
  if (const std::optional<int> status = parse_probe(args, given)) return *status;
  CommonOptions& options = given.common;
  if (given.queries.empty()) {
    return fail(files::input_error("missing queries", "tyndall probe", "expected --queries FILE"));
  }
  const scene::ModelInfo& model = *scene::find_model(given.model_name);  // the option accepts only names of models
  if (Result<void> r = resolve(options, &model); !r) return fail(r.error());
  Result<ProbeTable> table = read_queries(given.queries);
  if (!table) return fail(table.error());
  for (std::size_t row = 0; row < table.value().queries.size(); ++row) {
    const double altitude_m = table.value().queries[row].altitude_m;
    if (altitude_m >= 0.0) continue;
    const std::string where = files::concat({files::one_line(given.queries, 200), ":",
                                             std::to_string(table.value().input.lines[row]), ": column 'altitude_m'"});
    if (Result<void> r = check_altitude(altitude_m, options.settings.effect, where); !r) return fail(r.error());
  }
  const std::string path =
      options.output.empty() ? std::string() : shard_path(options.output, given.batch.shard, ".csv");
  if (Result<void> r = check_probe(given, path); !r) return fail(r.error());
  Result<Batch> batch = begin_batch(given, model, table.value().queries.size());
  if (!batch) return fail(batch.error());
  interruption.describe_by(batch.value().describe());

  ProbeSettings& settings = given.settings;
  settings.params = options.settings.effect;
  settings.scene = options.settings.scene;
  settings.device = options.device;
  settings.table_cache = table_cache(options.settings.scene);
  if (!batch.value().numbers().empty()) {
    const Result<std::vector<ProbeAnswer>> answers = evaluate(settings, model, given.batch.shard, table.value());
    if (!answers) return fail(answers.error());
    const std::string text =
        path.empty() && options.json
            ? std::string()
            : answers_as_csv(table.value(), answers.value(), {model.random, is_spectral(settings.params)});
    if (path.empty()) return print(options.json ? as_json(model, settings, answers.value()) : text);
    if (Result<void> r = files::write_file(path, text); !r) return fail(r.error());
    if (Result<void> r = batch.value().finished(given.batch.shard.index, {path}); !r) return fail(r.error());
    if (options.json) return print(as_json(model, settings, answers.value()));
  }
  const Result<void> ended = batch.value().end();
  return ended ? kDone : fail(ended.error());
}

}  // namespace tyndall::cli
