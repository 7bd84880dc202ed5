// Automatic exposure: log-average luminance, adaptation over time and the luminance histogram, on the GPU. Independent
// of scattering. The same pictures give the same bytes on every run.
#pragma once

#include <array>
#include <vector>

#include "gpu/descriptors.hpp"
#include "gpu/resource.hpp"
#include "tyndall/post_settings.hpp"

namespace tyndall::post {

class Exposure {
 public:
  // `frames_in_flight`: how many measurements may be pending while others are recorded.
  static Result<Exposure> create(const gpu::Device& device, std::uint32_t frames_in_flight = 1);

  // Records the measurement of `from` (RGBA32F in GENERAL layout), and adapts to it over the `seconds` since the
  // previous picture. The first picture, and the first after reset_history(), takes effect at once. Writes to `from`
  // must be visible to compute shaders; the result is visible to later ones. `slot` is below frames_in_flight, for
  // read(); the commands that were recorded with it before must have completed.
  Result<void> measure(VkCommandBuffer cmd, VkImageView from, VkExtent2D extent, const TonemapSettings& settings,
                       double seconds, std::uint32_t slot = 0);
  // Resets the history: the next picture is unrelated to the previous one.
  void reset_history() { reset_ = true; }
  // The state on the host from which the next measurement starts. A caller that drops the commands of measure() must
  // restore the state from before the call.
  struct Start {
    bool reset = true;
    bool measured = false;
  };
  [[nodiscard]] Start start() const { return {reset_, measured_}; }
  void put_back(const Start& start) {
    reset_ = start.reset;
    measured_ = start.measured;
  }

  // Returns the measurement recorded last for the slot. Its commands must have completed.
  [[nodiscard]] Measurement read(std::uint32_t slot = 0) const;

  [[nodiscard]] bool measured() const { return measured_; }
  [[nodiscard]] VkBuffer state() const { return state_.buffer.get(); }
  [[nodiscard]] VkDeviceSize bytes() const;

 private:
  const gpu::Device* device_ = nullptr;
  gpu::Pipeline measure_, adapt_;
  gpu::DescriptorSets sets_;  // sets of both pipelines, a copy for each slot
  gpu::Buffer counts_, state_;
  std::vector<gpu::Buffer> results_;  // one per slot: the state, then the counts
  bool reset_ = true;
  bool measured_ = false;
};

}  // namespace tyndall::post
