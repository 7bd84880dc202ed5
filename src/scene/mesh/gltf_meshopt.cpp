#include "scene/mesh/gltf_decoders.hpp"

#ifdef TYNDALL_WITH_MESHOPT
#include <meshoptimizer.h>
#endif

namespace tyndall::scene {

#ifdef TYNDALL_WITH_MESHOPT

std::vector<unsigned char> decode_meshopt(const GltfMeshopt& in, std::span<const unsigned char> bytes,
                                          const std::string& where) {
  // The codecs compress by a factor of at most 64. A larger stated size is refused before memory is allocated.
  constexpr std::size_t kMaxRatio = 64;
  const std::string path = where + ".extensions.EXT_meshopt_compression";
  if (in.count * in.stride / kMaxRatio > bytes.size()) {
    fail(path + " claims " + std::to_string(in.count * in.stride) + " bytes from " + std::to_string(bytes.size()),
         "expected " + std::to_string(kMaxRatio) + " times as many");
  }
  std::vector<unsigned char> out(in.count * in.stride);
  int error = 0;
  switch (in.mode) {
    case GltfMeshopt::Mode::attributes:
      error = meshopt_decodeVertexBuffer(out.data(), in.count, in.stride, bytes.data(), bytes.size());
      break;
    case GltfMeshopt::Mode::triangles:
      error = meshopt_decodeIndexBuffer(out.data(), in.count, in.stride, bytes.data(), bytes.size());
      break;
    case GltfMeshopt::Mode::indices:
      error = meshopt_decodeIndexSequence(out.data(), in.count, in.stride, bytes.data(), bytes.size());
      break;
  }
  if (error != 0) fail(path + " cannot be decoded", "expected the bytes of a meshoptimizer codec");
  switch (in.filter) {
    case GltfMeshopt::Filter::none: break;
    case GltfMeshopt::Filter::octahedral: meshopt_decodeFilterOct(out.data(), in.count, in.stride); break;
    case GltfMeshopt::Filter::quaternion: meshopt_decodeFilterQuat(out.data(), in.count, in.stride); break;
    case GltfMeshopt::Filter::exponential: meshopt_decodeFilterExp(out.data(), in.count, in.stride); break;
  }
  return out;
}

#else

std::vector<unsigned char> decode_meshopt(const GltfMeshopt&, std::span<const unsigned char>,
                                          const std::string& where) {
  fail(where + " is compressed by meshoptimizer, whose decoder this program was built without",
       "expected uncompressed views");
}

#endif

}  // namespace tyndall::scene
