// Result<T>: a value or an Error. The library reports every failure that a caller can cause as an Error; it never
// throws, prints or exits.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>

namespace tyndall {

enum class ErrorCode : std::uint32_t {
  invalid_argument,    // the caller passed something outside the documented range
  unsupported_device,  // the device lacks something that requirements() lists
  out_of_memory,       // host or device memory is exhausted
  device_lost,         // the device is lost; destroy everything and start again
  vulkan,              // any other VkResult; see Error::vk_result
  io,                  // a file could not be read or written
};

struct Error {
  ErrorCode code = ErrorCode::invalid_argument;
  std::string message;         // one line, without a full stop or newline at the end
  std::int32_t vk_result = 0;  // the VkResult behind it; 0 when there is none
};

template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}      // NOLINT
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT

  [[nodiscard]] bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  // Precondition: ok().
  T& value() & { return *std::get_if<0>(&state_); }
  const T& value() const& { return *std::get_if<0>(&state_); }
  T&& value() && { return std::move(*std::get_if<0>(&state_)); }

  // Precondition: !ok().
  Error& error() & { return *std::get_if<1>(&state_); }
  const Error& error() const& { return *std::get_if<1>(&state_); }
  Error&& error() && { return std::move(*std::get_if<1>(&state_)); }

 private:
  std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)), ok_(false) {}  // NOLINT

  [[nodiscard]] bool ok() const { return ok_; }
  explicit operator bool() const { return ok_; }

  // Precondition: !ok().
  Error& error() & { return error_; }
  const Error& error() const& { return error_; }
  Error&& error() && { return std::move(error_); }

 private:
  Error error_;
  bool ok_ = true;
};

}  // namespace tyndall
