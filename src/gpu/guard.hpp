// Turns exceptions into errors. Each public function of the library runs its body in guarded(), and those of scenes run
// theirs in within_memory(); nothing below them handles exceptions.
#pragma once

#include <new>
#include <string>
#include <type_traits>

#include "tyndall/result.hpp"

namespace tyndall {

// Returns an error with a message that names `where`, or with a short message that every std::string stores without an
// allocation.
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

// The same for std::bad_alloc alone; other exceptions pass.
template <typename Body>
std::invoke_result_t<Body> within_memory(const char* where, Body&& body) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return guard_error(ErrorCode::out_of_memory, where, "out of host memory", "out of memory");
  }
}

}  // namespace tyndall
