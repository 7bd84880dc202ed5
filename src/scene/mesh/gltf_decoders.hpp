// Decoders of compressed geometry: EXT_meshopt_compression through meshoptimizer and KHR_draco_mesh_compression through
// Draco. Both libraries are optional; without one, files that require its extension are refused by name.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scene/mesh/gltf_document.hpp"

namespace tyndall::scene {

#ifdef TYNDALL_WITH_DRACO
constexpr bool kHasDraco = true;
#else
constexpr bool kHasDraco = false;
#endif
#ifdef TYNDALL_WITH_MESHOPT
constexpr bool kHasMeshopt = true;
#else
constexpr bool kHasMeshopt = false;
#endif

// Returns the decompressed bytes of a view, count * stride of them. Throws GltfFailure with `where` in its message.
[[nodiscard]] std::vector<unsigned char> decode_meshopt(const GltfMeshopt& compressed,
                                                        std::span<const unsigned char> bytes, const std::string& where);

struct DracoMesh {
  std::size_t points = 0;
  std::vector<std::uint32_t> corners;                            // three per triangle, each less than `points`
  std::map<std::string, std::vector<unsigned char>> attributes;  // by semantic; elements have the accessor's type
};

// Decodes a primitive that has `draco`. Throws GltfFailure with `where` in its message.
[[nodiscard]] DracoMesh decode_draco(const GltfDocument& document, const GltfPrimitive& primitive,
                                     std::span<const unsigned char> bytes, const std::string& where);

}  // namespace tyndall::scene
