// The joint parameter table, and conversion between values and text.
#include "config/settings.hpp"

#include <algorithm>
#include <cstring>
#include <optional>

#include "files/text.hpp"
#include "scene/description/camera_exposure.hpp"
#include "scene/description/model_registry.hpp"
#include "scene/description/placed_sun.hpp"
#include "tyndall/version.hpp"

namespace tyndall::config {
namespace {

constexpr std::string_view kLost = "see 'tyndall params'";

std::byte* address(Settings& settings, const Row& row) {
  std::byte* const base = row.owner == Owner::effect ? reinterpret_cast<std::byte*>(&settings.effect)
                                                     : reinterpret_cast<std::byte*>(&settings.scene);
  return base + row.info.offset;
}

const std::byte* address(const Settings& settings, const Row& row) {
  return address(const_cast<Settings&>(settings), row);
}

template <typename T>
T read_bytes(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

// Returns the expected number of components in words, as in "expects 3 numbers".
std::string expected(const Row& row) {
  const std::size_t count = component_count(row.info.type);
  const std::string_view kind = is_real(row.info.type) ? "number" : "whole number";
  if (count == 1) return files::concat({"one ", kind});
  return files::concat({row.info.grey ? "1 or " : "", std::to_string(count), " ", kind, "s"});
}

Error bad_value(const Row& row, std::string_view value, std::string_view problem, std::string_view where) {
  return files::input_error(files::concat({"'", row.key(), "' = '", files::one_line(value), "' ", problem}), where,
                            files::concat({"expected ", allowed_text(row)}));
}

// Returns the size of one component of a number [bytes].
std::size_t component_size(ParamType type) { return type == ParamType::dvec3 ? sizeof(double) : sizeof(float); }

// Parses one component of a number and writes its stored form to `to`.
Result<void> store_number(const Row& row, std::string_view text, std::string_view where, std::byte* to) {
  files::NumberError problem = files::NumberError::none;
  std::uint64_t bits = 0;
  bool inside = false;
  if (row.info.type == ParamType::dvec3) {
    double value = 0.0;
    problem = files::read_number(text, value);
    inside = value >= row.info.min && value <= row.info.max;
    std::memcpy(&bits, &value, sizeof(value));
  } else if (is_real(row.info.type)) {
    float value = 0.0F;
    problem = files::read_number(text, value);
    inside = value >= static_cast<float>(row.info.min) && value <= static_cast<float>(row.info.max);
    std::memcpy(&bits, &value, sizeof(value));
  } else {
    std::int64_t value = 0;
    problem = files::read_integer(text, value);
    inside = value >= static_cast<std::int64_t>(row.info.min) && value <= static_cast<std::int64_t>(row.info.max);
    const auto whole = static_cast<std::uint32_t>(value);
    std::memcpy(&bits, &whole, sizeof(whole));
  }
  if (problem == files::NumberError::not_finite) return bad_value(row, text, "is not a finite number", where);
  if (problem == files::NumberError::not_a_number)
    return bad_value(row, text, files::concat({"is not ", expected(row)}), where);
  if (problem == files::NumberError::too_large || !inside) return bad_value(row, text, "is out of range", where);
  std::memcpy(to, &bits, component_size(row.info.type));
  return {};
}

std::optional<std::uint32_t> flag_value(std::string_view text) {
  if (text == "true" || text == "on" || text == "1") return 1U;
  if (text == "false" || text == "off" || text == "0") return 0U;
  return std::nullopt;
}

// Returns the index of `text` among the choices. Enumerations count from 0 in the order of their names.
std::optional<std::uint32_t> choice_value(const Row& row, std::string_view text) {
  for (std::uint32_t i = 0; i < files::count_parts(row.info.choices, '|'); ++i) {
    if (files::part(row.info.choices, '|', i) == text) return i;
  }
  return std::nullopt;
}

// Removes repeated groups. A group that is in both lists is placed where the second list has it.
std::vector<Group> without_repetitions(const std::vector<Group>& groups) {
  std::vector<Group> out;
  for (const Group& group : groups) {
    std::erase_if(out, [&](const Group& before) { return before.name == group.name; });
    out.push_back(group);
  }
  return out;
}

std::vector<std::string> all_keys() {
  std::vector<std::string> keys;
  for (const Row& row : rows()) keys.push_back(row.key());
  return keys;
}

}  // namespace

std::size_t component_count(ParamType type) {
  return type == ParamType::vec3 || type == ParamType::dvec3 ? 3 : type == ParamType::uvec4 ? 4 : 1;
}

bool is_real(ParamType type) {
  return type == ParamType::float32 || type == ParamType::vec3 || type == ParamType::dvec3;
}

bool is_vector(ParamType type) { return component_count(type) > 1; }

std::string Row::key() const { return files::concat({info.group, ".", info.name}); }

const std::vector<Row>& rows() {
  static const std::vector<Row> all = [] {
    std::vector<Row> joined;
    for (const ParamInfo& info : scene::scene_param_table()) joined.push_back({info, Owner::scene});
    for (const ParamInfo& info : param_table()) joined.push_back({info, Owner::effect});
    return joined;
  }();
  return all;
}

const std::vector<Group>& groups() {
  static const std::vector<Group> all = without_repetitions({
#define ENUM_BEGIN(type)
#define ENUM_VALUE(type, identifier, value, text)
#define ENUM_END(type)
#define GROUP_BEGIN(group, type, title) {#group, title},
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
#include "tyndall/params.def"
#include "tyndall/params_undef.h"
  });
  return all;
}

const Row* find_row(std::string_view key) {
  const std::vector<Row>& all = rows();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Row& row) { return row.key() == key; });
  return found == all.end() ? nullptr : &*found;
}

Error unknown_key(std::string_view key, std::string_view where) {
  const std::string what = files::concat({"unknown parameter '", files::one_line(key), "'"});
  const std::size_t dot = key.find('.');
  const std::string_view group = dot == std::string_view::npos ? std::string_view() : key.substr(0, dot);
  const std::string_view name = dot == std::string_view::npos ? key : key.substr(dot + 1);
  // The nearest complete key, unless the name exists in one or more other groups.
  std::optional<std::string> near;
  int same_name = 0;
  for (const Row& row : rows()) {
    if (row.info.name != name) continue;
    ++same_name;
    near = near ? files::concat({*near, "' or '", row.key()}) : row.key();
  }
  if (same_name != 1 && same_name != 2) near = files::nearest(key, all_keys());
  if (near) return files::input_error(what, where, files::concat({"did you mean '", *near, "'?"}));
  std::string members;
  for (const Row& row : rows()) {
    if (row.info.group == group) members.append(members.empty() ? "" : ", ").append(row.info.name);
  }
  if (!members.empty()) return files::input_error(what, where, files::concat({"'", group, "' has ", members}));
  return files::input_error(what, where, kLost);
}

Result<void> set(Settings& settings, std::string_view assignment, std::string_view where) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos || files::trimmed(assignment.substr(0, equals)).empty()) {
    return files::input_error(files::concat({"invalid assignment '", files::one_line(assignment), "'"}), where,
                              "expected KEY=VALUE");
  }
  return set(settings, files::trimmed(assignment.substr(0, equals)), assignment.substr(equals + 1), where);
}

Result<void> set(Settings& settings, std::string_view key, std::string_view value, std::string_view where) {
  const Row* const row = find_row(key);
  if (row == nullptr) return unknown_key(key, where);
  if (row->info.type == ParamType::string) return store(settings, *row, {std::string(value)}, where);
  const std::string_view text = files::trimmed(value);
  const std::size_t count = component_count(row->info.type);
  const bool grey = row->info.grey && files::count_parts(text, ',') == 1;
  if (count == 1 || grey) return store(settings, *row, {std::string(text)}, where);
  if (files::count_parts(text, ',') != count) {
    return bad_value(*row, text, files::concat({"is not ", expected(*row), " separated by commas"}), where);
  }
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < count; ++i) parts.emplace_back(files::part(text, ',', i));
  return store(settings, *row, parts, where);
}

Result<void> store(Settings& settings, const Row& row, const std::vector<std::string>& parts, std::string_view where) {
  const std::size_t count = component_count(row.info.type);
  const bool grey = row.info.grey && parts.size() == 1;
  if (parts.size() != count && !grey) {
    return bad_value(row, files::concat({std::to_string(parts.size()), " values"}),
                     files::concat({"is not ", expected(row)}), where);
  }
  std::byte* const target = address(settings, row);
  if (row.info.type == ParamType::string) {
    if (!files::is_utf8(parts[0])) return bad_value(row, parts[0], "is not valid UTF-8", where);
    if (files::has_control_characters(parts[0])) return bad_value(row, parts[0], "contains control characters", where);
    *reinterpret_cast<std::string*>(target) = parts[0];
    return {};
  }
  const std::size_t size = component_size(row.info.type);
  std::byte bytes[sizeof(DVec3)] = {};  // has room for the largest type
  if (row.info.type == ParamType::flag || row.info.type == ParamType::enumeration) {
    const bool flag = row.info.type == ParamType::flag;
    const std::optional<std::uint32_t> value = flag ? flag_value(parts[0]) : choice_value(row, parts[0]);
    if (!value) return bad_value(row, parts[0], flag ? "is neither on nor off" : "is not one of its values", where);
    std::memcpy(bytes, &*value, sizeof(*value));
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      if (Result<void> read = store_number(row, parts[grey ? 0 : i], where, bytes + i * size); !read) return read;
    }
  }
  std::memcpy(target, bytes, count * size);
  return {};
}

std::string value_text(const Row& row, const Settings& settings) {
  const std::byte* const from = address(settings, row);
  std::string text;
  switch (row.info.type) {
    case ParamType::string: return *reinterpret_cast<const std::string*>(from);
    case ParamType::flag: return read_bytes<std::uint32_t>(from) != 0 ? "true" : "false";
    case ParamType::enumeration:
      return std::string(files::part(row.info.choices, '|', read_bytes<std::uint32_t>(from)));
    default: break;
  }
  for (std::size_t i = 0; i < component_count(row.info.type); ++i) {
    if (i > 0) text += ',';
    const std::byte* const at = from + i * component_size(row.info.type);
    text += row.info.type == ParamType::dvec3 ? files::number_text(read_bytes<double>(at))
            : is_real(row.info.type)          ? files::number_text(read_bytes<float>(at))
                                              : std::to_string(read_bytes<std::uint32_t>(at));
  }
  return text;
}

std::string allowed_text(const Row& row) {
  std::string text;
  switch (row.info.type) {
    case ParamType::string: return "text in UTF-8";
    case ParamType::flag: return "true or false";
    case ParamType::enumeration:
      for (std::size_t i = 0; i < files::count_parts(row.info.choices, '|'); ++i) {
        text.append(i > 0 ? ", " : "").append(files::part(row.info.choices, '|', i));
      }
      return text;
    default: break;
  }
  const std::size_t count = component_count(row.info.type);
  if (count > 1) text = files::concat({expected(row), ", each "});
  if (count == 1 && !is_real(row.info.type)) text = "a whole number, ";
  // Limits of whole numbers are written out: "4294967295", not "4.294967295e+09".
  const auto limit = [&](double value) {
    return is_real(row.info.type) ? files::number_text(value) : std::to_string(static_cast<std::int64_t>(value));
  };
  text.append(limit(row.info.min)).append(" to ").append(limit(row.info.max));
  if (!row.info.unit.empty() && row.info.unit != "1") text.append(" ").append(row.info.unit);
  return text;
}

Result<void> check(const Settings& settings) {
  if (Result<void> allowed = check_params(settings.effect); !allowed) return allowed;
  const scene::ModelInfo& model = scene::drawn_model(settings.effect, settings.scene);
  if (settings.effect.scattering.color == ColorMode::spectral && !model.spectral) {
    return files::input_error(
        files::concat({"'spectral' is not supported by scattering.model = ", model.name, ", which has three channels"}),
        "scattering.color", "expected rgb");
  }
  const MiePhase phase = settings.effect.atmosphere.mie_phase;
  if ((phase == MiePhase::draine || phase == MiePhase::table) && !model.spectral) {
    return files::input_error(files::concat({"'", phase == MiePhase::table ? "table" : "draine",
                                             "' is not supported by scattering.model = ", model.name}),
                              "atmosphere.mie_phase", "expected cornette-shanks or henyey-greenstein");
  }
  const scene::ShadowParams& shadows = settings.scene.shadows;
  if (shadows.first_marched >= shadows.cascades) {
    return files::input_error(files::concat({std::to_string(shadows.first_marched),
                                             " is not below shadows.cascades = ", std::to_string(shadows.cascades)}),
                              "shadows.first_marched",
                              files::concat({"expected 0 to ", std::to_string(shadows.cascades - 1)}));
  }
  const scene::HomogeneousParams& homogeneous = settings.scene.homogeneous;
  if (homogeneous.haze_length_m > homogeneous.air_length_m) {
    return files::input_error(
        files::concat({files::number_text(homogeneous.haze_length_m), " exceeds homogeneous.air_length_m"}),
        "homogeneous.haze_length_m", files::concat({"expected 1 to ", files::number_text(homogeneous.air_length_m)}));
  }
  const std::string& source = settings.scene.terrain.source;
  const bool file = source != "procedural" && source != "none";
  if (settings.path.has_dates() && settings.path.place_text.empty() && !file) {
    return files::input_error(
        "a path with dates has no place", "[playback]",
        "expected place = \"LAT,LON\", or an elevation file with a coordinate system in terrain.source");
  }
  if (settings.scene.moon.by_date && !settings.path.has_dates() && settings.path.moves_sun()) {
    return files::input_error("the camera path moves the sun without dates", "moon.by_date",
                              "expected date in the frames of the path, or moon.by_date = false");
  }
  const scene::SunParams& sun = settings.scene.sun;
  // A file may have a place of its own.
  if (Result<scene::SunParams> placed = scene::placed_sun(sun, file ? std::optional(scene::Place()) : std::nullopt);
      !placed) {
    return std::move(placed).error();
  }
  // The dates of a path place the moon without sun.time.
  if (!settings.path.has_dates()) {
    if (Result<scene::MoonParams> moon =
            scene::placed_moon(settings.scene.moon, sun, file ? std::optional(scene::Place()) : std::nullopt);
        !moon) {
      return std::move(moon).error();
    }
  }
  if (!sun.place.empty()) {
    if (Result<scene::Place> place = scene::parse_place(sun.place, "sun.place"); !place)
      return std::move(place).error();
  }
  if (Result<void> r = scene::check_camera_exposure(settings.scene.tonemap); !r) return r;
  if (settings.scene.tables.cache.empty()) {
    return files::input_error("empty value", "tables.cache", "expected auto, off or a directory");
  }
  if (settings.scene.terrain.source.empty()) {
    return files::input_error("empty value", "terrain.source", "expected procedural or an elevation file");
  }
  return {};
}

std::vector<std::pair<std::string, std::string>> metadata(const Settings& settings) {
  std::vector<std::pair<std::string, std::string>> list = {{"tyndall.version", TYNDALL_VERSION_STRING}};
  for (const Row& row : rows()) {
    list.emplace_back(files::concat({"tyndall.", row.key()}), value_text(row, settings));
  }
  return list;
}

std::vector<std::pair<std::string, std::string>> radiance_metadata(const Settings& settings, std::string_view unit) {
  std::vector<std::pair<std::string, std::string>> list = metadata(settings);
  const Vec3& nm = settings.effect.atmosphere.wavelengths_nm;
  const bool spectral = settings.effect.scattering.color == ColorMode::spectral;
  list.emplace_back("tyndall.channels",
                    spectral ? std::string("R, G, B are the linear colour of the whole spectrum")
                             : files::concat({"R, G, B are the radiance at ", files::number_text(nm.x), ", ",
                                              files::number_text(nm.y), " and ", files::number_text(nm.z),
                                              " nm, which is shown as if it were linear Rec. 709"}));
  if (unit.empty()) {
    unit =
        spectral ? "sun.irradiance per steradian; times whiteLuminance it is cd/m^2" : "sun.irradiance per steradian";
  }
  list.emplace_back("tyndall.unit", unit);
  return list;
}

}  // namespace tyndall::config
