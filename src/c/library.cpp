// The version, the errors and the requirements of the C interface.
#include <algorithm>
#include <cstring>

#include "c/error.hpp"
#include "c/structures.hpp"
#include "gpu/try.hpp"
#include "tyndall/effect.hpp"

namespace tyndall::c {
namespace {

// Per thread, so that no lock is needed and a caller reads the error of its own call. The text has a fixed size, so
// that an error about exhausted memory needs none.
struct LastError {
  char text[1024];
  std::int32_t vk_result;
};
thread_local LastError last_error = {};

constexpr TyndallStatus status_of(ErrorCode code) {
  return static_cast<TyndallStatus>(static_cast<std::uint32_t>(code) + 1);
}
static_assert(status_of(ErrorCode::invalid_argument) == TyndallStatus_invalid_argument);
static_assert(status_of(ErrorCode::unsupported_device) == TyndallStatus_unsupported_device);
static_assert(status_of(ErrorCode::out_of_memory) == TyndallStatus_out_of_memory);
static_assert(status_of(ErrorCode::device_lost) == TyndallStatus_device_lost);
static_assert(status_of(ErrorCode::vulkan) == TyndallStatus_vulkan);
static_assert(status_of(ErrorCode::io) == TyndallStatus_io);

}  // namespace

TyndallStatus store_error(const Error& error) noexcept {
  const std::size_t length = std::min(error.message.size(), sizeof last_error.text - 1);
  // A name that the caller passed may contain line ends.
  std::replace_copy_if(
      error.message.data(), error.message.data() + length, last_error.text,
      [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  last_error.text[length] = '\0';
  last_error.vk_result = error.vk_result;
  return status_of(error.code);
}

}  // namespace tyndall::c

using namespace tyndall;

uint32_t tyndall_version(void) { return TYNDALL_VERSION; }

const char* tyndall_last_error(void) { return c::last_error.text; }

int32_t tyndall_last_vk_result(void) { return c::last_error.vk_result; }

const char* tyndall_status_name(TyndallStatus status) {
  switch (status) {
    case TyndallStatus_success: return "success";
    case TyndallStatus_invalid_argument: return "invalid_argument";
    case TyndallStatus_unsupported_device: return "unsupported_device";
    case TyndallStatus_out_of_memory: return "out_of_memory";
    case TyndallStatus_device_lost: return "device_lost";
    case TyndallStatus_vulkan: return "vulkan";
    case TyndallStatus_io: return "io";
    case TyndallStatus_max: break;
  }
  return "unknown";
}

TyndallStatus tyndall_requirements(TyndallRequirements* requirements) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    const auto& [api_version, device_extensions] = tyndall::requirements();
    TyndallRequirements out = {};
    out.api_version = api_version;
    out.device_extension_count = static_cast<uint32_t>(device_extensions.size());
    out.device_extensions = device_extensions.data();
    return c::write(where, out, requirements);
  });
}
