// Limits of a TOML text, which are checked before it is parsed.
#pragma once

#include <string_view>

#include "tyndall/result.hpp"

namespace tyndall::config {

constexpr int kMaxKeyParts = 16;  // parts of one dotted key; the keys of parameters have two

// Returns an error that names the line of the first dotted key ("a.b.c") of more than kMaxKeyParts parts. Each part
// is a table inside the one before it, and the parser recurses into them without a limit of its own. `name` names
// the file in the error.
[[nodiscard]] Result<void> check_key_depth(std::string_view toml, std::string_view name);

}  // namespace tyndall::config
