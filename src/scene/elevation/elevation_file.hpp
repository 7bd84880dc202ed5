// Reads elevation files of any format and projection that GDAL supports into a raster of square cells around the centre
// of the file, in the azimuthal equidistant projection on a sphere that the terrain uses. Latitudes and longitudes are
// copied from the file's ellipsoid to the sphere without conversion.
//
// Missing properties of a file are assumed and reported in `notes`:
// - no georeferencing (e.g. a 16-bit PNG): samples 30 m apart, north up, heights in metres;
// - a geotransform without a coordinate system: see ElevationRequest::units. `automatic` assumes degrees on WGS 84 if
//   the extent is within ±360 and ±90, samples are less than one degree apart and it does not begin at 0,0; otherwise
//   metres;
// - no vertical unit: that of the vertical coordinate system if there is one, otherwise metres.
// The band's scale, offset, unit (metres, feet, US survey feet, and decimal multiples) and no-data value are used. NaN,
// infinite and impossible heights (beyond ±25 km), and masked or transparent samples, are holes, too. Holes are filled
// from their borders. Undeclared samples of -9999 and similar values are holes if they are far from all other values.
// If there are several bands, the first is read, but colour tiles (Terrarium, Terrain-RGB) are decoded and other colour
// images are refused. Files with more than max_samples on a side are read at a lower resolution. The latitudes and
// longitudes of a file of another celestial body are used unchanged.
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
  double spacing_m = 0.0;      // distance between samples in both directions
  std::vector<float> heights;  // [m] above sea level, row-major, the northernmost row first
  float min_m = 0.0F, max_m = 0.0F;
  std::optional<Place> centre;     // latitude and longitude on the Earth, where the file has a coordinate system
  std::vector<std::string> notes;  // one line each: assumptions and changes
};

constexpr int kMaxElevationSamples = 8192;
constexpr double kMaxElevation_m = 25000.0;  // greater heights and depths are holes; Olympus Mons has 21.2 km

struct ElevationRequest {
  double planet_radius_m = 6360000.0;
  int max_samples = kMaxElevationSamples;  // limit for each side
  TerrainUnits units = TerrainUnits::automatic;
};

// Reads `source`: a file, or a name of GDAL (/vsizip/..., /vsicurl/..., NETCDF:...). Errors: the file does not exist,
// is a directory, is empty or truncated, has an unsupported format, fewer than 2 x 2 samples, complex numbers, only
// holes, latitudes beyond 90 degrees or an impossible extent, or is a picture. Prints nothing. Needs about 12 bytes of
// memory per sample of the result. GDAL runs in a child process with limits of its own, because some of its drivers
// crash on damaged files; that is an error of the file here.
Result<ElevationRaster> read_elevation_file(const std::string& source, const ElevationRequest& request = {});

// Returns whether the program was built with GDAL. Without it, read_elevation_file() refuses every file.
[[nodiscard]] bool elevation_files_supported();

// Returns `source` and all other files that are read with it, as far as its format lists them: auxiliary files and the
// sources of a virtual raster.
[[nodiscard]] std::vector<std::string> elevation_file_list(const std::string& source);

}  // namespace tyndall::scene
