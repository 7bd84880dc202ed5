// Reads the triangles and vertices of primitives, and applies morph targets and skins.
#include <algorithm>
#include <array>
#include <cmath>

#include "scene/mesh/gltf_reader.hpp"

namespace tyndall::scene {
namespace {

constexpr double kLargestCoordinate_m = 1.0e7;
constexpr glm::vec3 kUp(0, 1, 0);

std::string shown_range(int low, int high) {
  return low == high ? std::to_string(low) : std::to_string(low) + " to " + std::to_string(high);
}

// Returns the normal of a triangle, or up if it is degenerate.
glm::vec3 flat_normal(const MeshVertex& a, const MeshVertex& b, const MeshVertex& c) {
  const glm::dvec3 n =
      glm::cross(glm::dvec3(b.position) - glm::dvec3(a.position), glm::dvec3(c.position) - glm::dvec3(a.position));
  const double length = glm::length(n);
  return length > 0.0 ? glm::vec3(n / length) : kUp;
}

}  // namespace

// Returns an element of an attribute with the displacements of the morph targets added. Missing components are 1.
glm::dvec4 GltfVertices::morphed(const GltfValues& base, GltfValues Target::*target, std::size_t i) const {
  glm::dvec4 out(1.0);
  for (int c = 0; c < base.components; ++c) out[c] = base.real(i, c);
  for (const Target& one : targets) {
    const GltfValues& moved = one.*target;
    for (int c = 0; c < moved.components; ++c) out[c] += one.weight * moved.real(i, c);
  }
  return out;
}

// Returns the weighted mean of the matrices of a vertex's joints. The weights are normalised to a sum of one.
glm::dmat4 GltfVertices::skinned(std::size_t i) const {
  glm::dmat4 out(0.0);
  double sum = 0.0;
  for (const Influence& one : influences) {
    for (int c = 0; c < 4; ++c) {
      const double weight = one.weights.real(i, c);
      if (weight < 0.0)
        fail(where + " has a negative weight of a joint at vertex " + std::to_string(i),
             "expected weights of 0 and more");
      if (weight == 0.0) continue;
      const std::uint32_t joint = one.joints.whole(i, c);
      if (joint >= joints->size()) {
        fail(where + " has joint " + std::to_string(joint) + " at vertex " + std::to_string(i),
             "expected 0 to " + std::to_string(joints->size() - 1));
      }
      out += weight * (*joints)[joint];
      sum += weight;
    }
  }
  if (sum > 0.0) return out / sum;
  unweighted = true;
  return joints->front();
}

bool GltfVertices::mirrored() const { return joints != nullptr && glm::determinant(glm::dmat3(joints->front())) < 0.0; }

MeshVertex GltfVertices::at(std::size_t i) const {
  MeshVertex out;
  glm::dvec3 p = morphed(position, &Target::position, i);
  glm::dvec3 n(0.0);
  if (!normal.empty()) n = morphed(normal, &Target::normal, i);
  if (!influences.empty()) {
    const glm::dmat4 m = skinned(i);
    p = glm::dvec3(m * glm::dvec4(p, 1.0));
    // Normals are transformed by the cofactor matrix, which is also correct for singular matrices.
    const glm::dmat3 c(glm::cross(glm::dvec3(m[1]), glm::dvec3(m[2])), glm::cross(glm::dvec3(m[2]), glm::dvec3(m[0])),
                       glm::cross(glm::dvec3(m[0]), glm::dvec3(m[1])));
    n = mirrored() ? -(c * n) : c * n;
  }
  // Every input is finite, but sums and products can leave the range of floats.
  for (int c = 0; c < 3; ++c) {
    if (!(std::abs(p[c]) <= kLargestCoordinate_m))
      fail(where + " reaches farther than a planet", "expected coordinates of up to 10000 km");
  }
  out.position = glm::vec3(p);
  const double length = glm::length(n);
  out.normal = length > 1e-30 && std::isfinite(length) ? glm::vec3(n / length) : glm::vec3(0.0F);
  if (!uv.empty()) {
    const glm::dvec2 t = glm::dvec2(morphed(uv, &Target::uv, i)) * texture.scale;
    const double cosine = std::cos(texture.rotation_rad), sine = std::sin(texture.rotation_rad);
    out.uv = glm::vec2(texture.offset + glm::dvec2(t.x * cosine + t.y * sine, t.y * cosine - t.x * sine));
    if (!std::isfinite(out.uv.x) || !std::isfinite(out.uv.y))
      fail(where + " has a texture coordinate that is too large", "expected 32-bit floats");
  }
  if (!color.empty()) {
    const glm::dvec4 x = morphed(color, &Target::color, i);
    for (int c = 0; c < 4; ++c) {
      clamped = clamped || x[c] > 1.001 || x[c] < -0.001;
      out.color[static_cast<std::size_t>(c)] =
          static_cast<std::uint16_t>(std::lround(65535.0 * std::clamp(x[c], 0.0, 1.0)));
    }
  }
  return out;
}

void GltfReader::read_shape(const Shape& shape, const std::vector<glm::dmat4>& placed) {
  const auto [index, skin, weights] = shape;
  Mesh mesh;
  mesh.first_part = static_cast<std::uint32_t>(out_.parts.size());
  const std::size_t first_vertex = out_.vertices.size();
  std::vector<glm::dmat4> joints;
  if (skin >= 0) joints = joint_matrices(static_cast<std::size_t>(skin));
  const std::vector<GltfPrimitive>& primitives = document_.meshes[static_cast<std::size_t>(index)].primitives;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    read_primitive(primitives[i],
                   scene::at("meshes", static_cast<std::size_t>(index)) + "." + scene::at("primitives", i), shape,
                   joints);
  }
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
        if (!(std::abs(world[c]) <= kLargestCoordinate_m))
          fail("reaches farther than a planet", "expected coordinates of up to 10000 km");
      }
      out_.bounds.add(world);
    }
  }
  out_.meshes.push_back(mesh);
}

void GltfReader::read_primitive(const GltfPrimitive& primitive, const std::string& where, const Shape& shape,
                                const std::vector<glm::dmat4>& joints) {
  if (primitive.mode < 4) return note("lines and points in meshes are not drawn");
  if (!primitive.attributes.contains("POSITION"))
    return note_each("position", where + " has no POSITION and is not drawn");
  std::optional<DracoMesh> draco;
  if (primitive.draco) draco = decode_draco(document_, primitive, data_.view(primitive.draco->view), where);
  const DracoMesh* const decoded = draco ? &*draco : nullptr;
  const GltfVertices read = vertices(primitive, where, decoded, shape, joints);
  std::vector<std::uint32_t> corners =
      draco ? std::move(draco->corners) : triangles(primitive, where, read.position.count);
  if (read.mirrored()) {
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) std::swap(corners[t + 1], corners[t + 2]);
  }
  emit(read, corners, material_of(primitive, !read.uv.empty(), where));
  // Morphed colours are clamped by the specification.
  if (read.clamped && read.targets.empty())
    note_each("color", where + ".attributes.COLOR_0 has values outside 0 to 1, which are clamped");
  if (read.unweighted)
    note_each("joints", where + " has vertices whose joints have no weight; they follow the first joint");
}

// Returns the values of an attribute, or none if it is missing.
GltfValues GltfReader::attribute(const GltfAttributes& attributes, const std::string& name, const std::string& where,
                                 const DracoMesh* draco, std::size_t count, int min_components, int max_components) {
  const auto found = attributes.find(name);
  if (found == attributes.end()) return {};
  const auto index = static_cast<std::size_t>(found->second);
  const std::string path = where + "." + name;
  const GltfAccessor& accessor = document_.accessors[index];
  const std::string full = path + " (" + scene::at("accessors", index) + ")";
  if (accessor.components < min_components || accessor.components > max_components) {
    fail(full + " has " + std::to_string(accessor.components) + " components",
         "expected " + shown_range(min_components, max_components));
  }
  if (count > 0 && accessor.count != count) {
    fail(full + " has another length than POSITION", "expected " + std::to_string(count) + " elements");
  }
  if (draco != nullptr) {
    const auto compressed = draco->attributes.find(name);
    if (compressed != draco->attributes.end()) return data_.values_of(index, compressed->second, path);
  }
  return data_.values(index, path);
}

GltfVertices GltfReader::vertices(const GltfPrimitive& primitive, const std::string& where, const DracoMesh* draco,
                                  const Shape& shape, const std::vector<glm::dmat4>& joints) {
  GltfVertices out;
  out.where = where;
  const std::string path = where + ".attributes";
  out.position = attribute(primitive.attributes, "POSITION", path, draco, 0, 3, 3);
  const std::size_t count = out.position.count;
  if (count > kMaxMeshVertices) fail("has too many vertices", "expected up to " + std::to_string(kMaxMeshVertices));
  if (draco != nullptr && count != draco->points) {
    fail(path + ".POSITION has " + std::to_string(count) + " elements",
         "expected the " + std::to_string(draco->points) + " of the Draco mesh");
  }
  out.normal = attribute(primitive.attributes, "NORMAL", path, draco, count, 3, 3);
  // Texture coordinates: the set that the base colour uses, transformed by KHR_texture_transform.
  if (primitive.material >= 0) out.texture = document_.materials[static_cast<std::size_t>(primitive.material)].texture;
  const std::string uv = "TEXCOORD_" + std::to_string(out.texture.set);
  out.uv = attribute(primitive.attributes, uv, path, draco, count, 2, 2);
  out.color = attribute(primitive.attributes, "COLOR_0", path, draco, count, 3, 4);
  if (!out.color.empty() && out.color.component != GltfComponent::float32 && !out.color.normalized) {
    fail(path + ".COLOR_0 has integers that are not normalized", "expected \"normalized\": true, or floats");
  }
  const std::vector<double>& weights = std::get<2>(shape);
  for (std::size_t i = 0; i < primitive.targets.size(); ++i) {
    if (weights[i] == 0.0) continue;
    const std::string target = where + "." + scene::at("targets", i);
    const GltfAttributes& in = primitive.targets[i];
    GltfVertices::Target moved;
    moved.weight = weights[i];
    moved.position = attribute(in, "POSITION", target, nullptr, count, 3, 3);
    moved.normal = attribute(in, "NORMAL", target, nullptr, count, 3, 3);
    moved.uv = attribute(in, uv, target, nullptr, count, 2, 2);
    moved.color = attribute(in, "COLOR_0", target, nullptr, count, 3, 4);
    out.targets.push_back(std::move(moved));
  }
  if (joints.empty()) return out;
  out.joints = &joints;
  for (std::size_t set = 0; set < 16; ++set) {
    GltfVertices::Influence one;
    one.joints = attribute(primitive.attributes, "JOINTS_" + std::to_string(set), path, draco, count, 4, 4);
    one.weights = attribute(primitive.attributes, "WEIGHTS_" + std::to_string(set), path, draco, count, 4, 4);
    if (one.joints.empty() != one.weights.empty())
      fail(path + " has only one of JOINTS_" + std::to_string(set) + " and WEIGHTS_" + std::to_string(set),
           "expected both");
    if (one.joints.empty()) break;
    if (one.joints.component != GltfComponent::uint8 && one.joints.component != GltfComponent::uint16) {
      fail(path + ".JOINTS_" + std::to_string(set) + " has another type", "expected unsigned bytes and shorts");
    }
    out.influences.push_back(std::move(one));
  }
  if (out.influences.empty()) fail(path + " has no JOINTS_0 and WEIGHTS_0", "expected both in a mesh with a skin");
  return out;
}

void GltfReader::emit(const GltfVertices& vertices, const std::vector<std::uint32_t>& corners, std::uint32_t material) {
  const bool flat = vertices.normal.empty();
  const std::size_t added = flat ? corners.size() : vertices.position.count;
  if (out_.vertices.size() + added > kMaxMeshVertices)
    fail("has too many vertices", "expected up to " + std::to_string(kMaxMeshVertices));
  if (out_.indices.size() + corners.size() > kMaxMeshIndices)
    fail("has too many triangles", "expected up to " + std::to_string(kMaxMeshIndices / 3));
  MeshPart part;
  part.first_index = static_cast<std::uint32_t>(out_.indices.size());
  part.index_count = static_cast<std::uint32_t>(corners.size());
  part.material = material;
  const auto base = static_cast<std::uint32_t>(out_.vertices.size());
  if (!flat) {
    for (std::size_t i = 0; i < vertices.position.count; ++i) out_.vertices.push_back(vertices.at(i));
    for (const std::uint32_t c : corners) out_.indices.push_back(base + c);
    // A zero normal is replaced by that of a triangle at the vertex.
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
      for (std::size_t k = 0; k < 3; ++k) {
        glm::vec3& normal = out_.vertices[base + corners[t + k]].normal;
        if (normal == glm::vec3(0.0F)) {
          normal = flat_normal(out_.vertices[base + corners[t]], out_.vertices[base + corners[t + 1]],
                               out_.vertices[base + corners[t + 2]]);
        }
      }
    }
    // Vertices without a triangle are not drawn, but every normal has unit length.
    for (std::size_t i = base; i < out_.vertices.size(); ++i) {
      if (out_.vertices[i].normal == glm::vec3(0.0F)) out_.vertices[i].normal = kUp;
    }
  } else {
    // Without normals, triangles are flat, so each has its own vertices.
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
      std::array<MeshVertex, 3> v = {vertices.at(corners[t]), vertices.at(corners[t + 1]), vertices.at(corners[t + 2])};
      const glm::vec3 normal = flat_normal(v[0], v[1], v[2]);
      for (MeshVertex& one : v) {
        one.normal = normal;
        out_.indices.push_back(static_cast<std::uint32_t>(out_.vertices.size()));
        out_.vertices.push_back(one);
      }
    }
  }
  if (part.index_count > 0) out_.parts.push_back(part);
}

// Returns the vertex indices of a primitive as a list of triangles, whatever its mode.
std::vector<std::uint32_t> GltfReader::triangles(const GltfPrimitive& primitive, const std::string& where,
                                                 std::size_t count) {
  std::vector<std::uint32_t> list;
  if (primitive.indices >= 0) {
    const auto index = static_cast<std::size_t>(primitive.indices);
    const GltfAccessor& accessor = document_.accessors[index];
    const bool whole = accessor.component == GltfComponent::uint8 || accessor.component == GltfComponent::uint16 ||
                       accessor.component == GltfComponent::uint32;
    if (!whole || accessor.components != 1) {
      fail(where + ".indices (" + scene::at("accessors", index) + ") are indices of a wrong type",
           "expected SCALAR unsigned bytes, shorts and ints");
    }
    const GltfValues in = data_.values(index, where + ".indices");
    list.reserve(in.count);
    for (std::size_t i = 0; i < in.count; ++i) {
      const std::uint32_t value = in.whole(i);
      if (value >= count)
        fail(where + " has index " + std::to_string(value) + " of " + std::to_string(count) + " vertices",
             "expected 0 to " + std::to_string(count - 1));
      list.push_back(value);
    }
  } else {
    for (std::size_t i = 0; i < count; ++i) list.push_back(static_cast<std::uint32_t>(i));
  }
  if (primitive.mode == 4) {
    if (list.size() % 3 != 0)
      note_each("corners", where + " has " + std::to_string(list.size()) +
                               " corners, which is not a multiple of 3; the last ones are left out");
    list.resize(list.size() / 3 * 3);
    return list;
  }
  std::vector<std::uint32_t> out;
  for (std::size_t i = 2; i < list.size(); ++i) {
    if (primitive.mode == 6) {
      out.insert(out.end(), {list[0], list[i - 1], list[i]});
    } else if (i % 2 == 0) {
      out.insert(out.end(), {list[i - 2], list[i - 1], list[i]});
    } else {
      out.insert(out.end(), {list[i - 1], list[i - 2], list[i]});
    }
  }
  return out;
}

}  // namespace tyndall::scene
