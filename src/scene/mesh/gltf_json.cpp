#include "scene/mesh/gltf_json.hpp"

#include <algorithm>
#include <cmath>

#include "files/text.hpp"

namespace tyndall::scene {
namespace {

using nlohmann::json;

constexpr double kRounding = 1.0e-3;  // tolerance, because exporters write values like 1.0000001

// Returns a value as text for a message.
std::string shown(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "an array of " + std::to_string(value.size());
  return files::one_line(value.dump(-1, ' ', false, json::error_handler_t::replace), 60);
}

[[noreturn]] void refuse_value(const std::string& path, const json& value, const std::string& allowed) {
  fail(path + " is " + shown(value), allowed);
}

// Returns the value of a number without a fraction as an integer, or nothing.
std::optional<std::int64_t> whole(const json& value) {
  if (value.is_number_unsigned()) {
    const auto number = value.get<std::uint64_t>();
    if (number > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return {};
    return static_cast<std::int64_t>(number);
  }
  if (value.is_number_integer()) return value.get<std::int64_t>();
  if (!value.is_number_float()) return {};
  const auto number = value.get<double>();
  if (!(std::abs(number) < 9.0e15) || number != std::floor(number)) return {};
  return static_cast<std::int64_t>(number);
}

double finite(const json& value, const std::string& path) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) refuse_value(path, value, "expected a finite number");
  return value.get<double>();
}

double in_range(const json& value, const std::string& path, double low, double high) {
  const double number = finite(value, path);
  if (number < low - kRounding || number > high + kRounding) {
    refuse_value(path, value,
                 "expected a number " + (high < std::numeric_limits<double>::max()
                                             ? "from " + files::number_text(low) + " to " + files::number_text(high)
                                             : "of " + files::number_text(low) + " or more"));
  }
  return std::clamp(number, low, high);
}

}  // namespace

GltfJson::GltfJson(const json& root, const json& value, std::string path)
    : root_(&root), value_(&value), path_(std::move(path)) {
  if (!value.is_object()) refuse_value(path_.empty() ? "the root of its JSON" : path_, value, "expected an object");
}

const json* GltfJson::find(const char* name) const {
  const auto found = value_->find(name);
  return found == value_->end() ? nullptr : &*found;
}

const json* GltfJson::array(const char* name) const {
  const json* const value = find(name);
  if (value != nullptr && !value->is_array()) refuse_value(path(name), *value, "expected an array");
  return value;
}

void GltfJson::refuse(const char* name, const std::string& allowed) const {
  const json* const value = find(name);
  if (value == nullptr) fail(path(name) + " is missing", allowed);
  refuse_value(path(name), *value, allowed);
}

GltfJson GltfJson::object(const char* name) const {
  const json* const value = find(name);
  if (value == nullptr) refuse(name, "expected an object");
  return {*root_, *value, path(name)};
}

std::optional<GltfJson> GltfJson::find_object(const char* name) const {
  if (find(name) == nullptr) return {};
  return object(name);
}

std::optional<GltfJson> GltfJson::extension(const char* name) const {
  const std::optional<GltfJson> extensions = find_object("extensions");
  return extensions ? extensions->find_object(name) : std::optional<GltfJson>();
}

std::vector<GltfJson> GltfJson::objects(const char* name) const {
  std::vector<GltfJson> out;
  const json* const values = array(name);
  if (values == nullptr) return out;
  out.reserve(values->size());
  for (std::size_t i = 0; i < values->size(); ++i) out.push_back({*root_, (*values)[i], at(path(name), i)});
  return out;
}

std::int64_t GltfJson::integer(const char* name, std::int64_t min, std::int64_t max,
                               std::optional<std::int64_t> fallback) const {
  const std::string allowed = max == std::numeric_limits<std::int64_t>::max()
                                  ? "an integer of " + std::to_string(min) + " or more"
                                  : "an integer from " + std::to_string(min) + " to " + std::to_string(max);
  const json* const value = find(name);
  if (value == nullptr) {
    if (!fallback) refuse(name, "expected " + allowed);
    return *fallback;
  }
  const std::optional<std::int64_t> number = whole(*value);
  if (!number || *number < min || *number > max) refuse(name, "expected " + allowed);
  return *number;
}

int GltfJson::checked_index(const json& value, const std::string& path, const char* list) const {
  const auto found = root_->find(list);
  const std::size_t count = found != root_->end() && found->is_array() ? found->size() : 0;
  const std::optional<std::int64_t> number = whole(value);
  if (!number || *number < 0 || static_cast<std::uint64_t>(*number) >= count ||
      *number > std::numeric_limits<int>::max()) {
    refuse_value(path, value,
                 count == 0 ? "expected none, because the file has no " + std::string(list)
                            : "expected an index from 0 to " + std::to_string(count - 1) + " into " + list);
  }
  return static_cast<int>(*number);
}

int GltfJson::index(const char* name, const char* list, bool required) const {
  const json* const value = find(name);
  if (value != nullptr) return checked_index(*value, path(name), list);
  if (required) refuse(name, std::string("expected an index into ") + list);
  return -1;
}

std::vector<int> GltfJson::indices(const char* name, const char* list) const {
  std::vector<int> out;
  const json* const values = array(name);
  if (values == nullptr) return out;
  for (std::size_t i = 0; i < values->size(); ++i) out.push_back(checked_index((*values)[i], at(path(name), i), list));
  return out;
}

std::vector<std::pair<std::string, int>> GltfJson::named_indices(const char* list) const {
  std::vector<std::pair<std::string, int>> out;
  for (const auto& [key, value] : value_->items()) {
    out.emplace_back(key, checked_index(value, path_ + "." + files::one_line(key, 40), list));
  }
  return out;
}

double GltfJson::number(const char* name, double fallback) const {
  const json* const value = find(name);
  return value == nullptr ? fallback : finite(*value, path(name));
}

std::vector<double> GltfJson::numbers(const char* name) const {
  std::vector<double> out;
  const json* const values = array(name);
  if (values == nullptr) return out;
  for (std::size_t i = 0; i < values->size(); ++i) out.push_back(finite((*values)[i], at(path(name), i)));
  return out;
}

bool GltfJson::numbers(const char* name, std::span<double> out) const {
  constexpr double kMax = std::numeric_limits<double>::max();
  return bounded(name, -kMax, kMax, out);
}

double GltfJson::bounded(const char* name, double low, double high, double fallback) const {
  const json* const value = find(name);
  return value == nullptr ? fallback : in_range(*value, path(name), low, high);
}

bool GltfJson::bounded(const char* name, double low, double high, std::span<double> out) const {
  const json* const values = find(name);
  if (values == nullptr) return false;
  if (!values->is_array() || values->size() != out.size()) {
    refuse(name, "expected an array of " + std::to_string(out.size()) + " numbers");
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = in_range((*values)[i], at(path(name), i), low, high);
  return true;
}

std::string GltfJson::text(const char* name, std::optional<std::string> fallback) const {
  const json* const value = find(name);
  if (value == nullptr && fallback) return *std::move(fallback);
  if (value == nullptr || !value->is_string()) refuse(name, "expected a string");
  return value->get<std::string>();
}

std::vector<std::string> GltfJson::texts(const char* name) const {
  std::vector<std::string> out;
  const json* const values = array(name);
  if (values == nullptr) return out;
  for (std::size_t i = 0; i < values->size(); ++i) {
    if (!(*values)[i].is_string()) refuse_value(at(path(name), i), (*values)[i], "expected a string");
    out.push_back((*values)[i].get<std::string>());
  }
  return out;
}

bool GltfJson::flag(const char* name) const {
  const json* const value = find(name);
  if (value != nullptr && !value->is_boolean()) refuse(name, "expected true or false");
  return value != nullptr && value->get<bool>();
}

}  // namespace tyndall::scene
