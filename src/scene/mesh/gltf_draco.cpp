#include "scene/mesh/gltf_decoders.hpp"

#ifdef TYNDALL_WITH_DRACO
#include <draco/compression/decode.h>
#endif

namespace tyndall::scene {

#ifdef TYNDALL_WITH_DRACO

namespace {

draco::DataType data_type(GltfComponent component) {
  switch (component) {
    case GltfComponent::int8: return draco::DT_INT8;
    case GltfComponent::uint8: return draco::DT_UINT8;
    case GltfComponent::int16: return draco::DT_INT16;
    case GltfComponent::uint16: return draco::DT_UINT16;
    case GltfComponent::uint32: return draco::DT_UINT32;
    case GltfComponent::float32: return draco::DT_FLOAT32;
  }
  return draco::DT_INVALID;
}

}  // namespace

DracoMesh decode_draco(const GltfDocument& document, const GltfPrimitive& primitive,
                       std::span<const unsigned char> bytes, const std::string& where) {
  const std::string path = where + ".extensions.KHR_draco_mesh_compression";
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    fail(path + " cannot be decoded: " + decoded.status().error_msg_string(), "expected a whole Draco mesh");
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  DracoMesh out;
  out.points = mesh->num_points();
  if (out.points == 0 || out.points > kMaxMeshVertices || mesh->num_faces() > kMaxMeshIndices / 3) {
    fail(path + " has " + std::to_string(out.points) + " vertices",
         "expected 1 to " + std::to_string(kMaxMeshVertices));
  }
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
    for (const draco::PointIndex& corner : mesh->face(f)) {
      if (corner.value() >= out.points) fail(path + " is damaged", "expected corners that are vertices");
      out.corners.push_back(corner.value());
    }
  }
  for (const auto& [semantic, number] : primitive.draco->attributes) {
    const GltfAccessor& accessor = document.accessors[static_cast<std::size_t>(primitive.attributes.at(semantic))];
    const draco::PointAttribute* const attribute = mesh->GetAttributeByUniqueId(number);
    const std::string name = path + ".attributes." + semantic;
    if (attribute == nullptr)
      fail(name + " is " + std::to_string(number), "expected the numbers of attributes in the Draco mesh");
    if (attribute->data_type() != data_type(accessor.component) || attribute->num_components() != accessor.components) {
      fail(name + " has another type than its accessor", "expected equal types");
    }
    if (accessor.count != out.points) {
      fail(name + " has " + std::to_string(out.points) + " elements",
           "expected the " + std::to_string(accessor.count) + " of its accessor");
    }
    const std::size_t element = bytes_of(accessor.component) * static_cast<std::size_t>(accessor.components);
    std::vector<unsigned char>& values = out.attributes[semantic];
    values.resize(out.points * element);
    for (std::size_t i = 0; i < out.points; ++i) {
      const draco::AttributeValueIndex value =
          attribute->mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
      if (value.value() >= attribute->size()) fail(name + " is damaged", "expected a value for each vertex");
      attribute->GetValue(value, values.data() + i * element);
    }
  }
  return out;
}

#else

DracoMesh decode_draco(const GltfDocument&, const GltfPrimitive&, std::span<const unsigned char>,
                       const std::string& where) {
  fail(where + " is compressed by Draco, whose decoder this program was built without", "expected uncompressed meshes");
}

#endif

}  // namespace tyndall::scene
