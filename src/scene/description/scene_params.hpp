// SceneParams: every setting of the demo scene (camera, sun, terrain, shadows, tone mapping), generated from the list
// in scene_params.def in the same way as tyndall::Params, and the table that describes them. Angles are in degrees, as
// in files; the scene converts them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "tyndall/params.hpp"

namespace tyndall::scene {

#define ENUM_BEGIN(type) enum class type : std::uint32_t {
#define ENUM_VALUE(type, identifier, value, text) identifier = value,
#define ENUM_END(type) \
  }                    \
  ;
#define GROUP_BEGIN(group, type, title) struct type {
#define GROUP_END(group, type) \
  }                            \
  ;
#define PARAM_FLOAT(group, name, def, min, max, unit, affects, doc) float name = static_cast<float>(def);
#define PARAM_UINT(group, name, def, min, max, unit, affects, doc) std::uint32_t name = def;
#define PARAM_VEC3(group, name, def, min, max, unit, affects, doc) Vec3 name = Vec3 def;
#define PARAM_COLOR(group, name, def, min, max, unit, affects, doc) Vec3 name = Vec3 def;
#define PARAM_DVEC3(group, name, def, min, max, unit, affects, doc) DVec3 name = DVec3 def;
#define PARAM_UVEC4(group, name, def, min, max, unit, affects, doc) UVec4 name = UVec4 def;
#define PARAM_FLAG(group, name, def, affects, doc) Flag name = def;
#define PARAM_ENUM(group, name, type, def, affects, doc) type name = type::def;
#define PARAM_STRING(group, name, def, unit, affects, doc) std::string name = def;
#include "scene/description/scene_params.def"
#include "tyndall/params_undef.h"

struct SceneParams {
#define ENUM_BEGIN(type)
#define ENUM_VALUE(type, identifier, value, text)
#define ENUM_END(type)
#define GROUP_BEGIN(group, type, title) type group;
#define GROUP_END(group, type)
#define PARAM_FLOAT(group, name, def, min, max, unit, affects, doc)
#define PARAM_UINT(group, name, def, min, max, unit, affects, doc)
#define PARAM_VEC3(group, name, def, min, max, unit, affects, doc)
#define PARAM_COLOR(group, name, def, min, max, unit, affects, doc)
#define PARAM_DVEC3(group, name, def, min, max, unit, affects, doc)
#define PARAM_UVEC4(group, name, def, min, max, unit, affects, doc)
#define PARAM_FLAG(group, name, def, affects, doc)
#define PARAM_ENUM(group, name, type, def, affects, doc)
#define PARAM_STRING(group, name, def, unit, affects, doc)
#include "scene/description/scene_params.def"
#include "tyndall/params_undef.h"
};

// Returns the rows that describe SceneParams, in the order of scene_params.def. Offsets are from the start of
// SceneParams; at the offset of a row of type string there is a std::string.
[[nodiscard]] std::span<const ParamInfo> scene_param_table();

// Returns whether a parameter of `group` that declares `affects` has different values.
[[nodiscard]] bool differs(const SceneParams& a, const SceneParams& b, std::string_view group, Affects affects);

}  // namespace tyndall::scene
