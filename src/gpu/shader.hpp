// A compiled shader and the declarations of its SPIR-V. tools/embed_shaders.cpp generates these tables during the
// build. Resources are bound by name, so a binding is declared only in GLSL.
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
  bool writes;  // the shader may write it; both determine the barriers
};

struct Shader {
  const char* name;  // name of the file, with underscores instead of dots
  VkShaderStageFlagBits stage;
  std::span<const std::uint32_t> spirv;
  std::span<const Binding> bindings;
  std::uint32_t push_constant_bytes;
  std::uint32_t local_size[3];               // compute only
  std::span<const std::uint32_t> constants;  // ids of its specialisation constants, ascending
};

}  // namespace tyndall::gpu
