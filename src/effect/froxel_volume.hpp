// The images of the froxel volume, one pair for each view: allocates them for new settings, and frees them when no
// frame uses them any more.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gpu/resource.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {

// Returns whether frames fill the froxel volume.
[[nodiscard]] bool uses_froxels(const Params& params);
// Returns the size of the volume; 0 if frames do not fill it.
[[nodiscard]] VkExtent3D froxel_extent(const Params& params);
// Returns the device memory of the volume with these settings [bytes].
[[nodiscard]] VkDeviceSize froxel_bytes(const gpu::Device& device, const EffectDesc& desc, const Params& params);
// Returns an error if the device does not allow images of this size.
[[nodiscard]] Result<void> check_froxels(const gpu::Device& device, const Params& params);

class FroxelVolume {
 public:
  static constexpr std::uint32_t kImages = 2;
  static constexpr std::array<const char*, kImages> kNames = {"froxel_inscattering", "froxel_transmittance"};

  // The images of all views.
  struct Images {
    std::vector<std::array<gpu::Image, kImages>> views;
    VkExtent3D extent = {0, 0, 0};
    [[nodiscard]] VkDeviceSize bytes(std::uint32_t image) const;
    [[nodiscard]] VkDeviceSize bytes() const { return bytes(0) + bytes(1); }
  };
  // New images if their size changes with the settings.
  struct Pending {
    Images images;
    bool replaces = false;
  };

  void create(const gpu::Device& device) { device_ = &device; }
  // Allocates the images for new settings, and changes nothing.
  Result<Pending> plan(const EffectDesc& desc, const Params& params);
  // Replaces the images by those of the last plan(). The old ones are freed by the `frames`-th following call of
  // begin_frame(), because commands in flight may use them until then.
  void commit(Pending&& pending, std::uint32_t frames) noexcept;
  // Moves new images out of the undefined layout, and frees old ones.
  void begin_frame(VkCommandBuffer cmd);

  // Returns an image of a view; null if frames do not fill the volume.
  [[nodiscard]] VkImageView view_of(std::uint32_t view, std::uint32_t image) const;
  [[nodiscard]] const Images& images() const { return images_; }
  [[nodiscard]] VkDeviceSize retired_bytes() const;

 private:
  struct Retired {
    Images images;
    std::uint32_t frames_left;
  };

  const gpu::Device* device_ = nullptr;
  Images images_ = {};
  bool ready_ = true;  // false: the layout of the images is undefined
  std::vector<Retired> retired_ = {};
};

}  // namespace tyndall
