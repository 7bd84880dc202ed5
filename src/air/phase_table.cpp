#include "tyndall/phase_table.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "math/angles.hpp"

namespace tyndall {
namespace {

constexpr double kTolerance = 0.1;  // of the integral over the sphere
constexpr std::size_t kMinAngles = 3, kMaxAngles = 10'000, kMaxWavelengths = 1000;

// A number without trailing zeros.
std::string text(double value) {
  std::string out = std::to_string(value);
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return out;
}

Error invalid(const std::string& what, const std::string& expected) {
  return {ErrorCode::invalid_argument, "phase table: " + what + "; expected " + expected};
}

Result<void> check_list(std::span<const double> list, const std::string& name, double min, double max) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (!(list[i] >= min && list[i] <= max)) {
      return invalid("invalid " + name + " " + text(list[i]), text(min) + " to " + text(max));
    }
    if (i > 0 && !(list[i] > list[i - 1])) {
      return invalid(name + " " + text(list[i]) + " follows " + text(list[i - 1]), "increasing values");
    }
  }
  return {};
}

Result<void> check_input(std::span<const double> angles_deg, std::span<const double> wavelengths_nm,
                         std::span<const double> values) {
  if (angles_deg.size() < kMinAngles || angles_deg.size() > kMaxAngles) {
    return invalid(std::to_string(angles_deg.size()) + " angles", "3 to 10000");
  }
  if (wavelengths_nm.empty() || wavelengths_nm.size() > kMaxWavelengths) {
    return invalid(std::to_string(wavelengths_nm.size()) + " wavelengths", "1 to 1000");
  }
  if (values.size() != angles_deg.size() * wavelengths_nm.size()) {
    return invalid(std::to_string(values.size()) + " values", "one for each angle and wavelength");
  }
  if (Result<void> angles = check_list(angles_deg, "angle", 0.0, 180.0); !angles) return angles;
  if (Result<void> nm = check_list(wavelengths_nm, "wavelength", 100.0, 100'000.0); !nm) return nm;
  if (angles_deg.front() != 0.0) {
    return invalid("the first angle is " + text(angles_deg.front()) + " degrees", "0");
  }
  if (angles_deg.back() != 180.0) {
    return invalid("the last angle is " + text(angles_deg.back()) + " degrees", "180");
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= 0.0 && values[i] <= 1e12) continue;
    return invalid("invalid value " + text(values[i]) + " at " + text(angles_deg[i / wavelengths_nm.size()]) +
                       " degrees and " + text(wavelengths_nm[i % wavelengths_nm.size()]) + " nm",
                   "0 or more");
  }
  return {};
}

}  // namespace

double PhaseTable::between(double angle_rad, std::size_t segment, std::size_t column) const {
  const std::size_t columns = wavelengths_.size();
  const double a = values_[segment * columns + column];
  const double b = values_[(segment + 1) * columns + column];
  const double part = (angle_rad - angles_[segment]) / (angles_[segment + 1] - angles_[segment]);
  return a > 0.0 && b > 0.0 ? a * std::pow(b / a, part) : std::lerp(a, b, part);
}

double PhaseTable::integral(std::size_t column, int power) const {
  // Gauss-Legendre rule with four nodes on [0; 1], on two halves of each segment.
  constexpr double kNode[] = {0.069431844202974, 0.330009478207572, 0.669990521792428, 0.930568155797026};
  constexpr double kWeight[] = {0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727};
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < angles_.size(); ++i) {
    const double half = 0.5 * (angles_[i + 1] - angles_[i]);
    for (std::size_t k = 0; k < 8; ++k) {
      const double angle = angles_[i] + half * (static_cast<double>(k / 4) + kNode[k % 4]);
      const double factor = power == 0 ? 1.0 : std::cos(angle);
      sum += half * kWeight[k % 4] * factor * std::sin(angle) * between(angle, i, column);
    }
  }
  return 2.0 * kPi * sum;
}

Result<std::shared_ptr<const PhaseTable>> PhaseTable::create(std::span<const double> angles_deg,
                                                             std::span<const double> wavelengths_nm,
                                                             std::span<const double> values) {
  if (Result<void> valid = check_input(angles_deg, wavelengths_nm, values); !valid) return std::move(valid).error();
  PhaseTable table;
  table.wavelengths_.assign(wavelengths_nm.begin(), wavelengths_nm.end());
  table.values_.assign(values.begin(), values.end());
  for (const double angle : angles_deg) table.angles_.push_back(angle * (kPi / 180.0));
  for (std::size_t k = 0; k < wavelengths_nm.size(); ++k) {
    const double total = table.integral(k, 0);
    const double from_one = std::abs(total - 1.0);
    const double from_sphere = std::abs(total / (4.0 * kPi) - 1.0);
    const double deviation = std::min(from_one, from_sphere);
    if (!(deviation <= kTolerance)) {
      return invalid("the integral over the sphere is " + text(total) + " at " + text(wavelengths_nm[k]) + " nm",
                     "1 or 12.566371 (4 pi) within 10 %");
    }
    table.deviation_ = std::max(table.deviation_, deviation);
    for (std::size_t i = 0; i < angles_deg.size(); ++i) table.values_[i * wavelengths_nm.size() + k] /= total;
    table.asymmetry_.push_back(table.integral(k, 1));
  }
  return std::shared_ptr<const PhaseTable>(std::make_shared<PhaseTable>(std::move(table)));
}

template <typename OfColumn>
double PhaseTable::at_wavelength(double wavelength_nm, const OfColumn& of_column) const {
  const auto right = std::upper_bound(wavelengths_.begin(), wavelengths_.end(), wavelength_nm);
  if (right == wavelengths_.begin()) return of_column(std::size_t{0});
  const auto column = static_cast<std::size_t>(right - wavelengths_.begin()) - 1;
  if (right == wavelengths_.end()) return of_column(column);
  const double part = (wavelength_nm - wavelengths_[column]) / (wavelengths_[column + 1] - wavelengths_[column]);
  return std::lerp(of_column(column), of_column(column + 1), part);
}

double PhaseTable::operator()(double cosine, double wavelength_nm) const {
  // The angle from both half angles, because the arc cosine loses digits near its ends.
  const double c = std::clamp(cosine, -1.0, 1.0);
  const double angle = 2.0 * std::atan2(std::sqrt(1.0 - c), std::sqrt(1.0 + c));
  const auto above = std::upper_bound(angles_.begin() + 1, angles_.end() - 1, angle);
  const auto segment = static_cast<std::size_t>(above - angles_.begin()) - 1;
  return at_wavelength(wavelength_nm, [&](std::size_t column) { return between(angle, segment, column); });
}

double PhaseTable::asymmetry(double wavelength_nm) const {
  return at_wavelength(wavelength_nm, [&](std::size_t column) { return asymmetry_[column]; });
}

}  // namespace tyndall
