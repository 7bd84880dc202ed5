// The format of a storage image in a compiled shader. SPIR-V declares it with the image, so that GLSL needs a variant
// of the shader for each format. One word differs between these variants.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>

namespace tyndall::gpu {

// Chooses the format of the storage image at a binding: VK_FORMAT_R16G16B16A16_SFLOAT or VK_FORMAT_R32G32B32A32_SFLOAT.
struct StorageFormat {
  std::uint32_t binding;
  VkFormat format;
};

// Changes the declared format of the image in a module. Images of the same type share their declaration in SPIR-V and
// change, too. Returns false, and changes nothing, if the module is damaged, has no image at the binding, or the format
// is another one.
bool set_storage_format(std::span<std::uint32_t> spirv, const StorageFormat& format);

}  // namespace tyndall::gpu
