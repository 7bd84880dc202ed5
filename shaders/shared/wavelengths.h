// The four wavelengths of scattering.color = spectral, and the matrices between light at them and linear Rec. 709.
// Written by `tools/fit_wavelengths.py --header shaders/shared/wavelengths.h`; docs/spectral.md explains the fit.
#ifndef TYNDALL_SHARED_WAVELENGTHS
#define TYNDALL_SHARED_WAVELENGTHS

const vec4 kWavelengths_nm = vec4(635.0, 575.0, 525.0, 445.0);
// The illuminance of the sun above the atmosphere, on a surface that faces it, over 683 lm/W [W/m^2].
const float kSunLuminous = 194.997471;
// The rows of the matrix from light relative to the sun's to Rec. 709, relative to the sun's luminance.
const vec4 kColorRed = vec4(0.766345756, 0.888975409, -0.613434934, 0.0555431772);
const vec4 kColorGreen = vec4(-0.0433023317, 0.333829693, 0.756282451, -0.0697103418);
const vec4 kColorBlue = vec4(-0.00145442682, -0.130190635, 0.14366075, 0.927797414);
// The columns of the matrix from Rec. 709 to a smooth spectrum.
const vec4 kLiftRed = vec4(0.879951911, 0.307493927, -0.080099702, 0.0569303577);
const vec4 kLiftGreen = vec4(-0.0621007393, 0.738502338, 0.988159744, -0.0494763209);
const vec4 kLiftBlue = vec4(0.101077074, -0.062824365, 0.130210386, 1.04900243);
// The component of light that its colour lacks is dot(kLostInColor, light) times the spectrum kOfLost.
const vec4 kLostInColor = vec4(0.398456352, -0.922875909, 0.705677859, -0.18125838);
const vec4 kOfLost = vec4(0.810905609, -0.511371359, 0.261918448, -0.111041223);
// The colour of the sun above the atmosphere.
const vec3 kSunColor = vec3(1.09742941, 0.97709947, 0.939813102);

#endif
