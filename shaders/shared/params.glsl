// The parameter list as GLSL: the structure Params with one member per group, and the values of the enumerations as
// constants (MiePhase_cornette_shanks). Every member consists of four-byte numbers (a vec3 is a float[3]; flags and
// enumerations are uint), so that the std430 layout equals that of tyndall::Params byte for byte. Units and ranges are
// in include/tyndall/params.def.
#ifndef TYNDALL_PARAMS_GLSL
#define TYNDALL_PARAMS_GLSL

#define ENUM_BEGIN(type)
#define ENUM_VALUE(type, identifier, value, text) const uint type##_##identifier = uint(value);
#define ENUM_END(type)
#define GROUP_BEGIN(group, type, title) struct type {
#define GROUP_END(group, type) \
  }                            \
  ;
#define PARAM_FLOAT(group, name, def, min, max, unit, affects, doc) float name;
#define PARAM_UINT(group, name, def, min, max, unit, affects, doc) uint name;
#define PARAM_VEC3(group, name, def, min, max, unit, affects, doc) float name[3];
#define PARAM_UVEC4(group, name, def, min, max, unit, affects, doc) uint name[4];
#define PARAM_FLAG(group, name, def, affects, doc) uint name;
#define PARAM_ENUM(group, name, type, def, affects, doc) uint name;
#include "tyndall/params.def"
#include "tyndall/params_undef.h"

struct Params {
#define ENUM_BEGIN(type)
#define ENUM_VALUE(type, identifier, value, text)
#define ENUM_END(type)
#define GROUP_BEGIN(group, type, title) type group;
#define GROUP_END(group, type)
#define PARAM_FLOAT(group, name, def, min, max, unit, affects, doc)
#define PARAM_UINT(group, name, def, min, max, unit, affects, doc)
#define PARAM_VEC3(group, name, def, min, max, unit, affects, doc)
#define PARAM_UVEC4(group, name, def, min, max, unit, affects, doc)
#define PARAM_FLAG(group, name, def, affects, doc)
#define PARAM_ENUM(group, name, type, def, affects, doc)
#include "tyndall/params.def"
#include "tyndall/params_undef.h"
};

#endif
