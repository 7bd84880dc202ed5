// Settings: all parameters of one run (the library's and the demo scene's) under one roof, and what
// every interface does with them by name: list, set from text, show as text, check.
// A key is "group.name" (camera.yaw_deg). Text forms, the same everywhere: 0.76 | 5.8e-6,13.5e-6,33.1e-6 |
// true, false, on, off, 1, 0 | the names of an enumeration. Errors are ErrorCode::invalid_argument.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/description/camera_path.hpp"
#include "scene/description/scene_params.hpp"
#include "tyndall/params.hpp"
#include "tyndall/result.hpp"

namespace tyndall::config {

struct Settings {
  Params effect;
  scene::SceneParams scene;
  scene::CameraPath path;  // of scene files alone; empty: the camera stands where `scene` has it
};

enum class Owner : std::uint32_t { scene, effect };

// One parameter: its row and the part of Settings that row.offset counts from.
struct Row {
  ParamInfo info;
  Owner owner;

  [[nodiscard]] std::string key() const;
};

struct Group {
  std::string_view name;
  std::string_view title;
};

// Numbers that a value of this type consists of, and whether they are real ones.
[[nodiscard]] std::size_t component_count(ParamType type);
[[nodiscard]] bool is_real(ParamType type);
// Whether text and files write it as a list of numbers.
[[nodiscard]] bool is_vector(ParamType type);

// All parameters, the scene's first, in the order of the lists.
[[nodiscard]] const std::vector<Row>& rows();
[[nodiscard]] const std::vector<Group>& groups();
// The row of a key, nullptr when there is none.
[[nodiscard]] const Row* find_row(std::string_view key);

// Sets one parameter from "key=value". `where` names the source in the error ("--set", "a.toml:3").
[[nodiscard]] Result<void> set(Settings& settings, std::string_view assignment, std::string_view where = "--set");
// The same with the key and the text of the value apart.
[[nodiscard]] Result<void> set(Settings& settings, std::string_view key, std::string_view value,
                               std::string_view where);

// The value as set() reads it; it reads back exactly.
[[nodiscard]] std::string value_text(const Row& row, const Settings& settings);

// What the value of a row may be: "-0.99 to 0.99", "materials, height, plain", "true or false".
[[nodiscard]] std::string allowed_text(const Row& row);

// The error for a key that does not exist, with the nearest that does.
[[nodiscard]] Error unknown_key(std::string_view key, std::string_view where);

// Checks what ranges alone cannot say, once everything is set: the values allowed for scattering.downscale and
// tables.size, shadows.first_marched below shadows.cascades, terrain.source and tables.cache not empty.
[[nodiscard]] Result<void> check(const Settings& settings);

// Every parameter as {"tyndall.camera.yaw_deg", "332"} after {"tyndall.version", "0.1.0"}: for images.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> metadata(const Settings& settings);

// metadata() and what an EXR of linear radiance has to say of its channels ("tyndall.channels").
[[nodiscard]] std::vector<std::pair<std::string, std::string>> radiance_metadata(const Settings& settings);

// Stores one value whose parts are already apart: for readers of other syntaxes. Numbers are given as
// text; a vector has as many parts as components, a colour also one for all three.
[[nodiscard]] Result<void> store(Settings& settings, const Row& row, const std::vector<std::string>& parts,
                                 std::string_view where);

}  // namespace tyndall::config
