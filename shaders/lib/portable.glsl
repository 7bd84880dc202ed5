// Macros for code that compiles both as GLSL and as C++ (src/models/glsl_double.hpp), after Bruneton, "Precomputed
// Atmospheric Scattering: a New Implementation" (2017). Code in shaders/lib consists of functions only: no bindings and
// no swizzles. Float literals have a dot and no suffix, and parameters are marked with the macros below. Lengths are in
// m, angles in rad, coefficients in 1/m.
// All functions are accurate in single precision. They subtract altitudes, never squared radii.
#ifndef TYNDALL_LIB_PORTABLE
#define TYNDALL_LIB_PORTABLE

#ifndef __cplusplus
#define IN(type) in type
#define OUT(type) out type
#define INOUT(type) inout type
#endif

#endif
