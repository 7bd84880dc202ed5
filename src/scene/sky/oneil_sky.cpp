#include "scene/sky/oneil_sky.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <span>
#include <vector>

#include "gpu/try.hpp"
#include "scene/description/map_projection.hpp"
#include "scene/sky/oneil_settings.hpp"
#include "scene/view/constant_ids.hpp"
#include "scene_shaders.hpp"

namespace tyndall::scene {
namespace {

constexpr std::size_t kOneilSuns = 128;
constexpr int kSkyNodes = 10;             // nodes of the sky's irradiance: 200 rays for each position of the sun
constexpr std::uint32_t kSkySamples = 8;  // largest number of samples on each of these rays

// The model_block of shaders/scene/oneil_air.glsl in std430.
struct OneilBlock {
  tyndall::shared::Medium medium;
  tyndall::shared::Oneil oneil;
  Vec3 eye_position;
  float eye_altitude_m;
  Vec3 eye_up;
  float eye_cos_sun;
  Vec3 to_sun;
  float horizon_rad;
  Vec3 sun_irradiance;
  float air_shown;
  Vec3 north_pole;
  float ground_shown;
  std::uint32_t sphere_seed;
  std::uint32_t is_sphere;
  float unused[2];
  float sky_by_sun[kOneilSuns][4];
};
static_assert(sizeof(OneilBlock) == 2 * 96 + 6 * 16 + 16 * kOneilSuns);

class OneilSky : public SkyModel {
 public:
  explicit OneilSky(bool table) : table_(table) {}

  Result<void> create(gpu::Host& host, ModelEvaluation evaluation, VkFormat color_format, VkFormat depth_format) {
    std::vector<std::array<gpu::Constant, 2>> constants;
    for (const Variant& v : variants())
      constants.push_back({{{shared::kIntegralMethodId, v.integral_method}, {shared::kSampleSpacingId, v.spacing}}});
    const std::vector<std::span<const gpu::Constant>> spans(constants.begin(), constants.end());
    return create_objects(host,
                          {&shaders::oneil_terrain_vert, &shaders::oneil_terrain_frag, &shaders::oneil_light_comp, 3,
                           &shaders::oneil_sky_vert, &shaders::oneil_sky_frag},
                          evaluation, sizeof(OneilBlock), color_format, depth_format, spans);
  }

  [[nodiscard]] bool draws_terrain(const SceneParams& scene) const override {
    return scene.oneil.ground == OneilGround::terrain;
  }

 protected:
  Result<void> fill(const ModelFrame& frame, void* constants) override {
    TYNDALL_TRY(make(models::oneil_medium(frame.params), oneil_settings(frame.scene.oneil, table_)));
    const double radius = frame.params.planet.radius_m;
    const glm::dvec3 up = up_of(frame.view.position, radius);
    const double altitude = altitude_of(frame.view.position, radius);
    OneilBlock out = {};
    out.medium = model_.medium;
    out.oneil = model_.constants;
    out.eye_position = to_vec3(frame.local.place(frame.view.position));
    out.eye_altitude_m = static_cast<float>(altitude);
    out.eye_up = to_vec3(frame.local.direction(up));
    out.eye_cos_sun = static_cast<float>(std::clamp(glm::dot(up, frame.light.direction_to_sun), -1.0, 1.0));
    out.to_sun = to_vec3(frame.local.direction(frame.light.direction_to_sun));
    // Radius of the ground sphere: sea level, or twice the depth of an eye below it.
    const double ground = radius + 2.0 * std::min(altitude, 0.0);
    out.horizon_rad =
        static_cast<float>(0.5 * std::numbers::pi + std::acos(std::clamp(ground / (radius + altitude), -1.0, 1.0)));
    out.sun_irradiance = frame.light.sun_irradiance;
    out.air_shown = frame.params.scattering.enabled ? 1.0F : 0.0F;
    out.ground_shown = frame.params.scattering.only ? 0.0F : 1.0F;
    // North is -z at the origin, which lies at 25 degrees of latitude.
    out.north_pole = to_vec3(glm::normalize(glm::dvec3(0.0, std::sin(0.436), -std::cos(0.436))));
    out.sphere_seed = frame.scene.terrain.seed;
    out.is_sphere = frame.scene.oneil.ground == OneilGround::sphere ? 1 : 0;
    std::memcpy(out.sky_by_sun, sky_by_sun_, sizeof sky_by_sun_);
    std::memcpy(constants, &out, sizeof out);
    return {};
  }

  [[nodiscard]] std::size_t variant() const override {
    const Variant wanted = {model_.constants.integral_method, model_.constants.spacing};
    const std::span<const Variant> all = variants();
    return static_cast<std::size_t>(std::find(all.begin(), all.end() - 1, wanted) - all.begin());
  }

  [[nodiscard]] std::vector<gpu::NamedResource> more_resources() const override {
    return {gpu::named_buffer("oneil_table_block", table_buffer_.buffer.get())};
  }

 private:
  // Computes the fit or the table and the irradiance of the sky if the planet, the atmosphere or the settings have
  // changed. The previous frame, which reads the previous table, may be in flight.
  Result<void> make(const tyndall::shared::Medium& medium, const models::OneilSettings& settings) {
    const bool same =
        table_buffer_.buffer && settings == settings_ && std::memcmp(&medium, &model_.medium, sizeof medium) == 0;
    if (same) return {};
    models::OneilModel model = models::make_oneil(medium, settings);
    const VkDeviceSize bytes = model.table.size() * sizeof model.table[0];
    TYNDALL_ASSIGN(gpu::Buffer table, gpu::create_buffer(host_->device(), "oneil_table", bytes,
                                                         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::MemoryKind::upload));
    std::memcpy(table.mapped, model.table.data(), bytes);
    previous_table_ = std::exchange(table_buffer_, std::move(table));
    settings_ = settings;
    model_ = std::move(model);
    models::OneilModel coarse = model_;
    coarse.constants.samples = std::min(coarse.constants.samples, kSkySamples);
    for (std::size_t i = 0; i < kOneilSuns; ++i) {
      const double cos_sun = -1.0 + 2.0 * static_cast<double>(i) / (kOneilSuns - 1);
      const std::array<double, 3> sky = models::oneil_sky_irradiance(coarse, 0.0, cos_sun, kSkyNodes);
      for (std::size_t c = 0; c < 3; ++c) sky_by_sun_[i][c] = static_cast<float>(sky[c]);
    }
    return {};
  }

  // The specialisation of a pipeline. With the published function, points are always spaced uniformly.
  struct Variant {
    std::uint32_t integral_method, spacing;
    bool operator==(const Variant&) const = default;
  };
  [[nodiscard]] std::span<const Variant> variants() const {
    constexpr auto kComputed = static_cast<std::uint32_t>(models::OneilIntegralMethod::computed);
    constexpr auto kPublished = static_cast<std::uint32_t>(models::OneilIntegralMethod::published);
    constexpr auto kTable = static_cast<std::uint32_t>(models::OneilIntegralMethod::table);
    static constexpr Variant kOfFunction[] = {{kComputed, 0}, {kComputed, 1}, {kPublished, 0}};
    static constexpr Variant kOfTable[] = {{kTable, 0}, {kTable, 1}};
    return table_ ? std::span<const Variant>(kOfTable) : std::span<const Variant>(kOfFunction);
  }

  bool table_ = false;
  models::OneilModel model_ = {};
  models::OneilSettings settings_ = {};
  float sky_by_sun_[kOneilSuns][4] = {};
  gpu::Buffer table_buffer_, previous_table_;
};

}  // namespace

Result<std::unique_ptr<SkyModel>> create_oneil_sky(gpu::Host& host, ModelEvaluation evaluation, bool table,
                                                   VkFormat color_format, VkFormat depth_format) {
  auto out = std::make_unique<OneilSky>(table);
  TYNDALL_TRY(out->create(host, evaluation, color_format, depth_format));
  return std::unique_ptr<SkyModel>(std::move(out));
}

}  // namespace tyndall::scene
