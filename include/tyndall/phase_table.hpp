// PhaseTable: a phase function of the aerosol that was measured or computed, by scattering angle and wavelength.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "tyndall/export.h"
#include "tyndall/result.hpp"

namespace tyndall {

// Immutable, so threads may share it. Its values are normalised: their integral over the sphere is 1 at every
// wavelength.
class TYNDALL_API PhaseTable {
 public:
  // Makes a table of values[i * wavelengths_nm.size() + k] at the scattering angle i [degrees] and the wavelength k
  // [nm]. The scattering angle is 0 for light that goes straight ahead. Both lists increase strictly; the angles begin
  // with 0 and end with 180, and there are 3 to 10 000 of them. There are 1 to 1000 wavelengths. The integral of the
  // values over the sphere must be 1 or 4 pi within 10 %, at every wavelength, and no value may be negative.
  // Errors: invalid_argument.
  static Result<std::shared_ptr<const PhaseTable>> create(std::span<const double> angles_deg,
                                                          std::span<const double> wavelengths_nm,
                                                          std::span<const double> values);

  // Returns the phase function [1/sr] at the cosine of a scattering angle. Between two angles, its logarithm is linear
  // in the angle; next to a value of 0, the function itself is. Between wavelengths it is linear, and beyond them
  // constant.
  [[nodiscard]] double operator()(double cosine, double wavelength_nm) const;

  // Returns the mean cosine of the scattering angle, linear between wavelengths.
  [[nodiscard]] double asymmetry(double wavelength_nm) const;

  // Returns the largest relative deviation of the given values' integral from 1 or 4 pi, at any wavelength.
  [[nodiscard]] double deviation() const { return deviation_; }

  bool operator==(const PhaseTable& other) const {
    return angles_ == other.angles_ && wavelengths_ == other.wavelengths_ && values_ == other.values_;
  }

 private:
  PhaseTable() = default;
  [[nodiscard]] double between(double angle_rad, std::size_t segment, std::size_t column) const;
  // Returns the integral over the sphere of the function times the cosine to the power of `power`.
  [[nodiscard]] double integral(std::size_t column, int power) const;
  // Returns a quantity at a wavelength from its values at the wavelengths of the table.
  template <typename OfColumn>
  [[nodiscard]] double at_wavelength(double wavelength_nm, const OfColumn& of_column) const;

  std::vector<double> angles_;       // [rad]
  std::vector<double> wavelengths_;  // [nm]
  std::vector<double> values_;       // [1/sr]
  std::vector<double> asymmetry_;    // of each wavelength
  double deviation_ = 0.0;
};

}  // namespace tyndall
