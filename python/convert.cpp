#include "convert.hpp"

#include <cmath>

#include "config/phase_file.hpp"
#include "config/scene_file.hpp"

namespace tyndall::python {
namespace {

PyObject* error_type = nullptr;

}  // namespace

void set_error_type(PyObject* type) { error_type = type; }

void raise(const Error& error) {
  PyObject* type = error.code == ErrorCode::invalid_argument ? PyExc_ValueError
                   : error.code == ErrorCode::out_of_memory  ? PyExc_MemoryError
                   : error.code == ErrorCode::io             ? PyExc_OSError
                                                             : error_type;
  PyErr_SetString(type, error.message.c_str());
  throw py::error_already_set();
}

config::Settings settings_of(const std::string& scene, const Assignments& assignments) {
  config::Settings settings;
  if (!scene.empty()) {
    if (const Result<void> loaded = config::load(settings, scene); !loaded.ok()) raise(loaded.error());
  }
  for (const auto& [key, value] : assignments) {
    if (const Result<void> set = config::set(settings, key, value, "parameters"); !set.ok()) raise(set.error());
  }
  if (const Result<void> loaded = config::load_files(settings); !loaded.ok()) raise(loaded.error());
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

}  // namespace tyndall::python
