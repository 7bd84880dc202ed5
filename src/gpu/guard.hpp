// Turns exceptions into errors. Every public function of the library that can fail runs its body in guarded(), and
// those of scenes in within_memory(). Other code catches exceptions only to clean up or to do with fewer threads.
#pragma once

#include <new>
#include <string>
#include <type_traits>

#include "tyndall/result.hpp"

namespace tyndall {

// Returns an error with a message that names `where`. If there is no memory for it, the message is `briefly`, which is
// so short that std::string stores it without an allocation.
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

// Runs `body` and returns its Result, or an error if it throws.
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

// Runs `body` and returns its Result, or an error if it throws std::bad_alloc. Other exceptions propagate.
template <typename Body>
std::invoke_result_t<Body> within_memory(const char* where, Body&& body) {
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return guard_error(ErrorCode::out_of_memory, where, "out of host memory", "out of memory");
  }
}

}  // namespace tyndall
