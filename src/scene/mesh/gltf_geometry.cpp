// Triangles and what stands at their corners, from accessors that are checked against the end of their buffers.
#include "scene/mesh/gltf_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tyndall::scene {
namespace {

constexpr double kLargestCoordinate_m = 1.0e7;

}  // namespace

std::span<const unsigned char> GltfReader::view_bytes(std::size_t index) const {
  if (index >= model_.bufferViews.size()) fail("has a bufferView that is not there", range(model_.bufferViews.size()));
  const tinygltf::BufferView& view = model_.bufferViews[index];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size()) {
    fail("has " + at("bufferViews", index) + " of a buffer that is not there", range(model_.buffers.size()));
  }
  const std::vector<unsigned char>& bytes = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) {
    fail("has " + at("bufferViews", index) + " beyond the end of its buffer", "allowed are up to " + std::to_string(bytes.size()) + " bytes");
  }
  return std::span(bytes).subspan(view.byteOffset, view.byteLength);
}

GltfReader::Values GltfReader::values(int index) const {
  if (index < 0 || static_cast<std::size_t>(index) >= model_.accessors.size()) fail("has an accessor that is not there", range(model_.accessors.size()));
  const auto i = static_cast<std::size_t>(index);
  const tinygltf::Accessor& accessor = model_.accessors[i];
  if (accessor.sparse.isSparse) fail("has " + at("accessors", i) + ", which is sparse", "allowed are accessors without sparse");
  if (accessor.bufferView < 0) fail("has " + at("accessors", i) + " without data", "allowed are accessors with a bufferView");
  const std::span<const unsigned char> bytes = view_bytes(static_cast<std::size_t>(accessor.bufferView));
  const int component = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
  const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  if (component <= 0 || components <= 0) fail("has " + at("accessors", i) + " of an unknown type", "allowed are the types of glTF 2.0");
  const auto element = static_cast<std::size_t>(component) * static_cast<std::size_t>(components);
  const std::size_t step = model_.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
  Values out;
  out.stride = step == 0 ? element : step;
  out.count = accessor.count;
  out.type = accessor.componentType;
  out.components = components;
  out.normalized = accessor.normalized;
  if (out.count == 0 || out.count > std::max(kMaxMeshVertices, kMaxMeshIndices)) {
    fail("has " + at("accessors", i) + " of " + std::to_string(out.count) + " elements", "allowed are 1 to " + std::to_string(kMaxMeshIndices));
  }
  if (out.stride < element || out.stride > 1024 || accessor.byteOffset > bytes.size() ||
      (out.count - 1) * out.stride + element > bytes.size() - accessor.byteOffset) {
    fail("has " + at("accessors", i) + " beyond the end of its bufferView", "allowed are up to " + std::to_string(bytes.size()) + " bytes");
  }
  out.data = bytes.data() + accessor.byteOffset;
  return out;
}

// The values of an attribute, or none.
GltfReader::Values GltfReader::attribute(const tinygltf::Primitive& primitive, const std::string& name, std::size_t count, int least, int most) const {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) return {};
  const Values out = values(found->second);
  if (out.components < least || out.components > most) fail("has an attribute " + name + " of " + std::to_string(out.components) + " components", "allowed are " + std::to_string(least) + " to " + std::to_string(most));
  if (count > 0 && out.count != count) fail("has an attribute " + name + " of another length than POSITION", "allowed are " + std::to_string(count) + " elements");
  return out;
}

void GltfReader::read_mesh(std::size_t index, const std::vector<glm::dmat4>& placed) {
  Mesh mesh;
  mesh.first_part = static_cast<std::uint32_t>(out_.parts.size());
  const std::size_t first_vertex = out_.vertices.size();
  for (const tinygltf::Primitive& primitive : model_.meshes[index].primitives) read_primitive(primitive);
  mesh.part_count = static_cast<std::uint32_t>(out_.parts.size()) - mesh.first_part;
  if (mesh.part_count == 0) return;
  mesh.first_instance = static_cast<std::uint32_t>(out_.instances.size());
  mesh.instance_count = static_cast<std::uint32_t>(placed.size());
  Box box;
  for (std::size_t v = first_vertex; v < out_.vertices.size(); ++v) box.add(out_.vertices[v].position);
  for (const glm::dmat4& transform : placed) {
    out_.instances.emplace_back(transform);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p((corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                         (corner & 4) != 0 ? box.max.z : box.min.z);
      const glm::dvec3 world(transform * glm::dvec4(p, 1.0));
      for (int c = 0; c < 3; ++c) {
        if (!(std::abs(world[c]) <= kLargestCoordinate_m)) fail("reaches farther than a planet", "allowed are coordinates of up to 10000 km");
      }
      out_.bounds.add(world);
    }
  }
  out_.meshes.push_back(mesh);
}

void GltfReader::read_primitive(const tinygltf::Primitive& primitive) {
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    skipped_lines_ = true;
    return;
  }
  std::size_t material = out_.materials.size() - 1;
  if (primitive.material >= 0) {
    material = static_cast<std::size_t>(primitive.material);
    if (material >= model_.materials.size()) fail("has a primitive with a material that is not there", range(model_.materials.size()));
  }
  const Values position = attribute(primitive, "POSITION", 0, 3, 3);
  if (position.data == nullptr) return;  // a primitive without positions draws nothing
  const std::vector<std::uint32_t> corners = triangles(primitive, mode, position.count);
  const Values normal = attribute(primitive, "NORMAL", position.count, 3, 3);
  // Of the set that the base colour asks for, moved as KHR_texture_transform says.
  int set = 0;
  glm::dvec2 offset(0.0), scale(1.0);
  double turn = 0.0;
  if (primitive.material >= 0) {
    texture_transform(model_.materials[material].pbrMetallicRoughness.baseColorTexture, set, offset, scale, turn);
  }
  const Values uv = attribute(primitive, "TEXCOORD_" + std::to_string(set), position.count, 2, 2);
  const Values color = attribute(primitive, "COLOR_0", position.count, 3, 4);
  const auto vertex = [&](std::size_t i) {
    MeshVertex v;
    for (int c = 0; c < 3; ++c) {
      const double x = position.real(i, c);
      if (!std::isfinite(x)) fail("has a position that is not finite", "allowed are finite numbers");
      v.position[c] = static_cast<float>(x);
    }
    if (normal.data != nullptr) {
      const glm::dvec3 n(normal.real(i, 0), normal.real(i, 1), normal.real(i, 2));
      const double length = glm::length(n);
      if (!std::isfinite(length)) fail("has a normal that is not finite", "allowed are finite numbers");
      if (length > 1e-6) v.normal = glm::vec3(n / length);
    }
    if (uv.data != nullptr) {
      const glm::dvec2 t = glm::dvec2(uv.real(i, 0), uv.real(i, 1)) * scale;
      v.uv = glm::vec2(offset + glm::dvec2(t.x * std::cos(turn) + t.y * std::sin(turn), t.y * std::cos(turn) - t.x * std::sin(turn)));
      if (!std::isfinite(v.uv.x) || !std::isfinite(v.uv.y)) fail("has a texture coordinate that is not finite", "allowed are finite numbers");
    }
    if (color.data != nullptr) {
      v.color = 0;
      for (int c = 0; c < 4; ++c) {
        const double x = c < color.components ? color.real(i, c) : 1.0;
        v.color |= static_cast<std::uint32_t>(std::lround(255.0 * (x > 0.0 ? std::min(x, 1.0) : 0.0))) << (8 * c);
      }
    }
    return v;
  };
  const std::size_t added = normal.data != nullptr ? position.count : corners.size();
  if (out_.vertices.size() + added > kMaxMeshVertices) fail("has too many vertices", "allowed are up to " + std::to_string(kMaxMeshVertices));
  if (out_.indices.size() + corners.size() > kMaxMeshIndices) fail("has too many triangles", "allowed are up to " + std::to_string(kMaxMeshIndices / 3));
  MeshPart part;
  part.first_index = static_cast<std::uint32_t>(out_.indices.size());
  part.index_count = static_cast<std::uint32_t>(corners.size());
  part.material = static_cast<std::uint32_t>(material);
  const auto base = static_cast<std::uint32_t>(out_.vertices.size());
  if (normal.data != nullptr) {
    for (std::size_t i = 0; i < position.count; ++i) out_.vertices.push_back(vertex(i));
    for (const std::uint32_t c : corners) out_.indices.push_back(base + c);
  } else {
    // Without normals triangles are flat, so no two share a vertex.
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
      std::array<MeshVertex, 3> v = {vertex(corners[t]), vertex(corners[t + 1]), vertex(corners[t + 2])};
      const glm::dvec3 n = glm::cross(glm::dvec3(v[1].position) - glm::dvec3(v[0].position), glm::dvec3(v[2].position) - glm::dvec3(v[0].position));
      const double length = glm::length(n);
      for (MeshVertex& one : v) {
        if (length > 0.0) one.normal = glm::vec3(n / length);
        out_.indices.push_back(static_cast<std::uint32_t>(out_.vertices.size()));
        out_.vertices.push_back(one);
      }
    }
  }
  if (part.index_count > 0) out_.parts.push_back(part);
}

// Corners of the triangles, three by three, whatever the mode.
std::vector<std::uint32_t> GltfReader::triangles(const tinygltf::Primitive& primitive, int mode, std::size_t count) const {
  std::vector<std::uint32_t> list;
  if (primitive.indices >= 0) {
    const Values in = values(primitive.indices);
    const bool whole = in.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || in.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                       in.type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    if (!whole || in.components != 1) fail("has indices of a wrong type", "allowed are unsigned bytes, shorts and ints");
    list.reserve(in.count);
    for (std::size_t i = 0; i < in.count; ++i) {
      const std::uint64_t value = in.whole(i);
      if (value >= count) fail("has index " + std::to_string(value) + " of " + std::to_string(count) + " vertices", range(count));
      list.push_back(static_cast<std::uint32_t>(value));
    }
  } else {
    if (count > kMaxMeshVertices) fail("has too many vertices", "allowed are up to " + std::to_string(kMaxMeshVertices));
    for (std::size_t i = 0; i < count; ++i) list.push_back(static_cast<std::uint32_t>(i));
  }
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    list.resize(list.size() / 3 * 3);
    return list;
  }
  std::vector<std::uint32_t> out;
  for (std::size_t i = 2; i < list.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
      out.insert(out.end(), {list[0], list[i - 1], list[i]});
    } else if (i % 2 == 0) {
      out.insert(out.end(), {list[i - 2], list[i - 1], list[i]});
    } else {
      out.insert(out.end(), {list[i - 1], list[i - 2], list[i]});
    }
  }
  return out;
}

void GltfReader::texture_transform(const tinygltf::TextureInfo& info, int& set, glm::dvec2& offset, glm::dvec2& scale, double& turn) {
  set = info.texCoord;
  const auto found = info.extensions.find("KHR_texture_transform");
  if (found == info.extensions.end() || !found->second.IsObject()) return;
  const auto pair = [&](const char* name, glm::dvec2& out) {
    const tinygltf::Value& value = found->second.Get(name);
    if (!value.IsArray() || value.ArrayLen() != 2 || !value.Get(0).IsNumber() || !value.Get(1).IsNumber()) return;
    out = {value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble()};
  };
  pair("offset", offset);
  pair("scale", scale);
  if (found->second.Get("rotation").IsNumber()) turn = found->second.Get("rotation").GetNumberAsDouble();
  if (found->second.Get("texCoord").IsInt()) set = found->second.Get("texCoord").GetNumberAsInt();
}


std::string GltfReader::range(std::size_t count) {
  return count == 0 ? "allowed is none: the file has none" : "allowed is 0 to " + std::to_string(count - 1);
}

}  // namespace tyndall::scene
