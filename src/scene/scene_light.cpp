// The light at the camera of a scene, in lux.
#include "gpu/try.hpp"
#include "scene/description/map_projection.hpp"
#include "scene/photometry.hpp"
#include "scene/scene.hpp"

namespace tyndall::scene {

Result<std::optional<Illuminance>> Scene::measure_illuminance() {
  const double radius_m = params_.planet.radius_m;
  const double altitude_m = altitude_of(view_.position, radius_m);
  const double white = white_luminance(params_, scene_);
  const bool has_unit = params_.scattering.color == ColorMode::spectral && white > 0.0;
  const bool in_air = model_ == nullptr && params_.scattering.medium == MediumKind::atmosphere && tables_ready_ &&
                      effect_->precompute_progress().complete() && frame_index_ > 0 &&
                      altitude_m < static_cast<double>(params_.atmosphere.height_m) && altitude_m > -0.25 * radius_m;
  if (!has_unit || !in_air) return std::optional<Illuminance>();
  if (light_meter_ == nullptr) {
    TYNDALL_ASSIGN(LightMeter made, LightMeter::create(*host_, *effect_));
    light_meter_ = std::make_unique<LightMeter>(std::move(made));
  }
  const glm::dvec3 up = up_of(view_.position, radius_m);
  Result<Illuminance> found =
      light_meter_->measure(*host_, params_, {altitude_m, glm::dot(up, to_sun_), scene_.sun.irradiance, white});
  if (found) return std::optional(found.value());
  light_meter_.reset();
  return std::move(found).error();
}

}  // namespace tyndall::scene
