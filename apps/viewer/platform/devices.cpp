#include "viewer/platform/devices.hpp"

#include "gpu/try.hpp"
#include "viewer/platform/window.hpp"

namespace tyndall::viewer {

gpu::HostDesc Devices::host_desc() const {
  gpu::HostDesc out;
  out.device = desc_.name;
  out.validation = desc_.validation;
  Window::require_presentation(out);
  return out;
}

Result<void> Devices::open_scene_device(const Desc& desc) {
  desc_ = desc;
  TYNDALL_ASSIGN(scene_, gpu::Host::create(host_desc()));
  if (!slow() || desc.one_device) window_ = scene_;
  return {};
}

Result<void> Devices::open_window_device() {
  if (window_ != nullptr) return {};
  TYNDALL_ASSIGN(window_, gpu::Host::create(host_desc()));
  return {};
}

bool Devices::slow() const { return scene_->device().properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }

std::uint32_t Devices::validation_messages() const {
  std::uint32_t out = 0;
  if (scene_ != nullptr) out += scene_->validation_messages();
  if (window_ != nullptr && !are_one()) out += window_->validation_messages();
  return out;
}

std::string Devices::validation_text() const {
  std::string out;
  if (scene_ != nullptr) out += scene_->validation_text();
  if (window_ != nullptr && !are_one()) out += window_->validation_text();
  return out;
}

}  // namespace tyndall::viewer
