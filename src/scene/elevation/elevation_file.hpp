// Elevation files of any format and projection that GDAL reads, as a square-celled raster around the
// centre of the file, azimuthal equidistant on a sphere, as the terrain's map is. Latitudes and longitudes
// are carried over from the file's ellipsoid to the sphere as they are.
//
// What the file leaves out is assumed, and said in `notes`:
// - no georeferencing (e.g. a 16-bit PNG): samples 30 m apart, north up, heights in metres;
// - a geotransform without a coordinate system: degrees on WGS 84 if it lies within ±360 and ±90 with
//   samples less than one degree apart, else metres;
// - no vertical unit: that of the vertical coordinate system if there is one, else metres.
// The band's scale, offset, unit (metres, feet, US survey feet, and decimal multiples) and no-data value are
// honoured. NaN, infinite and impossible heights (beyond ±20 km) are holes too; holes are filled from
// their borders. Of several bands the first is read. Files larger than max_samples on a side are read at a
// lower resolution.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tyndall/result.hpp"

namespace tyndall::scene {

struct ElevationRaster {
  int width = 0, height = 0;   // samples, each at least 2
  double spacing_m = 0.0;      // of samples, both ways
  std::vector<float> heights;  // m above sea level, row-major, north row first
  float min_m = 0.0F, max_m = 0.0F;
  std::vector<std::string> notes;  // one line each: what was assumed or changed in reading
};

constexpr int kMaxElevationSamples = 8192;

// Errors: no such file, a directory, empty, in no known format, truncated, smaller than 2 x 2 samples,
// complex numbers, nothing but holes. Prints nothing. Memory: about 12 bytes per sample of the result.
Result<ElevationRaster> read_elevation_file(const std::filesystem::path& path, double planet_radius_m,
                                            int max_samples = kMaxElevationSamples);

}  // namespace tyndall::scene
