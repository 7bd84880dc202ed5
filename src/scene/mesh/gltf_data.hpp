// The data of a glTF document: buffers (files, data URIs and the chunk of a .glb), views, and the elements of
// accessors. All sizes that a file states are checked.
#pragma once

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/mesh/gltf_document.hpp"

namespace tyndall::scene {

constexpr std::uint64_t kMaxGltfFileBytes = std::uint64_t{1} << 31U;

// Elements whose range has been checked. Floats are finite.
struct GltfValues {
  const unsigned char* data = nullptr;  // null if the attribute is missing
  std::size_t count = 0, stride = 0;
  GltfComponent component = GltfComponent::float32;
  int components = 0;
  bool normalized = false;
  std::shared_ptr<const std::vector<unsigned char>> owned;  // storage of elements that were decoded or assembled

  [[nodiscard]] bool empty() const { return data == nullptr; }
  [[nodiscard]] double real(std::size_t i, int c) const {
    const unsigned char* p = data + i * stride;
    const auto c_ = static_cast<std::size_t>(c);
    switch (component) {
      case GltfComponent::int8: return scaled(get<std::int8_t>(p, c_), 127.0);
      case GltfComponent::uint8: return scaled(get<std::uint8_t>(p, c_), 255.0);
      case GltfComponent::int16: return scaled(get<std::int16_t>(p, c_), 32767.0);
      case GltfComponent::uint16: return scaled(get<std::uint16_t>(p, c_), 65535.0);
      case GltfComponent::uint32: return scaled(get<std::uint32_t>(p, c_), 4294967295.0);
      case GltfComponent::float32: break;
    }
    return static_cast<double>(get<float>(p, c_));
  }
  // Returns a component of an unsigned integer type.
  [[nodiscard]] std::uint32_t whole(std::size_t i, int c = 0) const {
    const unsigned char* p = data + i * stride;
    const auto c_ = static_cast<std::size_t>(c);
    if (component == GltfComponent::uint8) return get<std::uint8_t>(p, c_);
    if (component == GltfComponent::uint16) return get<std::uint16_t>(p, c_);
    return get<std::uint32_t>(p, c_);
  }

 private:
  template <typename T>
  static T get(const unsigned char* p, std::size_t c) {
    T value{};
    std::memcpy(&value, p + c * sizeof(T), sizeof(T));
    return value;
  }
  template <typename T>
  [[nodiscard]] double scaled(T value, double most) const {
    return normalized ? std::max(static_cast<double>(value) / most, -1.0) : static_cast<double>(value);
  }
};

// All functions throw GltfFailure. Their results are valid during the lifetime of this object and of the chunk.
class GltfData {
 public:
  // `chunk`: the binary chunk of a .glb, or empty. Names of files are relative to `folder`.
  GltfData(const GltfDocument& document, std::string folder, std::string_view chunk)
      : document_(document), folder_(std::move(folder)), chunk_(chunk) {}

  // Reads the files of all buffers, so that a missing file is reported even if no mesh uses it.
  void read_buffers();
  // Returns the decompressed bytes of a view.
  [[nodiscard]] std::span<const unsigned char> view(std::size_t index);
  // Returns the elements of an accessor, including sparse ones. `user`: the referring object, for messages.
  [[nodiscard]] GltfValues values(std::size_t index, const std::string& user);
  // Returns `bytes` as elements of the accessor's type.
  [[nodiscard]] GltfValues values_of(std::size_t index, std::vector<unsigned char> bytes,
                                     const std::string& user) const;
  // Returns the contents of a data URI or a file.
  [[nodiscard]] std::string resource(const std::string& uri, const std::string& user) const;

 private:
  [[nodiscard]] std::span<const unsigned char> buffer(std::size_t index);
  [[nodiscard]] GltfValues described(std::size_t index) const;
  [[nodiscard]] std::vector<unsigned char> with_sparse(const GltfAccessor& accessor, const GltfValues& base,
                                                       const std::string& user);

  const GltfDocument& document_;
  std::string folder_;
  std::string_view chunk_;
  std::map<std::size_t, std::string> buffers_;
  std::map<std::size_t, std::vector<unsigned char>> decoded_;  // the decompressed views
};

}  // namespace tyndall::scene
