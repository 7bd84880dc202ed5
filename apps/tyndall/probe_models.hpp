// The models that `probe` asks: one row each, and every one answers the same questions.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "models/homogeneous.hpp"
#include "scene/description/scene_params.hpp"
#include "tables/make_ready.hpp"
#include "tyndall/params.hpp"
#include "tyndall/result.hpp"

namespace tyndall::cli {

// One row of the query table. Angles in rad.
struct ProbeQuery {
  bool sky = false;  // asks for the horizontal irradiance of the sky; no view direction then
  double altitude_m = 0.0;
  double view_zenith_rad = 0.0;
  double sun_zenith_rad = 0.0;
  double azimuth_rad = 0.0;  // between view and sun
};

struct ProbeAnswer {
  std::array<double, 3> radiance = {};  // L / E0 [1/sr]; for the sky E / E0
  // To the end of the ray; for the sky that of the sun's light, 0 where the planet hides the sun.
  std::array<double, 3> transmittance = {};
  std::array<double, 3> standard_error = {};  // of the radiance; models without noise leave it
  bool single_precision = false;              // the numbers are floats, and are written as such
};

struct ProbeSettings {
  Params params;
  scene::SceneParams scene;  // for the models that have parameters of their own
  std::uint32_t orders = 8;
  std::uint32_t samples = 100000;
  std::uint32_t seed = 1;
  std::string device;
  tables::CacheDesc table_cache = {};
  std::function<void(const std::string& text)> note;  // gets remarks for the user; may be empty
  std::function<void(double done)> progress;          // the part done, 0 to 1
};

// What the scene's parameters say of the models.
[[nodiscard]] models::HomogeneousLengths homogeneous_lengths(const scene::SceneParams& scene);

struct ProbeModel {
  const char* name;
  bool random;  // has a standard error
  Result<std::vector<ProbeAnswer>> (*run)(const ProbeSettings& settings, std::span<const ProbeQuery> queries);
};
[[nodiscard]] std::span<const ProbeModel> probe_models();

}  // namespace tyndall::cli
