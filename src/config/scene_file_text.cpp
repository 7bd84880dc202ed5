// Writes scene files from the table of parameters.
#include "config/frame_keys.hpp"
#include "config/scene_file.hpp"
#include "files/files.hpp"
#include "files/text.hpp"

namespace tyndall::config {
namespace {

// Returns a number as TOML writes it: real numbers have a point or an exponent.
std::string toml_number(std::string_view text, bool real) {
  const bool plain = text.find_first_of(".e") == std::string_view::npos;
  return std::string(text) + (real && plain ? ".0" : "");
}

std::string toml_value(const Row& row, const Settings& settings) {
  std::string text = value_text(row, settings);
  const bool real = is_real(row.info.type);
  switch (row.info.type) {
    case ParamType::string:
    case ParamType::enumeration: return files::quoted_text(text);
    case ParamType::vec3:
    case ParamType::dvec3:
    case ParamType::uvec4: {
      std::string list = "[";
      for (std::size_t i = 0; i < files::count_parts(text, ','); ++i) {
        list += (i > 0 ? ", " : "") + toml_number(files::part(text, ',', i), real);
      }
      list += "]";
      return list;
    }
    case ParamType::flag: return text;
    default: return toml_number(text, real);
  }
}

void append_path(std::string& out, const scene::CameraPath& path) {
  if (path.empty()) return;
  out.append("\n# How the path below is played\n[playback]\n");
  out.append("loop = ").append(path.loop ? "true" : "false").append("\n");
  if (!path.place_text.empty()) out.append("place = ").append(files::quoted_text(path.place_text)).append("\n");
  for (const scene::PathFrame& frame : path.frames) {
    out.append("\n[[path]]\ntime_s = ").append(toml_number(files::number_text(frame.time_s), true)).append("\n");
    if (frame.position_m) {
      const auto part = [](double value) { return toml_number(files::number_text(value), true); };
      const DVec3& p = *frame.position_m;
      out.append("position_m = [")
          .append(part(p.x))
          .append(", ")
          .append(part(p.y))
          .append(", ")
          .append(part(p.z))
          .append("]\n");
    }
    for (const FrameKey& key : kFrameKeys) {
      const std::optional<float>& value = frame.*key.target;
      if (value) out.append(key.name).append(" = ").append(toml_number(files::number_text(*value), true)).append("\n");
    }
    if (!frame.date.empty()) out.append("date = ").append(files::quoted_text(frame.date)).append("\n");
  }
}

}  // namespace

std::string to_toml(const Settings& settings) {
  std::string out;
  for (const Group& group : groups()) {
    out.append(out.empty() ? "" : "\n").append("# ").append(group.title).append("\n[");
    out.append(group.name).append("]\n");
    for (const Row& row : rows()) {
      if (row.info.group != group.name) continue;
      out.append("# ").append(row.info.doc).append(" Allowed: ").append(allowed_text(row)).append(".\n");
      out.append(row.info.name).append(" = ").append(toml_value(row, settings)).append("\n");
    }
  }
  append_path(out, settings.path);
  return out;
}

Result<void> save(const Settings& settings, const std::string& path) {
  return files::write_file(path, to_toml(settings));
}

}  // namespace tyndall::config
