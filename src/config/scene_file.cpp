// Reads TOML with toml++, which no other source includes.
#include "config/scene_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>
#include <vector>

#include "config/frame_keys.hpp"
#include "config/scene_names.hpp"
#include "config/toml_limits.hpp"
#include "files/access.hpp"
#include "files/files.hpp"
#include "files/text.hpp"

namespace tyndall::config {
namespace {

constexpr std::uint64_t kLargestSceneFile = std::uint64_t{1} << 20U;  // bytes; a typical file has a few thousand

std::string position(std::string_view name, const toml::source_region& source) {
  return files::concat({files::one_line(name, 200), ":", std::to_string(source.begin.line)});
}

// Returns the kind of a node with its article, such as "a string".
std::string_view kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table: return "a table";
    case toml::node_type::array: return "an array";
    case toml::node_type::string: return "a string";
    case toml::node_type::integer: return "a whole number";
    case toml::node_type::floating_point: return "a number";
    case toml::node_type::boolean: return "a boolean";
    default: return "a date or time";
  }
}

// Returns the text of a scalar in the form that store() reads, if its TOML type suits the parameter.
std::optional<std::string> scalar_text(const toml::node& node, ParamType type) {
  switch (type) {
    case ParamType::string:
    case ParamType::enumeration:
      if (const auto* text = node.as_string()) return text->get();
      return std::nullopt;
    case ParamType::flag:
      if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
      return std::nullopt;
    case ParamType::float32:
    case ParamType::vec3:
    case ParamType::dvec3:
      if (const auto* real = node.as_floating_point()) return files::number_text(real->get());
      [[fallthrough]];
    case ParamType::uint32:
    case ParamType::uvec4:
      if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
      return std::nullopt;
  }
  return std::nullopt;
}

Error wrong_type(const Row& row, const toml::node& node, const std::string& where) {
  const bool unquoted = row.info.type == ParamType::string && !node.is_string();
  return files::input_error(files::concat({"'", row.key(), "' is ", kind_of(node)}), where,
                            files::concat({"expected ", allowed_text(row), unquoted ? ", in quotes" : ""}));
}

Error quoted_key(std::string_view key, std::string_view where) {
  return files::input_error(files::concat({"the name '", files::one_line(key), "' is in quotes"}), where,
                            "expected it without quotes, because its dot separates table and parameter");
}

Result<void> load_value(Settings& settings, const Row& row, const toml::node& node, std::string_view name) {
  const std::string where = position(name, node.source());
  const bool vector = is_vector(row.info.type);
  std::vector<std::string> parts;
  if (const toml::array* array = node.as_array(); vector && array != nullptr) {
    for (const toml::node& element : *array) {
      const std::optional<std::string> text = scalar_text(element, row.info.type);
      if (!text) return wrong_type(row, element, where);
      parts.push_back(*text);
    }
  } else {
    const std::optional<std::string> text = vector && !row.info.grey ? std::nullopt : scalar_text(node, row.info.type);
    if (!text) return wrong_type(row, node, where);
    parts.push_back(*text);
  }
  return store(settings, row, parts, where);
}

Error unknown_table(std::string_view group, std::string_view where) {
  std::vector<std::string> names;
  std::string list;
  for (const Group& known : groups()) {
    names.emplace_back(known.name);
    list.append(list.empty() ? "" : ", ").append(known.name);
  }
  const std::optional<std::string> near = files::nearest(group, names);
  return files::input_error(
      files::concat({"unknown table [", files::one_line(group), "]"}), where,
      near ? files::concat({"did you mean [", *near, "]?"}) : files::concat({"expected one of ", list}));
}

bool is_group(std::string_view name) {
  const std::vector<Group>& all = groups();
  return std::any_of(all.begin(), all.end(), [&](const Group& group) { return group.name == name; });
}

Result<void> load_table(Settings& settings, std::string_view group, const toml::table& table, std::string_view name) {
  for (const auto& [key, value] : table) {
    const std::string full = files::concat({group, ".", key.str()});
    // A dot inside a quoted key is not a separator.
    const Row* const row = key.str().find('.') == std::string_view::npos ? find_row(full) : nullptr;
    if (row == nullptr) return unknown_key(full, position(name, key.source()));
    if (Result<void> loaded = load_value(settings, *row, value, name); !loaded) return loaded;
  }
  return {};
}

Error unknown_name(std::string_view key, std::string_view table, const std::vector<std::string>& names,
                   std::string_view where) {
  std::string list;
  for (const std::string& name : names) list.append(list.empty() ? "" : ", ").append(name);
  const std::optional<std::string> near = files::nearest(key, names);
  return files::input_error(
      files::concat({"unknown key '", files::one_line(key), "' in ", table}), where,
      near ? files::concat({"did you mean '", *near, "'?"}) : files::concat({"expected one of ", list}));
}

Result<void> load_date(scene::PathFrame& frame, const toml::node& node, const std::string& where) {
  if (const auto* text = node.as_string()) {
    frame.date = text->get();
  } else if (const auto* time = node.as_date_time()) {
    std::ostringstream written;
    written << time->get();
    frame.date = written.str();
  } else {
    return files::input_error(files::concat({"'date' is ", kind_of(node)}), where,
                              "expected a date and time with its offset from UTC");
  }
  Result<double> day = scene::parse_time(frame.date, where);
  if (!day) return std::move(day).error();
  frame.julian_day = day.value();
  return {};
}

// Reads numbers like the parameters of the same name, with the same ranges.
Result<void> load_frame_value(scene::PathFrame& frame, std::string_view key, const toml::node& node,
                              std::string_view name) {
  const std::string where = position(name, node.source());
  if (key == "date") return load_date(frame, node, where);
  if (key == "time_s") {
    const std::optional<double> seconds = node.value<double>();
    if (!node.is_number() || !std::isfinite(*seconds) || *seconds < 0.0 || *seconds > 1.0e6) {
      return files::input_error("'time_s' is not a time", where, "expected a number, 0 to 1e+06 s");
    }
    frame.time_s = *seconds;
    return {};
  }
  Settings scratch;
  if (key == "position_m") {
    if (Result<void> read = load_value(scratch, *find_row("camera.position_m"), node, name); !read) return read;
    frame.position_m = scratch.scene.camera.position_m;
    return {};
  }
  for (const FrameKey& known : kFrameKeys) {
    if (key != known.name) continue;
    const Row& row = *find_row(known.parameter);
    if (Result<void> read = load_value(scratch, row, node, name); !read) return read;
    float value = 0.0F;
    static_cast<void>(files::read_number(value_text(row, scratch), value));
    if (key == "altitude_m" && value < 0.0F) {
      return files::input_error("'altitude_m' is below sea level", where,
                                "expected 0 to 1e+09 m, or a lower altitude in position_m");
    }
    frame.*known.target = value;
    return {};
  }
  std::vector<std::string> names = {"time_s", "position_m", "date"};
  for (const FrameKey& known : kFrameKeys) names.emplace_back(known.name);
  return unknown_name(key, "[[path]]", names, where);
}

constexpr std::string_view kTwoSuns = "the path gives the sun both by date and by angles";
constexpr std::string_view kOneSun = "expected only one of them";

bool has_sun(const scene::PathFrame& frame) { return frame.sun_elevation_deg || frame.sun_azimuth_deg; }

Result<void> load_path(scene::CameraPath& path, const toml::node& node, std::string_view name,
                       const std::string& where) {
  const toml::array* const frames = node.as_array();
  if (frames == nullptr || !frames->is_homogeneous(toml::node_type::table)) {
    return files::input_error("'path' is not a list of frames", where, "expected one table [[path]] for each frame");
  }
  path = scene::CameraPath{};
  for (const toml::node& element : *frames) {
    const toml::table& table = *element.as_table();
    const std::string at = position(name, element.source());
    scene::PathFrame frame;
    if (table.get("time_s") == nullptr)
      return files::input_error("a frame of the path has no time", at, "expected time_s = SECONDS");
    for (const auto& [key, value] : table) {
      if (Result<void> read = load_frame_value(frame, key.str(), value, name); !read) return read;
    }
    if (!path.frames.empty() && frame.time_s <= path.frames.back().time_s) {
      return files::input_error(
          files::concat({"the time of the path goes from ", files::number_text(path.frames.back().time_s), " s to ",
                         files::number_text(frame.time_s), " s"}),
          at, "expected a greater time_s in each frame");
    }
    const scene::PathFrame* const first = path.frames.empty() ? nullptr : &path.frames.front();
    if (has_sun(frame) && (frame.julian_day || (first != nullptr && first->julian_day))) {
      return files::input_error(kTwoSuns, at, kOneSun);
    }
    path.frames.push_back(std::move(frame));
  }
  if (path.frames.size() < 2)
    return files::input_error("the path has only one frame", where, "expected two or more [[path]]");
  return {};
}

Result<void> load_playback(scene::CameraPath& path, const toml::node& node, std::string_view name,
                           const std::string& where) {
  const toml::table* const table = node.as_table();
  if (table == nullptr)
    return files::input_error(files::concat({"'playback' is ", kind_of(node)}), where, "expected a table");
  for (const auto& [key, value] : *table) {
    const std::string at = position(name, value.source());
    if (key.str() == "loop") {
      if (!value.is_boolean())
        return files::input_error(files::concat({"'loop' is ", kind_of(value)}), at, "expected true or false");
      path.loop = **value.as_boolean();
    } else if (key.str() == "place") {
      if (!value.is_string())
        return files::input_error(files::concat({"'place' is ", kind_of(value)}), at,
                                  "expected \"LAT,LON\" in degrees");
      path.place_text = **value.as_string();
      Result<scene::Place> place = scene::parse_place(path.place_text, at);
      if (!place) return std::move(place).error();
      path.place = place.value();
    } else {
      return unknown_name(key.str(), "[playback]", {"loop", "place"}, position(name, key.source()));
    }
  }
  return {};
}

// Checks that [[path]] and [playback] are consistent.
Result<void> check_path(const scene::CameraPath& path, const std::string& where) {
  const auto dated = [](const scene::PathFrame& frame) { return frame.julian_day.has_value(); };
  const bool by_date = std::any_of(path.frames.begin(), path.frames.end(), dated);
  if (by_date && std::any_of(path.frames.begin(), path.frames.end(), has_sun)) {
    return files::input_error(kTwoSuns, where, kOneSun);
  }
  if (!path.loop) return {};
  if (path.empty()) return files::input_error("there is no path to loop", where, "expected two or more [[path]]");
  const scene::PathFrame& last = path.frames.back();
  const auto given = [&](const FrameKey& key) { return (last.*key.target).has_value(); };
  if (last.position_m || last.julian_day || std::any_of(std::begin(kFrameKeys), std::end(kFrameKeys), given)) {
    return files::input_error("the last frame of a loop has more than a time", where,
                              "expected only time_s, because the frame repeats the first one");
  }
  return {};
}

Result<void> load_root(Settings& settings, const toml::table& root, std::string_view name) {
  std::string path_at;  // position of the path in this file, for messages
  for (const auto& [group, node] : root) {
    if (group.str() == "include") continue;  // load_includes()
    const std::string where = position(name, group.source());
    if (group.str() == "path" || group.str() == "playback") {
      // toml++ gives the key of an array of tables the position of its last table.
      path_at = position(name, node.source());
      Result<void> loaded = group.str() == "path" ? load_path(settings.path, node, name, path_at)
                                                  : load_playback(settings.path, node, name, path_at);
      if (!loaded) return loaded;
      continue;
    }
    const toml::table* const table = node.as_table();
    if (find_row(group.str()) != nullptr) return quoted_key(group.str(), where);
    if (!is_group(group.str())) {
      return table != nullptr ? unknown_table(group.str(), where) : unknown_key(group.str(), where);
    }
    if (table == nullptr) {
      return files::input_error(files::concat({"'", group.str(), "' is ", kind_of(node)}), where, "expected a table");
    }
    if (Result<void> loaded = load_table(settings, group.str(), *table, name); !loaded) return loaded;
  }
  return path_at.empty() ? Result<void>() : check_path(settings.path, path_at);
}

// Returns whether a parameter for a file has a name with a meaning of its own, which is not that of a file.
bool is_keyword(const Row& row, std::string_view value) {
  if (row.key() == "terrain.source") return value == "procedural" || value == "none";
  return row.key() == "meshes.source" && (value == "none" || value == "hall");
}

// Resolves the file names in a scene file that exist relative to its folder, so that they hold for the working
// directory. Names in the files that it includes have been resolved already.
void find_files_beside(Settings& settings, const toml::table& root, const std::filesystem::path& scene_path) {
  const std::filesystem::path directory = scene_path.parent_path();
  for (const Row& row : rows()) {
    if (row.info.type != ParamType::string || row.info.unit != "file") continue;
    const toml::table* const group = root[row.info.group].as_table();
    if (group == nullptr || !group->contains(row.info.name)) continue;
    const std::string value = value_text(row, settings);
    if (value.empty() || is_keyword(row, value)) continue;
    const std::filesystem::path beside = directory / value;  // `value` itself when it is absolute
    std::error_code ignored;
    if (!std::filesystem::exists(beside, ignored)) continue;
    static_cast<void>(set(settings, row.key(), beside.string(), scene_path.string()).ok());
  }
}

constexpr std::size_t kMaxIncludeDepth = 8;    // files that include each other
constexpr std::size_t kMaxIncludedFiles = 64;  // of one scene

// The files that are being read, the outermost first, and the number of files read so far.
struct Reading {
  std::vector<std::filesystem::path> open;
  std::size_t files = 0;
};

Result<void> load_file(Settings& settings, const std::string& path, Reading& reading);

// Reads the files of `include`, which are relative to the folder of the file that includes them.
Result<void> load_includes(Settings& settings, const toml::table& root, std::string_view name, Reading& reading) {
  const toml::node* const node = root.get("include");
  if (node == nullptr) return {};
  const auto problem = [&](std::string_view what, const toml::node& at, std::string_view expected) {
    return files::input_error(what, position(name, at.source()), expected);
  };
  std::vector<const toml::node*> list = {node};
  if (const toml::array* const array = node->as_array(); array != nullptr) {
    list.clear();
    for (const toml::node& element : *array) list.push_back(&element);
  }
  if (reading.open.empty()) return problem("'include' needs a file", *node, "expected a scene without it");
  const std::filesystem::path folder = reading.open.back().parent_path();
  for (const toml::node* const element : list) {
    const auto* const text = element->as_string();
    if (text == nullptr || text->get().empty() || files::has_control_characters(text->get())) {
      return problem("'include' does not name a file", *element, "expected \"FILE.toml\" or a list of such names");
    }
    const std::filesystem::path path = folder / text->get();
    if (!files::outside_allowed() && !files::is_within(path.string(), reading.open.front().parent_path().string())) {
      return problem(files::concat({"'", files::one_line(text->get(), 200), "' is outside the folder of the scene"}),
                     *element, "expected a file in that folder or below it, or --allow-outside");
    }
    std::error_code ignored;
    for (const std::filesystem::path& open : reading.open) {
      if (open != path && !std::filesystem::equivalent(open, path, ignored)) continue;
      return problem(files::concat({"'", files::one_line(text->get(), 200), "' includes itself"}), *element,
                     "expected files that do not include each other in a circle");
    }
    if (reading.open.size() >= kMaxIncludeDepth || reading.files >= kMaxIncludedFiles) {
      return problem("too many files include each other", *element,
                     files::concat({"expected at most ", std::to_string(kMaxIncludeDepth), " files in a chain and ",
                                    std::to_string(kMaxIncludedFiles), " in all"}));
    }
    if (!std::filesystem::exists(path, ignored)) {
      return problem(files::concat({"'", files::one_line(text->get(), 200), "' does not exist"}), *element,
                     "expected a file, relative to the folder of this one");
    }
    if (Result<void> read = load_file(settings, path.string(), reading); !read) return read;
  }
  return {};
}

Result<void> load_toml(Settings& settings, std::string_view toml, std::string_view name, Reading& reading) {
  if (!files::is_utf8(toml)) {
    return files::input_error("not a text file", files::one_line(name, 200), "expected a scene file: TOML in UTF-8");
  }
  if (Result<void> shallow = check_key_depth(toml, name); !shallow) return shallow;
  try {
    const toml::table root = toml::parse(toml, name);
    Settings loaded = settings;
    if (Result<void> read = load_includes(loaded, root, name, reading); !read) return read;
    if (Result<void> read = load_root(loaded, root, name); !read) return read;
    if (!reading.open.empty()) find_files_beside(loaded, root, reading.open.back());
    settings = std::move(loaded);
    return {};
  } catch (const toml::parse_error& error) {
    std::string_view what = error.description();
    if (what.ends_with('.')) what.remove_suffix(1);
    return files::input_error(files::concat({"not valid TOML: ", files::one_line(what, 300)}),
                              position(name, error.source()), "expected KEY = VALUE in [TABLES]");
  }
}

Result<void> load_file(Settings& settings, const std::string& path, Reading& reading) {
  Result<std::string> text = files::read_file(path, kLargestSceneFile);
  if (!text) return std::move(text).error();
  Settings loaded = settings;
  reading.open.emplace_back(path);
  ++reading.files;
  Result<void> read = load_toml(loaded, text.value(), path, reading);
  const std::string folder = reading.open.front().parent_path().string();
  reading.open.pop_back();
  if (!read) return read;
  if (Result<void> allowed = check_names(loaded, settings, path, folder); !allowed) return allowed;
  settings = std::move(loaded);
  return {};
}

}  // namespace

Result<void> load_text(Settings& settings, std::string_view toml, std::string_view name) {
  Reading reading;
  return load_toml(settings, toml, name, reading);
}

Result<void> load(Settings& settings, const std::string& path) {
  Reading reading;
  return load_file(settings, path, reading);
}

}  // namespace tyndall::config
