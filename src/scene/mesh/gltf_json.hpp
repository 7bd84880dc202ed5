// Strict access to the JSON of a glTF file. A member that is missing, has another type or lies out of its range throws
// GltfFailure with the path of the member, for example "accessors[3].byteOffset is -4". Only gltf_document.cpp,
// gltf_json.cpp, gltf_materials.cpp and gltf_nodes.cpp include this header.
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

// An object of the JSON with its path. The JSON must outlive it.
class GltfJson {
 public:
  // Throws if the root of the file is not an object.
  explicit GltfJson(const nlohmann::json& root) : GltfJson(root, root, "") {}

  [[nodiscard]] bool has(const char* name) const { return value_->contains(name); }
  // Returns the path of a member, such as "accessors[3].count".
  [[nodiscard]] std::string path(const char* name) const { return path_.empty() ? name : path_ + "." + name; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[noreturn]] void refuse(const char* name, const std::string& allowed) const;

  [[nodiscard]] GltfJson object(const char* name) const;  // throws if the member is missing
  [[nodiscard]] std::optional<GltfJson> find_object(const char* name) const;
  [[nodiscard]] std::optional<GltfJson> extension(const char* name) const;
  [[nodiscard]] std::vector<GltfJson> objects(const char* name) const;  // array of objects; empty if missing

  // Returns an integer, which may be written as 3.0. The member is required if there is no fallback.
  [[nodiscard]] std::int64_t integer(const char* name, std::int64_t min, std::int64_t max,
                                     std::optional<std::int64_t> fallback = {}) const;
  // Returns an index into an array of the root, or -1 if the member is missing and not required.
  [[nodiscard]] int index(const char* name, const char* list, bool required = false) const;
  [[nodiscard]] std::vector<int> indices(const char* name, const char* list) const;
  // Returns all members of an object whose members are indices, such as attributes.
  [[nodiscard]] std::vector<std::pair<std::string, int>> named_indices(const char* list) const;
  [[nodiscard]] double number(const char* name, double fallback) const;  // always finite
  [[nodiscard]] std::vector<double> numbers(const char* name) const;     // of any length; empty if missing
  // Overwrites `out` with an array of the same length. Returns false if the member is missing.
  bool numbers(const char* name, std::span<double> out) const;
  // Returns a number in [low, high]. A number that exceeds the range by no more than a rounding error is clamped.
  [[nodiscard]] double bounded(const char* name, double low, double high, double fallback) const;
  bool bounded(const char* name, double low, double high, std::span<double> out) const;
  [[nodiscard]] std::string text(const char* name, std::optional<std::string> fallback = {}) const;
  [[nodiscard]] std::vector<std::string> texts(const char* name) const;
  [[nodiscard]] bool flag(const char* name) const;  // false if missing

 private:
  GltfJson(const nlohmann::json& root, const nlohmann::json& value, std::string path);
  [[nodiscard]] const nlohmann::json* find(const char* name) const;
  [[nodiscard]] const nlohmann::json* array(const char* name) const;
  [[nodiscard]] int checked_index(const nlohmann::json& value, const std::string& path, const char* list) const;

  const nlohmann::json* root_;
  const nlohmann::json* value_;
  std::string path_;
};

// Parts of parse_gltf(). `undrawn` collects the names of features in the file that the scene does not draw.
void parse_materials(const GltfJson& root, GltfDocument& out, std::set<std::string>& undrawn);
void parse_nodes(const GltfJson& root, GltfDocument& out, std::set<std::string>& undrawn);

}  // namespace tyndall::scene
