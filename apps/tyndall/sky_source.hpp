// The source of a sky map: a model that evaluates rays. It is prepared once for any number of maps.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "config/settings.hpp"
#include "gpu/host.hpp"
#include "models/single_scattering.hpp"
#include "sky_map.hpp"
#include "tables/make_ready.hpp"

namespace tyndall::cli {

// Evaluates rays: radiance / E0 of the atmosphere and the ground behind it.
class SkySource {
 public:
  virtual ~SkySource() = default;
  virtual Result<std::vector<models::Answer>> answer(std::span<const RayQuery> queries) = 0;
  // Returns how the tables were obtained; nullptr if the source uses none.
  [[nodiscard]] virtual const tables::Report* tables() const { return nullptr; }
};

// Returns the names of the models, the default first.
[[nodiscard]] std::vector<std::string> sky_models();
// Prepares a model of sky_models(). The position of the sun has no influence.
[[nodiscard]] Result<std::unique_ptr<SkySource>> make_sky_source(const std::string& model, gpu::Host& host,
                                                                 const config::Settings& settings);

// Fills the image with the source's radiance times the irradiance, in batches of rows. `label` is that of the progress
// bar.
[[nodiscard]] Result<void> fill(image::Image& image, const SkyMap& map, const std::array<double, 3>& irradiance,
                                ColorMode color, SkySource& source, std::string_view label);

// Returns the irradiance of the sky on a horizontal surface in the channels of an image.
[[nodiscard]] Result<std::array<double, 3>> sky_irradiance(const SkyMap& map, const std::array<double, 3>& irradiance,
                                                           ColorMode color, SkySource& source);

}  // namespace tyndall::cli
