// Places and times as text, and the position of the sun that follows from them. The first line is the time, the second
// the place.
#include <cmath>

#include "fuzz.hpp"
#include "scene/description/solar_position.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tyndall;
  const std::string_view text = fuzz::text_of(data, size);
  const std::size_t end = std::min(text.find('\n'), text.size());
  const Result<double> time = scene::parse_time(text.substr(0, end), "--time");
  const Result<scene::Place> place = scene::parse_place(text.substr(std::min(end + 1, text.size())), "--at");
  if (!time) fuzz::require_one_line(time.error());
  if (!place) fuzz::require_one_line(place.error());
  if (!time || !place) return 0;
  const scene::SolarPosition sun = scene::solar_position(place.value(), time.value());
  fuzz::require(std::abs(sun.elevation_deg) <= 90.0, "the sun has an elevation");
  fuzz::require(sun.azimuth_deg >= 0.0 && sun.azimuth_deg < 360.0, "the sun has an azimuth");
  fuzz::require(sun.distance_au > 0.98 && sun.distance_au < 1.02, "the sun has its distance");
  return 0;
}
