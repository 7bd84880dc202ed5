// The lists of `sky --list`: the angles of the sun are finite and possible, and a list that is written from them is
// read back unchanged.
#include "sky_list.hpp"

#include <cmath>

#include "cli.hpp"
#include "files/text.hpp"
#include "fuzz.hpp"

namespace {

using namespace tyndall;

std::string csv_quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) out.append(c == '"' ? 2 : 1, c);
  return out + "\"";
}

// Returns the list as a file. The place "LAT,LON" has one comma.
std::string written(const std::vector<cli::SkyEntry>& skies) {
  const bool by_place = !skies[0].place.empty();
  std::string out = by_place ? "name,time,latitude_deg,longitude_deg\n" : "sun_azimuth_deg,name,sun_elevation_deg\n";
  for (const cli::SkyEntry& sky : skies) {
    out += by_place ? files::concat({csv_quoted(sky.name), ",", csv_quoted(sky.time), ",", sky.place, "\n"})
                    : files::concat({files::number_text(sky.sun.azimuth_deg), ",", csv_quoted(sky.name), ",",
                                     files::number_text(sky.sun.elevation_deg), "\n"});
  }
  return out;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  const std::string path = folder.write("skies.csv", fuzz::text_of(data, size));
  for (const double altitude_m : {0.0, cli::kLowestAltitude_m, 400000.0}) {
    const Result<std::vector<cli::SkyEntry>> skies = cli::read_sky_list(path, altitude_m);
    if (!skies) {
      fuzz::require_one_line(skies.error());
      continue;
    }
    fuzz::require(!skies.value().empty(), "there is a sky");
    for (const cli::SkyEntry& sky : skies.value()) {
      fuzz::require(std::abs(sky.sun.elevation_deg) <= 90.0, "the sun has a possible elevation");
      fuzz::require(std::abs(sky.sun.azimuth_deg) <= 3600.0, "the sun has a possible azimuth");
    }
    const Result<std::vector<cli::SkyEntry>> again =
        cli::read_sky_list(folder.write("again.csv", written(skies.value())), altitude_m);
    fuzz::require(again.ok() && again.value().size() == skies.value().size(), "a written list is read back");
    for (std::size_t i = 0; i < skies.value().size(); ++i) {
      const cli::SkyEntry &a = skies.value()[i], &b = again.value()[i];
      fuzz::require(a.name == b.name && a.time == b.time && a.place == b.place, "the texts are read back");
      fuzz::require(a.sun.elevation_deg == b.sun.elevation_deg && a.sun.azimuth_deg == b.sun.azimuth_deg,
                    "the angles are read back");
    }
  }
  return 0;
}
