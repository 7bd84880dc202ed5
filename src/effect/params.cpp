// The table of the library's parameters and the comparison of two sets, both generated from params.def.
#include "tyndall/params.hpp"

#include <array>
#include <cstring>

#include "effect/phase_rows.hpp"

namespace tyndall {
namespace {

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
#define PARAM_UVEC4(group, name, def, min, max, unit, affects, doc)
#define PARAM_FLAG(group, name, def, affects, doc)
#define PARAM_ENUM(group, name, type, def, affects, doc)
#include "tyndall/params.def"
#include "tyndall/params_undef.h"

constexpr std::size_t value_size(ParamType type) {
  switch (type) {
    case ParamType::vec3: return sizeof(Vec3);
    case ParamType::uvec4: return sizeof(UVec4);
    default: return sizeof(float);
  }
}

constexpr ParamInfo kTable[] = {
#define ENUM_BEGIN(type)
#define ENUM_VALUE(type, identifier, value, text)
#define ENUM_END(type)
#define GROUP_BEGIN(group, type, title)
#define GROUP_END(group, type)
#define OFFSET(group, name) offsetof(Params, group.name)
#define PARAM_FLOAT(group, name, def, min, max, unit, affects, doc) \
  {#group, #name, ParamType::float32, OFFSET(group, name), min, max, unit, "", Affects::affects, doc},
#define PARAM_UINT(group, name, def, min, max, unit, affects, doc) \
  {#group, #name, ParamType::uint32, OFFSET(group, name), min, max, unit, "", Affects::affects, doc},
#define PARAM_VEC3(group, name, def, min, max, unit, affects, doc) \
  {#group, #name, ParamType::vec3, OFFSET(group, name), min, max, unit, "", Affects::affects, doc},
#define PARAM_COLOR(group, name, def, min, max, unit, affects, doc) \
  {#group, #name, ParamType::vec3, OFFSET(group, name), min, max, unit, "", Affects::affects, doc, true},
#define PARAM_UVEC4(group, name, def, min, max, unit, affects, doc) \
  {#group, #name, ParamType::uvec4, OFFSET(group, name), min, max, unit, "", Affects::affects, doc},
#define PARAM_FLAG(group, name, def, affects, doc) \
  {#group, #name, ParamType::flag, OFFSET(group, name), 0, 1, "", "", Affects::affects, doc},
#define PARAM_ENUM(group, name, type, def, affects, doc)              \
  {#group, #name, ParamType::enumeration,     OFFSET(group, name), 0, \
   0,      "",    k##type##Choices.substr(1), Affects::affects,    doc},
#include "tyndall/params.def"
#include "tyndall/params_undef.h"
};

}  // namespace

std::span<const ParamInfo> param_table() { return kTable; }

std::uint32_t affected(const Params& before, const Params& after) {
  std::uint32_t mask = 0;
  const char* a = reinterpret_cast<const char*>(&before);
  const char* b = reinterpret_cast<const char*>(&after);
  for (const ParamInfo& info : kTable) {
    if (std::memcmp(a + info.offset, b + info.offset, value_size(info.type)) != 0) {
      mask |= 1U << static_cast<std::uint32_t>(info.affects);
    }
  }
  if (!same_phase(before, after)) mask |= 1U << static_cast<std::uint32_t>(Affects::Tables);
  return mask;
}

}  // namespace tyndall
