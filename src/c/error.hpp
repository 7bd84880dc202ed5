// The last error of each thread, and the frame of every function of the C interface.
#pragma once

#include <string>
#include <utility>

#include "gpu/guard.hpp"
#include "tyndall/result.hpp"
#include "tyndall/tyndall.h"

namespace tyndall::c {

// Stores the error as the last one of this thread. Returns its status.
TyndallStatus store_error(const Error& error) noexcept;

// Runs body(where), which returns a Result<void>. Stores its error, or that of an exception that it throws.
template <typename Body>
TyndallStatus call(const char* where, const Body& body) noexcept {
  const Result<void> result = guarded(where, [&] { return body(where); });
  return result.ok() ? TyndallStatus_success : store_error(result.error());
}

[[nodiscard]] inline Error invalid(const char* where, const std::string& what) {
  return {ErrorCode::invalid_argument, std::string(where) + ": " + what};
}

// Returns an error if a pointer is null.
template <typename T>
[[nodiscard]] Result<void> check_pointer(const char* where, const char* name, const T* pointer) {
  if (pointer != nullptr) return {};
  return invalid(where, std::string("'") + name + "' is null; expected a valid pointer");
}

}  // namespace tyndall::c
