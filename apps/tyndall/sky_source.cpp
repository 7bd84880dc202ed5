#include "sky_source.hpp"

#include <algorithm>
#include <numbers>

#include "cli.hpp"
#include "effect/phase_rows.hpp"
#include "effect/spectral_medium.hpp"
#include "make_tables.hpp"
#include "models/gpu_probe.hpp"
#include "models/precomputed.hpp"
#include "models/spectral.hpp"
#include "scene/description/model_registry.hpp"
#include "sky_light.hpp"

namespace tyndall::cli {
namespace {

constexpr std::size_t kBatchRays = 131072;

// Single scattering, and the ground in direct sunlight.
class SingleSource final : public SkySource {
 public:
  SingleSource(gpu::Host& host, const Params& params)
      : host_(host),
        params_(params),
        medium_(spectral_medium_from_params(params)),
        phase_(phase_rows(params, params.scattering.color)) {}

  Result<std::vector<models::Answer>> answer(std::span<const RayQuery> queries) override {
    std::vector<models::Ray> rays;
    rays.reserve(queries.size());
    for (const RayQuery& query : queries) rays.push_back(models::ray_from_query(query));
    Result<std::vector<models::Answer>> found =
        models::single_scattering_on_gpu(host_, medium_, phase_, params_.scattering.color, rays);
    if (!found || medium_.ground_albedo == Vec3(0.0F)) return found;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      models::Answer& answer = found.value()[i];
      const models::Answer ground =
          models::in_all_channels(params_, medium_, [&](const shared::Medium& m) -> models::Answer {
            return {models::sunlit_ground(m, rays[i]), {}};
          });
      for (std::size_t c = 0; c < 3; ++c) answer.radiance[c] += answer.transmittance[c] * ground.radiance[c];
      answer.radiance_fourth += answer.transmittance_fourth * ground.radiance_fourth;
    }
    return found;
  }

 private:
  gpu::Host& host_;
  const Params params_;
  shared::SpectralMedium medium_;
  PhaseRows phase_;
};

// All orders of scattering from the tables, and the ground under sun and sky.
class PrecomputedSource final : public SkySource {
 public:
  explicit PrecomputedSource(models::PrecomputedModel model) : model_(std::move(model)) {}

  Result<std::vector<models::Answer>> answer(std::span<const RayQuery> queries) override {
    return model_.answer(queries);
  }
  [[nodiscard]] const tables::Report* tables() const override { return &model_.origin(); }

 private:
  models::PrecomputedModel model_;
};

using MakeSource = Result<std::unique_ptr<SkySource>> (*)(gpu::Host& host, const config::Settings& settings);

Result<std::unique_ptr<SkySource>> make_single(gpu::Host& host, const config::Settings& settings) {
  return std::unique_ptr<SkySource>(std::make_unique<SingleSource>(host, settings.effect));
}

Result<std::unique_ptr<SkySource>> make_precomputed(gpu::Host& host, const config::Settings& settings) {
  Result<models::PrecomputedModel> model =
      models::PrecomputedModel::create(host, settings.effect, make_tables(settings.scene));
  if (!model) return std::move(model).error();
  for (const std::string& text : model.value().origin().notes) note(text);
  return std::unique_ptr<SkySource>(std::make_unique<PrecomputedSource>(std::move(model).value()));
}

// A model of the registry that can make maps.
struct SkyModel {
  scene::ModelId id;
  MakeSource make;
  [[nodiscard]] std::string_view name() const { return scene::model_info(id).name; }
};
constexpr SkyModel kSkyModels[] = {{scene::ModelId::precomputed, make_precomputed},
                                   {scene::ModelId::single, make_single}};

// Returns the radiance of an answer in the channels of the image, per irradiance of the sun.
std::array<double, 3> channels_of(const models::Answer& answer, ColorMode color) {
  return color == ColorMode::spectral ? color_of_light(models::radiance_of(answer)) : answer.radiance;
}

}  // namespace

std::vector<std::string> sky_models() {
  std::vector<std::string> names;
  for (const SkyModel& model : kSkyModels) names.emplace_back(model.name());
  return names;
}

Result<std::unique_ptr<SkySource>> make_sky_source(const std::string& model, gpu::Host& host,
                                                   const config::Settings& settings) {
  const SkyModel* const found =
      std::find_if(std::begin(kSkyModels), std::end(kSkyModels), [&](const SkyModel& m) { return m.name() == model; });
  return found->make(host, settings);
}

Result<void> fill(image::Image& image, const SkyMap& map, const std::array<double, 3>& irradiance, ColorMode color,
                  SkySource& source, std::string_view label) {
  Progress progress(label);
  const std::uint32_t rows = static_cast<std::uint32_t>(std::max<std::size_t>(kBatchRays / map.width, 1));
  std::vector<RayQuery> queries;
  for (std::uint32_t first = 0; first < map.height; first += rows) {
    progress.update(first, map.height);
    const std::uint32_t last = std::min(first + rows, map.height);
    queries.clear();
    for (std::uint32_t y = first; y < last; ++y) {
      for (std::uint32_t x = 0; x < map.width; ++x) queries.push_back(map.query(x, y));
    }
    const Result<std::vector<models::Answer>> found = source.answer(queries);
    if (!found) return found.error();
    float* out = image.pixel(0, first);
    std::uint32_t pixel = first * map.width;
    for (const models::Answer& answer : found.value()) {
      const bool seen = map.direction(pixel % map.width, pixel / map.width).solid_angle > 0.0;
      ++pixel;
      const std::array<double, 3> radiance = channels_of(answer, color);
      for (std::size_t c = 0; c < 3; ++c) *out++ = seen ? static_cast<float>(irradiance[c] * radiance[c]) : 0.0F;
    }
  }
  return {};
}

Result<std::array<double, 3>> sky_irradiance(const SkyMap& map, const std::array<double, 3>& irradiance,
                                             ColorMode color, SkySource& source) {
  const SkyQuadrature quadrature = sky_quadrature(map.altitude_m, 0.5 * std::numbers::pi - map.sun_elevation_rad);
  const Result<std::vector<models::Answer>> found = source.answer(quadrature.queries);
  if (!found) return found.error();
  std::array<double, 3> sum = {};
  for (std::size_t i = 0; i < quadrature.weights.size(); ++i) {
    const std::array<double, 3> radiance = channels_of(found.value()[i], color);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += quadrature.weights[i] * irradiance[c] * radiance[c];
  }
  return sum;
}

}  // namespace tyndall::cli
