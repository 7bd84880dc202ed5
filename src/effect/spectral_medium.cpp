#include "effect/spectral_medium.hpp"

#include "air/coefficients.hpp"
#include "effect/medium.hpp"
#include "effect/wavelengths.hpp"
#include "tyndall/effect.hpp"

namespace tyndall {
namespace {

double dot(const shared::vec4& row, const FourChannels& light) {
  return static_cast<double>(row.x) * light[0] + static_cast<double>(row.y) * light[1] +
         static_cast<double>(row.z) * light[2] + static_cast<double>(row.w) * light[3];
}

}  // namespace

shared::SpectralMedium spectral_medium_from_params(const Params& params) {
  shared::SpectralMedium out = {medium_from_params(params), {}};
  if (params.scattering.color == ColorMode::rgb) return out;
  const shared::vec4& nm = shared::kWavelengths_nm;
  const air::Coefficients channels[] = {air::at_wavelength(params, nm.x), air::at_wavelength(params, nm.y),
                                        air::at_wavelength(params, nm.z), air::at_wavelength(params, nm.w)};
  const auto first_three = [&](double air::Coefficients::*value) {
    return Vec3(static_cast<float>(channels[0].*value), static_cast<float>(channels[1].*value),
                static_cast<float>(channels[2].*value));
  };
  out.rayleigh_scattering = first_three(&air::Coefficients::rayleigh_scattering);
  out.mie_scattering = first_three(&air::Coefficients::mie_scattering);
  out.mie_extinction = first_three(&air::Coefficients::mie_extinction);
  out.ozone_absorption = first_three(&air::Coefficients::ozone_absorption);
  out.ground_albedo = first_three(&air::Coefficients::ground_albedo);
  out.fourth_ground_albedo = static_cast<float>(channels[3].ground_albedo);
  out.fourth_channel = {channels[3].rayleigh_scattering, channels[3].mie_scattering, channels[3].mie_extinction,
                        channels[3].ozone_absorption};
  return out;
}

std::array<double, 3> color_of_light(const FourChannels& light) {
  return {dot(shared::kColorRed, light), dot(shared::kColorGreen, light), dot(shared::kColorBlue, light)};
}

std::array<double, 3> xyz_of_color(const std::array<double, 3>& color) {
  // Linear Rec. 709 to CIE XYZ with the white D65 (IEC 61966-2-1).
  constexpr double kRows[3][3] = {
      {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
  std::array<double, 3> out = {};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[i] += kRows[i][k] * color[k];
  }
  return out;
}

Vec3 sun_color(const Params& params) {
  return params.scattering.color == ColorMode::spectral ? shared::kSunColor : Vec3(1.0F);
}

FourChannels spectral_wavelengths_nm() {
  const shared::vec4& nm = shared::kWavelengths_nm;
  return {nm.x, nm.y, nm.z, nm.w};
}

double sun_luminous_irradiance() { return static_cast<double>(shared::kSunLuminous); }

}  // namespace tyndall
