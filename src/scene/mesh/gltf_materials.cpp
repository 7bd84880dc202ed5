// Materials, and their pictures through stb_image, which is kept to this file. Pictures are decoded here: tinygltf passes on
// any range of a buffer that a file names.
#include "scene/mesh/gltf_reader.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_MAX_DIMENSIONS 8192
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <limits>
#include <memory>

#include "config/text.hpp"

namespace tyndall::scene {

void GltfReader::read_materials() {
  for (std::size_t i = 0; i < model_.materials.size(); ++i) out_.materials.push_back(material(i));
  out_.materials.emplace_back();  // of parts that name none
}

MeshMaterial GltfReader::material(std::size_t index) {
  const tinygltf::Material& in = model_.materials[index];
  MeshMaterial out;
  out.name = in.name;
  const std::vector<double>& factor = in.pbrMetallicRoughness.baseColorFactor;
  for (int c = 0; c < 4 && c < static_cast<int>(factor.size()); ++c) {
    out.color[c] = static_cast<float>(bounded(factor[static_cast<std::size_t>(c)], index, "baseColorFactor"));
  }
  out.roughness = static_cast<float>(bounded(in.pbrMetallicRoughness.roughnessFactor, index, "roughnessFactor"));
  if (!(in.alphaCutoff >= 0.0)) fail("has " + at("materials", index) + ".alphaCutoff out of range", "allowed is 0 and more");
  out.alpha_cutoff = static_cast<float>(std::min(in.alphaCutoff, 2.0));  // above 1 nothing is left of the surface
  out.double_sided = in.doubleSided;
  if (in.alphaMode == "MASK") {
    out.kind = SurfaceKind::mask;
  } else if (in.alphaMode == "BLEND") {
    out.kind = SurfaceKind::blend;
  } else if (in.alphaMode != "OPAQUE") {
    fail("has " + at("materials", index) + ".alphaMode '" + config::one_line(in.alphaMode, 40) + "'", "allowed are OPAQUE, MASK and BLEND");
  }
  const auto extension = in.extensions.find("KHR_materials_transmission");
  if (extension != in.extensions.end() && extension->second.IsObject()) {
    const tinygltf::Value& value = extension->second.Get("transmissionFactor");
    if (value.IsNumber()) out.transmission = static_cast<float>(bounded(value.GetNumberAsDouble(), index, "transmissionFactor"));
    if (out.transmission > 0.0F) out.kind = SurfaceKind::glass;
  }
  if (in.pbrMetallicRoughness.baseColorTexture.index >= 0) {
    out.texture = texture(static_cast<std::size_t>(in.pbrMetallicRoughness.baseColorTexture.index), index);
  }
  return out;
}

double GltfReader::bounded(double value, std::size_t index, const char* name) {
  if (!(value >= 0.0 && value <= 1.0)) fail("has " + at("materials", index) + "." + name + " out of range", "allowed is 0 to 1");
  return value;
}

// The picture of a texture, decoded once.
int GltfReader::texture(std::size_t index, std::size_t material) {
  if (index >= model_.textures.size()) fail("has " + at("materials", material) + " with a texture that is not there", range(model_.textures.size()));
  const int source = model_.textures[index].source;
  if (source < 0 || static_cast<std::size_t>(source) >= model_.images.size()) {
    fail("has " + at("textures", index) + " with an image that is not there", range(model_.images.size()));
  }
  const auto known = decoded_.find(source);
  if (known != decoded_.end()) return known->second;
  const tinygltf::Image& image = model_.images[static_cast<std::size_t>(source)];
  std::span<const unsigned char> bytes(image.image);
  if (image.bufferView >= 0) bytes = view_bytes(static_cast<std::size_t>(image.bufferView));
  const std::string name = at("images", static_cast<std::size_t>(source)) +
                           (image.uri.empty() ? "" : " '" + config::one_line(image.uri, 200) + "'");
  if (bytes.empty()) fail("has " + name + ", which cannot be read", "allowed is a PNG or JPEG picture beside it or in it");
  int width = 0, height = 0, channels = 0;
  const int size = static_cast<int>(std::min<std::size_t>(bytes.size(), std::numeric_limits<int>::max()));
  if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) {
    fail("has " + name + ", which is no picture", "allowed are PNG and JPEG of up to " + std::to_string(kMaxTextureSide) + " texels on a side");
  }
  if (width <= 0 || height <= 0 || width > static_cast<int>(kMaxTextureSide) || height > static_cast<int>(kMaxTextureSide)) {
    fail("has " + name + " of " + std::to_string(width) + "x" + std::to_string(height), "allowed are up to " + std::to_string(kMaxTextureSide) + " texels on a side");
  }
  texture_bytes_ += 4ULL * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (texture_bytes_ > kMaxTextureBytes) fail("has more texels than there is room for", "allowed are textures of up to 1 GiB together");
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), stbi_image_free);
  if (pixels == nullptr) fail("has " + name + ", which is damaged", "allowed is a whole PNG or JPEG picture");
  MeshTexture out;
  out.width = static_cast<std::uint32_t>(width);
  out.height = static_cast<std::uint32_t>(height);
  out.rgba.assign(pixels.get(), pixels.get() + 4ULL * out.width * out.height);
  out_.textures.push_back(std::move(out));
  return decoded_[source] = static_cast<int>(out_.textures.size()) - 1;
}

}  // namespace tyndall::scene
