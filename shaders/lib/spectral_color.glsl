// Conversions between light at the four wavelengths and linear Rec. 709 colours, for shaders that are compiled with the
// macro SPECTRAL. docs/spectral.md derives the matrices.
#ifndef TYNDALL_SPECTRAL_COLOR_GLSL
#define TYNDALL_SPECTRAL_COLOR_GLSL

#include "shared/wavelengths.h"

// Returns the colour of light that is relative to the sun's irradiance above the atmosphere. That sunlight itself has
// the luminance 1.
vec3 spectral_color(vec4 light) { return vec3(dot(kColorRed, light), dot(kColorGreen, light), dot(kColorBlue, light)); }

// Returns a smooth spectrum of a colour, relative to the sun's. spectral_color() is its inverse.
vec4 spectrum_of_color(vec3 color) { return kLiftRed * color.r + kLiftGreen * color.g + kLiftBlue * color.b; }

// Returns the colour of a background behind a medium. It is exactly the background if the medium is clear.
vec3 transmitted_color(vec3 background, vec4 transmittance) {
  return background - spectral_color(spectrum_of_color(background) * (1.0 - transmittance));
}

// Returns the colour of a medium with a mean source function under a sun of a colour, in front of a background:
// sun * spectral_color(source * opacity) + transmitted_color(background, 1 - opacity).
vec3 composed_color(vec4 source, vec4 opacity, vec3 background, vec3 sun) {
  return background + sun * spectral_color(source * opacity) - spectral_color(spectrum_of_color(background) * opacity);
}

// Returns the transmittance of a filter (stained glass) of which the colour is given relative to white. The smooth
// spectrum of a saturated colour leaves the range of a passive filter, so it is clamped to 0 to 1.
vec4 spectral_filter(vec3 color) { return clamp(spectrum_of_color(color * kSunColor), vec4(0.0), vec4(1.0)); }

// The texels of the sun transmittance and sky irradiance tables hold a colour, which the caller's shaders read, and in
// alpha the component of the spectrum that does not change the colour. Both together determine the four wavelengths.
vec4 light_texel(vec4 light) { return vec4(spectral_color(light), dot(kLostInColor, light)); }
vec4 light_of_texel(vec4 texel) { return spectrum_of_color(vec3(texel)) + kOfLost * texel.a; }

#endif
