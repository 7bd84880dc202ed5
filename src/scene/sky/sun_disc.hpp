// Limb darkening of the sun: I(x) / I(0) = mu^alpha with mu = sqrt(1 - x^2) at the fraction x of the angular radius,
// where alpha depends on the wavelength (Hestroffer, Magnan, "Wavelength dependency of the Solar limb darkening", 1998,
// eq. 4). shaders/scene/background.frag uses the same function.
#pragma once

#include <algorithm>

namespace tyndall::scene {

// Returns the exponent alpha; the fit is valid from 416 to 1099 nm.
inline float limb_exponent(float wavelength_nm) {
  const float um = std::clamp(wavelength_nm, 303.0F, 1099.0F) * 1e-3F;
  return um < 0.422F ? 0.6F : -0.023F + 0.292F / um;
}

}  // namespace tyndall::scene
