#include "reference/phase.hpp"

#include <functional>

#include "air/phase.hpp"
#include "math/angles.hpp"

namespace tyndall::reference {
namespace {

// The angles of the ends of the bins: t^3 pi up to 30 degrees, and then equal steps.
std::vector<double> bin_angles() {
  constexpr std::size_t kAhead = 3000, kBeyond = 3000;
  constexpr double kTurn = kPi / 6.0;
  std::vector<double> out;
  for (std::size_t i = 0; i < kAhead; ++i) {
    const double t = static_cast<double>(i) / kAhead;
    out.push_back(kTurn * t * t * t);
  }
  for (std::size_t i = 0; i <= kBeyond; ++i) {
    out.push_back(kTurn + (kPi - kTurn) * static_cast<double>(i) / kBeyond);
  }
  return out;
}

}  // namespace

TabulatedPhase::TabulatedPhase(const Params& params, std::span<const double> wavelengths_nm)
    : channels_(wavelengths_nm.size()) {
  const std::vector<double> angles = bin_angles();
  const std::size_t bins = angles.size() - 1;
  std::vector<double> means(angles.size());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    cosines_.push_back(i == bins ? -1.0 : std::cos(angles[i]));
    for (const double nm : wavelengths_nm) {
      values_.push_back(air::phase(params, cosines_.back(), nm));
      means[i] += values_.back() / static_cast<double>(channels_);
    }
  }
  double total = 0.0;
  for (std::size_t i = 0; i < bins; ++i) {
    const double solid_angle = 2.0 * kPi * (cosines_[i] - cosines_[i + 1]);
    densities_.push_back(0.5 * (means[i] + means[i + 1]));
    total += densities_.back() * solid_angle;
  }
  // A tenth of all paths goes anywhere, so that no direction with a small value in the mean, but a larger one at some
  // wavelength, has a large weight.
  double before = 0.0;
  for (std::size_t i = 0; i < bins; ++i) {
    densities_[i] = 0.9 * densities_[i] / total + 0.1 / (4.0 * kPi);
    cumulative_.push_back(before);
    before += densities_[i] * 2.0 * kPi * (cosines_[i] - cosines_[i + 1]);
  }
}

std::size_t TabulatedPhase::bin_of(double cosine) const {
  const auto after = std::lower_bound(cosines_.begin() + 1, cosines_.end() - 1, cosine, std::greater<>());
  return static_cast<std::size_t>(after - cosines_.begin()) - 1;
}

void TabulatedPhase::values(double cosine, std::span<double> channels) const {
  const std::size_t bin = bin_of(cosine);
  const double width = cosines_[bin] - cosines_[bin + 1];
  const double part = width > 0.0 ? std::clamp((cosines_[bin] - cosine) / width, 0.0, 1.0) : 0.0;
  const double* const a = &values_[bin * channels_];
  for (std::size_t c = 0; c < channels_; ++c) channels[c] = std::lerp(a[c], a[c + channels_], part);
}

double TabulatedPhase::density(double cosine) const { return densities_[bin_of(cosine)]; }

double TabulatedPhase::sample(double u) const {
  const auto after = std::upper_bound(cumulative_.begin() + 1, cumulative_.end(), u);
  const auto bin = static_cast<std::size_t>(after - cumulative_.begin()) - 1;
  const double down = (u - cumulative_[bin]) / (2.0 * kPi * densities_[bin]);
  return std::clamp(cosines_[bin] - down, cosines_[bin + 1], cosines_[bin]);
}

}  // namespace tyndall::reference
