// Reads elevation files of any format and projection that GDAL supports into a raster of square cells around the centre
// of the file, in the azimuthal equidistant projection on a sphere that the terrain uses. Latitudes and longitudes are
// copied from the file's ellipsoid to the sphere without conversion.
//
// What the file does not say is assumed, and `notes` report it:
// - no georeferencing (e.g. a 16-bit PNG): samples 30 m apart, north up, heights in metres;
// - a geotransform without a coordinate system: as ElevationRequest::units says; automatic takes degrees on WGS 84
//   if it lies within ±360 and ±90 with samples less than one degree apart and does not begin at 0,0, else metres;
// - no vertical unit: that of the vertical coordinate system if there is one, else metres.
// The band's scale, offset, unit (metres, feet, US survey feet, and decimal multiples) and no-data value are
// honoured. NaN, infinite and impossible heights (beyond ±20 km) are holes too; holes are filled from
// their borders. Undeclared samples of -9999 and the like are holes when they lie far from all others. Of several
// bands the first is read, but colour tiles (Terrarium, Terrain-RGB) are decoded and other colour images refused. Files
// larger than max_samples on a side are read at a lower resolution. The latitudes and
// longitudes of a file of another celestial body are used as they are.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/description/scene_params.hpp"
#include "scene/description/solar_position.hpp"
#include "tyndall/result.hpp"

namespace tyndall::scene {

struct ElevationRaster {
  int width = 0, height = 0;   // samples, each at least 2
  double spacing_m = 0.0;      // of samples, both ways
  std::vector<float> heights;  // [m] above sea level, row-major, the northernmost row first
  float min_m = 0.0F, max_m = 0.0F;
  std::optional<Place> centre;     // latitude and longitude on the Earth, where the file has a coordinate system
  std::vector<std::string> notes;  // one line each: assumptions and changes
};

constexpr int kMaxElevationSamples = 8192;

struct ElevationRequest {
  double planet_radius_m = 6360000.0;
  int max_samples = kMaxElevationSamples;  // on a side
  TerrainUnits units = TerrainUnits::automatic;
};

// Reads `source`: a file, or one of GDAL's own names (/vsizip/..., /vsicurl/..., NETCDF:...).
// Errors: no such file, a directory, empty, in no format that is read, truncated, smaller than 2 x 2 samples,
// complex numbers, nothing but holes, latitudes beyond 90 degrees, extents that no planet has, a picture.
// Prints nothing. Memory: about 12 bytes per sample of the result.
Result<ElevationRaster> read_elevation_file(const std::string& source, const ElevationRequest& request = {});

// Returns `source` and the other files that reading it reads, as far as its format lists them: auxiliary files, and
// what a virtual raster refers to.
[[nodiscard]] std::vector<std::string> elevation_file_list(const std::string& source);

}  // namespace tyndall::scene
