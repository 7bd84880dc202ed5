#include "validate_models.hpp"

#include <algorithm>
#include <memory>
#include <optional>

#include "effect/medium.hpp"
#include "gpu/host.hpp"
#include "models/precomputed.hpp"
#include "models/single_scattering.hpp"
#include "models/spectral.hpp"
#include "probe_models.hpp"

namespace tyndall::cli {
namespace {

using validate::Rgb;

// A model of `probe`, and what it needs besides Params.
struct ChosenModel {
  scene::ModelId id;
  std::string device;
  scene::SceneParams scene;
};

Result<std::vector<Rgb>> evaluate_probe(const ChosenModel& model, const Params& params,
                                        std::span<const RayQuery> queries) {
  ProbeSettings settings;
  settings.params = params;
  settings.scene = model.scene;
  settings.device = model.device;
  settings.progress = [](double) {};
  const Result<std::vector<ProbeAnswer>> answers = evaluate_model(model.id, settings, queries);
  if (!answers) return answers.error();
  std::vector<Rgb> out;
  out.reserve(answers.value().size());
  for (const ProbeAnswer& answer : answers.value()) out.push_back(answer.radiance);
  return out;
}

// Evaluates a model with black ground and adds the directly sunlit ground, which the reference includes at the end of a
// ray.
Result<std::vector<Rgb>> evaluate_over_ground(const ChosenModel& model, const Params& params,
                                              std::span<const RayQuery> queries) {
  Result<std::vector<Rgb>> found = evaluate_probe(model, params, queries);
  if (!found || params.planet.ground_albedo == Vec3(0.0F)) return found;
  const shared::Medium medium = medium_from_params(params);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (queries[i].sky_irradiance) continue;
    const models::Ray ray = models::ray_from_query(queries[i]);
    const Rgb ground = models::sunlit_ground(medium, ray);
    const Rgb passed = models::single_scattering(medium, ray, 1).transmittance;
    for (std::size_t c = 0; c < 3; ++c) found.value()[i][c] += passed[c] * ground[c];
  }
  return found;
}

// Evaluates the scattering tables, and stores those of the latest parameters for the next call.
class Tables {
 public:
  Tables(std::string device, tables::CacheDesc cache) : device_(std::move(device)) { how_.cache = std::move(cache); }

  // Returns remarks on the cache, each only once.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  Result<std::vector<Rgb>> evaluate(const Params& params, std::span<const RayQuery> queries) {
    if (Result<void> r = build(params); !r) return std::move(r).error();
    const Result<std::vector<models::Answer>> found = model_->answer(queries);
    if (!found) return found.error();
    std::vector<Rgb> out;
    out.reserve(found.value().size());
    for (const models::Answer& answer : found.value()) out.push_back(answer.radiance);
    return out;
  }

  // Returns the colours of the light, relative to the luminance of the sun.
  Result<std::vector<validate::Color>> colors(const Params& params, std::span<const RayQuery> queries) {
    if (Result<void> r = build(params); !r) return std::move(r).error();
    const Result<std::vector<models::Answer>> found = model_->answer(queries);
    if (!found) return found.error();
    std::vector<validate::Color> out;
    out.reserve(found.value().size());
    for (const models::Answer& answer : found.value()) {
      out.push_back(params.scattering.color == ColorMode::spectral ? color_of_light(models::radiance_of(answer))
                                                                   : answer.radiance);
    }
    return out;
  }

 private:
  Result<void> build(const Params& params) {
    constexpr std::uint32_t kTables =
        1U << static_cast<std::uint32_t>(Affects::Tables) | 1U << static_cast<std::uint32_t>(Affects::Everything);
    if (model_ && (affected(model_->params(), params) & kTables) == 0) return model_->set_params(params);
    model_.reset();
    if (!host_) {
      Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({.device = device_, .graphics = false});
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
          [tables, change](const Params& params, std::span<const RayQuery> queries) {
            Params changed = params;
            change(changed);
            return tables->evaluate(changed, queries);
          }};
}

// Returns the parameterisations of the tables, for the horizon test.
std::vector<validate::Model> parameterizations(const std::shared_ptr<Tables>& tables) {
  std::vector<validate::Model> out;
  for (const auto& [name, value] :
       {std::pair("yusov", TableParameterization::yusov), std::pair("bruneton", TableParameterization::bruneton),
        std::pair("linear", TableParameterization::linear)}) {
    out.push_back(table_model(name, "", tables, [value = value](Params& p) { p.tables.parameterization = value; }));
  }
  return out;
}

// A row of the report for one of the registry's models. `change` sets parameters of the scene.
struct ProbeRow {
  const char* name;
  const char* meaning;  // nullptr for the registry's text
  scene::ModelId id;
  int orders;  // number of orders of the reference that it is compared with; 0: all
  void (*change)(scene::SceneParams& scene);
};
constexpr ProbeRow kProbeRows[] = {
    {"single", nullptr, scene::ModelId::single, 1, [](scene::SceneParams&) {}},
    {"single, against all orders", "single; its error is the multiple scattering that it leaves out",
     scene::ModelId::single, 0, [](scene::SceneParams&) {}},
    {"homogeneous", nullptr, scene::ModelId::homogeneous, 1,
     [](scene::SceneParams& scene) { scene.homogeneous.falloff = false; }},
    {"homogeneous, falling off", "homogeneous, with homogeneous.falloff", scene::ModelId::homogeneous, 1,
     [](scene::SceneParams& scene) { scene.homogeneous.falloff = true; }},
    {"homogeneous medium", nullptr, scene::ModelId::homogeneous_medium, 1, [](scene::SceneParams&) {}},
    {"oneil", nullptr, scene::ModelId::oneil, 1, [](scene::SceneParams&) {}},
    {"oneil, points by column", "oneil, with oneil.spacing = column", scene::ModelId::oneil, 1,
     [](scene::SceneParams& scene) { scene.oneil.spacing = scene::OneilSpacing::column; }},
    {"oneil-table", nullptr, scene::ModelId::oneil_table, 1, [](scene::SceneParams&) {}},
};

std::vector<validate::Model> all_models(const std::string& device, const scene::SceneParams& scene,
                                        const std::shared_ptr<Tables>& tables) {
  const scene::ModelInfo& precomputed = scene::model_info(scene::ModelId::precomputed);
  std::vector<validate::Model> out = {
      table_model(std::string(precomputed.name), std::string(precomputed.meaning), tables,
                  [](Params& p) { p.scattering.single = SingleScattering::table; }),
      table_model("precomputed, order 1 integrated", "precomputed, with scattering.single = integration", tables,
                  [](Params& p) { p.scattering.single = SingleScattering::integration; })};
  for (const ProbeRow& row : kProbeRows) {
    ChosenModel model = {row.id, device, scene};
    row.change(model.scene);
    out.push_back({row.name, row.meaning != nullptr ? row.meaning : std::string(scene::model_info(row.id).meaning),
                   row.orders, [model](const Params& params, std::span<const RayQuery> queries) {
                     return evaluate_over_ground(model, params, queries);
                   }});
  }
  return out;
}

// Returns the tables in both values of scattering.color, for the test of colours.
std::vector<validate::ColorModel> color_models(const std::shared_ptr<Tables>& tables) {
  std::vector<validate::ColorModel> out;
  for (const auto& [name, color] : {std::pair("rgb", ColorMode::rgb), std::pair("spectral", ColorMode::spectral)}) {
    out.push_back({name, [tables, color = color](const Params& params, std::span<const RayQuery> queries) {
                     Params changed = params;
                     changed.scattering.color = color;
                     return tables->colors(changed, queries);
                   }});
  }
  return out;
}

}  // namespace

ValidateModels validate_models(const std::string& device, const scene::SceneParams& scene,
                               const tables::CacheDesc& cache) {
  const auto tables = std::make_shared<Tables>(device, cache);
  return {all_models(device, scene, tables), parameterizations(tables), color_models(tables),
          [tables] { return tables->notes(); }};
}

}  // namespace tyndall::cli
