// The file of a shard of `validate`: the answers of its queries, as JSON. `tyndall merge` reads it.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "validate/parts.hpp"

namespace tyndall::cli {

// The ranges of the options that determine the rays of a study.
struct StudyRange {
  const char* option;
  std::uint32_t min, max;
};
constexpr std::array<StudyRange, 4> kStudyRanges = {
    {{"--rays", 18, 1000000}, {"--samples", 2, 1000000000}, {"--seed", 0, UINT32_MAX}, {"--orders", 1, 256}}};

constexpr const char* kPartEnding = ".answers.json";  // see shard_path()

// Returns the text of the file, which restores every number exactly.
[[nodiscard]] std::string part_json(const validate::StudyPart& rays, const validate::ColorPart& colors);

// Reads such a text. Errors (invalid_argument) call it `name`.
[[nodiscard]] Result<void> parse_part(std::string_view text, std::string_view name, validate::StudyPart& rays,
                                      validate::ColorPart& colors);

}  // namespace tyndall::cli
