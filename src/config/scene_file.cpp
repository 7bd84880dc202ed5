// Reading TOML through toml++ (kept to this file), writing it by hand from the table.
#include "config/scene_file.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include "config/files.hpp"
#include "config/text.hpp"

namespace tyndall::config {
namespace {

constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 20U;  // bytes; ours are a few thousand

std::string position(std::string_view name, const toml::source_region& source) {
  return concat({one_line(name, 200), ":", std::to_string(source.begin.line)});
}

// "a string", for "is a string".
std::string_view kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

// The text of one scalar in the form that store() reads, when its TOML type suits the parameter.
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
      if (const auto* real = node.as_floating_point()) return number_text(real->get());
      [[fallthrough]];
    case ParamType::uint32:
    case ParamType::uvec4:
      if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
      return std::nullopt;
  }
  return std::nullopt;
}

Error wrong_type(const Row& row, const toml::node& node, const std::string& where) {
  return input_error(concat({"'", row.key(), "' is ", kind_of(node)}), where,
                     concat({"allowed is ", allowed_text(row)}));
}

Result<void> load_value(Settings& settings, const Row& row, const toml::node& node, std::string_view name) {
  const std::string where = position(name, node.source());
  const bool vector = row.info.type == ParamType::vec3 || row.info.type == ParamType::uvec4;
  std::vector<std::string> parts;
  if (const toml::array* array = node.as_array(); vector && array != nullptr) {
    for (const toml::node& element : *array) {
      const std::optional<std::string> text = scalar_text(element, row.info.type);
      if (!text) return wrong_type(row, element, where);
      parts.push_back(*text);
    }
  } else {
    const std::optional<std::string> text = vector ? std::nullopt : scalar_text(node, row.info.type);
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
  const std::optional<std::string> near = nearest(group, names);
  return input_error(concat({"unknown table [", one_line(group), "]"}), where,
                     near ? concat({"did you mean [", *near, "]?"}) : concat({"tables are ", list}));
}

bool is_group(std::string_view name) {
  const std::vector<Group>& all = groups();
  return std::any_of(all.begin(), all.end(), [&](const Group& group) { return group.name == name; });
}

Result<void> load_table(Settings& settings, std::string_view group, const toml::table& table,
                        std::string_view name) {
  for (const auto& [key, value] : table) {
    const std::string full = concat({group, ".", key.str()});
    // A dot inside a quoted key is not a separator.
    const Row* const row = key.str().find('.') == std::string_view::npos ? find_row(full) : nullptr;
    if (row == nullptr) return unknown_key(full, position(name, key.source()));
    if (Result<void> loaded = load_value(settings, *row, value, name); !loaded) return loaded;
  }
  return {};
}

Result<void> load_root(Settings& settings, const toml::table& root, std::string_view name) {
  for (const auto& [group, node] : root) {
    const std::string where = position(name, group.source());
    const toml::table* const table = node.as_table();
    if (!is_group(group.str())) {
      return table != nullptr ? unknown_table(group.str(), where) : unknown_key(group.str(), where);
    }
    if (table == nullptr) {
      return input_error(concat({"'", group.str(), "' is ", kind_of(node)}), where, "it has to be a table");
    }
    if (Result<void> loaded = load_table(settings, group.str(), *table, name); !loaded) return loaded;
  }
  return {};
}

// A parameter that names a file, given relative to the scene file, becomes a path from here.
void find_files_beside(Settings& settings, const Settings& before, const std::string& scene_path) {
  const std::filesystem::path directory = std::filesystem::path(scene_path).parent_path();
  for (const Row& row : rows()) {
    if (row.info.type != ParamType::string || row.info.unit != "file") continue;
    const std::string value = value_text(row, settings);
    if (value.empty() || value == value_text(row, before) || value == value_text(row, Settings())) continue;
    const std::filesystem::path beside = directory / value;  // `value` itself when it is absolute
    std::error_code ignored;
    if (!std::filesystem::exists(beside, ignored)) continue;
    static_cast<void>(set(settings, row.key(), beside.string(), scene_path).ok());
  }
}

// A number as TOML writes it: a real one has a point or an exponent.
std::string toml_number(std::string_view text, bool real) {
  const bool plain = text.find_first_of(".e") == std::string_view::npos;
  return std::string(text) + (real && plain ? ".0" : "");
}

std::string toml_value(const Row& row, const Settings& settings) {
  const std::string text = value_text(row, settings);
  const bool real = row.info.type == ParamType::float32 || row.info.type == ParamType::vec3;
  switch (row.info.type) {
    case ParamType::string:
    case ParamType::enumeration:
      return quoted_text(text);
    case ParamType::vec3:
    case ParamType::uvec4: {
      std::string list = "[";
      for (std::size_t i = 0; i < count_parts(text, ','); ++i) {
        list += (i > 0 ? ", " : "") + toml_number(part(text, ',', i), real);
      }
      list += "]";
      return list;
    }
    case ParamType::flag:
      return text;
    default:
      return toml_number(text, real);
  }
}

}  // namespace

Result<void> load_text(Settings& settings, std::string_view toml, std::string_view name) {
  if (!is_utf8(toml)) {
    return input_error("not a text file", one_line(name, 200), "allowed is a scene file: TOML in UTF-8");
  }
  try {
    const toml::table root = toml::parse(toml, name);
    Settings loaded = settings;
    if (Result<void> read = load_root(loaded, root, name); !read) return read;
    settings = std::move(loaded);
    return {};
  } catch (const toml::parse_error& error) {
    std::string_view what = error.description();
    if (what.ends_with('.')) what.remove_suffix(1);
    return input_error(concat({"not valid TOML: ", one_line(what, 300)}), position(name, error.source()),
                       "allowed is KEY = VALUE in [TABLES]");
  }
}

Result<void> load(Settings& settings, const std::string& path) {
  Result<std::string> text = read_file(path, kLargestFile);
  if (!text) return std::move(text).error();
  Settings loaded = settings;
  if (Result<void> read = load_text(loaded, text.value(), path); !read) return read;
  find_files_beside(loaded, settings, path);
  settings = std::move(loaded);
  return {};
}

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
  return out;
}

Result<void> save(const Settings& settings, const std::string& path) {
  return write_file(path, to_toml(settings));
}

}  // namespace tyndall::config
