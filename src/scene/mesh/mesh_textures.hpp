// Textures of meshes on the GPU, with mip levels: colours are averaged as light, not as sRGB, and by their alpha, so
// that what is in a hole does not bleed out of it.
#pragma once

#include "gpu/host.hpp"
#include "scene/mesh/mesh_data.hpp"

namespace tyndall::scene {

// The levels of a texture below the first, each half as large, down to one texel.
[[nodiscard]] std::vector<MeshTexture> mip_levels(const MeshTexture& texture);
// An sRGB image with all levels, in SHADER_READ_ONLY_OPTIMAL.
Result<gpu::Image> upload_texture(gpu::Host& host, const MeshTexture& texture);
Result<gpu::Handle<VkSampler>> create_texture_sampler(const gpu::Device& device, const MeshSampler& sampler);

}  // namespace tyndall::scene
