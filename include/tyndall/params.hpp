// Params: all settings of the effect, generated from the list in params.def, and a table that describes each of them
// (name, type, unit, range, meaning) for command lines, files and user interfaces.
// Values are in SI units. Angles in files, and parameters whose names end in _deg, are in degrees.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "tyndall/export.h"
#include "tyndall/result.hpp"
#include "tyndall/types.hpp"

namespace tyndall {

// The part of the effect that must be replaced when a parameter changes, besides the constants of the next frame
// (Frame): pipelines, buffers (Resources, possibly with pipelines), tables, or all of them (Everything).
// Effect::set_params() prepares only that.
enum class Affects : std::uint32_t { Frame, Pipeline, Resources, Tables, Everything };

enum class ParamType : std::uint32_t { float32, uint32, flag, enumeration, vec3, uvec4, string, dvec3 };

// One row of a parameter table. `min` and `max` bound every component of numbers.
struct ParamInfo {
  std::string_view group;
  std::string_view name;
  ParamType type;
  std::size_t offset;        // bytes from the start of the structure that the table describes
  double min, max;           // numbers only
  std::string_view unit;     // numbers only; "1" has no dimension
  std::string_view choices;  // enumerations only: the names, separated by '|', in order of value
  Affects affects;
  std::string_view doc;
  bool grey = false;  // vec3 only: a single value may be given for all three components
};

namespace detail {
// Makes a Vec3 of the numbers of params.def without a warning about their conversion.
constexpr Vec3 single_precision(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}
}  // namespace detail

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
#define PARAM_VEC3(group, name, def, min, max, unit, affects, doc) Vec3 name = detail::single_precision def;
#define PARAM_COLOR(group, name, def, min, max, unit, affects, doc) Vec3 name = detail::single_precision def;
#define PARAM_UVEC4(group, name, def, min, max, unit, affects, doc) UVec4 name = UVec4 def;
#define PARAM_FLAG(group, name, def, affects, doc) Flag name = def;
#define PARAM_ENUM(group, name, type, def, affects, doc) type name = type::def;
#include "tyndall/params.def"
#include "tyndall/params_undef.h"

class PhaseTable;

struct Params {
#define ENUM_BEGIN(type)
#define ENUM_VALUE(type, identifier, value, text)
#define ENUM_END(type)
#define GROUP_BEGIN(group, type, title) type group;
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
  // The phase function if atmosphere.mie_phase is table (tyndall/phase_table.hpp). With other values of mie_phase it is
  // not read and may be null. It is not in param_table().
  std::shared_ptr<const PhaseTable> phase_table = nullptr;
};

// Returns the rows that describe Params, in the order of params.def. Offsets are from the start of Params.
[[nodiscard]] TYNDALL_API std::span<const ParamInfo> param_table();

// Returns what the change from `before` to `after` requires: a mask of bits 1 << Affects.
[[nodiscard]] TYNDALL_API std::uint32_t affected(const Params& before, const Params& after);

// Returns an error (invalid_argument) that names the first parameter that is out of range, not finite, or not one
// of the values allowed for it (scattering.downscale, tables.size). Needs no device. Limits of the device itself,
// such as the largest 3D image, are checked by Effect::create() and Effect::set_params().
[[nodiscard]] TYNDALL_API Result<void> check_params(const Params& params);

}  // namespace tyndall
