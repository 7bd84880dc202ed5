// Exports the tables: physical values as EXR files, and tables.json, which describes each file, row and column.
// docs/tables.md describes them.
#pragma once

#include <functional>
#include <string>

#include "config/settings.hpp"
#include "gpu/host.hpp"
#include "tyndall/effect.hpp"

namespace tyndall::cli {

// Checks before long work that the directory exists or can be created, and is writable.
[[nodiscard]] Result<void> check_export(const std::string& directory, const Params& params);

// Writes the finished tables of an effect whose parameters are settings.effect. Returns the number of files. They
// replace those of an earlier export when all of them are complete; after an error, the old files are still there.
[[nodiscard]] Result<std::size_t> export_tables(
    const std::string& directory, gpu::Host& host, Effect& effect, const config::Settings& settings,
    const std::function<void(std::size_t done, std::size_t total)>& progress);

}  // namespace tyndall::cli
