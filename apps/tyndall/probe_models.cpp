#include "probe_models.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "air/phase.hpp"
#include "effect/medium.hpp"
#include "effect/phase_rows.hpp"
#include "effect/spectral_medium.hpp"
#include "gpu/host.hpp"
#include "models/gpu_probe.hpp"
#include "models/homogeneous_medium.hpp"
#include "models/oneil.hpp"
#include "models/precomputed.hpp"
#include "models/spectral.hpp"
#include "reference/path_tracer.hpp"
#include "reference/spectrum.hpp"
#include "scene/sky/oneil_settings.hpp"
#include "tables/pipeline_store.hpp"

namespace tyndall::cli {
namespace {

// Returns CIE XYZ in cd/m^2 or lux of a linear Rec. 709 colour in the unit of ProbeAnswer::radiance.
std::array<double, 3> luminous_xyz(const std::array<double, 3>& color) {
  constexpr double kLumenPerWatt = 683.0;
  std::array<double, 3> out = xyz_of_color(color);
  for (double& value : out) value *= kLumenPerWatt;
  return out;
}

// Evaluates rays on the GPU. The sky's irradiance, whose quadrature takes hundreds of rays, is computed on the CPU in
// double precision.
Result<std::vector<ProbeAnswer>> run_single(const ProbeSettings& settings, std::span<const RayQuery> queries) {
  const Params& params = settings.params;
  const shared::SpectralMedium medium = spectral_medium_from_params(params);
  const PhaseRows phase = phase_rows(params, params.scattering.color);
  const PhaseRows fourth_phase = models::phase_at_fourth(phase);
  std::vector<ProbeAnswer> answers(queries.size());
  std::vector<models::Ray> rays;
  std::vector<std::size_t> places;  // indices of the rays among the queries
  const auto sky_count = static_cast<double>(
      std::count_if(queries.begin(), queries.end(), [](const RayQuery& q) { return q.sky_irradiance; }));
  double sky_done = 0.0;
  const double sky_share = queries.empty() ? 0.0 : sky_count / static_cast<double>(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const RayQuery& q = queries[i];
    if (q.sky_irradiance) {
      const double cos_sun = std::cos(q.sun_zenith_rad);
      const models::Answer sky =
          models::in_all_channels(params, medium, [&](const shared::Medium& m, bool fourth) -> models::Answer {
            return {models::single_sky_irradiance(m, q.altitude_m, cos_sun, fourth ? fourth_phase : phase),
                    models::sun_transmittance(m, q.altitude_m, cos_sun)};
          });
      answers[i] = probe_answer(params, sky, false);
      settings.progress(sky_share * ++sky_done / sky_count);
    } else {
      rays.push_back(models::ray_from_query(q));
      places.push_back(i);
    }
  }
  if (rays.empty()) return answers;  // no device needed
  Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({.device = settings.device, .graphics = false});
  if (!host) return std::move(host).error();
  const tables::PipelineStore pipelines(*host.value(), settings.table_cache);
  if (settings.note && !pipelines.note().empty()) settings.note(pipelines.note());
  const auto progress = [&](std::size_t done) {
    settings.progress(sky_share + (1.0 - sky_share) * static_cast<double>(done) / static_cast<double>(rays.size()));
  };
  const Result<std::vector<models::Answer>> found =
      models::single_scattering_on_gpu(*host.value(), medium, phase, params.scattering.color, rays, progress);
  if (!found) return found.error();
  for (std::size_t i = 0; i < places.size(); ++i) {
    answers[places[i]] = probe_answer(params, found.value()[i], true);
  }
  return answers;
}

// Traces 40 wavelengths along the same paths.
Result<std::vector<ProbeAnswer>> run_spectral_reference(const ProbeSettings& settings,
                                                        std::span<const RayQuery> queries,
                                                        const reference::Options& options) {
  const reference::VisibleSpectrum spectrum = reference::visible_spectrum_in_rec709();
  const Result<std::vector<reference::SpectralEstimate>> found =
      reference::trace_spectrum(settings.params, {spectrum.nm, spectrum.weights}, queries, options, [&](double done) {
        settings.progress(done);
        return true;
      });
  if (!found) return found.error();
  std::vector<ProbeAnswer> answers;
  answers.reserve(queries.size());
  for (const reference::SpectralEstimate& estimate : found.value()) {
    ProbeAnswer answer;
    answer.radiance = estimate.sums;
    answer.standard_error = estimate.standard_error;
    for (std::size_t i = 0; i < spectrum.nm.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        answer.transmittance[c] += spectrum.weights[i][c] * estimate.transmittance[i] / spectrum.sunlight[c];
      }
    }
    answer.xyz = luminous_xyz(answer.radiance);
    answers.push_back(answer);
  }
  return answers;
}

Result<std::vector<ProbeAnswer>> run_reference(const ProbeSettings& settings, std::span<const RayQuery> queries) {
  reference::Options options;
  options.samples = settings.samples;
  options.orders = static_cast<int>(settings.orders);
  options.seed = settings.seed;
  options.first = settings.first;
  options.stride = settings.stride;
  if (settings.params.scattering.color == ColorMode::spectral)
    return run_spectral_reference(settings, queries, options);
  const Result<std::vector<reference::Estimate>> found =
      reference::trace(settings.params, queries, options, [&](double done) {
        settings.progress(done);
        return true;
      });
  if (!found) return found.error();
  std::vector<ProbeAnswer> answers;
  answers.reserve(queries.size());
  for (const reference::Estimate& estimate : found.value()) {
    answers.push_back({estimate.radiance, estimate.transmittance, estimate.standard_error, false});
  }
  return answers;
}

Result<std::vector<ProbeAnswer>> run_precomputed(const ProbeSettings& settings, std::span<const RayQuery> queries) {
  std::vector<ProbeAnswer> answers;
  if (queries.empty()) return answers;
  Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({.device = settings.device, .graphics = false});
  if (!host) return std::move(host).error();
  const tables::PipelineStore pipelines(*host.value(), settings.table_cache);
  if (settings.note && !pipelines.note().empty()) settings.note(pipelines.note());
  tables::MakeReady how;
  how.cache = settings.table_cache;
  how.progress = [&](Progress built) {
    settings.progress(static_cast<double>(built.done) / static_cast<double>(built.total));
  };
  Result<models::PrecomputedModel> model = models::PrecomputedModel::create(*host.value(), settings.params, how);
  if (!model) return std::move(model).error();
  for (const std::string& text : model.value().origin().notes) {
    if (settings.note) settings.note(text);
  }
  const Result<std::vector<models::Answer>> found = model.value().answer(queries);
  if (!found) return found.error();
  answers.reserve(queries.size());
  for (const models::Answer& answer : found.value()) {
    answers.push_back(probe_answer(settings.params, answer, true));
  }
  return answers;
}

// Evaluates queries one after the other on the CPU.
std::vector<ProbeAnswer> run_on_cpu(const ProbeSettings& settings, std::span<const RayQuery> queries,
                                    const CpuModel& model) {
  if (settings.note) {
    for (const std::string& text : model.notes) settings.note(text);
  }
  std::vector<ProbeAnswer> out;
  out.reserve(queries.size());
  for (const RayQuery& query : queries) {
    out.push_back(probe_answer(settings.params, model.answer(query), false));
    settings.progress(static_cast<double>(out.size()) / static_cast<double>(queries.size()));
  }
  return out;
}

void note_missing_ozone(std::vector<std::string>& notes, const Params& params, const char* model) {
  const bool by_column = params.atmosphere.ozone_du > 0.0F;
  if (!by_column && params.atmosphere.ozone_absorption == Vec3(0.0F)) return;
  notes.push_back(std::string(model) + " has no ozone; atmosphere." + (by_column ? "ozone_du" : "ozone_absorption") +
                  " is ignored");
}

// O'Neil's model in double precision, with the functions that the shaders use.
CpuModel oneil_model(const Params& params, const scene::SceneParams& scene, bool table) {
  const auto model = std::make_shared<const models::OneilModel>(
      models::make_oneil(medium_from_params(params), scene::oneil_settings(scene.oneil, table)));
  CpuModel out;
  out.notes.push_back(models::describe_errors(*model));
  note_missing_ozone(out.notes, params, "O'Neil's model");
  out.answer = [model](const RayQuery& q) -> models::Answer {
    if (!q.sky_irradiance) return models::oneil(*model, models::ray_from_query(q));
    const double cos_sun = std::cos(q.sun_zenith_rad);
    return {models::oneil_sky_irradiance(*model, q.altitude_m, cos_sun),
            models::oneil_sun_transmittance(*model, q.altitude_m, cos_sun)};
  };
  return out;
}

// Hoffman and Preetham's closed forms in double precision.
CpuModel homogeneous_model(const Params& params, const scene::SceneParams& scene) {
  const shared::Homogeneous medium = models::homogeneous_from_params(params, homogeneous_lengths(scene));
  CpuModel out;
  note_missing_ozone(out.notes, params, "the homogeneous model");
  out.answer = [medium](const RayQuery& q) -> models::Answer {
    if (!q.sky_irradiance) return models::homogeneous_light(medium, models::ray_from_query(q));
    const double cos_sun = std::cos(q.sun_zenith_rad);
    return {models::homogeneous_sky_irradiance(medium, q.altitude_m, cos_sun),
            models::homogeneous_sun(medium, q.altitude_m, cos_sun)};
  };
  return out;
}

// The medium of scattering.medium = homogeneous without shadows, in double precision.
CpuModel homogeneous_medium_model(const Params& params) {
  const shared::SpectralMedium sea_level = spectral_medium_from_params(params);
  CpuModel out;
  out.answer = [params, sea_level](const RayQuery& q) {
    return models::in_all_channels(params, sea_level, [&](const shared::Medium& m, bool fourth) -> models::Answer {
      const models::HomogeneousMedium medium = models::homogeneous_medium_from_params(params, m, fourth);
      if (!q.sky_irradiance) return models::homogeneous_medium_light(medium, models::ray_from_query(q));
      return {models::homogeneous_medium_sky(medium, q.altitude_m, std::cos(q.sun_zenith_rad)), medium.sunlight};
    });
  };
  return out;
}

}  // namespace

ProbeAnswer probe_answer(const Params& params, const models::Answer& answer, bool single_precision) {
  if (params.scattering.color == ColorMode::rgb) {
    return {answer.radiance, answer.transmittance, {}, single_precision, {}};
  }
  ProbeAnswer out;
  out.single_precision = single_precision;
  const std::array<double, 3> color = color_of_light(models::radiance_of(answer));
  const std::array<double, 3> sunlight = color_of_light({1.0, 1.0, 1.0, 1.0});
  const std::array<double, 3> passed = color_of_light(models::transmittance_of(answer));
  for (std::size_t c = 0; c < 3; ++c) {
    out.radiance[c] = color[c] * sun_luminous_irradiance();
    out.transmittance[c] = passed[c] / sunlight[c];
  }
  out.xyz = luminous_xyz(out.radiance);
  return out;
}

models::HomogeneousLengths homogeneous_lengths(const scene::SceneParams& scene) {
  const scene::HomogeneousParams& own = scene.homogeneous;
  return {own.air_length_m, own.haze_length_m, own.falloff.value != 0};
}

CpuModel cpu_model(scene::ModelId model, const Params& params, const scene::SceneParams& scene) {
  using Id = scene::ModelId;
  switch (model) {
    case Id::homogeneous: return homogeneous_model(params, scene);
    case Id::homogeneous_medium: return homogeneous_medium_model(params);
    case Id::oneil: return oneil_model(params, scene, false);
    case Id::oneil_table: return oneil_model(params, scene, true);
    case Id::precomputed:
    case Id::single:
    case Id::reference: break;
  }
  return {};
}

Result<void> check_color(scene::ModelId model, ColorMode color) {
  if (color == ColorMode::rgb || scene::model_info(model).spectral) return {};
  return Error{ErrorCode::invalid_argument, "scattering.color: 'spectral' is not supported by the model '" +
                                                std::string(scene::model_info(model).name) +
                                                "', which has three channels; expected rgb"};
}

Result<void> check_phase(scene::ModelId model, const AtmosphereParams& atmosphere) {
  if (!air::tabulated(atmosphere) || scene::model_info(model).spectral) return {};
  const bool table = atmosphere.mie_phase == MiePhase::table;
  return Error{ErrorCode::invalid_argument, "atmosphere.mie_phase: '" + std::string(table ? "table" : "draine") +
                                                "' is not supported by the model '" +
                                                std::string(scene::model_info(model).name) +
                                                "'; expected cornette-shanks or henyey-greenstein"};
}

Result<std::vector<ProbeAnswer>> evaluate_model(scene::ModelId model, const ProbeSettings& settings,
                                                std::span<const RayQuery> queries) {
  using Id = scene::ModelId;
  if (Result<void> r = check_color(model, settings.params.scattering.color); !r) return std::move(r).error();
  if (Result<void> r = check_phase(model, settings.params.atmosphere); !r) return std::move(r).error();
  std::vector<RayQuery> chosen;
  // The random numbers of the reference depend on the indices of all queries.
  if (model != Id::reference && settings.stride > 1) {
    for (std::size_t i = settings.first; i < queries.size(); i += settings.stride) chosen.push_back(queries[i]);
    queries = chosen;
  }
  switch (model) {
    case Id::precomputed: return run_precomputed(settings, queries);
    case Id::single: return run_single(settings, queries);
    case Id::reference: return run_reference(settings, queries);
    case Id::homogeneous:
    case Id::homogeneous_medium:
    case Id::oneil:
    case Id::oneil_table: break;
  }
  return run_on_cpu(settings, queries, cpu_model(model, settings.params, settings.scene));
}

}  // namespace tyndall::cli
