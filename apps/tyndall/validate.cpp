// `tyndall validate`: compares every model with the path tracer and writes a report.
#include <filesystem>

#include "arguments.hpp"
#include "batch.hpp"
#include "cli.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "gpu/host.hpp"
#include "input_files.hpp"
#include "interruption.hpp"
#include "make_tables.hpp"
#include "tyndall/version.hpp"
#include "validate/parts.hpp"
#include "validate/report.hpp"
#include "validate_models.hpp"
#include "validate_part.hpp"

namespace tyndall::cli {
namespace {

using files::concat;

// Returns the command line that produces the same report, without the locations of files.
std::string command_line(const CommonOptions& options, const validate::Options& study) {
  std::string out = concat({"tyndall validate -o REPORT.html --rays ", std::to_string(study.rays), " --samples ",
                            std::to_string(study.samples), " --seed ", std::to_string(study.seed), " --orders ",
                            std::to_string(study.orders)});
  for (const std::string& set : options.sets) out += concat({" --set ", files::one_line(set, 200)});
  if (!options.scene_file.empty()) {
    out += concat({" ", files::one_line(std::filesystem::path(options.scene_file).filename().string(), 200)});
  }
  return out;
}

bool is_markdown(const std::string& path) { return path.ends_with(".md"); }

struct ValidateOptions {
  CommonOptions common;
  validate::Options study;
  std::string markdown;
  BatchOptions batch;
  // Returns whether the run computes a part, which is not a report.
  [[nodiscard]] bool part() const { return batch.shard.count > 1; }
};

std::optional<int> parse_validate(Args args, ValidateOptions& options) {
  std::uint32_t seed = 1;
  std::uint32_t orders = 8;
  Arguments arguments("validate");
  add_common(arguments, options.common, kScene | kSet | kDevice | kOutput | kJson);
  arguments.text("--markdown", options.markdown, "FILE",
                 "also write the summary as Markdown (docs/generated/accuracy.md)");
  const auto count = [&arguments](std::size_t i, std::uint32_t& value, const char* meaning) {
    arguments.count(kStudyRanges[i].option, value, kStudyRanges[i].min, kStudyRanges[i].max, meaning);
  };
  count(0, options.study.rays, "rays of the error tables");
  count(1, options.study.samples, "paths per ray of the reference");
  count(2, seed, "seed of the rays and the paths");
  count(3, orders, "orders of scattering of the reference");
  add_batch_options(arguments, options.batch, "rays");
  const std::optional<int> status = arguments.parse(args);
  options.study.seed = seed;
  options.study.orders = static_cast<int>(orders);
  return status;
}

// Checks the options against each other, and the outputs.
Result<void> check_validate(const ValidateOptions& options) {
  const CommonOptions& common = options.common;
  if (options.batch.active() && common.output.empty())
    return files::input_error("no output file", "-o", "expected -o REPORT.html with --shard or --resume");
  if (options.batch.active() && common.json)
    return files::input_error("a part of a report is not printed", "--json", "expected no --shard and no --resume");
  if (options.part() && !options.markdown.empty())
    return files::input_error("a part is not a page", "--markdown", "expected 'tyndall merge PAGE.md' for all parts");
  if (common.output.empty() && options.markdown.empty() && !common.json)
    return files::input_error("no output file", "-o", "expected -o REPORT.html, --markdown FILE or --json");
  if (!common.output.empty()) {
    if (Result<void> r = check_output(common, {".html", ".htm"}); !r) return r;
  }
  if (options.markdown.empty()) return {};
  if (!is_markdown(options.markdown)) {
    return files::input_error(concat({"unknown format '", files::one_line(options.markdown), "'"}), "--markdown",
                              "expected a name that ends in .md");
  }
  if (Result<void> r = check_not_input(options.markdown, "--markdown", input_files(common)); !r) return r;
  return files::check_writable(options.markdown);
}

// Starts the batch, which has one item: the report, or the part of this shard.
Result<Batch> begin_batch(const ValidateOptions& options) {
  const BatchOptions& batch = options.batch;
  BatchDesc desc = {batch, "validate", "reports", options.common.output, 0, {batch.shard.index}, {}};
  if (batch.active()) {
    desc.total = validate::count_queries(options.common.settings.effect, options.study, true);
    desc.inputs = common_inputs(options.common);
    desc.inputs.emplace_back("--rays", std::to_string(options.study.rays));
    desc.inputs.emplace_back("--samples", std::to_string(options.study.samples));
    desc.inputs.emplace_back("--seed", std::to_string(options.study.seed));
    desc.inputs.emplace_back("--orders", std::to_string(options.study.orders));
    desc.inputs.emplace_back("command", command_line(options.common, options.study));
    if (!options.markdown.empty()) desc.inputs.emplace_back("--markdown", files::one_line(options.markdown, 1000));
  }
  return Batch::begin(std::move(desc));
}

struct Parts {
  validate::StudyPart rays;
  validate::ColorPart colors;
};

// Computes the queries of a shard.
Result<Parts> evaluate(const Params& params, const validate::Options& how, const ValidateModels& models,
                       const Shard& shard) {
  constexpr std::uint64_t kSteps = 1000;
  const auto show = [](Progress& progress) {
    return [&progress](double done) {
      progress.update(static_cast<std::uint64_t>(done * static_cast<double>(kSteps)), kSteps);
    };
  };
  const validate::PartIndex part = {shard.index, shard.count};
  Result<validate::StudyPart> rays = validate::StudyPart();
  {
    Progress progress("validate");
    rays = validate::run_study_part(params, how, models.rays, models.horizon, part, show(progress));
  }
  if (!rays) return std::move(rays).error();
  Progress progress("colours");
  Result<validate::ColorPart> colors =
      validate::run_color_part(params, models.colors, how.samples, how.seed, how.orders, part, show(progress));
  if (!colors) return std::move(colors).error();
  return Parts{std::move(rays).value(), std::move(colors).value()};
}

}  // namespace

int run_validate(Args args) {
  Interruption interruption;
  ValidateOptions options;
  if (const std::optional<int> status = parse_validate(args, options)) return *status;
  CommonOptions& common = options.common;
  if (Result<void> r = resolve(common); !r) return fail(r.error());
  if (Result<void> r = check_validate(options); !r) return fail(r.error());
  Result<Batch> batch = begin_batch(options);
  if (!batch) return fail(batch.error());
  interruption.describe_by(batch.value().describe());
  if (batch.value().numbers().empty()) {
    const Result<void> ended = batch.value().end();
    return ended ? kDone : fail(ended.error());
  }

  validate::Origin origin = {command_line(common, options.study), TYNDALL_VERSION_STRING, ""};
  {
    const Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({.device = common.device, .graphics = false});
    if (!host) return fail(host.error());
    origin.device = host.value()->device_name();
  }
  batch.value().set_device(origin.device);
  // The study compares three channels. The test of colours evaluates both values of scattering.color.
  Params params = common.settings.effect;
  params.scattering.color = ColorMode::rgb;
  const ValidateModels models =
      validate_models(common.device, common.settings.scene, table_cache(common.settings.scene));
  Result<Parts> parts = evaluate(params, options.study, models, options.batch.shard);
  for (const std::string& text : models.notes()) note(text);
  if (!parts) return fail(parts.error());
  std::vector<std::string> written;
  const auto write = [&](const std::string& path, const std::string& text) {
    written.push_back(path);
    return files::write_file(path, text);
  };
  std::string printed;
  if (options.part()) {
    const std::string path = shard_path(common.output, options.batch.shard, kPartEnding);
    if (Result<void> r = write(path, part_json(parts.value().rays, parts.value().colors)); !r) return fail(r.error());
  } else {
    const Result<validate::Study> study =
        validate::join_study(params, options.study, models.rays, models.horizon, {std::move(parts.value().rays)});
    if (!study) return fail(study.error());
    const Result<validate::ColorTest> colors = validate::join_colors(models.colors, {std::move(parts.value().colors)});
    if (!colors) return fail(colors.error());
    if (!common.output.empty()) {
      if (Result<void> r = write(common.output, to_html(study.value(), origin)); !r) return fail(r.error());
    }
    if (!options.markdown.empty()) {
      if (Result<void> r = write(options.markdown, to_markdown(study.value(), colors.value(), origin)); !r)
        return fail(r.error());
    }
    if (common.json) printed = to_json(study.value(), colors.value(), origin);
  }
  if (Result<void> r = batch.value().finished(options.batch.shard.index, written); !r) return fail(r.error());
  if (Result<void> r = batch.value().end(); !r) return fail(r.error());
  return printed.empty() ? kDone : print(printed);
}

}  // namespace tyndall::cli
