#include "scene/mesh/mesh_textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "gpu/try.hpp"

namespace tyndall::scene {
namespace {

std::array<float, 256> linear_of_srgb() {
  std::array<float, 256> out = {};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float x = static_cast<float>(i) / 255.0F;
    out[i] = x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F);
  }
  return out;
}

std::uint8_t srgb_of_linear(float x) {
  const float encoded = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(encoded, 0.0F, 1.0F)));
}

// Returns a texture of half the size. If a side is odd, the last three rows or columns are averaged.
MeshTexture half_of(const MeshTexture& in) {
  static const std::array<float, 256> kLinear = linear_of_srgb();
  MeshTexture out;
  out.width = std::max(in.width / 2, 1U);
  out.height = std::max(in.height / 2, 1U);
  out.rgba.resize(std::size_t{4} * out.width * out.height);
  for (std::uint32_t y = 0; y < out.height; ++y) {
    const std::uint32_t y_end = y + 1 == out.height ? in.height : 2 * y + 2;
    for (std::uint32_t x = 0; x < out.width; ++x) {
      const std::uint32_t x_end = x + 1 == out.width ? in.width : 2 * x + 2;
      float weighted[3] = {}, plain[3] = {}, alpha = 0.0F, count = 0.0F;
      for (std::uint32_t v = std::min(2 * y, in.height - 1); v < y_end; ++v) {
        for (std::uint32_t u = std::min(2 * x, in.width - 1); u < x_end; ++u) {
          const std::uint8_t* const p = &in.rgba[std::size_t{4} * (std::size_t{v} * in.width + u)];
          const float a = static_cast<float>(p[3]) / 255.0F;
          for (int c = 0; c < 3; ++c) {
            plain[c] += kLinear[p[c]];
            weighted[c] += a * kLinear[p[c]];
          }
          alpha += a;
          count += 1.0F;
        }
      }
      std::uint8_t* const to = &out.rgba[std::size_t{4} * (std::size_t{y} * out.width + x)];
      for (int c = 0; c < 3; ++c) to[c] = srgb_of_linear(alpha > 0.0F ? weighted[c] / alpha : plain[c] / count);
      to[3] = static_cast<std::uint8_t>(std::lround(255.0F * alpha / count));
    }
  }
  return out;
}

VkSamplerAddressMode address_mode(TextureWrap wrap) {
  switch (wrap) {
    case TextureWrap::repeat: return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    case TextureWrap::mirrored_repeat: return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    case TextureWrap::clamp_to_edge: break;
  }
  return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
}

}  // namespace

Result<gpu::Handle<VkSampler>> create_texture_sampler(const gpu::Device& device, const MeshSampler& sampler) {
  gpu::SamplerDesc desc;
  desc.filter = sampler.mag_linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  desc.min_filter = sampler.min_linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  desc.address = address_mode(sampler.wrap_u);
  desc.address_v = address_mode(sampler.wrap_v);
  desc.between_levels = sampler.mip == MipFilter::linear;
  desc.first_level_only = sampler.mip == MipFilter::none;
  return gpu::create_sampler(device, desc);
}

std::vector<MeshTexture> mip_levels(const MeshTexture& texture) {
  std::vector<MeshTexture> out;
  const MeshTexture* last = &texture;
  while (last->width > 1 || last->height > 1) {
    out.push_back(half_of(*last));
    last = &out.back();
  }
  return out;
}

Result<gpu::Image> upload_texture(gpu::Host& host, const MeshTexture& texture) {
  const gpu::Device& device = host.device();
  const std::vector<MeshTexture> smaller = mip_levels(texture);
  const auto levels = static_cast<std::uint32_t>(smaller.size()) + 1;
  gpu::ImageDesc desc = {"mesh_texture",
                         VK_FORMAT_R8G8B8A8_SRGB,
                         {texture.width, texture.height, 1},
                         VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
  desc.levels = levels;
  TYNDALL_ASSIGN(gpu::Image image, gpu::create_image(device, desc));
  std::vector<VkBufferImageCopy> copies;
  VkDeviceSize size = 0;
  const auto level = [&](std::uint32_t i) -> const MeshTexture& { return i == 0 ? texture : smaller[i - 1]; };
  for (std::uint32_t i = 0; i < levels; ++i) {
    VkBufferImageCopy copy = {};
    copy.bufferOffset = size;
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, i, 0, 1};
    copy.imageExtent = {level(i).width, level(i).height, 1};
    copies.push_back(copy);
    size += level(i).rgba.size();
  }
  TYNDALL_ASSIGN(
      const gpu::Buffer staging,
      gpu::create_buffer(device, "staging", size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::MemoryKind::upload));
  for (std::uint32_t i = 0; i < levels; ++i) {
    std::memcpy(static_cast<std::byte*>(staging.mapped) + copies[i].bufferOffset, level(i).rgba.data(),
                level(i).rgba.size());
  }
  TYNDALL_TRY(host.run([&](VkCommandBuffer cmd) -> Result<void> {
    gpu::transition(device, cmd, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    device.vk.CmdCopyBufferToImage(cmd, staging.buffer.get(), image.image.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                   levels, copies.data());
    gpu::transition(device, cmd, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    return {};
  }));
  return image;
}

}  // namespace tyndall::scene
