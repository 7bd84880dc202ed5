// The Vulkan devices of the viewer: one for the scenes and one for the window. On a GPU both are the same. On a CPU
// device the window has a device of its own, because a queue executes its submissions in order, and the GUI would wait
// for whole frames of the scene.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gpu/host.hpp"

namespace tyndall::viewer {

class Devices {
 public:
  struct Desc {
    std::string name;  // name of the device, as for --device
    bool validation = false;
    bool one_device = false;  // always use one device for both
  };

  // Opens the device of the scenes.
  Result<void> open_scene_device(const Desc& desc);
  // Opens the window's device, unless it is that of the scenes. This is a separate step, so that the first scene can be
  // created at the same time.
  Result<void> open_window_device();

  [[nodiscard]] gpu::Host& scene() const { return *scene_; }
  [[nodiscard]] gpu::Host& window() const { return *window_; }
  [[nodiscard]] bool are_one() const { return window_ == scene_; }
  // Returns whether scenes are drawn without a GPU.
  [[nodiscard]] bool slow() const;
  // Returns the number of messages of the validation layer on both devices.
  [[nodiscard]] std::uint32_t validation_messages() const;
  [[nodiscard]] std::string validation_text() const;

 private:
  [[nodiscard]] gpu::HostDesc host_desc() const;

  Desc desc_;
  std::shared_ptr<gpu::Host> scene_, window_;
};

}  // namespace tyndall::viewer
