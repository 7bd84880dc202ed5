// A compiled shader with what its SPIR-V says of itself. tools/embed_shaders.cpp makes these tables at
// build time; bindings are found by name, so the GLSL is the only declaration of them.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <string_view>

namespace tyndall::gpu {

struct Binding {
  std::string_view name;
  std::uint32_t binding;
  VkDescriptorType type;
  bool reads;
  bool writes;
};

struct Shader {
  const char* name;  // file name with dots as underscores; also the debug label and the timer's name
  VkShaderStageFlagBits stage;
  std::span<const std::uint32_t> spirv;
  std::span<const Binding> bindings;
  std::uint32_t push_constant_bytes;
  std::uint32_t local_size[3];  // compute only
};

}  // namespace tyndall::gpu
