// The values of the enumerations of include/tyndall/params.def as constants: SingleScattering_table and so on. Uniforms
// and specialisation constants that hold an enumeration are compared with these.
#ifndef TYNDALL_PARAMS_GLSL
#define TYNDALL_PARAMS_GLSL

#define ENUM_BEGIN(type)
#define ENUM_VALUE(type, identifier, value, text) const uint type##_##identifier = uint(value);
#define ENUM_END(type)
#define GROUP_BEGIN(group, type, title)
#define GROUP_END(group, type)
#define PARAM_FLOAT(group, name, def, min, max, unit, affects, doc)
#define PARAM_UINT(group, name, def, min, max, unit, affects, doc)
#define PARAM_VEC3(group, name, def, min, max, unit, affects, doc)
#define PARAM_COLOR(group, name, def, min, max, unit, affects, doc)
#define PARAM_UVEC4(group, name, def, min, max, unit, affects, doc)
#define PARAM_FLAG(group, name, def, affects, doc)
#define PARAM_ENUM(group, name, type, def, affects, doc)
#include "tyndall/params.def"
#include "tyndall/params_undef.h"

#endif
