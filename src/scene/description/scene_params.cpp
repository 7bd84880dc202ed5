#include "scene/description/scene_params.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <string>
#include <type_traits>

namespace tyndall::scene {
namespace {

static_assert(std::is_standard_layout_v<SceneParams>, "the table holds offsets into it");

// Returns the name of a parameter without the underscore at the end of identifiers that would be keywords.
constexpr std::string_view file_name(std::string_view identifier) {
  if (identifier.ends_with('_')) identifier.remove_suffix(1);
  return identifier;
}

// The choices of each enumeration in order of value, as "name|name|...".
#define ENUM_BEGIN(type) constexpr std::string_view k##type##Choices = ""
#define ENUM_VALUE(type, identifier, value, text) "|" text
#define ENUM_END(type) ;
#define GROUP_BEGIN(group, type, title)
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

constexpr ParamInfo kTable[] = {
#define ENUM_BEGIN(type)
#define ENUM_VALUE(type, identifier, value, text)
#define ENUM_END(type)
#define GROUP_BEGIN(group, type, title)
#define GROUP_END(group, type)
#define AT(group, name) offsetof(SceneParams, group.name)
#define PARAM_FLOAT(group, name, def, min, max, unit, affects, doc) \
  {#group, file_name(#name), ParamType::float32, AT(group, name), min, max, unit, "", Affects::affects, doc},
#define PARAM_UINT(group, name, def, min, max, unit, affects, doc) \
  {#group, file_name(#name), ParamType::uint32, AT(group, name), min, max, unit, "", Affects::affects, doc},
#define PARAM_VEC3(group, name, def, min, max, unit, affects, doc) \
  {#group, file_name(#name), ParamType::vec3, AT(group, name), min, max, unit, "", Affects::affects, doc},
#define PARAM_COLOR(group, name, def, min, max, unit, affects, doc) \
  {#group, file_name(#name), ParamType::vec3, AT(group, name), min, max, unit, "", Affects::affects, doc, true},
#define PARAM_DVEC3(group, name, def, min, max, unit, affects, doc) \
  {#group, file_name(#name), ParamType::dvec3, AT(group, name), min, max, unit, "", Affects::affects, doc},
#define PARAM_UVEC4(group, name, def, min, max, unit, affects, doc) \
  {#group, file_name(#name), ParamType::uvec4, AT(group, name), min, max, unit, "", Affects::affects, doc},
#define PARAM_FLAG(group, name, def, affects, doc) \
  {#group, file_name(#name), ParamType::flag, AT(group, name), 0, 1, "", "", Affects::affects, doc},
#define PARAM_ENUM(group, name, type, def, affects, doc) \
  {#group,                                               \
   file_name(#name),                                     \
   ParamType::enumeration,                               \
   AT(group, name),                                      \
   0,                                                    \
   0,                                                    \
   "",                                                   \
   k##type##Choices.substr(1),                           \
   Affects::affects,                                     \
   doc},
#define PARAM_STRING(group, name, def, unit, affects, doc) \
  {#group, file_name(#name), ParamType::string, AT(group, name), 0, 0, unit, "", Affects::affects, doc},
#include "scene/description/scene_params.def"
#include "tyndall/params_undef.h"
};
#undef AT

bool same_value(const SceneParams& a, const SceneParams& b, const ParamInfo& info) {
  const char* const x = reinterpret_cast<const char*>(&a) + info.offset;
  const char* const y = reinterpret_cast<const char*>(&b) + info.offset;
  switch (info.type) {
    case ParamType::string: return *reinterpret_cast<const std::string*>(x) == *reinterpret_cast<const std::string*>(y);
    case ParamType::vec3: return std::memcmp(x, y, sizeof(Vec3)) == 0;
    case ParamType::dvec3: return std::memcmp(x, y, sizeof(DVec3)) == 0;
    case ParamType::uvec4: return std::memcmp(x, y, sizeof(UVec4)) == 0;
    default: return std::memcmp(x, y, sizeof(float)) == 0;
  }
}

}  // namespace

std::span<const ParamInfo> scene_param_table() { return kTable; }

bool differs(const SceneParams& a, const SceneParams& b, std::string_view group, Affects affects) {
  return std::any_of(std::begin(kTable), std::end(kTable), [&](const ParamInfo& info) {
    return info.group == group && info.affects == affects && !same_value(a, b, info);
  });
}

}  // namespace tyndall::scene
