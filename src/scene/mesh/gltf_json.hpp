// Strict access to the JSON of a glTF file. A member that is missing, has another type or lies out of its range throws
// GltfFailure with the path of the member, for example "accessors[3].byteOffset is -4". Included by gltf_document.cpp
// and gltf_file.cpp only.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scene/mesh/gltf_document.hpp"

namespace tyndall::scene {

// An object of the JSON with its path. Valid while the JSON is.
class GltfJson {
 public:
  // Throws if the root of the file is no object.
  explicit GltfJson(const nlohmann::json& root) : GltfJson(root, root, "") {}

  [[nodiscard]] bool has(const char* name) const { return value_->contains(name); }
  // The path of a member: "accessors[3].count".
  [[nodiscard]] std::string path(const char* name) const { return path_.empty() ? name : path_ + "." + name; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[noreturn]] void refuse(const char* name, const std::string& allowed) const;

  [[nodiscard]] GltfJson object(const char* name) const;  // required
  [[nodiscard]] std::optional<GltfJson> find_object(const char* name) const;
  [[nodiscard]] std::optional<GltfJson> extension(const char* name) const;
  [[nodiscard]] std::vector<GltfJson> objects(const char* name) const;  // an array of objects; none where it is missing

  // Without a fallback the member is required. Whole numbers may be written as 3.0.
  [[nodiscard]] std::int64_t integer(const char* name, std::int64_t min, std::int64_t max,
                                     std::optional<std::int64_t> fallback = {}) const;
  // An index into an array of the root; -1 where the member is missing and not required.
  [[nodiscard]] int index(const char* name, const char* list, bool required = false) const;
  [[nodiscard]] std::vector<int> indices(const char* name, const char* list) const;
  // All members of this object, which are indices, as of attributes.
  [[nodiscard]] std::vector<std::pair<std::string, int>> named_indices(const char* list) const;
  [[nodiscard]] double number(const char* name, double fallback) const;  // finite
  [[nodiscard]] std::vector<double> numbers(const char* name) const;     // of any length; none where it is missing
  // Overwrites `out` with as many numbers as it has, and returns true, where the member is there.
  bool numbers(const char* name, std::span<double> out) const;
  // Numbers in [low, high]; those that are out of it by less than rounding explains are clamped.
  [[nodiscard]] double bounded(const char* name, double low, double high, double fallback) const;
  bool bounded(const char* name, double low, double high, std::span<double> out) const;
  [[nodiscard]] std::string text(const char* name, std::optional<std::string> fallback = {}) const;
  [[nodiscard]] std::vector<std::string> texts(const char* name) const;
  [[nodiscard]] bool flag(const char* name) const;  // false where it is missing

 private:
  GltfJson(const nlohmann::json& root, const nlohmann::json& value, std::string path);
  [[nodiscard]] const nlohmann::json* find(const char* name) const;
  [[nodiscard]] const nlohmann::json* array(const char* name) const;
  [[nodiscard]] int checked_index(const nlohmann::json& value, const std::string& path, const char* list) const;

  const nlohmann::json* root_;
  const nlohmann::json* value_;
  std::string path_;
};

// Parts of parse_gltf(). `undrawn` collects the names of what the file has and the scene does not draw.
void parse_materials(const GltfJson& root, GltfDocument& out, std::set<std::string>& undrawn);
void parse_nodes(const GltfJson& root, GltfDocument& out, std::set<std::string>& undrawn);

}  // namespace tyndall::scene
