// The finished tables of an effect as physical quantities, for exports and for Python.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "effect/tables.hpp"
#include "gpu/host.hpp"
#include "tyndall/effect.hpp"

namespace tyndall::models {

// Returns the name of a table in files and reports, which is that of its view in the public interface.
[[nodiscard]] const char* table_name(TableId table);

// The values of one table, three channels each, as models::TableFactors defines them.
struct TableValues {
  TableId id = TableId::single_rayleigh;
  // The sizes of the axes, the slowest first. Scattering tables: altitudes, views, angles between view and sun, suns.
  // Look-up tables of light: 1, 1, suns, altitudes.
  std::array<std::uint32_t, 4> size = {};
  std::vector<float> values;
};

// Copies the finished tables from the device and decodes them, in the order of TableId. `params` are those of the
// effect, with scattering.color = rgb. Errors: those of record_save_tables() and of the device.
[[nodiscard]] Result<std::vector<TableValues>> table_values(gpu::Host& host, Effect& effect, const Params& params);

}  // namespace tyndall::models
