#include "gpu/pipeline.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "gpu/try.hpp"

namespace tyndall::gpu {
namespace {

// Adds the bindings of a stage to those of the pipeline. A binding number must have the same name in all stages.
Result<void> add_bindings(Pipeline& pipeline, const Shader& shader,
                          std::array<VkShaderStageFlags, kMaxBindings>& stages) {
  for (const Binding& binding : shader.bindings) {
    std::uint32_t i = 0;
    while (i < pipeline.binding_count && pipeline.bindings[i].binding != binding.binding) ++i;
    if (i == kMaxBindings) {
      return Error{ErrorCode::unsupported_device,
                   "more than " + std::to_string(kMaxBindings) + " bindings in " + shader.name};
    }
    if (i == pipeline.binding_count) {
      pipeline.bindings[i] = binding;
      ++pipeline.binding_count;
    } else if (pipeline.bindings[i].name != binding.name) {
      return Error{ErrorCode::invalid_argument,
                   std::string("two names for binding ") + std::to_string(binding.binding) + " in " + pipeline.name};
    }
    stages[i] |= static_cast<VkShaderStageFlags>(shader.stage);
  }
  if (shader.push_constant_bytes > 0) {
    pipeline.push_stages |= static_cast<VkShaderStageFlags>(shader.stage);
    pipeline.push_bytes = std::max(pipeline.push_bytes, shader.push_constant_bytes);
  }
  return {};
}

Result<void> create_layouts(const Device& device, Pipeline& pipeline,
                            const std::array<VkShaderStageFlags, kMaxBindings>& stages) {
  std::array<VkDescriptorSetLayoutBinding, kMaxBindings> bindings = {};
  for (std::uint32_t i = 0; i < pipeline.binding_count; ++i) {
    bindings[i].binding = pipeline.bindings[i].binding;
    bindings[i].descriptorType = pipeline.bindings[i].type;
    bindings[i].descriptorCount = 1;
    bindings[i].stageFlags = stages[i];
  }
  VkDescriptorSetLayoutCreateInfo set_info = {};
  set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  set_info.bindingCount = pipeline.binding_count;
  set_info.pBindings = bindings.data();
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkResult result = device.vk.CreateDescriptorSetLayout(device.device, &set_info, device.allocator, &set_layout);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating the descriptor layout", pipeline.name);
  pipeline.set_layout = Handle<VkDescriptorSetLayout>(device, set_layout);

  const VkPushConstantRange range = {pipeline.push_stages, 0, pipeline.push_bytes};
  VkPipelineLayoutCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = 1;
  info.pSetLayouts = &set_layout;
  info.pushConstantRangeCount = pipeline.push_bytes > 0 ? 1 : 0;
  info.pPushConstantRanges = &range;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  result = device.vk.CreatePipelineLayout(device.device, &info, device.allocator, &layout);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating the pipeline layout", pipeline.name);
  pipeline.layout = Handle<VkPipelineLayout>(device, layout);
  return {};
}

Result<Handle<VkShaderModule>> create_module(const Device& device, const Shader& shader,
                                             const std::optional<StorageFormat>& output = {}) {
  std::span<const std::uint32_t> spirv = shader.spirv;
  if (device.replace_shader != nullptr) {
    const std::span<const std::uint32_t> other = device.replace_shader(device.replace_shader_user, shader.name);
    if (!other.empty()) spirv = other;
  }
  std::vector<std::uint32_t> changed;
  if (output) {
    changed.assign(spirv.begin(), spirv.end());
    if (!set_storage_format(changed, *output)) {
      return Error{ErrorCode::invalid_argument, std::string("the shader ") + shader.name + " has no image at binding " +
                                                    std::to_string(output->binding) + "; expected its output"};
    }
    spirv = changed;
  }
  VkShaderModuleCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = spirv.size_bytes();
  info.pCode = spirv.data();
  VkShaderModule module = VK_NULL_HANDLE;
  const VkResult result = device.vk.CreateShaderModule(device.device, &info, device.allocator, &module);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating the shader", shader.name);
  return Handle<VkShaderModule>(device, module);
}

// Owns the arrays that VkSpecializationInfo points into.
struct Specialization {
  std::vector<VkSpecializationMapEntry> entries;
  VkSpecializationInfo info = {};

  explicit Specialization(std::span<const Constant> constants) {
    for (std::size_t i = 0; i < constants.size(); ++i) {
      entries.push_back({constants[i].id, static_cast<std::uint32_t>(i * sizeof(Constant) + offsetof(Constant, value)),
                         sizeof(std::uint32_t)});
    }
    info.mapEntryCount = static_cast<std::uint32_t>(entries.size());
    info.pMapEntries = entries.data();
    info.dataSize = constants.size_bytes();
    info.pData = constants.data();
  }
};

VkPipelineShaderStageCreateInfo stage_info(const Shader& shader, VkShaderModule module,
                                           const Specialization& specialization) {
  VkPipelineShaderStageCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage = shader.stage;
  info.module = module;
  info.pName = "main";
  info.pSpecializationInfo = &specialization.info;
  return info;
}

}  // namespace

Result<void> check_shader(const Device& device, const Shader& shader) {
  const VkPhysicalDeviceLimits& limits = device.properties.limits;
  const auto exceeds = [&](const char* what, std::uint64_t needed, std::uint64_t allowed) -> Result<void> {
    if (needed <= allowed) return {};
    return Error{ErrorCode::unsupported_device,
                 std::string("the shader ") + shader.name + " needs " + std::to_string(needed) + " " + what +
                     "; expected at most the limit of the device, " + std::to_string(allowed)};
  };
  const auto count = [&](std::initializer_list<VkDescriptorType> types) {
    return static_cast<std::uint32_t>(
        std::count_if(shader.bindings.begin(), shader.bindings.end(),
                      [&](const Binding& b) { return std::find(types.begin(), types.end(), b.type) != types.end(); }));
  };
  TYNDALL_TRY(exceeds("storage buffers", count({VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}),
                      limits.maxPerStageDescriptorStorageBuffers));
  TYNDALL_TRY(exceeds("uniform buffers", count({VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}),
                      limits.maxPerStageDescriptorUniformBuffers));
  TYNDALL_TRY(
      exceeds("storage images", count({VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}), limits.maxPerStageDescriptorStorageImages));
  TYNDALL_TRY(exceeds("sampled images",
                      count({VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE}),
                      limits.maxPerStageDescriptorSampledImages));
  TYNDALL_TRY(exceeds("samplers", count({VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_SAMPLER}),
                      limits.maxPerStageDescriptorSamplers));
  TYNDALL_TRY(exceeds("resources", shader.bindings.size(), limits.maxPerStageResources));
  TYNDALL_TRY(exceeds("bytes of push constants", shader.push_constant_bytes, limits.maxPushConstantsSize));
  if (shader.stage != VK_SHADER_STAGE_COMPUTE_BIT) return {};
  std::uint64_t invocations = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    TYNDALL_TRY(
        exceeds("invocations in a direction of a group", shader.local_size[i], limits.maxComputeWorkGroupSize[i]));
    invocations *= shader.local_size[i];
  }
  return exceeds("invocations in a group", invocations, limits.maxComputeWorkGroupInvocations);
}

Result<Pipeline> create_compute_pipeline(const Device& device, const Shader& shader,
                                         std::span<const Constant> constants,
                                         const std::optional<StorageFormat>& output) {
  Pipeline out;
  out.name = shader.name;
  std::copy(std::begin(shader.local_size), std::end(shader.local_size), out.local_size);
  std::array<VkShaderStageFlags, kMaxBindings> stages = {};
  TYNDALL_TRY(add_bindings(out, shader, stages));
  TYNDALL_TRY(create_layouts(device, out, stages));
  TYNDALL_ASSIGN(Handle<VkShaderModule> module, create_module(device, shader, output));
  const Specialization specialization(constants);
  VkComputePipelineCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage = stage_info(shader, module.get(), specialization);
  info.layout = out.layout.get();
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result =
      device.vk.CreateComputePipelines(device.device, device.pipeline_cache, 1, &info, device.allocator, &pipeline);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating the pipeline", shader.name);
  out.pipeline = Handle<VkPipeline>(device, pipeline);
  set_name(device, VK_OBJECT_TYPE_PIPELINE, pipeline, shader.name);
  return out;
}

namespace {

VkPipelineRasterizationStateCreateInfo rasterization(const GraphicsDesc& desc) {
  VkPipelineRasterizationStateCreateInfo raster = {};
  raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
  raster.cullMode = desc.cull;
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  raster.lineWidth = 1.0F;
  return raster;
}

VkPipelineDepthStencilStateCreateInfo depth_test(const GraphicsDesc& desc) {
  VkPipelineDepthStencilStateCreateInfo depth = {};
  depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
  depth.depthTestEnable = desc.depth_format != VK_FORMAT_UNDEFINED ? VK_TRUE : VK_FALSE;
  depth.depthWriteEnable = desc.depth_write ? VK_TRUE : VK_FALSE;
  depth.depthCompareOp = desc.depth_compare;
  return depth;
}

VkPipelineColorBlendAttachmentState blending(Blend blend) {
  VkPipelineColorBlendAttachmentState attachment = {};
  attachment.colorWriteMask = 0xF;
  if (blend == Blend::none) return attachment;
  const bool add = blend == Blend::add;
  attachment.blendEnable = VK_TRUE;
  attachment.srcColorBlendFactor = add ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_ZERO;
  attachment.dstColorBlendFactor = add ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_SRC_COLOR;
  attachment.colorBlendOp = VK_BLEND_OP_ADD;
  // VK_BLEND_OP_MIN ignores the factors. With the other operations they leave alpha unchanged.
  attachment.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
  attachment.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  attachment.alphaBlendOp = blend == Blend::multiply_min ? VK_BLEND_OP_MIN : VK_BLEND_OP_ADD;
  return attachment;
}

}  // namespace

Result<Pipeline> create_graphics_pipeline(const Device& device, const GraphicsDesc& desc,
                                          std::span<const Constant> constants) {
  Pipeline out;
  out.name = desc.name;
  out.bind_point = VK_PIPELINE_BIND_POINT_GRAPHICS;
  std::array<VkShaderStageFlags, kMaxBindings> stages = {};
  TYNDALL_TRY(add_bindings(out, *desc.vertex, stages));
  if (desc.fragment != nullptr) TYNDALL_TRY(add_bindings(out, *desc.fragment, stages));
  TYNDALL_TRY(create_layouts(device, out, stages));
  const Specialization specialization(constants);
  TYNDALL_ASSIGN(Handle<VkShaderModule> vertex, create_module(device, *desc.vertex));
  Handle<VkShaderModule> fragment;
  VkPipelineShaderStageCreateInfo stage[2] = {stage_info(*desc.vertex, vertex.get(), specialization), {}};
  if (desc.fragment != nullptr) {
    TYNDALL_ASSIGN(fragment, create_module(device, *desc.fragment));
    stage[1] = stage_info(*desc.fragment, fragment.get(), specialization);
  }
  VkPipelineVertexInputStateCreateInfo vertex_input = {};
  vertex_input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
  VkPipelineInputAssemblyStateCreateInfo assembly = {};
  assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport = {};
  viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
  viewport.viewportCount = viewport.scissorCount = 1;
  const VkPipelineRasterizationStateCreateInfo raster = rasterization(desc);
  VkPipelineMultisampleStateCreateInfo multisample = {};
  multisample.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
  multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  const VkPipelineDepthStencilStateCreateInfo depth = depth_test(desc);
  VkPipelineColorBlendStateCreateInfo blend = {};
  blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
  const bool color = desc.color_format != VK_FORMAT_UNDEFINED;
  const std::uint32_t colors = color ? desc.color_count : 0;
  std::array<VkPipelineColorBlendAttachmentState, kMaxColors> attachments;
  std::array<VkFormat, kMaxColors> formats;
  attachments.fill(blending(desc.blend));
  formats.fill(desc.color_format);
  blend.attachmentCount = colors;
  blend.pAttachments = attachments.data();
  const VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic = {};
  dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
  dynamic.dynamicStateCount = 2;
  dynamic.pDynamicStates = dynamic_states;
  VkPipelineRenderingCreateInfo rendering = {};
  rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
  rendering.colorAttachmentCount = colors;
  rendering.pColorAttachmentFormats = formats.data();
  rendering.depthAttachmentFormat = desc.depth_format;
  VkGraphicsPipelineCreateInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.pNext = &rendering;
  info.stageCount = desc.fragment != nullptr ? 2 : 1;
  info.pStages = stage;
  info.pVertexInputState = &vertex_input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &multisample;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = out.layout.get();
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result =
      device.vk.CreateGraphicsPipelines(device.device, device.pipeline_cache, 1, &info, device.allocator, &pipeline);
  if (result != VK_SUCCESS) return vulkan_error(result, "creating the pipeline", desc.name);
  out.pipeline = Handle<VkPipeline>(device, pipeline);
  set_name(device, VK_OBJECT_TYPE_PIPELINE, pipeline, desc.name);
  return out;
}

void dispatch(const Device& device, VkCommandBuffer cmd, const Pipeline& pipeline, std::uint32_t x, std::uint32_t y,
              std::uint32_t z) {
  const auto groups = [](std::uint32_t n, std::uint32_t local) { return (n + local - 1) / local; };
  device.vk.CmdDispatch(cmd, groups(x, pipeline.local_size[0]), groups(y, pipeline.local_size[1]),
                        groups(z, pipeline.local_size[2]));
}

}  // namespace tyndall::gpu
