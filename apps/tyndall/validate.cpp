// `tyndall validate`: every model against the path tracer, as a report.
#include <algorithm>
#include <filesystem>

#include "arguments.hpp"
#include "cli.hpp"
#include "effect/medium.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "gpu/host.hpp"
#include "input_files.hpp"
#include "make_tables.hpp"
#include "models/precomputed.hpp"
#include "models/single_scattering.hpp"
#include "probe_models.hpp"
#include "tyndall/version.hpp"
#include "validate/report.hpp"

namespace tyndall::cli {
namespace {

using files::concat;
using validate::Rgb;

// Answers of one of probe's models; a ray that ends on lit ground sees it, as in the reference.
Result<std::vector<Rgb>> ask_probe(const ProbeModel& model, const std::string& device, const scene::SceneParams& scene,
                                   const Params& params, std::span<const reference::Query> queries) {
  ProbeSettings settings;
  settings.params = params;
  settings.scene = scene;
  settings.device = device;
  settings.progress = [](double) {};
  std::vector<ProbeQuery> asked;
  asked.reserve(queries.size());
  for (const reference::Query& q : queries) {
    asked.push_back({q.sky_irradiance, q.altitude_m, q.view_zenith_rad, q.sun_zenith_rad, q.azimuth_rad});
  }
  const Result<std::vector<ProbeAnswer>> answers = model.run(settings, asked);
  if (!answers) return answers.error();
  std::vector<Rgb> out;
  out.reserve(answers.value().size());
  for (const ProbeAnswer& answer : answers.value()) out.push_back(answer.radiance);
  return out;
}

const ProbeModel& probe_model(std::string_view name) {
  return *std::find_if(probe_models().begin(), probe_models().end(),
                       [&](const ProbeModel& m) { return m.name == name; });
}

// A model whose ground is black, with the ground that the sun lights directly added.
Result<std::vector<Rgb>> ask_over_ground(const ProbeModel& model, const std::string& device,
                                         const scene::SceneParams& scene, const Params& params,
                                         std::span<const reference::Query> queries) {
  Result<std::vector<Rgb>> found = ask_probe(model, device, scene, params, queries);
  if (!found || params.planet.ground_albedo == 0.0F) return found;
  const shared::Medium medium = medium_from_params(params);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const reference::Query& q = queries[i];
    if (q.sky_irradiance) continue;
    const models::Ray ray = models::ray_from_angles(q.altitude_m, q.view_zenith_rad, q.sun_zenith_rad, q.azimuth_rad);
    const Rgb ground = models::sunlit_ground(medium, ray);
    const Rgb passed = models::single_scattering(medium, ray, 1).transmittance;
    for (std::size_t c = 0; c < 3; ++c) found.value()[i][c] += passed[c] * ground[c];
  }
  return found;
}

// The tables of the last parameters that were asked for, kept for the next question.
class Tables {
 public:
  Tables(std::string device, tables::CacheDesc cache) : device_(std::move(device)) { how_.cache = std::move(cache); }

  // About the cache, each but once.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  Result<std::vector<Rgb>> ask(const Params& params, std::span<const reference::Query> queries) {
    if (Result<void> r = build(params); !r) return std::move(r).error();
    std::vector<models::PrecomputedQuery> asked;
    asked.reserve(queries.size());
    for (const reference::Query& q : queries) {
      asked.push_back({models::ray_from_angles(q.altitude_m, q.view_zenith_rad, q.sun_zenith_rad, q.azimuth_rad),
                       q.sky_irradiance});
    }
    const Result<std::vector<models::Answer>> found = model_->answer(asked);
    if (!found) return found.error();
    std::vector<Rgb> out;
    out.reserve(found.value().size());
    for (const models::Answer& answer : found.value()) out.push_back(answer.radiance);
    return out;
  }

 private:
  Result<void> build(const Params& params) {
    constexpr std::uint32_t kTables = 1U << static_cast<std::uint32_t>(Affects::Tables);
    if (model_ && (affected(model_->effect().params(), params) & kTables) == 0)
      return model_->effect().set_params(params);
    model_.reset();
    if (!host_) {
      Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({device_, false});
      if (!host) return std::move(host).error();
      host_ = std::move(host).value();
    }
    Result<models::PrecomputedModel> model = models::PrecomputedModel::create(*host_, params, how_);
    if (!model) return std::move(model).error();
    for (const std::string& text : model.value().origin().notes) {
      if (std::find(notes_.begin(), notes_.end(), text) == notes_.end()) notes_.push_back(text);
    }
    model_.emplace(std::move(model).value());
    return {};
  }

  std::string device_;
  tables::MakeReady how_;
  std::vector<std::string> notes_;
  std::unique_ptr<gpu::Host> host_;
  std::optional<models::PrecomputedModel> model_;
};

validate::Model table_model(std::string name, std::string meaning, const std::shared_ptr<Tables>& tables,
                            const std::function<void(Params&)>& change) {
  return {std::move(name), std::move(meaning), 0,
          [tables, change](const Params& params, std::span<const reference::Query> queries) {
            Params changed = params;
            change(changed);
            return tables->ask(changed, queries);
          }};
}

// The parameterisations of the tables, for the horizon.
std::vector<validate::Model> parameterizations(const std::shared_ptr<Tables>& tables) {
  std::vector<validate::Model> out;
  for (const auto& [name, value] :
       {std::pair("yusov", TableParameterization::yusov), std::pair("bruneton", TableParameterization::bruneton),
        std::pair("linear", TableParameterization::linear)}) {
    out.push_back(table_model(name, "", tables, [value = value](Params& p) { p.tables.parameterization = value; }));
  }
  return out;
}

// One of probe's models over black ground, which claims `orders` orders (0: is compared with all).
validate::Model probe_row(std::string name, std::string meaning, int orders, std::string_view model,
                          const std::string& device, const scene::SceneParams& scene) {
  return {
      std::move(name), std::move(meaning), orders,
      [&model = probe_model(model), device, scene](const Params& params, std::span<const reference::Query> queries) {
        return ask_over_ground(model, device, scene, params, queries);
      }};
}

std::vector<validate::Model> all_models(const std::string& device, const scene::SceneParams& scene,
                                        const std::shared_ptr<Tables>& tables) {
  scene::SceneParams by_column = scene;
  by_column.oneil.spacing = scene::OneilSpacing::column;
  scene::SceneParams everywhere = scene;
  everywhere.homogeneous.falloff = false;
  scene::SceneParams falling = scene;
  falling.homogeneous.falloff = true;
  return {
      table_model("precomputed", "all orders, from the renderer's tables", tables,
                  [](Params& p) { p.scattering.single = SingleScattering::table; }),
      table_model("precomputed, order 1 integrated", "the same with scattering.single = integration", tables,
                  [](Params& p) { p.scattering.single = SingleScattering::integration; }),
      probe_row("single", "light scattered once, integrated for every ray", 1, "single", device, scene),
      probe_row("single, against all orders", "the same: what leaving out multiple scattering costs", 0, "single",
                device, scene),
      probe_row("homogeneous",
                "Hoffman and Preetham: closed forms for one density at every altitude, no ozone, no other sunset "
                "than the horizontal",
                1, "homogeneous", device, everywhere),
      probe_row("homogeneous, falling off", "the same with homogeneous.falloff", 1, "homogeneous", device, falling),
      probe_row("homogeneous medium",
                "Yusov 2012: scattering.medium = homogeneous, wholly lit: one density out to its extent, "
                "sunlight that nothing takes from, no sunset",
                1, "homogeneous-medium", device, scene),
      probe_row("oneil", "O'Neil: light scattered once, few points and the scale function, no ozone", 1, "oneil",
                device, scene),
      probe_row("oneil, points by column", "the same with oneil.spacing = column", 1, "oneil", device, by_column),
      probe_row("oneil-table", "the same as oneil with the table of 2004", 1, "oneil-table", device, scene),
  };
}

// What makes the same report, but for where files are.
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

}  // namespace

int run_validate(Args args) {
  CommonOptions options;
  validate::Options study_options;
  std::uint32_t seed = 1;
  std::uint32_t orders = 8;
  std::string markdown;
  Arguments arguments("validate");
  add_common(arguments, options, kScene | kSet | kDevice | kOutput | kJson);
  arguments.text("--markdown", markdown, "FILE", "write the summary as Markdown too (docs/generated/accuracy.md)");
  arguments.count("--rays", study_options.rays, 18, 1000000, "rays of the error tables");
  arguments.count("--samples", study_options.samples, 2, 1000000000, "paths per ray of the reference");
  arguments.count("--seed", seed, 0, UINT32_MAX, "of the rays and the paths");
  arguments.count("--orders", orders, 1, 256, "orders of scattering of the reference");
  if (const std::optional<int> status = arguments.parse(args)) return *status;
  study_options.seed = seed;
  study_options.orders = static_cast<int>(orders);
  if (Result<void> r = resolve(options); !r) return fail(r.error());
  if (options.output.empty() && markdown.empty() && !options.json) {
    return fail(files::input_error("no output file", "-o", "needed is -o REPORT.html, --markdown FILE or --json"));
  }
  if (!options.output.empty()) {
    if (Result<void> r = check_output(options, {".html", ".htm"}); !r) return fail(r.error());
  }
  if (!markdown.empty()) {
    if (!is_markdown(markdown)) {
      return fail(files::input_error(concat({"unknown format '", files::one_line(markdown), "'"}), "--markdown",
                                     "allowed is a name in .md"));
    }
    if (Result<void> r = check_not_input(markdown, "--markdown", input_files(options)); !r) return fail(r.error());
    if (Result<void> r = files::check_writable(markdown); !r) return fail(r.error());
  }

  validate::Origin origin = {command_line(options, study_options), TYNDALL_VERSION_STRING, ""};
  {
    const Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({options.device, false});
    if (!host) return fail(host.error());
    origin.device = host.value()->device_name();
  }
  Result<validate::Study> study = validate::Study();
  const auto tables = std::make_shared<Tables>(options.device, table_cache(options.settings.scene));
  {
    Progress progress("validate");
    constexpr std::uint64_t kSteps = 1000;
    study = validate::run_study(
        options.settings.effect, study_options, all_models(options.device, options.settings.scene, tables),
        parameterizations(tables),
        [&](double done) { progress.update(static_cast<std::uint64_t>(done * static_cast<double>(kSteps)), kSteps); });
  }
  for (const std::string& text : tables->notes()) note(text);
  if (!study) return fail(study.error());
  if (!options.output.empty()) {
    if (Result<void> r = files::write_file(options.output, to_html(study.value(), origin)); !r) return fail(r.error());
  }
  if (!markdown.empty()) {
    if (Result<void> r = files::write_file(markdown, to_markdown(study.value(), origin)); !r) return fail(r.error());
  }
  return options.json ? print(to_json(study.value(), origin)) : kDone;
}

}  // namespace tyndall::cli
