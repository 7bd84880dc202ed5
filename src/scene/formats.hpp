// Formats of the images that the scene draws into.
#pragma once

#include <vulkan/vulkan.h>

namespace tyndall::scene {

constexpr VkFormat kColorFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  // the sun's disc exceeds half precision
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr VkFormat kShadowColorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;  // alpha is a depth

}  // namespace tyndall::scene
