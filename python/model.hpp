// A model of `tyndall probe` with its constants or its tables, for arrays of queries.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "convert.hpp"
#include "gpu/host.hpp"
#include "models/gpu_probe.hpp"
#include "models/precomputed.hpp"
#include "probe_models.hpp"
#include "reference/path_tracer.hpp"

namespace tyndall::python {

// Returns a device that several models share. Its pipelines and memory are freed with the last of them.
[[nodiscard]] std::shared_ptr<gpu::Host> shared_host(const std::string& device, bool graphics);

// The representation of light in a model.
struct Light {
  bool spectral = false;  // use the four wavelengths of scattering.color = spectral, whatever the settings say
  std::vector<double> wavelengths_nm;  // wavelengths of the three channels; empty: those of the settings
};

// All calls may come from several threads.
class Model {
 public:
  // `name` is a model as in `tyndall probe --model`, except reference.
  Model(const std::string& scene, const Assignments& assignments, const std::string& device, const std::string& name,
        const Light& light);

  // Returns radiance / E0 (sky: irradiance / E0) and transmittance in the channels, both of shape (N, channels).
  py::tuple answer(const Array& rows, bool sky, bool ground);
  // Returns radiance, transmittance and standard error by the path tracer, each of shape (N, K). If `wavelengths_nm`
  // has entries (at most 40), these wavelengths are traced along the same paths, and K is their number. Otherwise K is
  // 3: the three channels, or, with light at four wavelengths, the colour of 40 wavelengths in Rec. 709 or XYZ, as by
  // colors().
  py::tuple trace(const Array& rows, bool sky, const reference::Options& options, bool xyz,
                  const std::vector<double>& wavelengths_nm) const;
  // Returns the transmittance along rays of given lengths: rows of altitude [m], cosine of the zenith angle, length
  // [m].
  [[nodiscard]] py::array_t<double> transmittance(const Array& rows) const;
  // Returns the tables and their axes as a dictionary of arrays.
  [[nodiscard]] py::dict tables();

  [[nodiscard]] int channels() const { return spectral() ? 4 : 3; }
  [[nodiscard]] std::vector<double> wavelengths_nm() const;
  [[nodiscard]] std::vector<std::string> notes() const;
  [[nodiscard]] std::string device() const;
  [[nodiscard]] std::map<std::string, std::string> parameters() const;
  [[nodiscard]] double planet_radius_m() const { return settings_.effect.planet.radius_m; }
  [[nodiscard]] double lowest_altitude_m() const;

 private:
  [[nodiscard]] bool spectral() const { return settings_.effect.scattering.color == ColorMode::spectral; }
  Result<std::vector<models::Answer>> answer_some(std::span<const RayQuery> queries, bool ground);
  Result<std::vector<models::Answer>> single(std::span<const RayQuery> queries);

  config::Settings settings_;
  Params given_;  // parameters before the channels were moved to other wavelengths
  std::shared_ptr<gpu::Host> host_;
  std::unique_ptr<models::PrecomputedModel> precomputed_;
  std::unique_ptr<models::SingleScatteringOnGpu> single_;
  cli::CpuModel cpu_;
  std::mutex mutex_;
};

// Returns the colours of light at four wavelengths, shape (N, 4), as (N, 3): as `probe` reports it, linear Rec. 709 or
// CIE XYZ. With `ratio`, relative to the colour of sunlight, component by component.
[[nodiscard]] py::array_t<double> colors(const Array& light, bool xyz, bool ratio);

// Returns the wavelengths of the path tracer for colours, shape (N,), and the weights of light relative to the sun's
// irradiance in CIE XYZ, shape (N, 3).
[[nodiscard]] py::tuple visible_spectrum();

}  // namespace tyndall::python
