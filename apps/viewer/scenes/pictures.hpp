// Draws the canvas of a scene, or a comparison of two, into the window below the GUI. Runs on the window's device and
// on the GUI's thread; shows the last canvas while the scene is being drawn.
#pragma once

#include <array>

#include "gpu/frames_in_flight.hpp"
#include "viewer/scenes/canvas.hpp"

namespace tyndall::viewer {

struct PictureOptions {
  Shown shown = Shown::picture;
  int layer = 0;         // layer of the shadow maps to show
  float slice = 0.5F;    // position of the slice through a table, 0 to 1
  float gain = 1.0F;     // brightness of all views but the picture
  bool compare = false;  // show both scenes side by side
  bool difference = false;
  float divider = 0.5F;  // position of the dividing line, as a fraction of the window's width
};

// Returns the view that the canvases of a window of this size must show.
[[nodiscard]] View view_of(const PictureOptions& options, VkExtent2D window);

class Pictures {
 public:
  Pictures() = default;
  Pictures(const Pictures&) = delete;
  Pictures& operator=(const Pictures&) = delete;
  ~Pictures();
  Result<void> create(gpu::Host& host, VkFormat format);
  // Sets the canvas of a side. 0: left or only, 1: right.
  Result<void> take(std::size_t side, Picture picture);
  void forget(std::size_t side) { sides_.at(side) = {}; }
  [[nodiscard]] bool has(std::size_t side) const { return sides_.at(side) != nullptr; }
  // Records the drawing into a rendering scope over the window. At most gpu::kFramesInFlight of these drawings may be
  // recorded or executing.
  Result<void> record(VkCommandBuffer cmd, VkExtent2D window, bool two, const PictureOptions& options);

 private:
  gpu::Host* host_ = nullptr;
  gpu::Pipeline present_;
  gpu::DescriptorSets sets_;  // one per frame in flight
  gpu::Handle<VkSampler> sampler_;
  std::array<std::shared_ptr<const gpu::Image>, 2> sides_;
  // The images that frames in flight read, which take() and forget() must not destroy.
  std::array<std::array<std::shared_ptr<const gpu::Image>, 2>, gpu::kFramesInFlight> read_;
  std::uint32_t frame_ = 0;                    // index of the last recorded frame
  std::shared_ptr<const gpu::Image> nothing_;  // one dark texel, until there is a picture
};

}  // namespace tyndall::viewer
