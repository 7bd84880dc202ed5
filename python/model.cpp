#include "model.hpp"

#include <algorithm>
#include <cmath>

#include "air/coefficients.hpp"
#include "effect/medium.hpp"
#include "effect/phase_rows.hpp"
#include "effect/spectral_medium.hpp"
#include "models/accuracy_notes.hpp"
#include "models/spectral.hpp"
#include "models/table_axes.hpp"
#include "models/table_values.hpp"
#include "reference/spectrum.hpp"
#include "scene/description/model_registry.hpp"

namespace tyndall::python {
namespace {

constexpr std::size_t kBatchQueries = 262144;  // bounds the memory on the device
constexpr double kLumenPerWatt = 683.0;

// Returns a new array of shape (N, columns), filled by value(row, column).
template <typename Value>
py::array_t<double> filled(std::size_t rows, std::size_t columns, const Value& value) {
  py::array_t<double> out({static_cast<py::ssize_t>(rows), static_cast<py::ssize_t>(columns)});
  auto at = out.template mutable_unchecked<2>();
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t c = 0; c < columns; ++c)
      at(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(c)) = value(i, c);
  }
  return out;
}

py::array_t<double> column(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

const scene::ModelInfo& model_named(const std::string& name) {
  const scene::ModelInfo* const found = scene::find_model(name);
  if (found != nullptr && found->id != scene::ModelId::reference) return *found;
  std::string expected;
  for (const scene::ModelInfo& info : scene::model_registry()) {
    if (info.id == scene::ModelId::reference) continue;
    expected += (expected.empty() ? "" : ", ") + std::string(info.name);
  }
  throw py::value_error("model: unknown model '" + name + "'; expected one of " + expected);
}

// Throws if the parameters choose another model than the one that is computed.
void check_drawn_model(const config::Settings& settings, const scene::ModelInfo& model) {
  const scene::ModelInfo& drawn = scene::drawn_model(settings.effect, settings.scene);
  if (drawn.id == model.id || drawn.id == scene::ModelId::precomputed) return;
  const bool medium = drawn.id == scene::ModelId::homogeneous_medium;
  const std::string name(drawn.name);
  throw py::value_error((medium ? "scattering.medium: 'homogeneous'" : "scattering.model: '" + name + "'") +
                        " is not the model '" + std::string(model.name) + "'; expected atmosphere, or model='" + name +
                        "'");
}

}  // namespace

// The interpreter lock is released before the mutex is taken: a thread that waits for the mutex must not hold it.
std::shared_ptr<gpu::Host> shared_host(const std::string& device, bool graphics) {
  static std::mutex mutex;
  static std::vector<std::pair<std::string, std::weak_ptr<gpu::Host>>> hosts;
  return without_lock([&]() -> Result<std::shared_ptr<gpu::Host>> {
    const std::string key = device + (graphics ? "\ngraphics" : "\n");
    const std::scoped_lock lock(mutex);
    for (auto& [name, held] : hosts) {
      if (name != key) continue;
      if (std::shared_ptr<gpu::Host> host = held.lock()) return host;
    }
    Result<std::unique_ptr<gpu::Host>> made = gpu::Host::create({.device = device, .graphics = graphics});
    if (!made.ok()) return made.error();
    std::shared_ptr<gpu::Host> host = std::move(made).value();
    std::erase_if(hosts, [](const auto& entry) { return entry.second.expired(); });
    hosts.emplace_back(key, host);
    return host;
  });
}

Model::Model(const std::string& scene, const Assignments& assignments, const std::string& device,
             const std::string& name, const Light& light)
    : settings_(settings_of(scene, assignments)) {
  const scene::ModelInfo& model = model_named(name);
  check_drawn_model(settings_, model);
  if (light.spectral) settings_.effect.scattering.color = ColorMode::spectral;
  if (const Result<void> r = cli::check_color(model.id, settings_.effect.scattering.color); !r.ok()) raise(r.error());
  if (const Result<void> r = cli::check_phase(model.id, settings_.effect.atmosphere); !r.ok()) raise(r.error());
  given_ = settings_.effect;
  if (!light.wavelengths_nm.empty()) {
    const std::vector<double>& nm = light.wavelengths_nm;
    if (nm.size() != 3) throw py::value_error("wavelengths: invalid number; expected 3 for a model");
    Result<Params> moved = air::with_wavelengths(settings_.effect, {nm[0], nm[1], nm[2]});
    if (!moved.ok()) raise(moved.error());
    settings_.effect = moved.value();
    if (const Result<void> checked = config::check(settings_); !checked.ok()) raise(checked.error());
  }
  cpu_ = without_lock(
      [&]() -> Result<cli::CpuModel> { return cli::cpu_model(model.id, settings_.effect, settings_.scene); });
  if (cpu_.answer) return;
  host_ = shared_host(device, false);
  if (model.id == scene::ModelId::single) {
    single_ = std::make_unique<models::SingleScatteringOnGpu>(
        without_lock([&] { return models::SingleScatteringOnGpu::create(*host_, settings_.effect.scattering.color); }));
    return;
  }
  precomputed_ = std::make_unique<models::PrecomputedModel>(
      without_lock([&] { return models::PrecomputedModel::create(*host_, settings_.effect, make_tables(settings_)); }));
}

py::tuple Model::answer(const Array& rows, bool sky, bool ground) {
  const std::vector<RayQuery> queries = queries_of(rows, sky);
  const std::vector<models::Answer> answers = without_lock([&]() -> Result<std::vector<models::Answer>> {
    std::vector<models::Answer> all;
    all.reserve(queries.size());
    for (std::size_t first = 0; first < queries.size(); first += kBatchQueries) {
      const auto some = std::span(queries).subspan(first, std::min(kBatchQueries, queries.size() - first));
      const Result<std::vector<models::Answer>> found = answer_some(some, ground);
      if (!found.ok()) return found.error();
      all.insert(all.end(), found.value().begin(), found.value().end());
    }
    return all;
  });
  const auto count = static_cast<std::size_t>(channels());
  return py::make_tuple(
      filled(answers.size(), count,
             [&](std::size_t i, std::size_t c) { return c < 3 ? answers[i].radiance[c] : answers[i].radiance_fourth; }),
      filled(answers.size(), count, [&](std::size_t i, std::size_t c) {
        return c < 3 ? answers[i].transmittance[c] : answers[i].transmittance_fourth;
      }));
}

Result<std::vector<models::Answer>> Model::answer_some(std::span<const RayQuery> queries, bool ground) {
  if (cpu_.answer) {
    std::vector<models::Answer> out;
    out.reserve(queries.size());
    for (const RayQuery& query : queries) out.push_back(cpu_.answer(query));
    return out;
  }
  const std::scoped_lock lock(mutex_);
  return precomputed_ != nullptr ? precomputed_->answer(queries, ground) : single(queries);
}

Result<std::vector<models::Answer>> Model::single(std::span<const RayQuery> queries) {
  const shared::SpectralMedium medium = spectral_medium_from_params(settings_.effect);
  const PhaseRows phase = phase_rows(settings_.effect, settings_.effect.scattering.color);
  if (!queries.front().sky_irradiance) {
    std::vector<models::Ray> rays;
    rays.reserve(queries.size());
    for (const RayQuery& query : queries) rays.push_back(models::ray_from_query(query));
    return single_->answer(medium, phase, rays);
  }
  const PhaseRows fourth_phase = models::phase_at_fourth(phase);
  std::vector<models::Answer> out;
  out.reserve(queries.size());
  for (const RayQuery& query : queries) {
    const double cos_sun = std::cos(query.sun_zenith_rad);
    const auto sky = [&](const shared::Medium& m, bool fourth) -> models::Answer {
      return {models::single_sky_irradiance(m, query.altitude_m, cos_sun, fourth ? fourth_phase : phase),
              models::sun_transmittance(m, query.altitude_m, cos_sun)};
    };
    out.push_back(models::in_all_channels(settings_.effect, medium, sky));
  }
  return out;
}

namespace {

// Runs trace(progress) without the interpreter lock. A signal that Python handles by an exception ends it.
template <typename Trace>
auto interruptible(const Trace& trace) {
  bool interrupted = false;
  const auto progress = [&](double) {
    const py::gil_scoped_acquire held;
    interrupted = interrupted || PyErr_CheckSignals() != 0;
    return !interrupted;
  };
  auto found = [&] {
    const py::gil_scoped_release released;
    return trace(progress);
  }();
  if (interrupted) throw py::error_already_set();
  if (!found.ok()) raise(found.error());
  return std::move(found).value();
}

py::tuple trace_wavelengths(const Params& params, std::span<const RayQuery> queries, const reference::Options& options,
                            const std::vector<double>& nm) {
  const std::vector<reference::Rgb> weights(nm.size());
  const auto found = interruptible([&](const reference::Progress& progress) {
    return reference::trace_spectrum(params, {nm, weights}, queries, options, progress);
  });
  const auto values = [&](std::vector<double> reference::SpectralEstimate::*member) {
    return filled(found.size(), nm.size(), [&](std::size_t i, std::size_t c) { return (found[i].*member)[c]; });
  };
  return py::make_tuple(values(&reference::SpectralEstimate::radiance),
                        values(&reference::SpectralEstimate::transmittance),
                        values(&reference::SpectralEstimate::radiance_error));
}

// The colour of the visible spectrum.
py::tuple trace_color(const Params& params, std::span<const RayQuery> queries, const reference::Options& options,
                      bool xyz) {
  reference::VisibleSpectrum spectrum = reference::visible_spectrum_in_rec709();
  if (xyz) {
    spectrum.sunlight = {};
    for (std::size_t i = 0; i < spectrum.nm.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        spectrum.weights[i][c] = kLumenPerWatt * reference::visible_spectrum()[i].xyz[c];
        spectrum.sunlight[c] += spectrum.weights[i][c];
      }
    }
  }
  const auto found = interruptible([&](const reference::Progress& progress) {
    return reference::trace_spectrum(params, {spectrum.nm, spectrum.weights}, queries, options, progress);
  });
  const auto passed = [&](std::size_t i, std::size_t c) {
    double sum = 0.0;
    for (std::size_t k = 0; k < spectrum.nm.size(); ++k)
      sum += spectrum.weights[k][c] * found[i].transmittance[k] / spectrum.sunlight[c];
    return sum;
  };
  return py::make_tuple(filled(found.size(), 3, [&](std::size_t i, std::size_t c) { return found[i].sums[c]; }),
                        filled(found.size(), 3, passed), filled(found.size(), 3, [&](std::size_t i, std::size_t c) {
                          return found[i].standard_error[c];
                        }));
}

}  // namespace

py::tuple Model::trace(const Array& rows, bool sky, const reference::Options& options, bool xyz,
                       const std::vector<double>& wavelengths_nm) const {
  const std::vector<RayQuery> queries = queries_of(rows, sky);
  if (!wavelengths_nm.empty()) return trace_wavelengths(given_, queries, options, wavelengths_nm);
  if (spectral()) return trace_color(given_, queries, options, xyz);
  const auto found = interruptible([&](const reference::Progress& progress) {
    return reference::trace(settings_.effect, queries, options, progress);
  });
  const auto values = [&](reference::Rgb reference::Estimate::*member) {
    return filled(found.size(), 3, [&](std::size_t i, std::size_t c) { return (found[i].*member)[c]; });
  };
  return py::make_tuple(values(&reference::Estimate::radiance), values(&reference::Estimate::transmittance),
                        values(&reference::Estimate::standard_error));
}

py::array_t<double> Model::transmittance(const Array& rows) const {
  if (rows.ndim() != 2 || rows.shape(1) != 3) throw py::value_error("rays: invalid shape; expected (N, 3)");
  if (cpu_.answer) {
    throw py::value_error(
        "aerial_perspective: this model describes whole rays only; expected a model precomputed or single");
  }
  const auto at = rows.unchecked<2>();
  const shared::SpectralMedium medium = spectral_medium_from_params(settings_.effect);
  const shared::Medium fourth = models::medium_at_fourth(medium);
  py::array_t<double> out({rows.shape(0), static_cast<py::ssize_t>(channels())});
  auto to = out.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    const std::array<double, 3> t = models::transmittance_along(medium, at(i, 0), at(i, 1), at(i, 2));
    for (std::size_t c = 0; c < 3; ++c) to(i, static_cast<py::ssize_t>(c)) = t[c];
    if (spectral()) to(i, 3) = models::transmittance_along(fourth, at(i, 0), at(i, 1), at(i, 2))[0];
  }
  return out;
}

py::dict Model::tables() {
  if (precomputed_ == nullptr) throw py::value_error("tables: this model has none; expected the model precomputed");
  if (spectral()) {
    throw py::value_error(
        "tables: values at four wavelengths are not supported; expected color='channels' or wavelengths");
  }
  const Params& params = settings_.effect;
  const std::vector<models::TableValues> tables = without_lock([&] {
    const std::scoped_lock lock(mutex_);
    return models::table_values(*host_, precomputed_->effect(), params);
  });
  py::dict out;
  for (const models::TableValues& table : tables) {
    const std::vector<py::ssize_t> shape = {table.size[0], table.size[1], table.size[2], table.size[3], 3};
    out[models::table_name(table.id)] = py::array_t<float>(shape, table.values.data());
  }
  const models::TableAxes axes = models::table_axes(params);
  const std::size_t altitudes = params.tables.size.x;
  const std::size_t views = params.tables.size.y;
  const auto by_altitude = [&](const std::vector<double>& values) {
    return filled(altitudes, views, [&](std::size_t i, std::size_t k) { return values[i * views + k]; });
  };
  out["altitude"] = column(axes.altitude_m);
  out["cos_view_zenith"] = by_altitude(axes.cos_view_zenith);
  out["mean_distance"] = by_altitude(axes.mean_distance_m);
  out["ends_on_ground"] = by_altitude({axes.ends_on_ground.begin(), axes.ends_on_ground.end()});
  out["cos_sun_zenith"] = column(axes.cos_sun_zenith);
  out["cos_view_sun"] = column(axes.cos_view_sun);
  const models::LightTableAxes light = models::light_table_axes(params, tables.back().size[3], tables.back().size[2]);
  out["light_altitude"] = column(light.altitude_m);
  out["light_cos_sun_zenith"] =
      filled(light.altitude_m.size(), light.cos_sun_from_horizon.size(), [&](std::size_t i, std::size_t k) {
        return std::clamp(light.cos_horizon[i] + light.cos_sun_from_horizon[k], -1.0, 1.0);
      });
  return out;
}

std::vector<double> Model::wavelengths_nm() const {
  const Vec3& nm = settings_.effect.atmosphere.wavelengths_nm;
  if (!spectral()) return {nm.x, nm.y, nm.z};
  const FourChannels four = spectral_wavelengths_nm();
  return {four.begin(), four.end()};
}

std::vector<std::string> Model::notes() const {
  std::vector<std::string> out = precomputed_ != nullptr ? precomputed_->origin().notes : cpu_.notes;
  // The CPU models say by themselves what they leave out.
  if (precomputed_ != nullptr || single_ != nullptr) {
    for (std::string& note : models::accuracy_notes(settings_.effect, precomputed_ != nullptr)) {
      out.push_back(std::move(note));
    }
  }
  return out;
}

std::string Model::device() const { return host_ != nullptr ? host_->device_name() : "CPU, double precision"; }

std::map<std::string, std::string> Model::parameters() const {
  std::map<std::string, std::string> out;
  for (const config::Row& row : config::rows()) out[row.key()] = config::value_text(row, settings_);
  return out;
}

double Model::lowest_altitude_m() const {
  return -std::min(11000.0, 0.25 * static_cast<double>(settings_.effect.planet.radius_m));
}

py::array_t<double> colors(const Array& light, bool xyz, bool ratio) {
  if (light.ndim() != 2 || light.shape(1) != 4) throw py::value_error("light: invalid shape; expected (N, 4)");
  const auto at = light.unchecked<2>();
  const auto color_of = [&](const FourChannels& four) {
    std::array<double, 3> color = color_of_light(four);
    for (double& value : color) value *= ratio ? 1.0 : sun_luminous_irradiance();
    if (!xyz) return color;
    color = xyz_of_color(color);
    for (double& value : color) value *= ratio ? 1.0 : kLumenPerWatt;
    return color;
  };
  const std::array<double, 3> sunlight = color_of({1.0, 1.0, 1.0, 1.0});
  py::array_t<double> out({light.shape(0), py::ssize_t{3}});
  auto to = out.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < light.shape(0); ++i) {
    const std::array<double, 3> color = color_of({at(i, 0), at(i, 1), at(i, 2), at(i, 3)});
    for (std::size_t c = 0; c < 3; ++c) to(i, static_cast<py::ssize_t>(c)) = ratio ? color[c] / sunlight[c] : color[c];
  }
  return out;
}

py::tuple visible_spectrum() {
  const std::span<const reference::Bin> bins = reference::visible_spectrum();
  std::vector<double> nm;
  for (const reference::Bin& bin : bins) nm.push_back(bin.wavelength_nm);
  return py::make_tuple(
      column(nm), filled(bins.size(), 3, [&](std::size_t i, std::size_t c) { return kLumenPerWatt * bins[i].xyz[c]; }));
}

}  // namespace tyndall::python
