#include "config/describe.hpp"

#include "files/text.hpp"
#include "tyndall/version.hpp"

namespace tyndall::config {
namespace {

std::string_view type_name(ParamType type) {
  switch (type) {
    case ParamType::float32: return "float";
    case ParamType::uint32: return "uint";
    case ParamType::flag: return "flag";
    case ParamType::enumeration: return "enum";
    case ParamType::vec3: return "vec3";
    case ParamType::dvec3: return "dvec3";
    case ParamType::uvec4: return "uvec4";
    case ParamType::string: return "string";
  }
  return "";
}

std::string_view affects_name(Affects affects) {
  switch (affects) {
    case Affects::Frame: return "frame";
    case Affects::Pipeline: return "pipeline";
    case Affects::Resources: return "resources";
    case Affects::Tables: return "tables";
    case Affects::Everything: return "everything";
  }
  return "";
}

bool is_number(ParamType type) { return is_real(type) || type == ParamType::uint32 || type == ParamType::uvec4; }

std::string limit_text(const Row& row, double limit) {
  return is_real(row.info.type) ? files::number_text(limit) : std::to_string(static_cast<std::int64_t>(limit));
}

std::string range_text(const Row& row) {
  if (is_number(row.info.type)) {
    return limit_text(row, row.info.min) + " to " + limit_text(row, row.info.max);
  }
  return row.info.type == ParamType::string ? "" : allowed_text(row);
}

std::string json_value(const Row& row, const Settings& settings) {
  std::string text = value_text(row, settings);
  if (is_vector(row.info.type)) return files::concat({"[", text, "]"});
  if (row.info.type == ParamType::string || row.info.type == ParamType::enumeration) return files::quoted_text(text);
  return text;
}

}  // namespace

std::string to_markdown() {
  const Settings defaults;
  std::string out = "# Parameters\n\n"
                    "This page lists all parameters by the names that scene files, `--set` and image metadata use.\n"
                    "It is made by `tyndall params --format markdown` from `include/tyndall/params.def` and\n"
                    "`src/scene/description/scene_params.def`. The column \"requires\" lists what the effect prepares "
                    "when a parameter "
                    "changes:\nonly the constants of the next frame (`frame`), other pipelines (`pipeline`), other "
                    "buffers (`resources`) "
                    "or new\nscattering tables (`tables`).\n";
  for (const Group& group : groups()) {
    out.append("\n## ").append(group.title).append("\n\n");
    out.append("| name | type | default | range | unit | requires | meaning |\n|---|---|---|---|---|---|---|\n");
    for (const Row& row : rows()) {
      if (row.info.group != group.name) continue;
      const std::string_view unit = row.info.unit == "1" ? "" : row.info.unit;
      out.append("| `").append(row.key()).append("` | ").append(type_name(row.info.type)).append(" | `");
      out.append(value_text(row, defaults)).append("` | ").append(range_text(row)).append(" | ");
      out.append(unit).append(" | ").append(affects_name(row.info.affects)).append(" | ");
      out.append(row.info.doc).append(" |\n");
    }
  }
  return out;
}

std::string to_json(const Settings& settings) {
  const Settings defaults;
  std::string out = "{\n  \"version\": " + files::quoted_text(TYNDALL_VERSION_STRING) + ",\n  \"parameters\": [";
  bool first = true;
  for (const Row& row : rows()) {
    out += first ? "\n    {" : ",\n    {";
    first = false;
    out += "\"name\": " + files::quoted_text(row.key()) + ", \"group\": " + files::quoted_text(row.info.group);
    out += ", \"type\": " + files::quoted_text(type_name(row.info.type));
    out += ", \"default\": " + json_value(row, defaults) + ", \"value\": " + json_value(row, settings);
    if (is_number(row.info.type)) {
      out += ", \"min\": " + limit_text(row, row.info.min) + ", \"max\": " + limit_text(row, row.info.max);
    }
    if (row.info.type == ParamType::enumeration) {
      out += ", \"choices\": [";
      for (std::size_t i = 0; i < files::count_parts(row.info.choices, '|'); ++i) {
        out += (i > 0 ? ", " : "") + files::quoted_text(files::part(row.info.choices, '|', i));
      }
      out += "]";
    }
    out += ", \"unit\": " + files::quoted_text(row.info.unit) +
           ", \"affects\": " + files::quoted_text(affects_name(row.info.affects));
    out += ", \"doc\": " + files::quoted_text(row.info.doc) + "}";
  }
  return out + "\n  ]\n}\n";
}

}  // namespace tyndall::config
