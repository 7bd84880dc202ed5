// Reads a glTF file. The container is read here, the document in gltf_document.cpp and the meshes in gltf_reader.hpp.
#include "scene/mesh/gltf_file.hpp"

#include <cstring>
#include <filesystem>
#include <new>

#include "files/files.hpp"
#include "files/text.hpp"
#include "scene/mesh/gltf_reader.hpp"

namespace tyndall::scene {
namespace {

constexpr const char* kAllowed = "expected none, hall, and glTF 2.0 files: .gltf or .glb";

// The parts of a file, as views into its bytes.
struct Container {
  std::string_view json, chunk;
  bool trailing = false;  // bytes follow the end that a .glb states
};

std::uint32_t word(std::string_view bytes, std::size_t at) {
  std::uint32_t out = 0;
  std::memcpy(&out, bytes.data() + at, 4);
  return out;
}

// Splits a .glb into its chunks (glTF 2.0, section 4.4).
Container split_binary(std::string_view bytes) {
  constexpr std::uint32_t kJson = 0x4E4F534AU, kBin = 0x004E4942U;
  if (bytes.size() < 12) fail("ends within the header of a .glb", "expected 12 bytes and the chunks");
  const std::uint32_t version = word(bytes, 4);
  if (version != 2) fail("is a .glb of version " + std::to_string(version), "expected version 2");
  const std::uint32_t length = word(bytes, 8);
  if (length < 12 || length > bytes.size()) {
    fail("is a .glb that states " + std::to_string(length) + " bytes and has " + std::to_string(bytes.size()),
         "expected all of them");
  }
  Container out;
  out.trailing = length < bytes.size();
  bytes = bytes.substr(0, length);
  for (std::size_t i = 12, number = 0; i < bytes.size(); ++number) {
    if (bytes.size() - i < 8) fail("ends within a chunk of a .glb", "expected whole chunks");
    const std::uint32_t size = word(bytes, i), kind = word(bytes, i + 4);
    if (size > bytes.size() - i - 8) {
      fail("has a chunk of " + std::to_string(size) + " bytes, beyond its end",
           "expected up to " + std::to_string(bytes.size() - i - 8));
    }
    if (number == 0 && kind != kJson) fail("is a .glb without JSON at its start", "expected a first chunk of JSON");
    if (number == 0) out.json = bytes.substr(i + 8, size);
    if (number == 1 && kind == kBin) out.chunk = bytes.substr(i + 8, size);
    i += std::size_t{8} + size;
  }
  if (out.json.empty()) fail("is a .glb without JSON", "expected a first chunk of JSON");
  return out;
}

Container split(std::string_view bytes) {
  if (bytes.starts_with("glTF")) return split_binary(bytes);
  const std::size_t start = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (start == std::string_view::npos || bytes[start] != '{') fail("is not a glTF file", kAllowed);
  return {bytes, {}, false};
}

Error error_of(const std::string& path, const std::string& what, const std::string& allowed) {
  return Error{ErrorCode::invalid_argument, "meshes.source: mesh file " + files::one_line(path, 300) + ": " +
                                                files::one_line(what, 400) + "; " + files::one_line(allowed, 300)};
}

}  // namespace

Result<MeshData> load_gltf(const std::string& path) {
  Result<std::string> bytes = files::read_file(path, kMaxGltfFileBytes);
  if (!bytes.ok()) return Error{ErrorCode::io, "meshes.source: " + bytes.error().message + "; " + kAllowed};
  try {
    const Container parts = split(bytes.value());
    const GltfDocument document = parse_gltf(parts.json);
    GltfData data(document, std::filesystem::path(path).parent_path().string(), parts.chunk);
    MeshData out;
    GltfReader(document, data, out).read();
    if (parts.trailing) out.notes.emplace_back("bytes after the end that the .glb states are ignored");
    return out;
  } catch (const GltfFailure& failure) {
    return error_of(path, failure.what, failure.allowed);
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_memory,
                 "meshes.source: mesh file " + files::one_line(path, 300) + " does not fit into memory; " + kAllowed};
  } catch (const std::exception& thrown) {
    return error_of(path, std::string("cannot be read: ") + thrown.what(), kAllowed);
  }
}

}  // namespace tyndall::scene
