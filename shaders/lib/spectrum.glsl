// The type of everything that carries light: radiance, transmittance, coefficients. A shader is compiled once for
// scattering.color = rgb, where a Spectrum has three channels, and once with the macro SPECTRAL for spectral, where it
// has the four wavelengths of shared/wavelengths.h, in decreasing order (docs/spectral.md). In C++ a Spectrum has three
// channels. Colours of the caller (images, glass) and of the output are vec3 in both modes.
#ifndef TYNDALL_LIB_SPECTRUM
#define TYNDALL_LIB_SPECTRUM

#ifdef SPECTRAL

#include "lib/spectral_color.glsl"

#define Spectrum vec4
// Structures have room for three channels of a quantity. The fourth is stored elsewhere.
#define RAYLEIGH_SCATTERING(m) vec4((m).rayleigh_scattering, (m).fourth_channel.x)
#define MIE_SCATTERING(m) vec4((m).mie_scattering, (m).fourth_channel.y)
#define MIE_EXTINCTION(m) vec4((m).mie_extinction, (m).fourth_channel.z)
#define OZONE_ABSORPTION(m) vec4((m).ozone_absorption, (m).fourth_channel.w)
#define GROUND_ALBEDO(m) vec4((m).ground_albedo, (m).fourth_ground_albedo)
// The channels of a vector with four components. In rgb, the fourth may have another meaning.
#define CHANNELS(v) (v)
#define OUTER_CHANNELS(v) (v).xw
#define LARGEST(v) max(max((v).x, (v).y), max((v).z, (v).w))
#define SMALLEST(v) min(min((v).x, (v).y), min((v).z, (v).w))
#define EACH_CHANNEL(f, v) vec4(f((v).x), f((v).y), f((v).z), f((v).w))
// The vec4 that stores a spectrum. `w` is stored with the three channels of rgb.
#define STORED(v, w) (v)
// The colour of light relative to the sun's, and the colour that a coloured background has behind the medium.
#define COLOR(light) spectral_color(light)
#define TRANSMITTED(background, transmittance) transmitted_color(background, transmittance)
// The colour of a medium with a mean source function under a sun of a colour, in front of a background.
#define COMPOSED(source, transmittance, opacity, background, sun) composed_color(source, opacity, background, sun)
#define FILTER(color) spectral_filter(color)
// The texels of the sun transmittance and sky irradiance tables.
#define LIGHT_TEXEL(light) light_texel(light)
#define LIGHT_OF_TEXEL(texel) light_of_texel(texel)

#else

#ifdef __cplusplus
typedef vec3 Spectrum;
#else
#define Spectrum vec3
#endif
#define RAYLEIGH_SCATTERING(m) (m).rayleigh_scattering
#define MIE_SCATTERING(m) (m).mie_scattering
#define MIE_EXTINCTION(m) (m).mie_extinction
#define OZONE_ABSORPTION(m) (m).ozone_absorption
#define GROUND_ALBEDO(m) (m).ground_albedo
#define CHANNELS(v) (v).rgb
#define OUTER_CHANNELS(v) (v).xz
#define LARGEST(v) max((v).x, max((v).y, (v).z))
#define SMALLEST(v) min((v).x, min((v).y, (v).z))
#define EACH_CHANNEL(f, v) vec3(f((v).x), f((v).y), f((v).z))
#define STORED(v, w) vec4(v, w)
#define COLOR(light) (light)
#define TRANSMITTED(background, transmittance) (background) * (transmittance)
#define COMPOSED(source, transmittance, opacity, background, sun) \
  ((source) * (opacity) * (sun) + (background) * (transmittance))
#define FILTER(color) (color)
#define LIGHT_TEXEL(light) (light)
#define LIGHT_OF_TEXEL(texel) (texel).rgb

#endif

#endif
