#pragma once

#include <string>
#include <utility>

#include "tyndall/result.hpp"

namespace tyndall {

[[nodiscard]] inline Error invalid(std::string message) { return {ErrorCode::invalid_argument, std::move(message)}; }

}  // namespace tyndall
