#include "scene/mesh/gltf_data.hpp"

#include <array>
#include <cmath>
#include <filesystem>

#include "files/access.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "scene/mesh/gltf_decoders.hpp"

namespace tyndall::scene {
namespace {

constexpr std::size_t kMaxElement = 64;  // bytes: a MAT4 of floats

// Decodes percent-encoded characters. Throws if a percent sign is not followed by two hexadecimal digits.
std::string percent_decoded(std::string_view text, const std::string& user) {
  const auto digit = [&](char c) -> unsigned {
    if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
    if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a') + 10;
    if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10;
    fail(user + ".uri has a % without two hexadecimal digits", "expected URIs such as my%20file.bin");
  };
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    if (i + 2 >= text.size()) digit(' ');
    out += static_cast<char>(digit(text[i + 1]) << 4U | digit(text[i + 2]));
    i += 2;
  }
  return out;
}

std::string base64_decoded(std::string_view text, const std::string& user) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    std::uint32_t value = 0;
    if (c >= 'A' && c <= 'Z')
      value = static_cast<std::uint32_t>(c - 'A');
    else if (c >= 'a' && c <= 'z')
      value = static_cast<std::uint32_t>(c - 'a') + 26;
    else if (c >= '0' && c <= '9')
      value = static_cast<std::uint32_t>(c - '0') + 52;
    else if (c == '+')
      value = 62;
    else if (c == '/')
      value = 63;
    else
      fail(user + ".uri has a character that is not base64", "expected A-Z, a-z, 0-9, + and /");
    bits = bits << 6U | value;
    count += 6;
    if (count >= 8) {
      count -= 8;
      out += static_cast<char>(bits >> static_cast<unsigned>(count) & 255U);
    }
  }
  return out;
}

void check_finite(const GltfValues& values, const std::string& user) {
  if (values.component != GltfComponent::float32 || values.stride == 0) return;
  for (std::size_t i = 0; i < values.count; ++i) {
    for (int c = 0; c < values.components; ++c) {
      if (!std::isfinite(values.real(i, c))) {
        fail(user + " has an element that is not finite, number " + std::to_string(i), "expected finite numbers");
      }
    }
  }
}

}  // namespace

std::string GltfData::resource(const std::string& uri, const std::string& user) const {
  // The scheme and "base64" are case-insensitive (RFC 3986, section 3.1; RFC 2045, section 6.1).
  if (files::lower_case(uri.substr(0, 5)) == "data:") {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos) fail(user + ".uri is a data URI without data", "expected data:MIME;base64,DATA");
    const std::string_view data = std::string_view(uri).substr(comma + 1);
    const std::string_view head = std::string_view(uri).substr(0, comma);
    return files::lower_case(head).ends_with(";base64") ? base64_decoded(data, user) : percent_decoded(data, user);
  }
  const std::string name = percent_decoded(uri, user);
  const std::string shown = user + ".uri '" + files::one_line(name, 200) + "'";
  if (name.find("://") != std::string::npos) fail(shown + " is not a file", "expected files and data URIs");
  if (name.empty() || files::has_control_characters(name))
    fail(shown + " is not the name of a file", "expected files and data URIs");
  const std::string path = (std::filesystem::path(folder_) / name).string();
  if (!files::outside_allowed() && !files::is_within(path, folder_)) {
    fail(shown + " leaves the folder of the glTF file",
         "expected a file in that folder or below it, or --allow-outside");
  }
  Result<std::string> read = files::read_file(path, kMaxGltfFileBytes);
  if (!read.ok()) {
    const std::string& message = read.error().message;  // ends with what is expected
    fail(user + ".uri: " + message.substr(0, message.rfind("; ")), "expected a file that can be read");
  }
  return std::move(read).value();
}

void GltfData::read_buffers() {
  for (std::size_t i = 0; i < document_.buffers.size(); ++i) {
    if (document_.buffers[i].uri && !document_.buffers[i].fallback) (void)buffer(i);
  }
}

std::span<const unsigned char> GltfData::buffer(std::size_t index) {
  const GltfBuffer& described = document_.buffers[index];
  const std::string name = at("buffers", index);
  std::string_view bytes;
  if (described.uri) {
    const auto known = buffers_.find(index);
    if (known == buffers_.end()) buffers_[index] = resource(*described.uri, name);
    bytes = buffers_[index];
  } else if (index == 0 && !chunk_.empty()) {
    bytes = chunk_;
  } else {
    fail(name + " has no data", "expected a uri, or the binary chunk of a .glb for buffers[0]");
  }
  if (bytes.size() < described.length) {
    fail(name + " has " + std::to_string(bytes.size()) + " bytes",
         "expected the " + std::to_string(described.length) + " of its byteLength");
  }
  return {reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<std::size_t>(described.length)};
}

std::span<const unsigned char> GltfData::view(std::size_t index) {
  const GltfView& described = document_.views[index];
  if (!described.meshopt) return buffer(described.buffer).subspan(described.offset, described.length);
  const auto known = decoded_.find(index);
  if (known != decoded_.end()) return known->second;
  const GltfMeshopt& meshopt = *described.meshopt;
  return decoded_[index] = decode_meshopt(meshopt, buffer(meshopt.buffer).subspan(meshopt.offset, meshopt.length),
                                          at("bufferViews", index));
}

GltfValues GltfData::described(std::size_t index) const {
  const GltfAccessor& accessor = document_.accessors[index];
  GltfValues out;
  out.count = accessor.count;
  out.component = accessor.component;
  out.components = accessor.components;
  out.normalized = accessor.normalized;
  out.stride = bytes_of(accessor.component) * static_cast<std::size_t>(accessor.components);
  return out;
}

GltfValues GltfData::values(std::size_t index, const std::string& user) {
  static constexpr std::array<unsigned char, kMaxElement> kZeros = {};
  const GltfAccessor& accessor = document_.accessors[index];
  GltfValues out = described(index);
  if (accessor.view >= 0) {
    const auto i = static_cast<std::size_t>(accessor.view);
    out.data = view(i).data() + accessor.offset;
    if (document_.views[i].stride != 0) out.stride = document_.views[i].stride;
  } else {
    out.data = kZeros.data();
    out.stride = 0;
  }
  const std::string name = user + " (" + at("accessors", index) + ")";
  if (accessor.sparse) return values_of(index, with_sparse(accessor, out, name), user);
  check_finite(out, name);
  return out;
}

GltfValues GltfData::values_of(std::size_t index, std::vector<unsigned char> bytes, const std::string& user) const {
  GltfValues out = described(index);
  out.owned = std::make_shared<const std::vector<unsigned char>>(std::move(bytes));
  out.data = out.owned->data();
  check_finite(out, user + " (" + at("accessors", index) + ")");
  return out;
}

std::vector<unsigned char> GltfData::with_sparse(const GltfAccessor& accessor, const GltfValues& base,
                                                 const std::string& user) {
  if (accessor.count > kMaxMeshVertices) {
    fail(user + " is sparse and has " + std::to_string(accessor.count) + " elements",
         "expected up to " + std::to_string(kMaxMeshVertices));
  }
  const GltfSparse& sparse = *accessor.sparse;
  const std::size_t element = bytes_of(accessor.component) * static_cast<std::size_t>(accessor.components);
  std::vector<unsigned char> out(accessor.count * element);
  for (std::size_t i = 0; i < accessor.count; ++i) std::memcpy(&out[i * element], base.data + i * base.stride, element);
  GltfValues indices;
  indices.data = view(sparse.index_view).data() + sparse.index_offset;
  indices.component = sparse.index_component;
  indices.stride = bytes_of(sparse.index_component);
  const unsigned char* const values = view(sparse.value_view).data() + sparse.value_offset;
  std::int64_t last = -1;
  for (std::size_t i = 0; i < sparse.count; ++i) {
    const std::int64_t to = indices.whole(i);
    if (to <= last || static_cast<std::size_t>(to) >= accessor.count) {
      fail(user + " has the sparse index " + std::to_string(to),
           "expected increasing indices below " + std::to_string(accessor.count));
    }
    std::memcpy(&out[static_cast<std::size_t>(to) * element], values + i * element, element);
    last = to;
  }
  return out;
}

}  // namespace tyndall::scene
