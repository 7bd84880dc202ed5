// Pipelines from embedded shaders. The layouts of descriptor sets follow from the reflected bindings; descriptors.hpp
// binds resources. Specialisation constants select variants. Pipelines are never created while commands are recorded.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "gpu/device.hpp"
#include "gpu/shader.hpp"
#include "gpu/storage_format.hpp"

namespace tyndall::gpu {

constexpr std::uint32_t kMaxBindings = 20;

// A specialisation constant of four bytes.
struct Constant {
  std::uint32_t id;
  std::uint32_t value;
};

struct Pipeline {
  Handle<VkDescriptorSetLayout> set_layout;
  Handle<VkPipelineLayout> layout;
  Handle<VkPipeline> pipeline;
  VkPipelineBindPoint bind_point = VK_PIPELINE_BIND_POINT_COMPUTE;
  const char* name = "";
  std::array<Binding, kMaxBindings> bindings = {};
  std::uint32_t binding_count = 0;
  VkShaderStageFlags push_stages = 0;
  std::uint32_t push_bytes = 0;
  std::uint32_t local_size[3] = {1, 1, 1};
};

// Returns an error if the bindings, push constants or workgroup size of a shader exceed the limits of the device.
[[nodiscard]] Result<void> check_shader(const Device& device, const Shader& shader);

// `output`: the format of a storage image, instead of that which the shader declares.
Result<Pipeline> create_compute_pipeline(const Device& device, const Shader& shader,
                                         std::span<const Constant> constants = {},
                                         const std::optional<StorageFormat>& output = {});

// The operation that combines the colour of a fragment with the attachment. `multiply_min` multiplies the colours and
// stores the smaller alpha.
enum class Blend { none, add, multiply, multiply_min };

constexpr std::uint32_t kMaxColors = 4;  // colour attachments; every device supports as many

// The variable state of a graphics pipeline. All pipelines draw triangles with dynamic rendering, and their vertex
// shaders read the vertices from buffers.
struct GraphicsDesc {
  const char* name;
  const Shader* vertex;
  const Shader* fragment = nullptr;  // none: depth only
  VkFormat color_format = VK_FORMAT_UNDEFINED;
  std::uint32_t color_count = 1;  // attachments of that format, kMaxColors at most
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  VkCompareOp depth_compare = VK_COMPARE_OP_GREATER;
  bool depth_write = true;
  VkCullModeFlags cull = VK_CULL_MODE_NONE;
  Blend blend = Blend::none;
};
Result<Pipeline> create_graphics_pipeline(const Device& device, const GraphicsDesc& desc,
                                          std::span<const Constant> constants = {});

// Records a dispatch of enough workgroups for x × y × z invocations.
void dispatch(const Device& device, VkCommandBuffer cmd, const Pipeline& pipeline, std::uint32_t x, std::uint32_t y = 1,
              std::uint32_t z = 1);

}  // namespace tyndall::gpu
