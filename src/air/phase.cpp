#include "air/phase.hpp"

#include <cmath>

#include "math/angles.hpp"
#include "tyndall/phase_table.hpp"

namespace tyndall::air {
namespace {

// (1 - g^2) / (4 pi (1 + g^2 - 2 g c)^1.5), without cancellation where the base is small.
double henyey_greenstein(double cosine, double g) {
  const double base =
      g >= 0.0 ? (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - cosine) : (1.0 + g) * (1.0 + g) - 2.0 * g * (1.0 + cosine);
  return 0.25 / kPi * (1.0 - g * g) / (base * std::sqrt(base));
}

}  // namespace

double DropletPhase::operator()(double cosine) const {
  const double shape = (1.0 + alpha * cosine * cosine) / (1.0 + alpha * (1.0 + 2.0 * g_draine * g_draine) / 3.0);
  return (1.0 - weight) * henyey_greenstein(cosine, g_henyey_greenstein) +
         weight * henyey_greenstein(cosine, g_draine) * shape;
}

DropletPhase droplet_phase(double d) {
  const double l = std::log(d);
  if (d <= 0.1) {
    return {13.8 * d * d, 1.1456 * d * std::sin(9.29044 * d), 250.0, 0.252977 - 312.983 * std::pow(d, 4.3)};
  }
  if (d < 1.5) {
    const double inner = std::cos((l - 0.238604) * (l + 1.00667) / (0.507522 - 0.15677 * l));
    return {0.862 - 0.143 * l * l, 0.379685 * std::cos(1.19692 * inner + 1.37932 * l + 0.0625835) + 0.344213, 250.0,
            0.146209 * std::cos(3.38707 * l + 2.11193) + 0.316072 + 0.0778917 * l};
  }
  if (d < 5.0) {
    const double ll = std::log(l);
    return {0.0604931 * ll + 0.940256, 0.500411 - 0.081287 / (-2.0 * l + std::tan(l) + 1.27551), 7.30354 * l + 6.31675,
            0.026914 * (l - std::cos(5.68947 * (ll - 0.0292149))) + 0.376475};
  }
  return {std::exp(-0.0990567 / (d - 1.67154)), std::exp(-2.20679 / (d + 3.91029) - 0.428934),
          std::exp(3.62489 - 8.29288 / (d + 5.52825)), std::exp(-0.599085 / (d - 0.641583) - 0.665888)};
}

double phase(const Params& params, double cosine, double wavelength_nm) {
  if (params.atmosphere.mie_phase == MiePhase::table) return (*params.phase_table)(cosine, wavelength_nm);
  return droplet_phase(static_cast<double>(params.atmosphere.droplet_diameter_um))(cosine);
}

double asymmetry(const Params& params, double wavelength_nm) {
  if (params.atmosphere.mie_phase == MiePhase::table) return params.phase_table->asymmetry(wavelength_nm);
  const DropletPhase d = droplet_phase(static_cast<double>(params.atmosphere.droplet_diameter_um));
  const double g = d.g_draine;
  // The mean cosine of Draine's function (Draine 2003, equation 5).
  const double draine = g * (1.0 + d.alpha * (3.0 + 2.0 * g * g) / 5.0) / (1.0 + d.alpha * (1.0 + 2.0 * g * g) / 3.0);
  return (1.0 - d.weight) * d.g_henyey_greenstein + d.weight * draine;
}

double channel_wavelength_nm(const Params& params, std::size_t channel) {
  const Vec3& nm = params.atmosphere.wavelengths_nm;
  return static_cast<double>(channel == 0 ? nm.x : channel == 1 ? nm.y : nm.z);
}

}  // namespace tyndall::air
