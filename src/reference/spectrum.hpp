// The wavelengths at which trace_spectrum() represents the visible spectrum by default, and their colours.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "reference/path_tracer.hpp"

namespace tyndall::reference {

// A bin of the spectrum around a wavelength.
struct Bin {
  double wavelength_nm;
  // Weights in CIE XYZ (1931, 2 degrees) over 683 lm/W, of light relative to the sun's irradiance above the atmosphere:
  // the product of solar irradiance, colour-matching function and width of the bin [W/m^2].
  std::array<double, 3> xyz;
};
[[nodiscard]] std::span<const Bin> visible_spectrum();

// The bins as arguments of trace_spectrum(), with weights for linear Rec. 709 in the unit of Bin::xyz.
struct VisibleSpectrum {
  std::vector<double> nm;
  std::vector<Rgb> weights;
  Rgb sunlight{};  // the colour of the sun above the atmosphere, which is the sum of the weights
};
[[nodiscard]] VisibleSpectrum visible_spectrum_in_rec709();

}  // namespace tyndall::reference
