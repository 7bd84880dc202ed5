#include "air/cross_sections.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>

namespace tyndall::air {
namespace {

constexpr double kCarbonDioxide = 360.0e-6;           // parts per volume
constexpr double kMoleculesPerM3At15C = 2.546899e25;  // at 288.15 K and 1013.25 hPa
constexpr double kAvogadro = 6.02214076e23;           // 1/mol
constexpr double kStandardGravity = 9.80665;          // m/s^2
constexpr double kPascalPerHpa = 100.0;

// Returns the refractive index of dry air minus 1, at 288.15 K and 1013.25 hPa (Bodhaine et al. 1999, equations 18 and
// 19, after Peck and Reeder 1972). x is the squared wavenumber [1/um^2].
double refractivity(double x) {
  const double at_300_ppm = 1.0e-8 * (8060.51 + 2480990.0 / (132.274 - x) + 17455.7 / (39.32957 - x));
  return at_300_ppm * (1.0 + 0.54 * (kCarbonDioxide - 300.0e-6));
}

// Returns the King factor of dry air, which accounts for the anisotropy of its molecules (Bodhaine et al. 1999,
// equations 5, 6 and 23). The parts of the gases are in percent of the volume.
double king_factor(double x) {
  const double nitrogen = 1.034 + 3.17e-4 * x;
  const double oxygen = 1.096 + 1.385e-3 * x + 1.448e-4 * x * x;
  constexpr double kArgon = 1.0, kCo2 = 1.15, kPercentCo2 = 100.0 * kCarbonDioxide;
  return (78.084 * nitrogen + 20.946 * oxygen + 0.934 * kArgon + kPercentCo2 * kCo2) /
         (78.084 + 20.946 + 0.934 + kPercentCo2);
}

// Means over 360 to 370 nm, 370 to 380 nm, ... [1e-25 m^2].
constexpr double kOzone[] = {0.0118, 0.002182, 0.002818, 0.006636, 0.01527, 0.02763, 0.0552, 0.08451, 0.1582, 0.2316,
                             0.3669, 0.4924,   0.7752,   0.9016,   1.48,    1.602,   2.139,  2.755,   3.091,  3.5,
                             4.266,  4.672,    4.398,    4.701,    5.019,   4.305,   3.74,   3.215,   2.662,  2.238,
                             1.852,  1.473,    1.209,    0.9423,   0.7455,  0.6566,  0.5105, 0.415,   0.4228, 0.3237,
                             0.2451, 0.2801,   0.2534,   0.1624,   0.1465,  0.2078,  0.1383, 0.07105};

}  // namespace

double rayleigh_cross_section_m2(double wavelength_nm) {
  const double wavelength_um = wavelength_nm * 1.0e-3;
  const double x = 1.0 / (wavelength_um * wavelength_um);
  const double n = 1.0 + refractivity(x);
  const double n2 = n * n;
  const double wavelength_m = wavelength_nm * 1.0e-9;
  const double ratio = (n2 - 1.0) / (n2 + 2.0) / (wavelength_m * wavelength_m * kMoleculesPerM3At15C);
  return 24.0 * std::pow(std::numbers::pi, 3) * ratio * ratio * king_factor(x);
}

double molecules_per_m2(double pressure_hpa) {
  constexpr double kMolarMass = 1.0e-3 * (15.0556 * kCarbonDioxide + 28.9595);  // kg/mol (equation 17)
  return pressure_hpa * kPascalPerHpa * kAvogadro / (kMolarMass * kStandardGravity);
}

double ozone_cross_section_m2(double wavelength_nm) {
  constexpr double kFirstCentre = 365.0, kStep = 10.0;
  constexpr std::size_t kCount = std::size(kOzone);
  const double at = std::clamp((wavelength_nm - kFirstCentre) / kStep, 0.0, static_cast<double>(kCount - 1));
  const auto below = std::min(static_cast<std::size_t>(at), kCount - 2);
  return 1.0e-25 * std::lerp(kOzone[below], kOzone[below + 1], at - static_cast<double>(below));
}

}  // namespace tyndall::air
