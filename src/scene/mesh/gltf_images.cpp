// Decodes pictures with stb_image, which only this file uses.
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
#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>

#include "files/text.hpp"
#include "scene/mesh/gltf_reader.hpp"

namespace tyndall::scene {
namespace {

constexpr std::string_view kPngSignature("\x89PNG\r\n\x1a\n", 8);

std::uint32_t big_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (std::size_t i = 0; i < 4; ++i) out = out << 8U | static_cast<std::uint8_t>(bytes[at + i]);
  return out;
}

// Returns whether the compressed parts of a PNG inflate without an error to between `low` and `high` bytes. The data is
// not stored.
bool inflates(const std::vector<std::string_view>& parts, std::uint64_t low, std::uint64_t high) {
  z_stream stream = {};
  if (inflateInit(&stream) != Z_OK) return false;
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
  std::vector<unsigned char> scratch(std::size_t{1} << 16U);
  std::uint64_t size = 0;
  int state = Z_OK;
  for (const std::string_view part : parts) {
    stream.next_in = reinterpret_cast<unsigned char*>(const_cast<char*>(part.data()));
    stream.avail_in = static_cast<unsigned>(part.size());
    while (stream.avail_in > 0 && state == Z_OK) {
      stream.next_out = scratch.data();
      stream.avail_out = static_cast<unsigned>(scratch.size());
      state = inflate(&stream, Z_NO_FLUSH);
      size += scratch.size() - stream.avail_out;
      if (size > high || (state != Z_OK && state != Z_STREAM_END)) return false;
    }
  }
  // All input has been passed in; get the rest of the output.
  while (state == Z_OK) {
    stream.next_out = scratch.data();
    stream.avail_out = static_cast<unsigned>(scratch.size());
    state = inflate(&stream, Z_FINISH);
    const std::size_t more = scratch.size() - stream.avail_out;
    size += more;
    if (state == Z_BUF_ERROR && more == scratch.size()) state = Z_OK;
    if (size > high) return false;
  }
  return state == Z_STREAM_END && size >= low;
}

// Returns the error in a PNG, if any: in its chunks, their checksums or the inflated size of the picture. This is
// checked before memory of the stated size is allocated.
std::optional<std::string> fault_of_png(std::string_view bytes, std::uint64_t width, std::uint64_t height) {
  std::vector<std::string_view> data;
  std::uint64_t bits = 0;
  bool interlaced = false, ended = false;
  for (std::size_t i = kPngSignature.size(); !ended;) {
    if (bytes.size() - i < 12) return "which ends early";
    const std::uint32_t length = big_endian(bytes, i);
    if (length > bytes.size() - i - 12)
      return "which has a chunk of " + std::to_string(length) + " bytes, beyond its end";
    const std::string_view kind = bytes.substr(i + 4, 4);
    const std::string_view body = bytes.substr(i + 8, length);
    const auto sum = crc32(0, reinterpret_cast<const unsigned char*>(kind.data()), length + 4U);
    if (sum != big_endian(bytes, i + 8 + length)) return "whose checksums are wrong";
    if (kind == "IHDR" && length == 13) {
      constexpr std::array<unsigned, 7> kChannels = {1, 0, 3, 1, 2, 0, 4};
      const auto color = static_cast<std::uint8_t>(body[9]);
      bits = color < kChannels.size() ? std::uint64_t{static_cast<std::uint8_t>(body[8])} * kChannels[color] : 0;
      interlaced = body[12] != 0;
    }
    if (kind == "IDAT") data.push_back(body);
    ended = kind == "IEND";
    i += std::size_t{12} + length;
  }
  const std::uint64_t size = height * (1 + (width * bits + 7) / 8);
  // Interlacing adds at most a filter byte and a padding byte to each row of its passes, which have fewer than 3 *
  // height rows.
  const std::uint64_t high = interlaced ? size + 6 * height + 64 : size;
  if (bits == 0 || !inflates(data, interlaced ? width * height * bits / 8 : size, high + 64))
    return "whose picture data is damaged";
  return {};
}

// Returns the error in a JPEG, if any. A truncated file would decode to a picture that is partly grey. Each block of 8
// x 8 texels takes at least one bit.
std::optional<std::string> fault_of_jpeg(std::string_view bytes, std::uint64_t width, std::uint64_t height) {
  // Up to the first scan, segments consist of a marker and a length. The end marker cannot occur inside a scan.
  std::size_t i = 2;
  bool four = false, adobe = false;
  while (i + 4 <= bytes.size() && bytes.substr(i, 2) != "\xFF\xDA") {
    const auto marker = static_cast<std::uint8_t>(bytes[i + 1]);
    if (marker == 0xFF) {
      ++i;  // padding
    } else {
      // A frame has its number of components in the tenth byte.
      const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
      four = four || (frame && i + 9 < bytes.size() && bytes[i + 9] == 4);
      adobe = adobe || (marker == 0xEE && bytes.substr(i + 4, 5) == "Adobe");
      i += 2 + (std::size_t{static_cast<std::uint8_t>(bytes[i + 2])} << 8U | static_cast<std::uint8_t>(bytes[i + 3]));
    }
  }
  const bool ended = i < bytes.size() && bytes.find("\xFF\xD9", i) != std::string_view::npos;
  if (four && !adobe) return "of four components without Adobe's segment, which defines their colours";
  if (!ended || width * height / 64 / 8 > bytes.size()) return "which ends early";
  return {};
}

// Returns whether a material draws its texture without regard to alpha.
bool ignores_alpha(const MeshMaterial& material) {
  return material.kind != SurfaceKind::blend && material.alpha_cutoff == 0.0F;
}

bool is_opaque(const MeshTexture& texture) {
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4) {
    if (texture.rgba[i] != 255) return false;
  }
  return true;
}

// Returns whether the colours of vertices may make a material transparent.
bool has_vertex_alpha(const GltfDocument& document, std::size_t material) {
  for (const GltfMesh& mesh : document.meshes) {
    for (const GltfPrimitive& primitive : mesh.primitives) {
      const auto color = primitive.attributes.find("COLOR_0");
      if (primitive.material == static_cast<int>(material) && color != primitive.attributes.end() &&
          document.accessors[static_cast<std::size_t>(color->second)].components == 4)
        return true;
    }
  }
  return false;
}

}  // namespace

void GltfReader::read_materials() {
  for (std::size_t i = 0; i < document_.materials.size(); ++i) {
    const GltfMaterial& in = document_.materials[i];
    MeshMaterial out = in.drawn;
    if (in.texture.texture >= 0) {
      const auto index = static_cast<std::size_t>(in.texture.texture);
      const GltfTexture& texture = document_.textures[index];
      out.sampler = texture.sampler;
      if (texture.image >= 0)
        out.texture = read_image(static_cast<std::size_t>(texture.image), ignores_alpha(out));
      else
        note_each("texture",
                  at("textures", index) + " has no PNG or JPEG picture and is left out of " + at("materials", i));
    }
    // Exporters often choose BLEND for opaque surfaces.
    const bool opaque_texture = out.texture < 0 || is_opaque(out_.textures[static_cast<std::size_t>(out.texture)]);
    if (out.kind == SurfaceKind::blend && out.color.a == 1.0F && opaque_texture && !has_vertex_alpha(document_, i))
      out.kind = SurfaceKind::opaque;
    out_.materials.push_back(std::move(out));
  }
  out_.materials.emplace_back();  // used by parts without a material
}

// Returns the index of a texture's picture, which is decoded at the first call. If it is `opaque`, its alpha is
// ignored, also by the weights of its mip levels.
int GltfReader::read_image(std::size_t index, bool opaque) {
  const auto known = decoded_.find({index, opaque});
  if (known != decoded_.end()) return known->second;
  const GltfImage& image = document_.images[index];
  const std::string name = at("images", index);
  std::string file;
  std::string_view bytes;
  if (image.uri) {
    bytes = file = data_.resource(*image.uri, name);
  } else {
    const std::span<const unsigned char> view = data_.view(static_cast<std::size_t>(image.view));
    bytes = {reinterpret_cast<const char*>(view.data()), view.size()};
  }
  int width = 0, height = 0, channels = 0;
  const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) ||
      stbi_info_from_memory(data, static_cast<int>(bytes.size()), &width, &height, &channels) == 0) {
    fail(name + " is not a picture",
         "expected PNG and JPEG of up to " + std::to_string(kMaxTextureSide) + " texels on a side");
  }
  if (width <= 0 || height <= 0 || width > static_cast<int>(kMaxTextureSide) ||
      height > static_cast<int>(kMaxTextureSide)) {
    fail(name + " has " + std::to_string(width) + "x" + std::to_string(height) + " texels",
         "expected up to " + std::to_string(kMaxTextureSide) + " texels on a side");
  }
  texture_bytes_ += 4ULL * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (texture_bytes_ > kMaxTextureBytes)
    fail("has more texels than there is room for", "expected textures of up to 1 GiB together");
  const auto w = static_cast<std::uint64_t>(width);
  const auto h = static_cast<std::uint64_t>(height);
  const std::optional<std::string> fault =
      bytes.starts_with(kPngSignature) ? fault_of_png(bytes, w, h) : fault_of_jpeg(bytes, w, h);
  if (fault) fail(name + " is a picture " + *fault, "expected a whole PNG or JPEG picture");
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(data, static_cast<int>(bytes.size()), &width, &height, &channels, 4), stbi_image_free);
  if (pixels == nullptr) fail(name + " is a picture that is damaged", "expected a whole PNG or JPEG picture");
  MeshTexture out;
  out.width = static_cast<std::uint32_t>(width);
  out.height = static_cast<std::uint32_t>(height);
  out.rgba.assign(pixels.get(), pixels.get() + 4ULL * out.width * out.height);
  const bool has_alpha = !is_opaque(out);
  if (opaque && has_alpha) {
    for (std::size_t i = 3; i < out.rgba.size(); i += 4) out.rgba[i] = 255;
  }
  out_.textures.push_back(std::move(out));
  const int texture = static_cast<int>(out_.textures.size()) - 1;
  if (!has_alpha) decoded_[{index, !opaque}] = texture;
  return decoded_[{index, opaque}] = texture;
}

std::uint32_t GltfReader::material_of(const GltfPrimitive& primitive, bool has_coordinates, const std::string& where) {
  if (primitive.material < 0) return static_cast<std::uint32_t>(document_.materials.size());
  const auto index = static_cast<std::uint32_t>(primitive.material);
  if (has_coordinates || out_.materials[index].texture < 0) return index;
  note_each("coordinates", where + " has no TEXCOORD_" + std::to_string(document_.materials[index].texture.set) +
                               ", which " + at("materials", index) +
                               " names for its texture: it is drawn without the texture");
  const auto [found, is_new] =
      untextured_.try_emplace(primitive.material, static_cast<std::uint32_t>(out_.materials.size()));
  if (is_new) {
    MeshMaterial plain = out_.materials[index];
    plain.texture = -1;
    out_.materials.push_back(std::move(plain));
  }
  return found->second;
}

}  // namespace tyndall::scene
