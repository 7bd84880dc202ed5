// Textures of meshes on the GPU, with mip levels. Colours are averaged in linear space and weighted by alpha, so that
// the colours of transparent texels do not bleed into their surroundings.
#pragma once

#include "gpu/host.hpp"
#include "scene/mesh/mesh_data.hpp"

namespace tyndall::scene {

// Returns the levels of a texture after the first, each half as large as the one before, down to one texel.
[[nodiscard]] std::vector<MeshTexture> mip_levels(const MeshTexture& texture);
// Creates an sRGB image with all levels, in the layout SHADER_READ_ONLY_OPTIMAL.
Result<gpu::Image> upload_texture(gpu::Host& host, const MeshTexture& texture);
Result<gpu::Handle<VkSampler>> create_texture_sampler(const gpu::Device& device, const MeshSampler& sampler);

}  // namespace tyndall::scene
