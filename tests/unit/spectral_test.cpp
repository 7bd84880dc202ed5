// The conversions of scattering.color = spectral: matrices that invert each other, four wavelengths against forty, and
// the colours of measured reflectances behind air.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "air/coefficients.hpp"
#include "effect/spectral_medium.hpp"
#include "effect/wavelengths.hpp"
#include "models/spectral.hpp"
#include "reference/spectrum.hpp"
#include "tyndall/effect.hpp"

// The functions for shaders.
#undef TYNDALL_SHARED_WAVELENGTHS
namespace glsl {
using glm::clamp;
using glm::dot;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
#include "lib/spectral_color.glsl"
}  // namespace glsl

namespace tyndall {
namespace {

using Color = std::array<double, 3>;

struct Patch {
  const char* name;
  std::array<double, 40> reflectance;  // at the wavelengths of reference::visible_spectrum()
};
constexpr Patch kPatches[] = {
#include "reflectances.inl"
};

FourChannels four(const shared::vec4& v) { return {v.x, v.y, v.z, v.w}; }

FourChannels spectrum_of(const Color& color) {
  const FourChannels lift[] = {four(shared::kLiftRed), four(shared::kLiftGreen), four(shared::kLiftBlue)};
  FourChannels out = {};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t c = 0; c < 3; ++c) out[i] += lift[c][i] * color[c];
  }
  return out;
}

// The error of a colour: that of the luminance, relative, and the distance in the CIE 1976 chromaticity diagram.
struct ColorError {
  double luminance, chromaticity;
};
ColorError error_of(const Color& found, const Color& expected) {
  const auto uv = [](const Color& color) {
    const Color xyz = xyz_of_color(color);
    const double sum = xyz[0] + 15.0 * xyz[1] + 3.0 * xyz[2];
    return std::array<double, 2>{4.0 * xyz[0] / sum, 9.0 * xyz[1] / sum};
  };
  const std::array<double, 2> a = uv(found);
  const std::array<double, 2> b = uv(expected);
  return {std::abs(xyz_of_color(found)[1] / xyz_of_color(expected)[1] - 1.0), std::hypot(a[0] - b[0], a[1] - b[1])};
}

struct Statistics {
  double mean, p95;
};
Statistics statistics(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double sum = 0.0;
  for (const double v : values) sum += v;
  return {sum / static_cast<double>(values.size()), values[values.size() * 95 / 100]};
}

// Errors of many colours.
struct Errors {
  std::vector<double> luminance, chromaticity;
  void add(const ColorError& e) {
    luminance.push_back(e.luminance);
    chromaticity.push_back(e.chromaticity);
  }
};

Params spectral_params() {
  Params params;
  params.scattering.color = ColorMode::spectral;
  params.atmosphere.aerosol_optical_depth = 0.2F;
  params.atmosphere.angstrom_exponent = 1.2F;
  params.atmosphere.ozone_du = 300.0F;
  return params;
}

// Returns the medium whose three channels are at these wavelengths.
shared::Medium medium_at(const Params& params, const std::array<double, 3>& nm) {
  const shared::SpectralMedium medium = spectral_medium_from_params(params);
  shared::Medium out = static_cast<const shared::Medium&>(medium);
  const air::Coefficients c[] = {air::at_wavelength(params, nm[0]), air::at_wavelength(params, nm[1]),
                                 air::at_wavelength(params, nm[2])};
  const auto all = [&](double air::Coefficients::*v) {
    return Vec3(static_cast<float>(c[0].*v), static_cast<float>(c[1].*v), static_cast<float>(c[2].*v));
  };
  out.rayleigh_scattering = all(&air::Coefficients::rayleigh_scattering);
  out.mie_scattering = all(&air::Coefficients::mie_scattering);
  out.mie_extinction = all(&air::Coefficients::mie_extinction);
  out.ozone_absorption = all(&air::Coefficients::ozone_absorption);
  return out;
}

struct Spectrum40 {
  std::array<double, 40> radiance = {}, transmittance = {};
};

// Returns single scattering along a ray at all wavelengths.
Spectrum40 at_all_wavelengths(const Params& params, const models::Ray& ray) {
  const auto bins = reference::visible_spectrum();
  Spectrum40 out;
  for (std::size_t first = 0; first < bins.size(); first += 3) {
    std::array<double, 3> nm = {};
    for (std::size_t k = 0; k < 3; ++k) nm[k] = bins[std::min(first + k, bins.size() - 1)].wavelength_nm;
    const models::Answer answer = models::single_scattering(medium_at(params, nm), ray, 12);
    for (std::size_t k = 0; k < 3 && first + k < bins.size(); ++k) {
      out.radiance[first + k] = answer.radiance[k];
      out.transmittance[first + k] = answer.transmittance[k];
    }
  }
  return out;
}

models::Answer at_four_wavelengths(const Params& params, const models::Ray& ray) {
  return models::in_all_channels(params, spectral_medium_from_params(params), [&](const shared::Medium& medium) {
    return models::single_scattering(medium, ray, 12);
  });
}

// Returns the colour of a spectrum relative to the luminance of the sun.
Color color_of_spectrum(const std::array<double, 40>& light) {
  const reference::VisibleSpectrum spectrum = reference::visible_spectrum_in_rec709();
  Color out = {};
  for (std::size_t i = 0; i < light.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) out[c] += spectrum.weights[i][c] * light[i] / sun_luminous_irradiance();
  }
  return out;
}

std::vector<models::Ray> rays() {
  std::vector<models::Ray> out;
  for (const double sun_deg : {0.0, 60.0, 80.0, 86.0, 89.0, 91.0}) {
    for (const double view_deg : {0.0, 60.0, 85.0, 89.0, 120.0}) {
      for (const double altitude_m : {0.0, 10000.0}) {
        out.push_back(models::ray_from_angles(altitude_m, view_deg * std::numbers::pi / 180.0,
                                              sun_deg * std::numbers::pi / 180.0, 0.7));
      }
    }
  }
  return out;
}

TEST(Spectral, TheLiftIsARightInverseAndSmoothForSunlight) {
  for (std::size_t c = 0; c < 3; ++c) {
    Color unit = {};
    unit[c] = 1.0;
    const Color back = color_of_light(spectrum_of(unit));
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(back[k], unit[k], 1e-6);
  }
  const Color sun = color_of_light({1.0, 1.0, 1.0, 1.0});
  EXPECT_NEAR(xyz_of_color(sun)[1], 1.0, 1e-5);
  for (const double channel : spectrum_of(sun)) EXPECT_NEAR(channel, 1.0, 1e-4);
  Params params;
  EXPECT_EQ(sun_color(params), Vec3(1.0F));
  params.scattering.color = ColorMode::spectral;
  EXPECT_NEAR(sun_color(params).x, sun[0], 1e-5);
}

// The texels of the tables of sunlight and sky light lose nothing: light_texel() and light_of_texel() of
// lib/spectral_color.glsl.
TEST(Spectral, LightTexelsHoldAllChannels) {
  const FourChannels lost = four(shared::kLostInColor);
  const FourChannels of_lost = four(shared::kOfLost);
  for (std::size_t i = 0; i < 4; ++i) {
    FourChannels light = {0.1, 0.1, 0.1, 0.1};
    light[i] = 1.0;
    double alpha = 0.0;
    for (std::size_t k = 0; k < 4; ++k) alpha += lost[k] * light[k];
    const FourChannels smooth = spectrum_of(color_of_light(light));
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(smooth[k] + of_lost[k] * alpha, light[k], 1e-5);
  }
}

// The smooth spectra of saturated colours leave the range from 0 to 1: unlimited, yellow would amplify light at 575 nm
// by 1.06.
TEST(Spectral, GlassNeverAmplifiesLight) {
  for (int i = 0; i < 125; ++i) {
    const glm::dvec3 color = glm::dvec3(i % 5, i / 5 % 5, i / 25) / 4.0;
    const glm::dvec4 filter = glsl::spectral_filter(color);
    for (int c = 0; c < 4; ++c) {
      EXPECT_GE(filter[c], 0.0);
      EXPECT_LE(filter[c], 1.0);
    }
  }
  const glm::dvec4 yellow = glsl::spectrum_of_color(glm::dvec3(1.0, 1.0, 0.0) * glsl::kSunColor);
  EXPECT_GT(yellow[1], 1.0);
  const glm::dvec4 clear = glsl::spectral_filter(glm::dvec3(1.0));
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(clear[c], 1.0, 1e-5);
}

// G173 has 133.1 klux above the atmosphere (Gueymard 2004), with the chromaticity of a black body of 5770 K.
// The froxel volume rounds each transmittance to half precision. Behind the first metres of a medium, that makes a grey
// background brighter in a channel with negative weights. The medium is that of a finding in docs/reliability.md.
TEST(Spectral, RoundedTransmittancesBrightenLittle) {
  const glm::dvec4 extinction = {2.80345e-5, 4.16981e-5, 5.99999e-5, 1.16238e-4};
  glm::dvec3 brightest(0.0);
  for (double distance_m = 0.0; distance_m < 40.0; distance_m += 0.001) {
    glm::dvec4 rounded;
    // Half precision has steps of 2^-11 between 0.5 and 1.
    for (int i = 0; i < 4; ++i) rounded[i] = std::round(std::exp(-extinction[i] * distance_m) * 2048.0) / 2048.0;
    brightest = glm::max(brightest, glsl::transmitted_color(glm::dvec3(1.0), rounded));
  }
  EXPECT_NEAR(brightest.r, 1.0003, 5.0e-5);
  EXPECT_LT(brightest.g, 1.0001);
  EXPECT_LE(brightest.b, 1.0);
}

TEST(Spectral, SunlightAboveTheAtmosphere) {
  EXPECT_NEAR(683.0 * sun_luminous_irradiance(), 133.1e3, 0.7e3);
  const Color xyz = xyz_of_color(color_of_light({1.0, 1.0, 1.0, 1.0}));
  EXPECT_NEAR(xyz[0] / (xyz[0] + xyz[1] + xyz[2]), 0.3236, 0.002);
  EXPECT_NEAR(xyz[1] / (xyz[0] + xyz[1] + xyz[2]), 0.3332, 0.002);
}

TEST(Spectral, FourWavelengthsStandForForty) {
  const Params params = spectral_params();
  Errors light, passed;
  for (const models::Ray& ray : rays()) {
    const Spectrum40 truth = at_all_wavelengths(params, ray);
    const models::Answer found = at_four_wavelengths(params, ray);
    if (*std::max_element(truth.radiance.begin(), truth.radiance.end()) > 1e-8)
      light.add(error_of(color_of_light(models::radiance_of(found)), color_of_spectrum(truth.radiance)));
    if (*std::max_element(truth.transmittance.begin(), truth.transmittance.end()) > 1e-4)
      passed.add(error_of(color_of_light(models::transmittance_of(found)), color_of_spectrum(truth.transmittance)));
  }
  EXPECT_LE(statistics(light.luminance).mean, 0.003);
  EXPECT_LE(statistics(light.luminance).p95, 0.01);
  EXPECT_LE(statistics(light.chromaticity).mean, 0.001);
  EXPECT_LE(statistics(light.chromaticity).p95, 0.003);
  // Some of these rays are level, and only the reddest light passes.
  EXPECT_LE(statistics(passed.luminance).mean, 0.003);
  EXPECT_LE(statistics(passed.chromaticity).mean, 0.0015);
  EXPECT_LE(statistics(passed.chromaticity).p95, 0.005);
}

// 24 reflectances in sunlight behind air: the colour without air times the matrix of the four transmittances, against
// the attenuated spectrum.
TEST(Spectral, ColoursBehindAirFollowTheirSpectra) {
  const Params params = spectral_params();
  Errors errors;
  for (const double length_deg : {0.0, 70.0, 85.0}) {
    const models::Ray ray = models::ray_from_angles(0.0, length_deg * std::numbers::pi / 180.0, 0.5, 0.0);
    const Spectrum40 air = at_all_wavelengths(params, ray);
    const FourChannels through = models::transmittance_of(at_four_wavelengths(params, ray));
    for (const Patch& patch : kPatches) {
      std::array<double, 40> seen = {};
      for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = patch.reflectance[i] * air.transmittance[i];
      FourChannels lifted = spectrum_of(color_of_spectrum(patch.reflectance));
      for (std::size_t i = 0; i < 4; ++i) lifted[i] *= through[i];
      errors.add(error_of(color_of_light(lifted), color_of_spectrum(seen)));
    }
  }
  EXPECT_LE(statistics(errors.luminance).mean, 0.01);
  EXPECT_LE(statistics(errors.chromaticity).mean, 0.005);
}

// Coefficients that are given for three channels hold at these channels in both modes.
TEST(Spectral, GivenCoefficientsHoldAtTheirWavelengths) {
  Params params;
  params.scattering.color = ColorMode::spectral;
  params.atmosphere.custom_coefficients = true;
  const shared::vec4& nm = shared::kWavelengths_nm;
  params.atmosphere.wavelengths_nm = {nm.x, nm.y, nm.w};
  params.atmosphere.rayleigh_scattering = {6e-6F, 9e-6F, 30e-6F};
  params.atmosphere.ozone_absorption = {2e-6F, 3e-6F, 1e-7F};
  const shared::SpectralMedium medium = spectral_medium_from_params(params);
  EXPECT_FLOAT_EQ(medium.rayleigh_scattering.x, 6e-6F);
  EXPECT_FLOAT_EQ(medium.rayleigh_scattering.y, 9e-6F);
  EXPECT_FLOAT_EQ(medium.fourth_channel.x, 30e-6F);
  EXPECT_FLOAT_EQ(medium.ozone_absorption.x, 2e-6F);
  EXPECT_FLOAT_EQ(medium.fourth_channel.w, 1e-7F);
  EXPECT_GT(medium.rayleigh_scattering.z, 9e-6F);
  EXPECT_LT(medium.rayleigh_scattering.z, 30e-6F);
}

// The path tracer at any wavelengths agrees with itself at three.
TEST(Spectral, ThePathTracerFollowsAnyWavelengths) {
  Params params;
  params.planet.ground_albedo = Vec3(0.3F);
  const RayQuery query = {100.0, 1.2, 1.3, 0.8, false};
  reference::Options options;
  options.samples = 20000;
  options.orders = 4;
  const Result<reference::Estimate> three = reference::trace(params, query, options);
  const std::array<double, 3> nm = {params.atmosphere.wavelengths_nm.x, params.atmosphere.wavelengths_nm.y,
                                    params.atmosphere.wavelengths_nm.z};
  const std::array<reference::Rgb, 3> identity = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  const auto any = reference::trace_spectrum(params, {nm, identity}, std::span(&query, 1), options);
  ASSERT_TRUE(three.ok() && any.ok());
  for (std::size_t c = 0; c < 3; ++c) {
    const double noise = std::hypot(three.value().standard_error[c], any.value()[0].standard_error[c]);
    EXPECT_GT(noise, 0.0);
    EXPECT_NEAR(any.value()[0].sums[c], three.value().radiance[c], 4.0 * noise);
    EXPECT_NEAR(any.value()[0].radiance[c], any.value()[0].sums[c], 1e-12);
    EXPECT_NEAR(any.value()[0].transmittance[c], three.value().transmittance[c], 1e-12);
  }
  const std::vector<double> many(41, 550.0);
  const std::vector<reference::Rgb> weights(41);
  EXPECT_FALSE(reference::trace_spectrum(params, {many, weights}, std::span(&query, 1), options).ok());
  EXPECT_FALSE(reference::trace_spectrum(params, {nm, {}}, std::span(&query, 1), options).ok());
}

TEST(Spectral, ThePathTracerRefusesWhatHasNoCoefficients) {
  const RayQuery query = {100.0, 1.2, 1.3, 0.8, false};
  reference::Options options;
  options.samples = 1;
  const std::array<reference::Rgb, 1> weights = {{{1.0, 1.0, 1.0}}};
  const auto problem = [&](const Params& params, double nm, const reference::Rgb& weight) {
    const auto found = reference::trace_spectrum(params, {{&nm, 1}, {&weight, 1}}, std::span(&query, 1), options);
    return found.ok() ? std::string() : found.error().message;
  };
  Params params;
  EXPECT_EQ(problem(params, 550.0, weights[0]), "");
  for (const double nm : {0.0, -550.0, 5000.0, std::nan("")}) {
    EXPECT_NE(problem(params, nm, weights[0]).find("nm; expected 100 to 4000 nm"), std::string::npos) << nm;
  }
  EXPECT_NE(problem(params, 550.0, {1.0, std::numeric_limits<double>::infinity(), 0.0}).find("finite"),
            std::string::npos);
  params.atmosphere.ozone_du = 300.0F;
  EXPECT_NE(problem(params, 350.0, weights[0]).find("expected 360 to 840 nm"), std::string::npos);
  params.atmosphere.pressure_hpa = 1000.0F;
  EXPECT_EQ(problem(params, 365.0, weights[0]), "");
  // trace() refuses the same parameters as the effect.
  params = {};
  params.atmosphere.aerosol_optical_depth = 0.1F;
  params.atmosphere.visibility_m = 10000.0F;
  const Result<reference::Estimate> contradiction = reference::trace(params, query, options);
  ASSERT_FALSE(contradiction.ok());
  EXPECT_NE(contradiction.error().message.find("are both set; expected one of them"), std::string::npos);
}

// Single scattering of the path tracer at 40 wavelengths against quadrature at each of them.
TEST(Spectral, ThePathTracerAgreesWithQuadrature) {
  const Params params = spectral_params();
  const RayQuery query = {0.0, 1.4, 1.5, 0.4, false};
  reference::Options options;
  options.samples = 20000;
  options.orders = 1;
  const reference::VisibleSpectrum spectrum = reference::visible_spectrum_in_rec709();
  const auto found = reference::trace_spectrum(params, {spectrum.nm, spectrum.weights}, std::span(&query, 1), options);
  ASSERT_TRUE(found.ok());
  const Color expected = color_of_spectrum(at_all_wavelengths(params, models::ray_from_query(query)).radiance);
  for (std::size_t c = 0; c < 3; ++c) {
    const double error = found.value()[0].standard_error[c];
    EXPECT_NEAR(found.value()[0].sums[c], expected[c] * sun_luminous_irradiance(),
                4.0 * error + 1e-3 * expected[c] * sun_luminous_irradiance());
  }
}

}  // namespace
}  // namespace tyndall
