// Exposure from the picture itself: log-average luminance, adaptation in time, and the histogram behind it, on the GPU.
// Knows nothing of scattering. The same pictures give the same bytes on every run.
#pragma once

#include <array>
#include <vector>

#include "gpu/pipeline.hpp"
#include "gpu/resource.hpp"
#include "post/settings.hpp"

namespace tyndall::post {

constexpr std::size_t kHistogramBins = 256;
// log2 of the luminance (radiance in the picture's unit) at which a bin of the histogram stands.
[[nodiscard]] double stop_of_bin(std::size_t bin);

// What was found of a picture.
struct Measurement {
  float exposure = 0.0F;                         // that scales the radiance with auto exposure
  float luminance = 0.0F;                        // that the eye is adapted to
  float measured = 0.0F;                         // log-average of the picture; 0 when all of it is black
  float counted = 0.0F;                          // mean weight of its samples, 0 to 1: black space has none
  float black = 0.0F;                            // share of samples darker than the histogram begins
  std::array<float, kHistogramBins> share = {};  // of the samples in each bin; with `black` they add up to 1
};

class Exposure {
 public:
  // `frames_in_flight`: measurements that can be read while others are recorded.
  static Result<Exposure> create(const gpu::Device& device, std::uint32_t frames_in_flight = 1);

  // Records the measurement of `from` (RGBA32F in GENERAL layout) and adapts to it over `seconds` since the picture
  // before; the first picture, and the first after reset_history(), is taken at once. What wrote `from` must be visible
  // to compute shaders; the result is visible to those that follow. `slot`: below frames_in_flight, for read().
  Result<void> measure(VkCommandBuffer cmd, VkImageView from, VkExtent2D extent, const TonemapSettings& settings,
                       double seconds, std::uint32_t slot = 0);
  // The next picture has nothing to do with the one before.
  void reset_history() { reset_ = true; }
  // What the next measurement starts from, as far as the host knows it. A caller that drops the commands of measure()
  // puts back what was there before them.
  struct Start {
    bool reset = true;
    bool measured = false;
  };
  [[nodiscard]] Start start() const { return {reset_, measured_}; }
  void put_back(const Start& start) {
    reset_ = start.reset;
    measured_ = start.measured;
  }

  // Of the measurement recorded last for the slot, once its commands have completed.
  [[nodiscard]] Measurement read(std::uint32_t slot = 0) const;

  [[nodiscard]] bool measured() const { return measured_; }
  [[nodiscard]] VkBuffer state() const { return state_.buffer.get(); }
  [[nodiscard]] VkDeviceSize bytes() const;

 private:
  const gpu::Device* device_ = nullptr;
  gpu::Pipeline measure_, adapt_;
  gpu::Buffer counts_, state_;
  std::vector<gpu::Buffer> results_;  // one a slot: the state, then the counts
  bool reset_ = true;
  bool measured_ = false;
};

}  // namespace tyndall::post
