#include <cmath>
#include <string>

#include "gpu/guard.hpp"
#include "gpu/open_device.hpp"
#include "gpu/try.hpp"
#include "post/tonemap.hpp"
#include "tyndall/post.hpp"

namespace tyndall::post {

// The device must not move, because the other members refer to it.
struct ToneMapper::State {
  gpu::Device device;
  Tonemap tonemap;
};

namespace {

constexpr std::uint32_t kMaxSlots = 64;

Error moved_from(const char* where) {
  return {ErrorCode::invalid_argument, std::string(where) + ": the ToneMapper was moved from; expected a valid one"};
}

Result<void> check_command(const char* where, VkCommandBuffer cmd, VkExtent2D extent) {
  if (cmd == VK_NULL_HANDLE) {
    return Error{ErrorCode::invalid_argument, std::string(where) + ": the command buffer is null; expected one that is "
                                                                   "being recorded"};
  }
  if (extent.width == 0 || extent.height == 0) {
    return Error{ErrorCode::invalid_argument, std::string(where) + ": the extent is empty; expected at least 1x1"};
  }
  return {};
}

Result<void> check_view(const char* where, const char* what, VkImageView view) {
  if (view != VK_NULL_HANDLE) return {};
  return Error{ErrorCode::invalid_argument, std::string(where) + ": the view of `" + what +
                                                "` is null; expected an RGBA32F image in GENERAL layout"};
}

// The operator is checked with its pipeline.
Result<void> check_settings(const char* where, const TonemapSettings& settings) {
  const auto check = [where](const char* name, float value, bool zero) -> Result<void> {
    if (std::isfinite(value) && (value > 0.0F || (zero && value == 0.0F))) return {};
    return Error{ErrorCode::invalid_argument, std::string(where) + ": invalid TonemapSettings::" + name + ' ' +
                                                  std::to_string(value) + "; expected a number " +
                                                  (zero ? "that is not negative" : "above 0")};
  };
  TYNDALL_TRY(check("middle_gray", settings.middle_gray, true));
  TYNDALL_TRY(check("white_point", settings.white_point, false));
  TYNDALL_TRY(check("saturation", settings.saturation, false));
  TYNDALL_TRY(check("least_luminance", settings.least_luminance, false));
  return check("exposure", settings.exposure, true);
}

}  // namespace

ToneMapper::ToneMapper(std::unique_ptr<State> state) : state_(std::move(state)) {}
ToneMapper::ToneMapper(ToneMapper&&) noexcept = default;
ToneMapper& ToneMapper::operator=(ToneMapper&&) noexcept = default;
ToneMapper::~ToneMapper() = default;

Result<ToneMapper> ToneMapper::create(const DeviceInfo& device, std::uint32_t frames_in_flight) {
  constexpr const char* kWhere = "ToneMapper::create";
  return guarded(kWhere, [&]() -> Result<ToneMapper> {
    if (device.instance == VK_NULL_HANDLE || device.physical_device == VK_NULL_HANDLE ||
        device.device == VK_NULL_HANDLE || device.get_instance_proc_addr == nullptr) {
      return Error{ErrorCode::invalid_argument, std::string(kWhere) +
                                                    ": a handle of DeviceInfo is null; expected instance, "
                                                    "physical_device, device and get_instance_proc_addr"};
    }
    if (frames_in_flight == 0 || frames_in_flight > kMaxSlots) {
      return Error{ErrorCode::invalid_argument, std::string(kWhere) + ": invalid frames_in_flight " +
                                                    std::to_string(frames_in_flight) + "; expected 1 to " +
                                                    std::to_string(kMaxSlots)};
    }
    auto state = std::make_unique<State>();
    TYNDALL_TRY(gpu::open_device(state->device, device));
    TYNDALL_ASSIGN(state->tonemap, Tonemap::create(state->device, frames_in_flight));
    return ToneMapper(std::move(state));
  });
}

Result<void> ToneMapper::measure(VkCommandBuffer cmd, VkImageView radiance, VkExtent2D extent,
                                 const TonemapSettings& settings, double seconds, std::uint32_t slot) {
  constexpr const char* kWhere = "ToneMapper::measure";
  return guarded(kWhere, [&]() -> Result<void> {
    if (!state_) return moved_from(kWhere);
    TYNDALL_TRY(check_command(kWhere, cmd, extent));
    TYNDALL_TRY(check_view(kWhere, "radiance", radiance));
    TYNDALL_TRY(check_settings(kWhere, settings));
    if (std::isnan(seconds)) {
      return Error{ErrorCode::invalid_argument, std::string(kWhere) + ": `seconds` is not a number; expected the time "
                                                                      "since the previous picture"};
    }
    return state_->tonemap.exposure().measure(cmd, radiance, extent, settings, seconds, slot);
  });
}

Result<void> ToneMapper::record(VkCommandBuffer cmd, VkImageView radiance, VkImageView display, VkExtent2D extent,
                                const TonemapSettings& settings, std::uint32_t slot) {
  constexpr const char* kWhere = "ToneMapper::record";
  return guarded(kWhere, [&]() -> Result<void> {
    if (!state_) return moved_from(kWhere);
    TYNDALL_TRY(check_command(kWhere, cmd, extent));
    TYNDALL_TRY(check_view(kWhere, "radiance", radiance));
    TYNDALL_TRY(check_view(kWhere, "display", display));
    TYNDALL_TRY(check_settings(kWhere, settings));
    return state_->tonemap.record(cmd, radiance, display, extent, settings, slot);
  });
}

void ToneMapper::reset_history() {
  if (state_) state_->tonemap.exposure().reset_history();
}

Measurement ToneMapper::measurement(std::uint32_t slot) const {
  return state_ ? state_->tonemap.exposure().read(slot) : Measurement();
}

VkDeviceSize ToneMapper::bytes() const { return state_ ? state_->tonemap.exposure().bytes() : 0; }

}  // namespace tyndall::post
