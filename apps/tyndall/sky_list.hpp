// The list of `sky --list`: one sky for each row of a CSV file.
#pragma once

#include <string>
#include <vector>

#include "tyndall/result.hpp"

namespace tyndall::cli {

// The sun's elevation and azimuth [deg].
struct SunAngles {
  double elevation_deg = 0.0, azimuth_deg = 0.0;
};

// A sky of the run.
struct SkyEntry {
  SunAngles sun;
  std::string place, time;  // as given, "LAT,LON" and ISO 8601; empty if the sun is given by its angles
  std::string name;         // name in the row of the list; may be empty
};

// Returns a checksum of everything that the map of an entry takes from the list.
[[nodiscard]] std::string checksum(const SkyEntry& entry);

// Reads the list: columns latitude_deg, longitude_deg and time, or sun_elevation_deg and sun_azimuth_deg, and
// optionally name. `altitude_m` is that of the eye. Every mistake in the file is bad input; the error names line and
// column.
[[nodiscard]] Result<std::vector<SkyEntry>> read_sky_list(const std::string& path, double altitude_m);

}  // namespace tyndall::cli
