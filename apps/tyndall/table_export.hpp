// The tables as files: physical values as EXR, and tables.json, which says what each file, row and column is.
// docs/tables.md describes them.
#pragma once

#include <functional>
#include <string>

#include "config/settings.hpp"
#include "effect/tables.hpp"
#include "gpu/host.hpp"
#include "tyndall/effect.hpp"

namespace tyndall::cli {

// As in files and reports: the name of the table's view in the public interface.
[[nodiscard]] const char* table_name(TableId table);

// Whether the directory is there or can be made, and takes files: for a check before long work.
[[nodiscard]] Result<void> check_export(const std::string& directory);

// Writes the finished tables of an effect whose parameters are settings.effect; the number of files. They
// appear in the directory when all of them are written, in place of those of an earlier export; after an
// error, what was there is there.
[[nodiscard]] Result<std::size_t> export_tables(
    const std::string& directory, gpu::Host& host, Effect& effect, const config::Settings& settings,
    const std::function<void(std::size_t done, std::size_t total)>& progress);

}  // namespace tyndall::cli
