// Replaces the reader and the writer of EXR files in a build without OpenEXR.
#include "image/codec.hpp"

namespace tyndall::image {

bool exr_supported() { return false; }

Result<File> decode_exr(std::string_view /*bytes*/, const std::string& path) {
  return check_exr_supported(path).error();
}

Result<void> write_exr(const std::string& path, const Image& /*image*/, const Metadata& /*metadata*/,
                       const ExrOptions& /*options*/) {
  return check_exr_supported(path);
}

Result<files::AtomicFile> prepare_exr(const std::string& path, const Image& /*image*/, const Metadata& /*metadata*/,
                                      const ExrOptions& /*options*/) {
  return check_exr_supported(path).error();
}

}  // namespace tyndall::image
