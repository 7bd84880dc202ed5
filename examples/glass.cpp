// Draws a transparent surface with the haze and the shadows in front of it, from the froxel volume:
//   * the parameter froxels.enabled makes Effect::record fill the volume,
//   * a uniform block and the images of atmosphere_images() are bound to the engine's own shader (glass.comp),
//   * the engine's pass waits for the effect and looks up the volume with tyndall_froxel().
// The sun lights the first 500 m; a cascade beyond them is in shadow. The program draws a pane of glass 1.5 km away
// twice: as an opaque surface in the depth buffer, and as a transparent one whose opacity is 1. It prints by how much
// the pictures differ, and writes a third one, with an opacity of 0.6, to a file if its argument names one.
#include <tyndall/atmosphere.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "vulkan_host.hpp"

namespace {

using namespace host;

constexpr VkExtent2D kExtent = {64, 36};
constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;
constexpr std::uint32_t kShader[] = {
#include "glass_comp.inc"
};
constexpr std::uint32_t kImages = 7;  // bindings of images: the picture, and six of the effect
constexpr float kPaneDepth_m = 1500.0F;
constexpr float kNear_m = 0.1F;

// The push constants of glass.comp.
struct Pane {
  float radiance[3] = {0.02F, 0.06F, 0.03F};
  float opacity = 1.0F;
  float tan_half[2] = {1.0F, 9.0F / 16.0F};
  float depth_m = kPaneDepth_m;
};

tyndall::Effect create_effect(const Device& device) {
  tyndall::EffectDesc desc;
  desc.max_extent = kExtent;
  desc.frames_in_flight = 1;
  desc.output_format = tyndall::OutputFormat::rgba32f;
  tyndall::Params params;
  params.froxels.enabled = true;
  return value_or_exit(tyndall::Effect::create(device_info(device), desc, params));
}

// The pass that draws transparent surfaces, and what it binds.
struct GlassPass {
  Buffer constants;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
};

void create_pipeline(const Device& device, GlassPass& out) {
  std::array<VkDescriptorSetLayoutBinding, kImages + 1> bindings = {};
  for (std::uint32_t i = 0; i < bindings.size(); ++i) {
    const VkDescriptorType type = i == 0   ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                  : i == 1 ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                                           : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    bindings[i] = {i, type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  }
  VkDescriptorSetLayoutCreateInfo set_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set_info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  set_info.pBindings = bindings.data();
  need(vkCreateDescriptorSetLayout(device.device, &set_info, nullptr, &out.set_layout) == VK_SUCCESS, 50);
  const VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Pane)};
  VkPipelineLayoutCreateInfo layout_info = {VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout_info.setLayoutCount = layout_info.pushConstantRangeCount = 1;
  layout_info.pSetLayouts = &out.set_layout;
  layout_info.pPushConstantRanges = &push;
  need(vkCreatePipelineLayout(device.device, &layout_info, nullptr, &out.layout) == VK_SUCCESS, 51);
  VkShaderModuleCreateInfo code = {VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  code.codeSize = sizeof kShader;
  code.pCode = kShader;
  VkComputePipelineCreateInfo info = {VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.layout = out.layout;
  info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.pName = "main";
  need(vkCreateShaderModule(device.device, &code, nullptr, &info.stage.module) == VK_SUCCESS, 52);
  need(vkCreateComputePipelines(device.device, VK_NULL_HANDLE, 1, &info, nullptr, &out.pipeline) == VK_SUCCESS, 53);
  vkDestroyShaderModule(device.device, info.stage.module, nullptr);
}

// Writes the descriptor set: the picture, the uniform block, and the images of the effect, which include a sampler.
void bind_inputs(const Device& device, GlassPass& out, const Images& images, const tyndall::Effect& effect) {
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1},
                                        {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1},
                                        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, kImages - 1}};
  VkDescriptorPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool_info.maxSets = 1;
  pool_info.poolSizeCount = 3;
  pool_info.pPoolSizes = sizes;
  need(vkCreateDescriptorPool(device.device, &pool_info, nullptr, &out.pool) == VK_SUCCESS, 54);
  VkDescriptorSetAllocateInfo set_info = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  set_info.descriptorPool = out.pool;
  set_info.descriptorSetCount = 1;
  set_info.pSetLayouts = &out.set_layout;
  need(vkAllocateDescriptorSets(device.device, &set_info, &out.set) == VK_SUCCESS, 55);
  const tyndall::AtmosphereImages air = tyndall::atmosphere_images(effect);
  need(air.count == kImages - 1, 56);
  const VkDescriptorImageInfo picture = {VK_NULL_HANDLE, images.output.view, kGeneral};
  const VkDescriptorBufferInfo block = {out.constants.buffer, 0, VK_WHOLE_SIZE};
  std::array<VkWriteDescriptorSet, kImages + 1> writes = {};
  for (std::uint32_t i = 0; i < writes.size(); ++i) {
    writes[i] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    writes[i].dstSet = out.set;
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    if (i > 1) writes[i].pImageInfo = &air.list[i - 2];
  }
  writes[0].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  writes[0].pImageInfo = &picture;
  writes[1].descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  writes[1].pBufferInfo = &block;
  vkUpdateDescriptorSets(device.device, static_cast<std::uint32_t>(writes.size()), writes.data(), 0, nullptr);
}

GlassPass create_glass_pass(const Device& device, const Images& images, const tyndall::Effect& effect,
                            const tyndall::Sun& sun) {
  GlassPass out;
  tyndall::AtmosphereInputs inputs;
  inputs.sun = sun;
  const tyndall::AtmosphereConstants block = value_or_exit(tyndall::atmosphere_constants(effect.params(), inputs));
  out.constants = create_buffer(device, sizeof block.bytes, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  void* data = nullptr;
  need(vkMapMemory(device.device, out.constants.memory, 0, VK_WHOLE_SIZE, 0, &data) == VK_SUCCESS, 57);
  std::memcpy(data, block.bytes.data(), sizeof block.bytes);
  vkUnmapMemory(device.device, out.constants.memory);
  create_pipeline(device, out);
  bind_inputs(device, out, images, effect);
  return out;
}

// The sun and two cascades, whose maps cover 200 km: the first is lit, the second is in shadow.
tyndall::Sun sun() {
  tyndall::Sun out;
  out.direction_to_sun = {0.0F, 0.6F, -0.8F};
  out.irradiance = tyndall::Vec3(1.0F);
  return out;
}
constexpr float kPerMetre = 1.0F / 200000.0F;
constexpr tyndall::Mat4 kShadowFromWorld = {{kPerMetre, 0, 0, 0, 0, 0.8F * kPerMetre, -0.6F * kPerMetre, 0, 0,
                                             0.6F * kPerMetre, 0.8F * kPerMetre, 0, 0.5F, 0.5F, 0.5F, 1}};
constexpr tyndall::Cascade kCascades[] = {{kShadowFromWorld, 0.0F, 500.0F}, {kShadowFromWorld, 500.0F, 20000.0F}};

// Clears an image to a value, or a layer of it.
void clear_depth(VkCommandBuffer cmd, const Image& image, float depth, std::uint32_t layer) {
  const VkClearDepthStencilValue value = {depth, 0};
  const VkImageSubresourceRange range = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, layer, 1};
  vkCmdClearDepthStencilImage(cmd, image.image, kGeneral, &value, 1, &range);
}

// A frame with the pane in the depth buffer, or drawn after the effect.
void record_frame(VkCommandBuffer cmd, const Images& images, const Image& shadows, tyndall::Effect& effect,
                  const GlassPass& glass, std::uint64_t frame, const Pane* transparent) {
  const Pane pane;
  VkClearColorValue color = {};
  if (transparent == nullptr) std::copy(std::begin(pane.radiance), std::end(pane.radiance), color.float32);
  const VkImageSubresourceRange color_range = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  for (const Image& image : {images.color, images.depth, images.output, shadows})
    wait_and_move(cmd, image, VK_IMAGE_LAYOUT_UNDEFINED, kGeneral);
  vkCmdClearColorImage(cmd, images.color.image, kGeneral, &color, 1, &color_range);
  clear_depth(cmd, images.depth, transparent == nullptr ? kNear_m / kPaneDepth_m : 0.0F, 0);
  clear_depth(cmd, shadows, 1.0F, 0);
  clear_depth(cmd, shadows, 0.0F, 1);
  for (const Image& image : {images.color, images.depth, shadows}) wait_and_move(cmd, image, kGeneral, kGeneral);
  tyndall::FrameInputs inputs;
  inputs.frame_index = frame;
  inputs.extent = kExtent;
  inputs.color = {images.color.view, kGeneral};
  inputs.depth = {images.depth.view, kGeneral};
  inputs.output = {images.output.view, kGeneral};
  inputs.shadow_maps = {shadows.view, kGeneral};
  inputs.shadow_resolution = 4;
  inputs.cascades = kCascades;
  inputs.camera.world_from_view.m[13] = 1000.0F;  // at an altitude of 1 km, looking north
  inputs.camera.clip_from_view = {{1.0F, 0, 0, 0, 0, -16.0F / 9.0F, 0, 0, 0, 0, 0, -1, 0, 0, kNear_m, 0}};
  inputs.sun = sun();
  if (const tyndall::Result<void> recorded = effect.record(cmd, inputs); !recorded.ok()) fail(recorded.error());
  if (transparent != nullptr) {
    wait_and_move(cmd, images.output, kGeneral, kGeneral);  // waits for the froxel volume, too
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, glass.pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, glass.layout, 0, 1, &glass.set, 0, nullptr);
    vkCmdPushConstants(cmd, glass.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Pane), transparent);
    vkCmdDispatch(cmd, (kExtent.width + 7) / 8, (kExtent.height + 7) / 8, 1);
  }
  wait_and_move(cmd, images.output, kGeneral, kGeneral);
  VkBufferImageCopy copy = {};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {kExtent.width, kExtent.height, 1};
  vkCmdCopyImageToBuffer(cmd, images.output.image, kGeneral, images.readback.buffer, 1, &copy);
}

// Records commands, submits them and waits for them.
template <typename Record>
void run(const Device& device, const Record& record) {
  VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  vkResetCommandPool(device.device, device.pool, 0);
  vkBeginCommandBuffer(device.cmd, &begin);
  record(device.cmd);
  vkEndCommandBuffer(device.cmd);
  submit_and_wait(device);
}

std::vector<float> pixels_of(const Device& device, const Images& images) {
  std::vector<float> out(std::size_t{4} * kExtent.width * kExtent.height);
  void* data = nullptr;
  need(vkMapMemory(device.device, images.readback.memory, 0, VK_WHOLE_SIZE, 0, &data) == VK_SUCCESS, 32);
  std::memcpy(out.data(), data, out.size() * sizeof(float));
  vkUnmapMemory(device.device, images.readback.memory);
  return out;
}

void destroy(const Device& device, const GlassPass& glass, const Image& shadows) {
  vkDestroyPipeline(device.device, glass.pipeline, nullptr);
  vkDestroyPipelineLayout(device.device, glass.layout, nullptr);
  vkDestroyDescriptorPool(device.device, glass.pool, nullptr);
  vkDestroyDescriptorSetLayout(device.device, glass.set_layout, nullptr);
  vkDestroyBuffer(device.device, glass.constants.buffer, nullptr);
  vkFreeMemory(device.device, glass.constants.memory, nullptr);
  vkDestroyImageView(device.device, shadows.view, nullptr);
  vkDestroyImage(device.device, shadows.image, nullptr);
  vkFreeMemory(device.device, shadows.memory, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  const Device device = create_device();
  const Images images = create_images(device, kExtent);
  const Image shadows =
      create_image(device, {4, 4}, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                   VK_IMAGE_ASPECT_DEPTH_BIT, 2);
  GlassPass glass;
  std::vector<float> opaque, transparent, pane;
  {
    tyndall::Effect effect = create_effect(device);
    glass = create_glass_pass(device, images, effect, sun());
    std::uint64_t frame = 0;
    const auto draw = [&](const Pane* how) {
      run(device, [&](VkCommandBuffer cmd) {
        value_or_exit(effect.record_precompute(cmd));
        record_frame(cmd, images, shadows, effect, glass, frame++, how);
      });
      return pixels_of(device, images);
    };
    const Pane full;
    Pane partial;
    partial.opacity = 0.6F;
    opaque = draw(nullptr);
    transparent = draw(&full);
    pane = draw(&partial);
  }  // destroys the effect before the device
  float difference = 0.0F;
  for (std::size_t i = 0; i < opaque.size(); ++i) {
    if (i % 4 != 3) difference = std::max(difference, std::abs(transparent[i] / opaque[i] - 1.0F));
  }
  std::printf("the pane from the froxel volume differs from the opaque one by at most %.2g\n",
              static_cast<double>(difference));
  if (argc > 1) {
    std::FILE* file = std::fopen(argv[1], "wb");
    need(file != nullptr && std::fwrite(pane.data(), 4, pane.size(), file) == pane.size() && std::fclose(file) == 0,
         33);
  }
  destroy(device, glass, shadows);
  destroy(device, images);
  return difference < 0.01F ? 0 : 40;
}
