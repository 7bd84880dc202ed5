// Replaces the reader of elevation files in a build without GDAL.
#include "scene/elevation/elevation_file.hpp"

namespace tyndall::scene {

bool elevation_files_supported() { return false; }

Result<ElevationRaster> read_elevation_file(const std::string& source, const ElevationRequest& /*request*/) {
  return Error{ErrorCode::invalid_argument,
               "terrain.source: built without GDAL; elevation files cannot be read: '" + source +
                   "'; expected procedural or none",
               0};
}

std::vector<std::string> elevation_file_list(const std::string& source) { return {source}; }

}  // namespace tyndall::scene
