#include "probe_models.hpp"

#include <algorithm>
#include <cmath>

#include "effect/medium.hpp"
#include "gpu/host.hpp"
#include "models/gpu_probe.hpp"
#include "models/homogeneous_medium.hpp"
#include "models/oneil.hpp"
#include "models/precomputed.hpp"
#include "reference/path_tracer.hpp"
#include "scene/sky/oneil_settings.hpp"

namespace tyndall::cli {
namespace {

// Rays on the GPU; the sky, whose quadrature takes hundreds of rays, on the CPU in double precision.
Result<std::vector<ProbeAnswer>> run_single(const ProbeSettings& settings, std::span<const ProbeQuery> queries) {
  const shared::Medium medium = medium_from_params(settings.params);
  std::vector<ProbeAnswer> answers(queries.size());
  std::vector<models::Ray> rays;
  std::vector<std::size_t> places;  // of the rays among the queries
  const auto sky_count =
      static_cast<double>(std::count_if(queries.begin(), queries.end(), [](const ProbeQuery& q) { return q.sky; }));
  double sky_done = 0.0;
  const double sky_share = queries.empty() ? 0.0 : sky_count / static_cast<double>(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const ProbeQuery& q = queries[i];
    if (q.sky) {
      const double cos_sun = std::cos(q.sun_zenith_rad);
      answers[i].radiance = models::single_sky_irradiance(medium, q.altitude_m, cos_sun);
      answers[i].transmittance = models::sun_transmittance(medium, q.altitude_m, cos_sun);
      settings.progress(sky_share * ++sky_done / sky_count);
    } else {
      rays.push_back(models::ray_from_angles(q.altitude_m, q.view_zenith_rad, q.sun_zenith_rad, q.azimuth_rad));
      places.push_back(i);
    }
  }
  if (rays.empty()) return answers;  // needs no device
  Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({settings.device, false});
  if (!host) return std::move(host).error();
  const auto progress = [&](std::size_t done) {
    settings.progress(sky_share + (1.0 - sky_share) * static_cast<double>(done) / static_cast<double>(rays.size()));
  };
  const Result<std::vector<models::Answer>> found =
      models::single_scattering_on_gpu(*host.value(), medium, rays, progress);
  if (!found) return found.error();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const models::Answer& answer = found.value()[i];
    answers[places[i]] = {answer.radiance, answer.transmittance, {}, true};
  }
  return answers;
}

Result<std::vector<ProbeAnswer>> run_reference(const ProbeSettings& settings, std::span<const ProbeQuery> queries) {
  std::vector<reference::Query> asked;
  asked.reserve(queries.size());
  for (const ProbeQuery& q : queries) {
    asked.push_back({q.altitude_m, q.view_zenith_rad, q.sun_zenith_rad, q.azimuth_rad, q.sky});
  }
  reference::Options options;
  options.samples = settings.samples;
  options.orders = static_cast<int>(settings.orders);
  options.seed = settings.seed;
  const Result<std::vector<reference::Estimate>> found =
      reference::trace(settings.params, asked, options, [&](double done) {
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

Result<std::vector<ProbeAnswer>> run_precomputed(const ProbeSettings& settings, std::span<const ProbeQuery> queries) {
  std::vector<ProbeAnswer> answers;
  if (queries.empty()) return answers;
  std::vector<models::PrecomputedQuery> asked;
  asked.reserve(queries.size());
  for (const ProbeQuery& q : queries) {
    asked.push_back({models::ray_from_angles(q.altitude_m, q.view_zenith_rad, q.sun_zenith_rad, q.azimuth_rad), q.sky});
  }
  Result<std::unique_ptr<gpu::Host>> host = gpu::Host::create({settings.device, false});
  if (!host) return std::move(host).error();
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
  const Result<std::vector<models::Answer>> found = model.value().answer(asked);
  if (!found) return found.error();
  answers.reserve(queries.size());
  for (const models::Answer& answer : found.value()) {
    answers.push_back({answer.radiance, answer.transmittance, {}, true});
  }
  return answers;
}

// On the CPU in double precision: the functions that the shaders draw with.
Result<std::vector<ProbeAnswer>> run_oneil_model(const ProbeSettings& settings, std::span<const ProbeQuery> queries,
                                                 bool table) {
  const models::OneilModel model =
      models::make_oneil(medium_from_params(settings.params), scene::oneil_settings(settings.scene.oneil, table));
  if (settings.note) settings.note(models::describe_errors(model));
  if (settings.note && settings.params.atmosphere.ozone_absorption != Vec3(0.0F)) {
    settings.note("O'Neil's model has no ozone: atmosphere.ozone_absorption is left out");
  }
  std::vector<ProbeAnswer> answers;
  answers.reserve(queries.size());
  for (const ProbeQuery& q : queries) {
    if (q.sky) {
      const double cos_sun = std::cos(q.sun_zenith_rad);
      answers.push_back({models::oneil_sky_irradiance(model, q.altitude_m, cos_sun),
                         models::oneil_sun_transmittance(model, q.altitude_m, cos_sun),
                         {},
                         false});
    } else {
      const models::Answer answer = models::oneil(
          model, models::ray_from_angles(q.altitude_m, q.view_zenith_rad, q.sun_zenith_rad, q.azimuth_rad));
      answers.push_back({answer.radiance, answer.transmittance, {}, false});
    }
    settings.progress(static_cast<double>(answers.size()) / static_cast<double>(queries.size()));
  }
  return answers;
}

Result<std::vector<ProbeAnswer>> run_oneil(const ProbeSettings& settings, std::span<const ProbeQuery> queries) {
  return run_oneil_model(settings, queries, false);
}

Result<std::vector<ProbeAnswer>> run_oneil_table(const ProbeSettings& settings, std::span<const ProbeQuery> queries) {
  return run_oneil_model(settings, queries, true);
}

// Closed forms, on the CPU in double precision.
Result<std::vector<ProbeAnswer>> run_homogeneous(const ProbeSettings& settings, std::span<const ProbeQuery> queries) {
  const shared::Homogeneous medium =
      models::homogeneous_from_params(settings.params, homogeneous_lengths(settings.scene));
  if (settings.note && settings.params.atmosphere.ozone_absorption != Vec3(0.0F)) {
    settings.note("the homogeneous model has no ozone: atmosphere.ozone_absorption is left out");
  }
  std::vector<ProbeAnswer> answers;
  answers.reserve(queries.size());
  for (const ProbeQuery& q : queries) {
    if (q.sky) {
      const double cos_sun = std::cos(q.sun_zenith_rad);
      answers.push_back(
          {models::homogeneous_sky_irradiance(medium, cos_sun), models::homogeneous_sun(medium, cos_sun), {}, false});
      continue;
    }
    const models::Answer answer = models::homogeneous_light(
        medium, models::ray_from_angles(q.altitude_m, q.view_zenith_rad, q.sun_zenith_rad, q.azimuth_rad));
    answers.push_back({answer.radiance, answer.transmittance, {}, false});
  }
  return answers;
}

// The medium of scattering.medium = homogeneous, wholly lit, on the CPU in double precision.
Result<std::vector<ProbeAnswer>> run_homogeneous_medium(const ProbeSettings& settings,
                                                        std::span<const ProbeQuery> queries) {
  const models::HomogeneousMedium medium = models::homogeneous_medium_from_params(settings.params);
  std::vector<ProbeAnswer> answers;
  answers.reserve(queries.size());
  for (const ProbeQuery& q : queries) {
    if (q.sky) {
      answers.push_back({models::homogeneous_medium_sky(medium, q.altitude_m, std::cos(q.sun_zenith_rad)),
                         medium.sunlight,
                         {},
                         false});
      continue;
    }
    const models::Answer answer = models::homogeneous_medium_light(
        medium, models::ray_from_angles(q.altitude_m, q.view_zenith_rad, q.sun_zenith_rad, q.azimuth_rad));
    answers.push_back({answer.radiance, answer.transmittance, {}, false});
  }
  return answers;
}

constexpr ProbeModel kModels[] = {
    {"precomputed", false, run_precomputed},
    {"single", false, run_single},
    {"homogeneous", false, run_homogeneous},
    {"homogeneous-medium", false, run_homogeneous_medium},
    {"oneil", false, run_oneil},
    {"oneil-table", false, run_oneil_table},
    {"reference", true, run_reference},
};

}  // namespace

models::HomogeneousLengths homogeneous_lengths(const scene::SceneParams& scene) {
  const scene::HomogeneousParams& own = scene.homogeneous;
  return {own.air_length_m, own.haze_length_m, own.falloff.value != 0};
}

std::span<const ProbeModel> probe_models() { return kModels; }

}  // namespace tyndall::cli
