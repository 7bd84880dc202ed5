// A compiled shader and what its SPIR-V declares. tools/embed_shaders.cpp generates these tables when the project is
// built. Resources are bound by name, so that a binding is declared in GLSL alone.
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
  bool reads;   // the shader may read it
  bool writes;  // the shader may write it; barriers follow from both
};

struct Shader {
  const char* name;  // the file's name, dots replaced by underscores
  VkShaderStageFlagBits stage;
  std::span<const std::uint32_t> spirv;
  std::span<const Binding> bindings;
  std::uint32_t push_constant_bytes;
  std::uint32_t local_size[3];               // compute only
  std::span<const std::uint32_t> constants;  // ids of its specialisation constants, ascending
};

}  // namespace tyndall::gpu
