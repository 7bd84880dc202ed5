// tyndall::post, a library of its own: exposure and tone mapping. It converts the linear radiance of any HDR picture to
// displayable values, and does not need the effect. docs/tonemapping.md describes the operators and the exposure.
//
// Conventions, ownership, threads, errors and submission are those of tyndall/effect.hpp. Both images are RGBA32F, can
// be used as storage images, and are in layout GENERAL.
//
// A frame:   mapper.measure(cmd, radiance, extent, settings, seconds, slot);   // with auto exposure
//            mapper.record(cmd, radiance, display, extent, settings, slot);
#pragma once

#include <cstdint>
#include <memory>

#include "tyndall/effect.hpp"
#include "tyndall/post_settings.hpp"

namespace tyndall::post {

class ToneMapper {
 public:
  // Allocates all memory and makes all pipelines. `frames_in_flight` is the number of slots, 1 to 64: how many
  // frames are recorded before the first of them has completed.
  static Result<ToneMapper> create(const DeviceInfo& device, std::uint32_t frames_in_flight = 2);
  // A moved-from ToneMapper can be destroyed or assigned to. Its functions return an error or zeros.
  ToneMapper(ToneMapper&&) noexcept;
  ToneMapper& operator=(ToneMapper&&) noexcept;
  // Destroys everything immediately. All recorded commands must have completed.
  ~ToneMapper();

  // Records the measurement of `radiance`, and adapts the exposure to it over the `seconds` since the previous picture.
  // The first picture, and the first after reset_history(), takes effect at once. Negative seconds count as 0. Writes
  // to the image must be visible to COMPUTE_SHADER / SHADER_READ. `slot` is below frames_in_flight; the commands that
  // were recorded with it before must have completed.
  Result<void> measure(VkCommandBuffer cmd, VkImageView radiance, VkExtent2D extent, const TonemapSettings& settings,
                       double seconds, std::uint32_t slot = 0);
  // Records the pass from `radiance` to `display`, two images of the same extent: linear values in [0; 1] with Rec. 709
  // primaries, which are not yet encoded as sRGB. Writes `display` in COMPUTE_SHADER / SHADER_WRITE. Returns an error
  // with auto exposure if measure() was not recorded before. `slot` has the same meaning as for measure().
  Result<void> record(VkCommandBuffer cmd, VkImageView radiance, VkImageView display, VkExtent2D extent,
                      const TonemapSettings& settings, std::uint32_t slot = 0);
  // Makes the next picture take effect at once, because it is unrelated to the previous one.
  void reset_history();

  // Returns the measurement that was recorded last for the slot. Its commands must have completed.
  [[nodiscard]] Measurement measurement(std::uint32_t slot = 0) const;
  // Returns the memory that the library allocated [bytes].
  [[nodiscard]] VkDeviceSize bytes() const;

 private:
  struct State;
  explicit ToneMapper(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tyndall::post
