#include "scene/sky/homogeneous_sky.hpp"

#include <algorithm>
#include <cstring>

#include "gpu/try.hpp"
#include "models/homogeneous.hpp"
#include "scene/description/map_projection.hpp"
#include "scene_shaders.hpp"

namespace tyndall::scene {
namespace {

constexpr std::size_t kHomogeneousSuns = 64;

// The model_block of shaders/scene/homogeneous_air.glsl in std430.
struct HomogeneousBlock {
  tyndall::shared::Homogeneous medium;
  Vec3 eye_position;
  float eye_altitude_m;
  Vec3 eye_up;
  float eye_cos_sun;
  Vec3 to_sun;
  std::uint32_t in_space;
  Vec3 sun_on_ground;
  float air_shown;
  Vec3 sky_on_ground;
  float ground_shown;
  Vec3 sun_irradiance;
  float unused;
  float sky_by_sun[kHomogeneousSuns][4];
};

Vec3 narrow(const std::array<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

class HomogeneousSky : public SkyModel {
 public:
  Result<void> create(gpu::Host& host, ModelEvaluation evaluation, VkFormat color_format, VkFormat depth_format) {
    return create_objects(
        host,
        {&shaders::homogeneous_terrain_vert, &shaders::homogeneous_terrain_frag, &shaders::homogeneous_light_comp, 2,
         &shaders::homogeneous_sky_vert, &shaders::homogeneous_sky_frag},
        evaluation, sizeof(HomogeneousBlock), color_format, depth_format);
  }

 protected:
  Result<void> fill(const ModelFrame& frame, void* constants) override {
    const HomogeneousParams& own = frame.scene.homogeneous;
    HomogeneousBlock out = {};
    out.medium =
        models::homogeneous_from_params(frame.params, {own.air_length_m, own.haze_length_m, own.falloff.value != 0});
    out.medium.sun_radius_rad = glm::radians(frame.scene.sun.angular_radius_deg);
    const double radius = frame.params.planet.radius_m;
    const glm::dvec3 up = up_of(frame.view.position, radius);
    const double altitude = altitude_of(frame.view.position, radius);
    const double cos_sun = std::clamp(glm::dot(up, frame.light.direction_to_sun), -1.0, 1.0);
    out.eye_position = to_vec3(frame.local.place(frame.view.position));
    out.eye_altitude_m = static_cast<float>(altitude);
    out.eye_up = to_vec3(frame.local.direction(up));
    out.eye_cos_sun = static_cast<float>(cos_sun);
    out.to_sun = to_vec3(frame.local.direction(frame.light.direction_to_sun));
    out.in_space = altitude > static_cast<double>(frame.params.atmosphere.height_m) ? 1 : 0;
    out.sun_on_ground = narrow(models::homogeneous_sun(out.medium, 0.0, cos_sun));
    out.sky_on_ground = narrow(models::homogeneous_sky_irradiance(out.medium, 0.0, cos_sun));
    out.air_shown = frame.params.scattering.enabled.value != 0 ? 1.0F : 0.0F;
    out.ground_shown = frame.params.scattering.only.value != 0 ? 0.0F : 1.0F;
    out.sun_irradiance = frame.light.sun_irradiance;
    if (out.in_space != 0) fill_sky_by_sun(out.medium, out.sky_by_sun);
    std::memcpy(constants, &out, sizeof out);
    return {};
  }

 private:
  // Fills the table of the sky's irradiance by the sun's zenith angle, which views from space need. It takes thousands
  // of rays, so it is updated only when the medium changes.
  void fill_sky_by_sun(const tyndall::shared::Homogeneous& medium, float (&to)[kHomogeneousSuns][4]) {
    if (std::memcmp(&medium, &known_, sizeof medium) != 0) {
      for (std::size_t i = 0; i < kHomogeneousSuns; ++i) {
        const double root = static_cast<double>(i) / (kHomogeneousSuns - 1);
        const Vec3 sky = narrow(models::homogeneous_sky_irradiance(medium, 0.0, root * root));
        const float row[4] = {sky.x, sky.y, sky.z, 0.0F};
        std::memcpy(sky_by_sun_[i], row, sizeof row);
      }
      known_ = medium;
    }
    std::memcpy(to, sky_by_sun_, sizeof sky_by_sun_);
  }

  tyndall::shared::Homogeneous known_ = {};
  float sky_by_sun_[kHomogeneousSuns][4] = {};
};

}  // namespace

Result<std::unique_ptr<SkyModel>> create_homogeneous_sky(gpu::Host& host, ModelEvaluation evaluation,
                                                         VkFormat color_format, VkFormat depth_format) {
  auto out = std::make_unique<HomogeneousSky>();
  TYNDALL_TRY(out->create(host, evaluation, color_format, depth_format));
  return std::unique_ptr<SkyModel>(std::move(out));
}

}  // namespace tyndall::scene
