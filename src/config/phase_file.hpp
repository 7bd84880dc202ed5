// Reads the file of atmosphere.phase_table.
#pragma once

#include <memory>
#include <string>

#include "config/settings.hpp"
#include "tyndall/phase_table.hpp"

namespace tyndall::config {

// Reads a phase function from CSV: the first column, angle_deg, has scattering angles from 0 to 180, and the header of
// every other column is a wavelength in nm. `where` names the source in errors.
[[nodiscard]] Result<std::shared_ptr<const PhaseTable>> read_phase_table(const std::string& path,
                                                                         std::string_view where);

// Loads the files that Settings::effect contains by value: the phase function of atmosphere.phase_table, with
// atmosphere.mie_phase = table. To be called before check().
[[nodiscard]] Result<void> load_files(Settings& settings);

}  // namespace tyndall::config
