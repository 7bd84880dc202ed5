// Conversions between NumPy and the library: errors as exceptions, arrays of queries, settings.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "config/settings.hpp"
#include "rays/ray_query.hpp"
#include "tables/make_ready.hpp"
#include "tyndall/result.hpp"

namespace tyndall::python {

namespace py = pybind11;

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Assignments = std::vector<std::pair<std::string, std::string>>;

// tyndall.Error, which the module owns. Set before any other function of this file is called.
void set_error_type(PyObject* type);

// Throws the error of a result as the Python exception that fits.
[[noreturn]] void raise(const Error& error);

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

// Returns the settings of a scene file, if it is named, with assignments as of --set.
[[nodiscard]] config::Settings settings_of(const std::string& scene, const Assignments& assignments);
[[nodiscard]] tables::MakeReady make_tables(const config::Settings& settings);

// Returns the queries of rows of altitude [m], view zenith, sun zenith and azimuth [rad].
[[nodiscard]] std::vector<RayQuery> queries_of(const Array& rows, bool sky);

}  // namespace tyndall::python
