// The boundary of the library: no exception passes it. Each public function runs its body in guarded(), and nothing
// below it handles exceptions.
#pragma once

#include <new>
#include <string>
#include <type_traits>

#include "tyndall/result.hpp"

namespace tyndall {

// An error with a message that names `where`, or a short one that every std::string stores without an allocation.
[[nodiscard]] inline Error guard_error(ErrorCode code, const char* where, const char* what,
                                       const char* briefly) noexcept {
  Error error;
  error.code = code;
  try {
    error.message = std::string(where) + ": " + what;
  } catch (...) {
    error.message = briefly;
  }
  return error;
}

// Returns what `body` returns, a Result, or an error in place of an exception.
template <typename Body>
std::invoke_result_t<Body> guarded(const char* where, Body&& body) noexcept {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return guard_error(ErrorCode::out_of_memory, where, "out of host memory", "out of memory");
  } catch (...) {
    return guard_error(ErrorCode::invalid_argument, where, "a callback of DeviceInfo threw an exception; none may",
                       "exception");
  }
}

}  // namespace tyndall
