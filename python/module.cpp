// The extension module tyndall._core: the models of `tyndall probe` on arrays. python/tyndall/__init__.py is the public
// interface, which converts units, broadcasts arrays and documents. Arrays are float64 and contiguous; a query has the
// columns altitude [m], view zenith, sun zenith and azimuth [rad].
#include <cmath>

#include "convert.hpp"
#include "effect/spectral_medium.hpp"
#include "files/access.hpp"
#include "model.hpp"
#include "scene/description/lunar_position.hpp"
#include "scene/description/placed_sun.hpp"
#include "scene/description/solar_position.hpp"
#include "scene/scene.hpp"
#include "tyndall/photometry.hpp"
#include "tyndall/version.h"

namespace tyndall::python {
namespace {

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

scene::Place place_at(double latitude_deg, double longitude_deg) {
  if (!(std::abs(latitude_deg) <= 90.0)) throw py::value_error("latitude: out of range; expected -90 to 90 degrees");
  if (!(std::abs(longitude_deg) <= 360.0))
    throw py::value_error("longitude: out of range; expected -360 to 360 degrees");
  return {latitude_deg, std::remainder(longitude_deg, 360.0)};
}

double julian_day(const std::string& time) {
  const Result<double> day = scene::parse_time(time, "time");
  if (!day.ok()) raise(day.error());
  return day.value();
}

py::dict sun_position(double latitude_deg, double longitude_deg, const std::string& time, double altitude_m) {
  const scene::Place place = place_at(latitude_deg, longitude_deg);
  if (!std::isfinite(altitude_m)) throw py::value_error("altitude: not finite; expected a number");
  const scene::SolarPosition sun = scene::solar_position(place, julian_day(time), altitude_m);
  py::dict out;
  out["elevation"] = sun.elevation_deg;
  out["azimuth"] = sun.azimuth_deg;
  out["distance_au"] = sun.distance_au;
  return out;
}

py::dict moon_position(double latitude_deg, double longitude_deg, const std::string& time) {
  const scene::LunarPosition moon = scene::lunar_position(place_at(latitude_deg, longitude_deg), julian_day(time));
  py::dict out;
  out["elevation"] = moon.elevation_deg;
  out["azimuth"] = moon.azimuth_deg;
  out["distance_km"] = moon.distance_km;
  out["angular_radius"] = moon.angular_radius_deg;
  out["phase_angle"] = moon.phase_angle_deg;
  out["illuminance"] = scene::moon_illuminance(moon.phase_angle_deg, moon.angular_radius_deg);
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
  module.attr("sun_illuminance") = tyndall::kSunIlluminance_lux;
  PyObject* const error = PyErr_NewExceptionWithDoc(
      "tyndall.Error", "A device failed, or there is none that can be used.", PyExc_RuntimeError, nullptr);
  module.attr("Error") = py::reinterpret_borrow<py::object>(error);
  set_error_type(error);
  py::class_<Model>(module, "Model")
      .def(py::init([](const std::string& scene, const Assignments& assignments, const std::string& device,
                       const std::string& name, bool spectral, const std::vector<double>& wavelengths_nm) {
        return std::make_unique<Model>(scene, assignments, device, name, Light{spectral, wavelengths_nm});
      }))
      .def("answer", &Model::answer)
      .def("trace",
           [](const Model& model, const Array& rows, bool sky, std::uint64_t samples, int orders, std::uint64_t seed,
              bool xyz, const std::vector<double>& wavelengths_nm) {
             tyndall::reference::Options options;
             options.samples = samples;
             options.orders = orders;
             options.seed = seed;
             return model.trace(rows, sky, options, xyz, wavelengths_nm);
           })
      .def("transmittance", &Model::transmittance)
      .def("tables", &Model::tables)
      .def_property_readonly("channels", &Model::channels)
      .def_property_readonly("wavelengths_nm", &Model::wavelengths_nm)
      .def_property_readonly("notes", &Model::notes)
      .def_property_readonly("device", &Model::device)
      .def_property_readonly("parameters", &Model::parameters)
      .def_property_readonly("planet_radius_m", &Model::planet_radius_m)
      .def_property_readonly("lowest_altitude_m", &Model::lowest_altitude_m);
  module.def("colors", &colors);
  module.def("visible_spectrum", &visible_spectrum);
  module.def("xyz_of_color", &tyndall::xyz_of_color);
  module.def("render", &render);
  module.def("sun_position", &sun_position);
  module.def("moon_position", &moon_position);
  module.def("refraction", py::vectorize(&tyndall::scene::refraction_deg));
  module.def("allow_outside", &tyndall::files::allow_outside);
  module.def("describe_parameters", &describe_parameters);
}
