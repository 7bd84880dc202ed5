#include "scene/description/solar_position.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "files/text.hpp"
#include "scene/description/celestial.hpp"

namespace tyndall::scene {
namespace {

using files::concat;
using files::input_error;
using files::one_line;

// One periodic term: amplitude [1e-8 rad or au] * cos(phase + rate * millennia).
struct Term {
  double amplitude, phase_rad, rate_rad;
};

// Heliocentric longitude, latitude and radius vector of the Earth (VSOP87 as in table A4.2 of the report).
constexpr Term kL0[] = {
    {175347046, 0, 0},           {3341656, 4.6692568, 6283.07585},
    {34894, 4.6261, 12566.1517}, {3497, 2.7441, 5753.3849},
    {3418, 2.8289, 3.5231},      {3136, 3.6277, 77713.7715},
    {2676, 4.4181, 7860.4194},   {2343, 6.1352, 3930.2097},
    {1324, 0.7425, 11506.7698},  {1273, 2.0371, 529.691},
    {1199, 1.1096, 1577.3435},   {990, 5.233, 5884.927},
    {902, 2.045, 26.298},        {857, 3.508, 398.149},
    {780, 1.179, 5223.694},      {753, 2.533, 5507.553},
    {505, 4.583, 18849.228},     {492, 4.205, 775.523},
    {357, 2.92, 0.067},          {317, 5.849, 11790.629},
    {284, 1.899, 796.298},       {271, 0.315, 10977.079},
    {243, 0.345, 5486.778},      {206, 4.806, 2544.314},
    {205, 1.869, 5573.143},      {202, 2.458, 6069.777},
    {156, 0.833, 213.299},       {132, 3.411, 2942.463},
    {126, 1.083, 20.775},        {115, 0.645, 0.98},
    {103, 0.636, 4694.003},      {102, 0.976, 15720.839},
    {102, 4.267, 7.114},
};
constexpr Term kL1[] = {
    {628331966747, 0, 0}, {206059, 2.678235, 6283.07585}, {4303, 2.6351, 12566.1517},
    {425, 1.59, 3.523},   {119, 5.796, 26.298},           {109, 2.966, 1577.344},
};
constexpr Term kL2[] = {{52919, 0, 0}, {8720, 1.0721, 6283.0758}, {309, 0.867, 12566.152}};
constexpr Term kL3[] = {{289, 5.844, 6283.076}};
constexpr Term kL4[] = {{114, 3.142, 0}};
constexpr Term kB0[] = {{280, 3.199, 84334.662}, {102, 5.422, 5507.553}};
constexpr Term kR0[] = {
    {100013989, 0, 0},          {1670700, 3.0984635, 6283.07585}, {13956, 3.05525, 12566.1517},
    {3084, 5.1985, 77713.7715}, {1628, 1.1739, 5753.3849},        {1576, 2.8469, 7860.4194},
};
constexpr Term kR1[] = {{103019, 1.10749, 6283.07585}, {1721, 1.0644, 12566.1517}};
constexpr Term kR2[] = {{4359, 5.7846, 6283.0758}};

double sum(std::span<const Term> terms, double millennia) {
  double total = 0.0;
  for (const Term& term : terms) total += term.amplitude * std::cos(term.phase_rad + term.rate_rad * millennia);
  return 1e-8 * total;
}

// Returns the days from 1970-01-01 to a date of the Gregorian calendar.
std::int64_t days_from_civil(std::int64_t year, std::int64_t month, std::int64_t day) {
  // Years begin in March, so that the leap day comes last.
  const std::int64_t y = month <= 2 ? year - 1 : year;
  const std::int64_t m = month <= 2 ? month + 9 : month - 3;
  return 365 * y + y / 4 - y / 100 + y / 400 + (153 * m + 2) / 5 + day - 1 - 719468;
}

std::int64_t days_in_month(std::int64_t year, std::int64_t month) {
  const std::int64_t next_year = month == 12 ? year + 1 : year;
  return days_from_civil(next_year, month == 12 ? 1 : month + 1, 1) - days_from_civil(year, month, 1);
}

// Reads a text from its front, piece by piece.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  // Reads exactly `digits` digits.
  std::optional<std::int64_t> number(std::size_t digits) {
    if (rest_.size() < digits) return std::nullopt;
    std::int64_t value = 0;
    for (std::size_t i = 0; i < digits; ++i) {
      if (rest_[i] < '0' || rest_[i] > '9') return std::nullopt;
      value = 10 * value + (rest_[i] - '0');
    }
    rest_.remove_prefix(digits);
    return value;
  }
  // Reads one of these characters and returns it; returns 0 if none of them follows.
  char one_of(std::string_view characters) {
    if (rest_.empty() || characters.find(rest_.front()) == std::string_view::npos) return '\0';
    const char found = rest_.front();
    rest_.remove_prefix(1);
    return found;
  }
  // Reads at least one digit after a decimal point and returns the fraction.
  std::optional<double> fraction() {
    double value = 0.0;
    double weight = 0.1;
    std::size_t digits = 0;
    for (std::optional<std::int64_t> digit = number(1); digit; digit = number(1)) {
      value += weight * static_cast<double>(*digit);
      weight *= 0.1;
      ++digits;
    }
    return digits > 0 ? std::optional(value) : std::nullopt;
  }
  [[nodiscard]] bool at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

struct Civil {
  std::int64_t year, month, day, hour, minute, second = 0;
  double fraction_s = 0.0;
  std::int64_t offset_minutes = 0;
  bool has_offset = false;
};

// Reads the numbers of a date and time without checking their ranges. Returns nothing if the text has another form.
std::optional<Civil> read_civil(std::string_view text) {
  Reader reader(text);
  const auto year = reader.number(4);
  const bool dash_1 = reader.one_of("-") != 0;
  const auto month = reader.number(2);
  const bool dash_2 = reader.one_of("-") != 0;
  const auto day = reader.number(2);
  const bool separator = reader.one_of("Tt ") != 0;
  const auto hour = reader.number(2);
  const bool colon = reader.one_of(":") != 0;
  const auto minute = reader.number(2);
  if (!year || !dash_1 || !month || !dash_2 || !day || !separator || !hour || !colon || !minute) return std::nullopt;
  Civil civil = {*year, *month, *day, *hour, *minute};
  if (reader.one_of(":") != 0) {
    const auto second = reader.number(2);
    if (!second) return std::nullopt;
    civil.second = *second;
    if (reader.one_of(".,") != 0) {
      const auto fraction = reader.fraction();
      if (!fraction) return std::nullopt;
      civil.fraction_s = *fraction;
    }
  }
  if (reader.one_of("Zz") != 0) {
    civil.has_offset = true;
  } else if (const char sign = reader.one_of("+-"); sign != 0) {
    const auto hours = reader.number(2);
    if (!hours) return std::nullopt;
    std::int64_t minutes = 0;
    if (!reader.at_end()) {
      static_cast<void>(reader.one_of(":"));
      const auto given = reader.number(2);
      if (!given) return std::nullopt;
      minutes = *given;
    }
    if (*hours > 23 || minutes > 59) return std::nullopt;
    civil.offset_minutes = (sign == '-' ? -1 : 1) * (60 * *hours + minutes);
    civil.has_offset = true;
  }
  return reader.at_end() ? std::optional(civil) : std::nullopt;
}

}  // namespace

double delta_t_s(double year) {
  // Evaluates a polynomial by Horner's rule. The coefficients start with the lowest power.
  const auto polynomial = [](double t, std::initializer_list<double> coefficients) {
    double value = 0.0;
    for (auto c = std::rbegin(coefficients); c != std::rend(coefficients); ++c) value = value * t + *c;
    return value;
  };
  if (year < 1920.0) return polynomial(year - 1900.0, {-2.79, 1.494119, -0.0598939, 0.0061966, -0.000197});
  if (year < 1941.0) return polynomial(year - 1920.0, {21.20, 0.84493, -0.076100, 0.0020936});
  if (year < 1961.0) return polynomial(year - 1950.0, {29.07, 0.407, -1.0 / 233.0, 1.0 / 2547.0});
  if (year < 1986.0) return polynomial(year - 1975.0, {45.45, 1.067, -1.0 / 260.0, -1.0 / 718.0});
  if (year < 2005.0) {
    return polynomial(year - 2000.0, {63.86, 0.3345, -0.060374, 0.0017275, 0.000651814, 0.00002373599});
  }
  if (year < 2050.0) return polynomial(year - 2000.0, {62.92, 0.32217, 0.005589});
  const double u = (year - 1820.0) / 100.0;
  return -20.0 + 32.0 * u * u - 0.5628 * (2150.0 - year);
}

SolarPosition solar_position(const Place& place, double julian_day, double altitude_m) {
  const Epoch time = epoch(julian_day);
  const double t = 0.1 * time.centuries;
  SolarPosition out;

  // The sun seen from the centre of the Earth, on the ecliptic of the date (3.2 to 3.8 of the report).
  const double longitude_rad =
      sum(kL0, t) + t * (sum(kL1, t) + t * (sum(kL2, t) + t * (sum(kL3, t) + t * sum(kL4, t))));
  out.distance_au = sum(kR0, t) + t * (sum(kR1, t) + t * sum(kR2, t));
  const Nutation nutated = nutation(time.centuries);
  const double aberration_deg = -20.4898 * kDegreesPerArcsecond / out.distance_au;
  const double lambda = kRadPerDeg * (longitude_rad / kRadPerDeg + 180.0 + nutated.longitude_deg + aberration_deg);
  const double beta = -sum(kB0, t);
  const double obliquity = kRadPerDeg * obliquity_deg(time.centuries, nutated);
  const Equatorial position = equatorial(lambda, beta, obliquity);
  out.right_ascension_deg = wrapped_degrees(position.right_ascension_rad / kRadPerDeg);
  out.declination_deg = position.declination_rad / kRadPerDeg;

  const double parallax = std::sin(kRadPerDeg * 8.794 * kDegreesPerArcsecond / out.distance_au);
  const Horizontal seen = horizontal(place, altitude_m, time, nutated, obliquity, position, parallax);
  out.elevation_deg = seen.elevation_deg;
  out.azimuth_deg = seen.azimuth_deg;
  return out;
}

Result<Place> parse_place(std::string_view text, std::string_view where) {
  Place place;
  const bool read = files::count_parts(text, ',') == 2 &&
                    files::read_number(files::part(text, ',', 0), place.latitude_deg) == files::NumberError::none &&
                    files::read_number(files::part(text, ',', 1), place.longitude_deg) == files::NumberError::none;
  if (read && std::abs(place.latitude_deg) <= 90.0 && std::abs(place.longitude_deg) <= 360.0) {
    // Maps of the Pacific and many data sets count from 0 to 360.
    place.longitude_deg = std::remainder(place.longitude_deg, 360.0);
    return place;
  }
  return input_error(concat({"'", one_line(text), read ? "' is out of range" : "' is not a place"}), where,
                     "expected LAT,LON in degrees, -90 to 90 northwards and -360 to 360 eastwards");
}

Result<double> parse_time(std::string_view text, std::string_view where) {
  const auto error = [&](std::string_view what, std::string_view allowed) {
    return input_error(concat({"'", one_line(text), "' ", what}), where, allowed);
  };
  const std::optional<Civil> read = read_civil(text);
  if (!read) return error("is not a time", "expected a time as 2003-10-17T12:30:30-07:00 or 2003-10-17T19:30:30.5Z");
  const Civil& civil = *read;
  if (!civil.has_offset) return error("has no offset from UTC", "expected Z or an offset such as +01:00 at the end");
  if (civil.year < 1900 || civil.year > 2100) return error("is out of range", "expected the years 1900 to 2100");
  if (civil.month < 1 || civil.month > 12) return error("has no such month", "expected 01 to 12");
  const std::int64_t last = days_in_month(civil.year, civil.month);
  if (civil.day < 1 || civil.day > last) {
    return error("has no such day", concat({"expected 01 to ", std::to_string(last), " in that month"}));
  }
  // ISO 8601 has 24:00:00 for the end of a day, and a second 60 where a leap second is inserted.
  const bool end_of_day = civil.hour == 24 && civil.minute == 0 && civil.second == 0 && civil.fraction_s == 0.0;
  const bool leap_second = civil.minute == 59 && civil.second == 60;
  if ((civil.hour > 23 && !end_of_day) || civil.minute > 59 || (civil.second > 59 && !leap_second)) {
    return error("has no such time of day", "expected 00:00:00 to 24:00:00, with a fraction");
  }
  const std::int64_t seconds = 60 * (60 * civil.hour + civil.minute - civil.offset_minutes) + civil.second;
  return 2440587.5 + static_cast<double>(days_from_civil(civil.year, civil.month, civil.day)) +
         (static_cast<double>(seconds) + civil.fraction_s) / kSecondsPerDay;
}

}  // namespace tyndall::scene
