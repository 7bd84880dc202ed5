// Elevation files, read by GDAL from memory. The first byte chooses the file's ending, by which some drivers recognise
// their format.
#include "scene/elevation/elevation_file.hpp"

#include <cpl_vsi.h>

#include <array>
#include <cmath>

#include "fuzz.hpp"
#include "scene/elevation/elevation_gdal.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tyndall;
  constexpr std::array<const char*, 12> kEndings = {"tif", "asc", "hgt", "png", "dem", "grd",
                                                    "xyz", "bil", "dt0", "ter", "img", "nc"};
  if (size < 2) return -1;
  // libnetcdf 4.9 crashes on damaged counts, which the child process of read_elevation_file() turns into an error.
  if (fuzz::text_of(data + 1, size - 1).starts_with("CDF")) return -1;
  const std::string name = std::string("/vsimem/fuzz.") + kEndings[data[0] % kEndings.size()];
  VSIFCloseL(VSIFileFromMemBuffer(name.c_str(), const_cast<GByte*>(data + 1), size - 1, FALSE));
  scene::ElevationRequest request;
  request.max_samples = 64;
  const Result<scene::ElevationRaster> read = scene::read_elevation_here(name, request);
  VSIUnlink(name.c_str());
  if (!read) {
    fuzz::require(!read.error().message.empty(), "the error has a message");
    return 0;
  }
  const scene::ElevationRaster& raster = read.value();
  fuzz::require(raster.width >= 2 && raster.height >= 2 && raster.width <= 64 && raster.height <= 64,
                "the raster has the requested size");
  fuzz::require(raster.heights.size() == std::size_t(raster.width) * std::size_t(raster.height),
                "the raster is complete");
  fuzz::require(raster.spacing_m > 0.0 && std::isfinite(raster.spacing_m), "the samples have a distance");
  for (const float height : raster.heights) {
    fuzz::require(std::abs(static_cast<double>(height)) <= scene::kMaxElevation_m + 1.0,
                  "heights are finite and possible");
  }
  return 0;
}
