// The extension module tyndall._core: the models of `tyndall probe` on arrays. python/tyndall/__init__.py is the public
// interface, which converts units, broadcasts arrays and documents. Arrays are float64 and contiguous; a query has the
// columns altitude [m], view zenith, sun zenith and azimuth [rad].
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <mutex>

#include "config/scene_file.hpp"
#include "config/settings.hpp"
#include "effect/medium.hpp"
#include "gpu/host.hpp"
#include "models/gpu_probe.hpp"
#include "models/precomputed.hpp"
#include "reference/path_tracer.hpp"
#include "scene/description/solar_position.hpp"
#include "scene/scene.hpp"
#include "tables/make_ready.hpp"
#include "tyndall/version.h"

namespace py = pybind11;

namespace tyndall::python {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Assignments = std::vector<std::pair<std::string, std::string>>;

PyObject* error_type = nullptr;  // tyndall.Error, owned by the module

// Throws the error of a result as the Python exception that fits.
[[noreturn]] void raise(const Error& error) {
  PyObject* type = error.code == ErrorCode::invalid_argument ? PyExc_ValueError
                   : error.code == ErrorCode::out_of_memory  ? PyExc_MemoryError
                   : error.code == ErrorCode::io             ? PyExc_OSError
                                                             : error_type;
  PyErr_SetString(type, error.message.c_str());
  throw py::error_already_set();
}

// Runs a function without the interpreter lock and returns its value, or raises its error.
template <typename Function>
auto without_lock(const Function& function) {
  auto result = [&] {
    const py::gil_scoped_release released;
    return function();
  }();
  if (!result.ok()) raise(result.error());
  if constexpr (!std::is_same_v<decltype(result), Result<void>>) return std::move(result).value();
}

config::Settings settings_of(const std::string& scene, const Assignments& assignments) {
  config::Settings settings;
  if (!scene.empty()) {
    if (const Result<void> loaded = config::load(settings, scene); !loaded.ok()) raise(loaded.error());
  }
  for (const auto& [key, value] : assignments) {
    if (const Result<void> set = config::set(settings, key, value, "parameters"); !set.ok()) raise(set.error());
  }
  if (const Result<void> checked = config::check(settings); !checked.ok()) raise(checked.error());
  return settings;
}

tables::MakeReady make_tables(const config::Settings& settings) {
  tables::MakeReady how;
  how.cache.place = settings.scene.tables.cache;
  how.cache.limit_bytes = std::uint64_t{settings.scene.tables.cache_limit_mib} << 20U;
  return how;
}

std::vector<RayQuery> queries_of(const Array& rows, bool sky) {
  if (rows.ndim() != 2 || rows.shape(1) != 4) throw py::value_error("queries: invalid shape; expected (N, 4)");
  const auto at = rows.unchecked<2>();
  std::vector<RayQuery> out(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    for (py::ssize_t column = 0; column < 4; ++column) {
      if (!std::isfinite(at(i, column))) throw py::value_error("queries: a value is not finite; expected numbers");
    }
    out[static_cast<std::size_t>(i)] = {at(i, 0), at(i, 1), at(i, 2), at(i, 3), sky};
  }
  return out;
}

// Copies three numbers of each item into an array of shape (N, 3).
template <typename Items, typename Member>
py::array_t<double> columns(const Items& items, Member member) {
  py::array_t<double> out({static_cast<py::ssize_t>(items.size()), py::ssize_t{3}});
  auto at = out.template mutable_unchecked<2>();
  for (std::size_t i = 0; i < items.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      at(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(c)) = (items[i].*member)[c];
  }
  return out;
}

// A device that several models share. Its pipelines and memory are freed with the last of them. The interpreter lock is
// released before the mutex is taken: a thread that waits for the mutex must not hold it.
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

// A model with its tables on a device. All calls may come from several threads.
class Model {
 public:
  Model(const std::string& scene, const Assignments& assignments, const std::string& device, bool tables)
      : settings_(settings_of(scene, assignments)), host_(shared_host(device, false)) {
    if (settings_.effect.scattering.color == ColorMode::spectral) {
      throw py::value_error(
          "scattering.color: 'spectral' is not supported here, where light has three channels; expected rgb");
    }
    if (!tables) return;
    model_ = std::make_unique<models::PrecomputedModel>(without_lock(
        [&] { return models::PrecomputedModel::create(*host_, settings_.effect, make_tables(settings_)); }));
  }

  py::tuple answer(const Array& rows, bool sky, bool ground) {
    const std::vector<RayQuery> queries = queries_of(rows, sky);
    const std::vector<models::Answer> answers = without_lock([&]() -> Result<std::vector<models::Answer>> {
      if (queries.empty()) return std::vector<models::Answer>();
      const std::scoped_lock lock(mutex_);
      if (model_ != nullptr) return model_->answer(queries, ground);
      return single(queries);
    });
    return py::make_tuple(columns(answers, &models::Answer::radiance),
                          columns(answers, &models::Answer::transmittance));
  }

  py::tuple trace(const Array& rows, bool sky, std::uint32_t samples, int orders, std::uint32_t seed) const {
    const std::vector<RayQuery> queries = queries_of(rows, sky);
    reference::Options options;
    options.samples = samples;
    options.orders = orders;
    options.seed = seed;
    bool interrupted = false;
    const auto progress = [&](double) {
      const py::gil_scoped_acquire held;
      interrupted = interrupted || PyErr_CheckSignals() != 0;
      return !interrupted;
    };
    Result<std::vector<reference::Estimate>> found = [&] {
      const py::gil_scoped_release released;
      return reference::trace(settings_.effect, queries, options, progress);
    }();
    if (interrupted) throw py::error_already_set();
    if (!found.ok()) raise(found.error());
    const std::vector<reference::Estimate>& estimates = found.value();
    return py::make_tuple(columns(estimates, &reference::Estimate::radiance),
                          columns(estimates, &reference::Estimate::transmittance),
                          columns(estimates, &reference::Estimate::standard_error));
  }

  // Returns the transmittance along rays of given lengths: rows of altitude [m], cosine of the zenith angle, length
  // [m].
  [[nodiscard]] py::array_t<double> transmittance(const Array& rows) const {
    if (rows.ndim() != 2 || rows.shape(1) != 3) throw py::value_error("rays: invalid shape; expected (N, 3)");
    const auto at = rows.unchecked<2>();
    const shared::Medium medium = medium_from_params(settings_.effect);
    py::array_t<double> out({rows.shape(0), py::ssize_t{3}});
    auto to = out.mutable_unchecked<2>();
    for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
      const std::array<double, 3> t = models::transmittance_along(medium, at(i, 0), at(i, 1), at(i, 2));
      for (std::size_t c = 0; c < 3; ++c) to(i, static_cast<py::ssize_t>(c)) = t[c];
    }
    return out;
  }

  [[nodiscard]] std::vector<std::string> notes() const {
    return model_ != nullptr ? model_->origin().notes : std::vector<std::string>();
  }
  [[nodiscard]] std::string device() const { return host_->device_name(); }
  [[nodiscard]] std::map<std::string, std::string> parameters() const {
    std::map<std::string, std::string> out;
    for (const config::Row& row : config::rows()) out[row.key()] = config::value_text(row, settings_);
    return out;
  }
  [[nodiscard]] double planet_radius_m() const { return settings_.effect.planet.radius_m; }
  [[nodiscard]] double lowest_altitude_m() const {
    return -std::min(11000.0, 0.25 * static_cast<double>(settings_.effect.planet.radius_m));
  }

 private:
  Result<std::vector<models::Answer>> single(const std::vector<RayQuery>& queries) {
    const shared::Medium medium = medium_from_params(settings_.effect);
    std::vector<models::Answer> out(queries.size());
    if (queries.front().sky_irradiance) {
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const double cos_sun = std::cos(queries[i].sun_zenith_rad);
        out[i] = {models::single_sky_irradiance(medium, queries[i].altitude_m, cos_sun),
                  models::sun_transmittance(medium, queries[i].altitude_m, cos_sun)};
      }
      return out;
    }
    std::vector<models::Ray> rays;
    rays.reserve(queries.size());
    for (const RayQuery& query : queries) rays.push_back(models::ray_from_query(query));
    return models::single_scattering_on_gpu(*host_, medium, rays);
  }

  config::Settings settings_;
  std::shared_ptr<gpu::Host> host_;
  std::unique_ptr<models::PrecomputedModel> model_;
  std::mutex mutex_;
};

py::array_t<float> render(const std::string& scene, const Assignments& assignments, std::uint32_t width,
                          std::uint32_t height, const std::string& device, bool display) {
  const config::Settings settings = settings_of(scene, assignments);
  const std::shared_ptr<gpu::Host> host = shared_host(device, true);
  const image::Image picture = without_lock([&]() -> Result<image::Image> {
    scene::SceneDesc desc;
    desc.extent = {width, height};
    desc.make_tables = make_tables(settings);
    Result<std::unique_ptr<scene::Scene>> made = scene::Scene::create(*host, desc, settings.effect, settings.scene);
    if (!made.ok()) return std::move(made).error();
    if (const Result<void> drawn = made.value()->render(0.0); !drawn.ok()) return drawn.error();
    return display ? made.value()->display() : made.value()->radiance();
  });
  py::array_t<float> out({static_cast<py::ssize_t>(height), static_cast<py::ssize_t>(width), py::ssize_t{3}});
  std::copy(picture.rgb.begin(), picture.rgb.end(), out.mutable_data());
  return out;
}

py::dict sun_position(double latitude_deg, double longitude_deg, const std::string& time, double altitude_m) {
  if (!(std::abs(latitude_deg) <= 90.0)) throw py::value_error("latitude: out of range; expected -90 to 90 degrees");
  if (!(std::abs(longitude_deg) <= 360.0))
    throw py::value_error("longitude: out of range; expected -360 to 360 degrees");
  if (!std::isfinite(altitude_m)) throw py::value_error("altitude: not finite; expected a number");
  const Result<double> day = scene::parse_time(time, "time");
  if (!day.ok()) raise(day.error());
  const scene::SolarPosition sun =
      scene::solar_position({latitude_deg, std::remainder(longitude_deg, 360.0)}, day.value(), altitude_m);
  py::dict out;
  out["elevation"] = sun.elevation_deg;
  out["azimuth"] = sun.azimuth_deg;
  out["distance_au"] = sun.distance_au;
  return out;
}

py::list describe_parameters() {
  py::list out;
  const config::Settings defaults;
  for (const config::Row& row : config::rows()) {
    py::dict entry;
    entry["name"] = row.key();
    entry["default"] = config::value_text(row, defaults);
    entry["allowed"] = config::allowed_text(row);
    entry["unit"] = std::string(row.info.unit);
    entry["meaning"] = std::string(row.info.doc);
    out.append(entry);
  }
  return out;
}

}  // namespace
}  // namespace tyndall::python

PYBIND11_MODULE(_core, module) {
  using namespace tyndall::python;
  module.doc() = "Bindings; use the package tyndall.";
  module.attr("version") = TYNDALL_VERSION_STRING;
  error_type = PyErr_NewExceptionWithDoc("tyndall.Error", "A device failed, or there is none that can be used.",
                                         PyExc_RuntimeError, nullptr);
  module.attr("Error") = py::reinterpret_borrow<py::object>(error_type);
  py::class_<Model>(module, "Model")
      .def(py::init<const std::string&, const Assignments&, const std::string&, bool>())
      .def("answer", &Model::answer)
      .def("trace", &Model::trace)
      .def("transmittance", &Model::transmittance)
      .def_property_readonly("notes", &Model::notes)
      .def_property_readonly("device", &Model::device)
      .def_property_readonly("parameters", &Model::parameters)
      .def_property_readonly("planet_radius_m", &Model::planet_radius_m)
      .def_property_readonly("lowest_altitude_m", &Model::lowest_altitude_m);
  module.def("render", &render);
  module.def("sun_position", &sun_position);
  module.def("describe_parameters", &describe_parameters);
}
