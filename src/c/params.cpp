// Parameters by name. Names, types and ranges come from params.def through the table of params.hpp.
#include "c/params.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include "c/error.hpp"
#include "c/structures.hpp"
#include "gpu/try.hpp"
#include "tyndall/effect.hpp"
#include "tyndall/phase_table.hpp"

namespace tyndall::c {
namespace {

static_assert(same(TyndallParamType_float32, ParamType::float32) && same(TyndallParamType_uint32, ParamType::uint32) &&
              same(TyndallParamType_flag, ParamType::flag) &&
              same(TyndallParamType_enumeration, ParamType::enumeration) &&
              same(TyndallParamType_vec3, ParamType::vec3) && same(TyndallParamType_uvec4, ParamType::uvec4) &&
              same(TyndallParamType_string, ParamType::string) && same(TyndallParamType_dvec3, ParamType::dvec3));
static_assert(same(TyndallAffects_Frame, Affects::Frame) && same(TyndallAffects_Pipeline, Affects::Pipeline) &&
              same(TyndallAffects_Resources, Affects::Resources) && same(TyndallAffects_Tables, Affects::Tables) &&
              same(TyndallAffects_Everything, Affects::Everything));

// The names of the values of each enumeration, in order of value.
#define ENUM_BEGIN(type) constexpr const char* k##type##Names[] = {
#define ENUM_VALUE(type, identifier, value, text) text,
#define ENUM_END(type) \
  }                    \
  ;
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

// The names of a parameter and of its values, each with a final 0.
struct Names {
  const char* name;  // "group.name"
  std::span<const char* const> choices;
};

// The names of the enumerators, in the order of param_table().
constexpr Names kNames[] = {
#define ENUM_BEGIN(type)
#define ENUM_VALUE(type, identifier, value, text)
#define ENUM_END(type)
#define GROUP_BEGIN(group, type, title)
#define GROUP_END(group, type)
#define PARAM_FLOAT(group, name, def, min, max, unit, affects, doc) {#group "." #name, {}},
#define PARAM_UINT(group, name, def, min, max, unit, affects, doc) {#group "." #name, {}},
#define PARAM_VEC3(group, name, def, min, max, unit, affects, doc) {#group "." #name, {}},
#define PARAM_COLOR(group, name, def, min, max, unit, affects, doc) {#group "." #name, {}},
#define PARAM_UVEC4(group, name, def, min, max, unit, affects, doc) {#group "." #name, {}},
#define PARAM_FLAG(group, name, def, affects, doc) {#group "." #name, {}},
#define PARAM_ENUM(group, name, type, def, affects, doc) {#group "." #name, k##type##Names},
#include "tyndall/params.def"
#include "tyndall/params_undef.h"
};

struct Param {
  const ParamInfo& info;
  std::span<const char* const> choices;
};

// The function of the C interface and the parameter that it was called with, for messages.
struct Name {
  const char* where;
  const char* name;  // of the parameter
};

Error wrong(const Name& at, const std::string& what) { return invalid(at.where, at.name + (" " + what)); }

Result<Param> find(const Name& at) {
  TYNDALL_TRY(check_pointer(at.where, "name", at.name));
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    if (std::strcmp(kNames[i].name, at.name) == 0) return Param{param_table()[i], kNames[i].choices};
  }
  return invalid(at.where, std::string("unknown parameter '") + at.name +
                               "'; expected a name that tyndall_param_info() returns, such as atmosphere.mie_g");
}

std::uint32_t value_count(ParamType type) {
  switch (type) {
    case ParamType::vec3: return 3;
    case ParamType::uvec4: return 4;
    default: return 1;
  }
}

bool is_real(ParamType type) { return type == ParamType::float32 || type == ParamType::vec3; }

// Returns a parameter that consists of `count` numbers.
Result<Param> find_numbers(const Name& at, std::uint32_t count) {
  TYNDALL_ASSIGN(const Param param, find(at));
  if (param.info.type == ParamType::enumeration) {
    return wrong(at, "is an enumeration; expected tyndall_params_set_choice() or tyndall_params_get_choice()");
  }
  const bool grey = param.info.grey && count == 1;
  if (count != value_count(param.info.type) && !grey) {
    return wrong(at, "does not have " + std::to_string(count) + " numbers; expected " +
                         std::to_string(value_count(param.info.type)));
  }
  return param;
}

Result<Param> find_choice(const Name& at) {
  TYNDALL_ASSIGN(const Param param, find(at));
  if (param.info.type == ParamType::enumeration) return param;
  return wrong(at, "is not an enumeration; expected tyndall_params_set_numbers() or tyndall_params_get_numbers()");
}

// Sets the words of a parameter, if its value is then valid.
Result<void> set_words(TyndallParams& params, const ParamInfo& info, const Name& at, const std::uint32_t* words) {
  Params changed = params.params;
  std::memcpy(reinterpret_cast<char*>(&changed) + info.offset, words, value_count(info.type) * sizeof *words);
  if (const Result<void> valid = check_params(changed); !valid.ok()) return invalid(at.where, valid.error().message);
  params.params = changed;
  return {};
}

Result<std::uint32_t> word_of(const ParamInfo& info, const Name& at, double value) {
  std::uint32_t word = 0;
  if (is_real(info.type)) {
    // A finite number that has no single-precision value is out of every range.
    constexpr double kLargest = std::numeric_limits<float>::max();
    const double limited = std::abs(value) > kLargest ? std::copysign(HUGE_VAL, value) : value;
    const auto single = static_cast<float>(limited);
    std::memcpy(&word, &single, sizeof word);
    return word;
  }
  if (!(value >= 0.0 && value <= std::numeric_limits<std::uint32_t>::max()) || value != std::floor(value)) {
    return wrong(at, "is " + std::to_string(value) + "; expected a whole number from " +
                         std::to_string(static_cast<std::uint32_t>(info.min)) + " to " +
                         std::to_string(static_cast<std::uint32_t>(info.max)));
  }
  return static_cast<std::uint32_t>(value);
}

Result<void> set_numbers(TyndallParams* params, const Name& at, const double* values, std::uint32_t count) {
  TYNDALL_TRY(check_pointer(at.where, "params", params));
  TYNDALL_TRY(check_pointer(at.where, "values", values));
  TYNDALL_ASSIGN(const Param param, find_numbers(at, count));
  std::uint32_t words[4] = {};
  for (std::uint32_t i = 0; i < value_count(param.info.type); ++i) {
    TYNDALL_ASSIGN(words[i], word_of(param.info, at, values[count == 1 ? 0 : i]));
  }
  return set_words(*params, param.info, at, words);
}

Result<void> get_numbers(const TyndallParams* params, const Name& at, double* values, std::uint32_t count) {
  TYNDALL_TRY(check_pointer(at.where, "params", params));
  TYNDALL_TRY(check_pointer(at.where, "values", values));
  TYNDALL_ASSIGN(const Param param, find_numbers(at, count));
  const char* bytes = reinterpret_cast<const char*>(&params->params) + param.info.offset;
  if (count < value_count(param.info.type)) {
    Vec3 color;
    std::memcpy(&color, bytes, sizeof color);
    if (color.x != color.y || color.x != color.z) {
      return wrong(at, "has three different values; expected tyndall_params_get_numbers() with 3");
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    float real = 0.0F;
    std::uint32_t whole = 0;
    std::memcpy(&real, bytes + 4 * i, sizeof real);
    std::memcpy(&whole, bytes + 4 * i, sizeof whole);
    values[i] = is_real(param.info.type) ? static_cast<double>(real) : whole;
  }
  return {};
}

Result<void> set_choice(TyndallParams* params, const Name& at, const char* choice) {
  TYNDALL_TRY(check_pointer(at.where, "params", params));
  TYNDALL_TRY(check_pointer(at.where, "choice", choice));
  TYNDALL_ASSIGN(const Param param, find_choice(at));
  for (std::uint32_t i = 0; i < param.choices.size(); ++i) {
    if (std::strcmp(param.choices[i], choice) == 0) return set_words(*params, param.info, at, &i);
  }
  return wrong(at, std::string("cannot be '") + choice + "'; expected " + std::string(param.info.choices));
}

Result<void> get_choice(const TyndallParams* params, const Name& at, const char** choice) {
  TYNDALL_TRY(check_pointer(at.where, "params", params));
  TYNDALL_TRY(check_pointer(at.where, "choice", choice));
  TYNDALL_ASSIGN(const Param param, find_choice(at));
  std::uint32_t word = 0;
  std::memcpy(&word, reinterpret_cast<const char*>(&params->params) + param.info.offset, sizeof word);
  *choice = param.choices[word];
  return {};
}

}  // namespace
}  // namespace tyndall::c

using namespace tyndall;

uint32_t tyndall_param_count(void) { return static_cast<uint32_t>(param_table().size()); }

TyndallStatus tyndall_param_info(uint32_t index, TyndallParamInfo* info) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    if (index >= param_table().size()) {
      return c::invalid(where, "'index' is " + std::to_string(index) + "; expected less than " +
                                   std::to_string(param_table().size()) + ", which tyndall_param_count() returns");
    }
    const ParamInfo& row = param_table()[index];
    TyndallParamInfo out = {};
    out.type = static_cast<TyndallParamType>(row.type);
    out.value_count = c::value_count(row.type);
    out.affects = static_cast<TyndallAffects>(row.affects);
    out.name = c::kNames[index].name;
    out.choices = row.choices.data();
    out.unit = row.unit.data();
    out.doc = row.doc.data();
    out.min = row.min;
    out.max = row.max;
    return c::write(where, out, info);
  });
}

TyndallStatus tyndall_params_create(TyndallParams** params) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "params", params));
    *params = std::make_unique<TyndallParams>().release();
    return {};
  });
}

void tyndall_params_destroy(TyndallParams* params) { const std::unique_ptr<TyndallParams> owned(params); }

TyndallStatus tyndall_params_copy(const TyndallParams* from, TyndallParams* to) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "from", from));
    TYNDALL_TRY(c::check_pointer(where, "to", to));
    *to = *from;
    return {};
  });
}

TyndallStatus tyndall_params_set_number(TyndallParams* params, const char* name, double value) {
  return c::call(__func__, [&](const char* where) { return c::set_numbers(params, {where, name}, &value, 1); });
}

TyndallStatus tyndall_params_set_numbers(TyndallParams* params, const char* name, const double* values,
                                         uint32_t count) {
  return c::call(__func__, [&](const char* where) { return c::set_numbers(params, {where, name}, values, count); });
}

TyndallStatus tyndall_params_set_choice(TyndallParams* params, const char* name, const char* choice) {
  return c::call(__func__, [&](const char* where) { return c::set_choice(params, {where, name}, choice); });
}

TyndallStatus tyndall_params_get_number(const TyndallParams* params, const char* name, double* value) {
  return c::call(__func__, [&](const char* where) { return c::get_numbers(params, {where, name}, value, 1); });
}

TyndallStatus tyndall_params_get_numbers(const TyndallParams* params, const char* name, double* values,
                                         uint32_t count) {
  return c::call(__func__, [&](const char* where) { return c::get_numbers(params, {where, name}, values, count); });
}

TyndallStatus tyndall_params_get_choice(const TyndallParams* params, const char* name, const char** choice) {
  return c::call(__func__, [&](const char* where) { return c::get_choice(params, {where, name}, choice); });
}

TyndallStatus tyndall_params_set_phase_table(TyndallParams* params, const double* angles_deg, uint32_t angle_count,
                                             const double* wavelengths_nm, uint32_t wavelength_count,
                                             const double* values) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "params", params));
    TYNDALL_TRY(c::check_pointer(where, "angles_deg", angles_deg));
    TYNDALL_TRY(c::check_pointer(where, "wavelengths_nm", wavelengths_nm));
    TYNDALL_TRY(c::check_pointer(where, "values", values));
    Result<std::shared_ptr<const PhaseTable>> table =
        PhaseTable::create({angles_deg, angle_count}, {wavelengths_nm, wavelength_count},
                           {values, std::size_t{angle_count} * wavelength_count});
    if (!table.ok()) return c::invalid(where, table.error().message);
    params->params.phase_table = std::move(table).value();
    return {};
  });
}

TyndallStatus tyndall_params_affected(const TyndallParams* before, const TyndallParams* after, uint32_t* mask) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "before", before));
    TYNDALL_TRY(c::check_pointer(where, "after", after));
    TYNDALL_TRY(c::check_pointer(where, "mask", mask));
    *mask = affected(before->params, after->params);
    return {};
  });
}

TyndallStatus tyndall_params_sun_color(const TyndallParams* params, float color[3]) {
  return c::call(__func__, [&](const char* where) -> Result<void> {
    TYNDALL_TRY(c::check_pointer(where, "params", params));
    TYNDALL_TRY(c::check_pointer(where, "color", color));
    const Vec3 sun = sun_color(params->params);
    color[0] = sun.x;
    color[1] = sun.y;
    color[2] = sun.z;
    return {};
  });
}
