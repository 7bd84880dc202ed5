#include "air/coefficients.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "air/cross_sections.hpp"

namespace tyndall::air {
namespace {

constexpr double kRefractiveIndex = 1.0003;
constexpr double kMoleculesPerM3 = 2.545e25;
constexpr double kDepolarisation = 0.035;
constexpr double kAerosolScatteringPerM = 2.0e-5;  // at aerosol_density 1, the same at every wavelength

// A wavelength, which may be that of a channel.
struct Place {
  static constexpr std::size_t kNoChannel = 3;
  double wavelength_nm;
  std::size_t channel = kNoChannel;
};

double component(const Vec3& v, std::size_t i) { return static_cast<double>(i == 0 ? v.x : i == 1 ? v.y : v.z); }

// The function of the wavelength by which values of the three channels are interpolated and extrapolated.
enum class Between { power, line };

// Beyond the channels, a value follows at most this power of the wavelength, in either direction. Molecules scatter
// with the power -4.1 (Bodhaine et al. 1999), particles that are much smaller than the wavelength with -4, and larger
// ones with about 0. The steepest measured spectra are those of absorption by organic aerosol, with about -7 (Hoffer et
// al. 2006). Without a limit, channels a few nanometres apart would give arbitrary powers.
constexpr double kLargestPower = 8.0;

// Limits a value that was continued from the channel at `end` to a wavelength beyond it.
double continued(double at, double end, double value_at_end, double value) {
  const double factor = std::pow(std::max(at, end) / std::min(at, end), kLargestPower);
  return std::clamp(value, value_at_end / factor, value_at_end * factor);
}

double interpolated(double at, double a, double b, double value_a, double value_b, Between between) {
  if (a == b) return value_a;
  if (between == Between::line) return std::lerp(value_a, value_b, std::clamp((at - a) / (b - a), 0.0, 1.0));
  if (value_a > 0.0 && value_b > 0.0) {
    return value_a * std::pow(at / a, std::log(value_b / value_a) / std::log(b / a));
  }
  return std::max(0.0, std::lerp(value_a, value_b, (at - a) / (b - a)));
}

double value_at(const Params& params, const Vec3& values, const Place& place, Between between) {
  if (place.channel != Place::kNoChannel) return component(values, place.channel);
  struct Node {
    double wavelength_nm, value;
  };
  std::array<Node, 3> nodes;
  for (std::size_t c = 0; c < 3; ++c) {
    nodes[c] = {component(params.atmosphere.wavelengths_nm, c), component(values, c)};
    if (nodes[c].wavelength_nm == place.wavelength_nm) return nodes[c].value;
  }
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const Node& a, const Node& b) { return a.wavelength_nm < b.wavelength_nm; });
  // Two equal channels at an end leave only one interval.
  std::size_t low = place.wavelength_nm < nodes[1].wavelength_nm ? 0 : 1;
  if (nodes[low].wavelength_nm == nodes[low + 1].wavelength_nm) low = 1 - low;
  const Node& a = nodes[low];
  const Node& b = nodes[low + 1];
  const double nm = place.wavelength_nm;
  const double value = interpolated(nm, a.wavelength_nm, b.wavelength_nm, a.value, b.value, between);
  if (between == Between::line) return value;  // is never continued
  if (nm < a.wavelength_nm) return continued(nm, a.wavelength_nm, a.value, value);
  if (nm > b.wavelength_nm) return continued(nm, b.wavelength_nm, b.value, value);
  return value;
}

double rayleigh(const Params& params, const Place& place) {
  const AtmosphereParams& air = params.atmosphere;
  if (air.pressure_hpa > 0.0F) {
    return rayleigh_cross_section_m2(place.wavelength_nm) * molecules_per_m2(air.pressure_hpa) /
           exponential_column_m(params, air.rayleigh_scale_height_m);
  }
  return air.custom_coefficients ? value_at(params, air.rayleigh_scattering, place, Between::power)
                                 : rayleigh_scattering_per_m(place.wavelength_nm);
}

bool covers(const Range& range, double wavelength_nm) {
  return wavelength_nm >= range.from && wavelength_nm <= range.to;
}

// Returns the absorption coefficient of ozone that is given for the three channels. It follows the measured
// cross-sections, scaled by the ratio of what is given to them, because ozone absorbs most between the usual channels.
double ozone_between_channels(const Params& params, const Place& place) {
  const Vec3& nm = params.atmosphere.wavelengths_nm;
  const Vec3& given = params.atmosphere.ozone_absorption;
  for (std::size_t c = 0; c < 3; ++c) {
    if (component(nm, c) == place.wavelength_nm) return component(given, c);
    if (!covers(kOzoneRange, component(nm, c))) return value_at(params, given, place, Between::power);
  }
  const auto ratio = [&](std::size_t c) {
    return static_cast<float>(component(given, c) / (1.0e25 * ozone_cross_section_m2(component(nm, c))));
  };
  const double scale = value_at(params, {ratio(0), ratio(1), ratio(2)}, place, Between::power);
  return scale * 1.0e25 * ozone_cross_section_m2(place.wavelength_nm);
}

double ozone(const Params& params, const Place& place) {
  const AtmosphereParams& air = params.atmosphere;
  if (!(air.ozone_du > 0.0F)) {
    const bool measured = place.channel == Place::kNoChannel && covers(kOzoneRange, place.wavelength_nm);
    return measured ? ozone_between_channels(params, place)
                    : value_at(params, air.ozone_absorption, place, Between::power);
  }
  return ozone_cross_section_m2(place.wavelength_nm) * air.ozone_du * kMoleculesPerDobsonUnit / ozone_column_m(params);
}

struct Aerosol {
  double scattering, extinction;  // 1/m at sea level
};

// Returns the aerosol of the scattering coefficients.
Aerosol aerosol_of_coefficients(const Params& params, const Place& place, double density) {
  const AtmosphereParams& air = params.atmosphere;
  if (!air.custom_coefficients) {
    const double scattering = kAerosolScatteringPerM * density;
    return {scattering, scattering * (1.0 + static_cast<double>(air.aerosol_absorption))};
  }
  const Vec3& s = air.mie_scattering;
  const Vec3& a = air.mie_absorption;
  const Vec3 sum = {s.x + a.x, s.y + a.y, s.z + a.z};
  const double scattering = value_at(params, s, place, Between::power);
  const double extinction = std::max(scattering, value_at(params, sum, place, Between::power));
  return {scattering * density, extinction * density};
}

// Returns the extinction coefficient at sea level of everything but the aerosol, at the wavelength of visibility.
double clear_extinction(const Params& params) {
  const Place place = {kAerosolWavelength_nm};
  const AtmosphereParams& air = params.atmosphere;
  const double layer = std::max(0.0F, 1.0F - air.ozone_centre_m / air.ozone_half_width_m);
  return rayleigh(params, place) + (layer > 0.0 ? layer * ozone(params, place) : 0.0);
}

// Returns the extinction coefficient at sea level at the wavelength of optical depth and visibility, for an aerosol
// whose extinction follows its Angstrom exponent; nothing if that of the coefficients holds.
std::optional<double> reference_extinction(const Params& params) {
  const AtmosphereParams& air = params.atmosphere;
  if (air.aerosol_optical_depth > 0.0F) {
    return air.aerosol_optical_depth / exponential_column_m(params, air.mie_scale_height_m);
  }
  if (air.visibility_m > 0.0F) return std::max(0.0, kKoschmieder / air.visibility_m - clear_extinction(params));
  if (air.angstrom_exponent == 0.0F) return std::nullopt;
  return aerosol_of_coefficients(params, {kAerosolWavelength_nm}, air.aerosol_density).extinction;
}

Aerosol aerosol(const Params& params, const Place& place) {
  const AtmosphereParams& air = params.atmosphere;
  Aerosol out = aerosol_of_coefficients(params, place, air.aerosol_density);
  const std::optional<double> reference = reference_extinction(params);
  const bool albedo_is_set = !(air.single_scattering_albedo == Vec3(0.0F));
  if (!reference && !albedo_is_set) return out;
  if (reference) {
    const double ratio = place.wavelength_nm / kAerosolWavelength_nm;
    out.extinction = *reference * std::pow(ratio, -static_cast<double>(air.angstrom_exponent));
  }
  const Aerosol unit = aerosol_of_coefficients(params, place, 1.0);
  const double albedo = albedo_is_set           ? value_at(params, air.single_scattering_albedo, place, Between::line)
                        : unit.extinction > 0.0 ? unit.scattering / unit.extinction
                                                : 1.0;
  out.scattering = albedo * out.extinction;
  return out;
}

Coefficients at_place(const Params& params, const Place& place) {
  const Aerosol particles = aerosol(params, place);
  return {rayleigh(params, place), particles.scattering, particles.extinction, ozone(params, place),
          value_at(params, params.planet.ground_albedo, place, Between::line)};
}

std::string whole(double value) { return std::to_string(static_cast<long long>(value)); }

Result<void> check_wavelengths(const Params& params, const char* name, const Range& range) {
  for (std::size_t c = 0; c < 3; ++c) {
    const double nm = component(params.atmosphere.wavelengths_nm, c);
    if (covers(range, nm)) continue;
    return Error{ErrorCode::invalid_argument, std::string(name) + " is set, and atmosphere.wavelengths_nm contains " +
                                                  whole(nm) + " nm; expected wavelengths from " + whole(range.from) +
                                                  " to " + whole(range.to) + " nm"};
  }
  return {};
}

}  // namespace

double rayleigh_scattering_per_m(double wavelength_nm) {
  const double n2 = kRefractiveIndex * kRefractiveIndex - 1.0;
  const double king = (6.0 + 3.0 * kDepolarisation) / (6.0 - 7.0 * kDepolarisation);
  const double wavelength_m = wavelength_nm * 1.0e-9;
  const double pi3 = std::numbers::pi * std::numbers::pi * std::numbers::pi;
  return 8.0 * pi3 * n2 * n2 / (3.0 * kMoleculesPerM3) * king / std::pow(wavelength_m, 4);
}

Coefficients in_channel(const Params& params, std::size_t channel) {
  return at_place(params, {component(params.atmosphere.wavelengths_nm, channel), channel});
}

Coefficients at_wavelength(const Params& params, double wavelength_nm) { return at_place(params, {wavelength_nm}); }

Result<Params> with_wavelengths(const Params& params, const std::array<double, 3>& wavelengths_nm) {
  Params out = params;
  AtmosphereParams& air = out.atmosphere;
  const auto floats = [](const std::array<double, 3>& v) {
    return Vec3(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
  };
  air.wavelengths_nm = floats(wavelengths_nm);
  if (params.atmosphere.pressure_hpa > 0.0F) {
    if (Result<void> r = check_wavelengths(out, "atmosphere.pressure_hpa", kRayleighRange); !r)
      return std::move(r).error();
  }
  if (params.atmosphere.ozone_du > 0.0F) {
    if (Result<void> r = check_wavelengths(out, "atmosphere.ozone_du", kOzoneRange); !r) return std::move(r).error();
  }
  std::array<double, 3> rayleigh_at, scattering_at, absorption_at, ozone_at, albedo_at;
  for (std::size_t c = 0; c < 3; ++c) {
    const Coefficients at = at_wavelength(params, wavelengths_nm[c]);
    rayleigh_at[c] = at.rayleigh_scattering;
    scattering_at[c] = at.mie_scattering;
    absorption_at[c] = at.mie_extinction - at.mie_scattering;
    ozone_at[c] = at.ozone_absorption;
    albedo_at[c] = at.ground_albedo;
  }
  air.rayleigh_scattering = floats(rayleigh_at);
  air.mie_scattering = floats(scattering_at);
  air.mie_absorption = floats(absorption_at);
  air.ozone_absorption = floats(ozone_at);
  out.planet.ground_albedo = floats(albedo_at);
  // The coefficients hold as they are.
  air.custom_coefficients = true;
  air.aerosol_density = 1.0F;
  air.aerosol_optical_depth = air.visibility_m = air.angstrom_exponent = air.ozone_du = air.pressure_hpa = 0.0F;
  air.single_scattering_albedo = Vec3(0.0F);
  return out;
}

double exponential_column_m(const Params& params, double scale_height_m) {
  return -scale_height_m * std::expm1(-params.atmosphere.height_m / scale_height_m);
}

double ozone_column_m(const Params& params) {
  const double centre = params.atmosphere.ozone_centre_m, half = params.atmosphere.ozone_half_width_m;
  // The integral of the tent from its lower edge to an altitude.
  const auto below = [&](double altitude_m) {
    const double x = std::clamp((altitude_m - centre) / half, -1.0, 1.0);
    return half * (x < 0.0 ? 0.5 * (1.0 + x) * (1.0 + x) : 1.0 - 0.5 * (1.0 - x) * (1.0 - x));
  };
  return below(params.atmosphere.height_m) - below(0.0);
}

Result<void> check_wavelength(const Params& params, double wavelength_nm) {
  Range range = {100.0, 4000.0};  // as atmosphere.wavelengths_nm
  if (params.atmosphere.pressure_hpa > 0.0F) range = kRayleighRange;
  if (params.atmosphere.ozone_du > 0.0F) range = kOzoneRange;  // lies inside the other ranges
  if (covers(range, wavelength_nm)) return {};
  return Error{ErrorCode::invalid_argument, "a wavelength is " + std::to_string(wavelength_nm) + " nm; expected " +
                                                whole(range.from) + " to " + whole(range.to) +
                                                " nm for the parameters that are set"};
}

Result<void> check(const Params& params) {
  const AtmosphereParams& air = params.atmosphere;
  const auto invalid = [](std::string message) { return Error{ErrorCode::invalid_argument, std::move(message)}; };
  if (air.aerosol_optical_depth > 0.0F && air.visibility_m > 0.0F) {
    return invalid("atmosphere.aerosol_optical_depth and atmosphere.visibility_m are both set; expected one of them, "
                   "and 0 for the "
                   "other");
  }
  if (air.pressure_hpa > 0.0F) {
    if (Result<void> r = check_wavelengths(params, "atmosphere.pressure_hpa", kRayleighRange); !r) return r;
  }
  if (air.ozone_du > 0.0F) {
    if (Result<void> r = check_wavelengths(params, "atmosphere.ozone_du", kOzoneRange); !r) return r;
    if (!(ozone_column_m(params) > 0.0)) {
      return invalid(
          "atmosphere.ozone_du is set, and the ozone layer is above the atmosphere; expected atmosphere.height_m above "
          "its lower edge");
    }
  }
  if (air.visibility_m > 0.0F) {
    const double clear = clear_extinction(params);
    if (clear > 0.0 && air.visibility_m > kKoschmieder / clear) {
      return invalid("atmosphere.visibility_m is " + whole(air.visibility_m) +
                     "; expected at most the visibility without aerosol, " + whole(kKoschmieder / clear) + " m");
    }
  }
  return {};
}

}  // namespace tyndall::air
