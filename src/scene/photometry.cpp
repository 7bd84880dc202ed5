#include "scene/photometry.hpp"

#include "scene/description/camera_exposure.hpp"
#include "tyndall/effect.hpp"
#include "tyndall/photometry.hpp"

namespace tyndall::scene {

double white_luminance(const Params& params, const SceneParams& scene) {
  const Vec3 color = sun_color(params);
  const Vec3& sun = scene.sun.irradiance;
  const float scale = params.scattering.scale;
  return tyndall::white_luminance({scale * sun.x * color.x, scale * sun.y * color.y, scale * sun.z * color.z});
}

post::TonemapSettings tonemap_settings(const Params& params, const SceneParams& scene) {
  const TonemapParams& given = scene.tonemap;
  post::TonemapSettings out = {static_cast<post::Operator>(given.operator_),
                               given.middle_gray,
                               given.white_point,
                               given.saturation,
                               is_auto_exposed(given),
                               given.light_adaptation,
                               given.least_luminance,
                               given.exposure};
  if (const std::optional<double> ev100 = camera_ev100(given); ev100) {
    out.exposure = static_cast<float>(
        exposure_of_ev100(*ev100, static_cast<double>(given.middle_gray), white_luminance(params, scene)));
  }
  return out;
}

}  // namespace tyndall::scene
