// The language of shaders/lib: GLSL that C++ compiles too (src/models/glsl_double.hpp), after Bruneton,
// "Precomputed Atmospheric Scattering: a New Implementation" (2017). Functions only: no bindings, no
// swizzles, float literals with a dot and no suffix, parameters marked with the macros below. Lengths in m,
// angles in rad, coefficients in 1/m. Everything holds in single precision: squared radii are never
// subtracted, altitudes are.
#ifndef TYNDALL_LIB_PORTABLE
#define TYNDALL_LIB_PORTABLE

#ifndef __cplusplus
#define IN(type) in type
#define OUT(type) out type
#define INOUT(type) inout type
#endif

#endif
