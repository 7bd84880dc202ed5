// Reading through tinygltf, which parses; what its model holds is checked by GltfReader before it is used.
#include "scene/mesh/gltf_file.hpp"

#define TINYGLTF_IMPLEMENTATION
#include "scene/mesh/gltf_reader.hpp"

#include <filesystem>

#include "config/files.hpp"
#include "config/text.hpp"

namespace tyndall::scene {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 31U;
constexpr int kMaxJsonDepth = 96;   // tinygltf recurses

// Depth of the nesting of a JSON text, strings left out.
bool too_deep(std::string_view json) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxJsonDepth) return true;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return false;
}

// Files that a glTF file refers to. The last error is kept: tinygltf says less.
bool read_whole(std::vector<unsigned char>* out, std::string* error, const std::string& path, void*) {
  Result<std::string> text = config::read_file(path, kMaxFileBytes);
  if (!text.ok()) {
    *error = text.error().message;
    return false;
  }
  out->assign(text.value().begin(), text.value().end());
  return true;
}

bool exists(const std::string& path, void*) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

std::string unchanged(const std::string& path, void*) { return path; }

// Keeps the file's bytes of a picture; those of buffers are looked up when they are needed.
bool keep_bytes(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes,
                int size, void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

Error error_of(const std::string& path, const std::string& what, const std::string& allowed) {
  return Error{ErrorCode::invalid_argument, "mesh file " + config::one_line(path, 300) + " " + config::one_line(what, 400) +
               ", meshes.source, " + config::one_line(allowed, 200)};
}

// The first line of what tinygltf says, without its full stop.
std::string first_line(const std::string& text) {
  std::string line = text.substr(0, text.find('\n'));
  while (!line.empty() && (line.back() == '.' || line.back() == ' ')) line.pop_back();
  return line.empty() ? "it is damaged" : line;
}

}  // namespace

void GltfReader::read() {
  check_extensions();
  read_materials();
  // A mesh without instances costs nothing: those of the scene are collected first.
  std::vector<std::vector<glm::dmat4>> placed(model_.meshes.size());
  place(placed);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (!placed[i].empty()) read_mesh(i, placed[i]);
  }
  if (out_.indices.empty()) fail("has no triangles in its scene", "allowed is a file with at least one triangle");
  if (skipped_lines_) out_.notes.emplace_back("lines and points of the meshes are left out");
  if (!model_.animations.empty() || !model_.skins.empty()) {
    out_.notes.emplace_back("the meshes are drawn at rest: animations and skins are left out");
  }
}

void GltfReader::check_extensions() const {
  for (const std::string& name : model_.extensionsRequired) {
    const bool known = name.rfind("KHR_materials_", 0) == 0 || name == "KHR_mesh_quantization" ||
                       name == "KHR_texture_transform" || name == "KHR_lights_punctual";
    if (!known) fail("requires the extension " + name, "allowed are KHR_materials_*, KHR_mesh_quantization and KHR_texture_transform");
  }
}

Result<MeshData> load_gltf(const std::string& path) {
  const char* const kAllowed = "allowed are none, hall, and glTF 2.0 files: .gltf or .glb";
  Result<std::string> text = config::read_file(path, kMaxFileBytes);
  if (!text.ok()) return Error{ErrorCode::io, text.error().message + ", meshes.source, " + kAllowed};
  const std::string& bytes = text.value();
  const bool binary = bytes.rfind("glTF", 0) == 0;
  std::string_view json(bytes);
  if (binary) {
    std::uint32_t length = 0;
    if (bytes.size() >= 20) std::memcpy(&length, bytes.data() + 12, 4);
    json = json.size() > 20 ? json.substr(20, length) : std::string_view();
  } else if (json.find_first_not_of(" \t\r\n\xEF\xBB\xBF") == std::string_view::npos || json[json.find_first_not_of(" \t\r\n\xEF\xBB\xBF")] != '{') {
    return error_of(path, "is no glTF file", kAllowed);
  }
  if (too_deep(json)) return error_of(path, "is nested too deeply", kAllowed);
  try {
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_bytes, nullptr);
    loader.SetFsCallbacks({exists, unchanged, read_whole, nullptr, nullptr});
    tinygltf::Model model;
    std::string error, warning;
    const std::string folder = std::filesystem::path(path).parent_path().string();
    const auto size = static_cast<unsigned>(bytes.size());
    const bool read = binary ? loader.LoadBinaryFromMemory(&model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
                             : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, folder);
    if (!read) return error_of(path, "cannot be read: " + first_line(error), kAllowed);
    MeshData out;
    GltfReader(model, out).read();
    return out;
  } catch (const GltfFailure& failure) {
    return error_of(path, failure.what, failure.allowed);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_memory, "mesh file " + config::one_line(path, 300) + " does not fit into memory, meshes.source, " + kAllowed};
  } catch (const std::exception& thrown) {
    return error_of(path, std::string("cannot be read: ") + thrown.what(), kAllowed);
  }
}

}  // namespace tyndall::scene
