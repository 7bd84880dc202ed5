#include "reference/spectrum.hpp"

namespace tyndall::reference {
namespace {

constexpr Bin kBins[] = {
#include "reference/bins.inl"
};
static_assert(std::size(kBins) <= kMaxWavelengths);

// Linear Rec. 709 from CIE XYZ with the white D65 (IEC 61966-2-1).
constexpr double kRec709[3][3] = {
    {3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};

}  // namespace

std::span<const Bin> visible_spectrum() { return kBins; }

VisibleSpectrum visible_spectrum_in_rec709() {
  VisibleSpectrum out;
  for (const Bin& bin : kBins) {
    Rgb weight{};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) weight[c] += kRec709[c][k] * bin.xyz[k];
      out.sunlight[c] += weight[c];
    }
    out.nm.push_back(bin.wavelength_nm);
    out.weights.push_back(weight);
  }
  return out;
}

}  // namespace tyndall::reference
