// Settings: all parameters of one run, those of the library and those of the demo scene, and functions to list, set,
// format and check them by name. A key is "group.name" (camera.yaw_deg).
// Values have the same text everywhere: 0.76 | 5.8e-6,13.5e-6,33.1e-6 | true, false, on, off, 1, 0 | the names of an
// enumeration. Errors are ErrorCode::invalid_argument.
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
  scene::CameraPath path;  // from scene files only; if empty, the camera stays where `scene` places it
};

enum class Owner : std::uint32_t { scene, effect };

// One parameter: its row in a table, and the part of Settings that ParamInfo::offset is relative to.
struct Row {
  ParamInfo info;
  Owner owner;

  [[nodiscard]] std::string key() const;
};

struct Group {
  std::string_view name;
  std::string_view title;
};

// Return the number of components of a value of this type, and whether they are real numbers.
[[nodiscard]] std::size_t component_count(ParamType type);
[[nodiscard]] bool is_real(ParamType type);
// Returns whether values of the type are written as lists of numbers.
[[nodiscard]] bool is_vector(ParamType type);

// Returns all parameters, the scene's first, in the order of their lists.
[[nodiscard]] const std::vector<Row>& rows();
[[nodiscard]] const std::vector<Group>& groups();
// Returns the row of a key, nullptr when there is none.
[[nodiscard]] const Row* find_row(std::string_view key);

// Sets one parameter from "key=value". `where` names the source in the error ("--set", "a.toml:3").
[[nodiscard]] Result<void> set(Settings& settings, std::string_view assignment, std::string_view where = "--set");
// Sets one parameter from its key and the text of its value.
[[nodiscard]] Result<void> set(Settings& settings, std::string_view key, std::string_view value,
                               std::string_view where);

// Returns the value as text, which set() reads back exactly.
[[nodiscard]] std::string value_text(const Row& row, const Settings& settings);

// Returns what the value of a row may be: "-0.99 to 0.99", "materials, height, plain", "true or false".
[[nodiscard]] std::string allowed_text(const Row& row);

// Returns the error for a key that does not exist, with the nearest key that does.
[[nodiscard]] Error unknown_key(std::string_view key, std::string_view where);

// Checks what the ranges of single parameters cannot express: values that are not allowed inside a range, such as
// scattering.downscale = 3, texts that cannot be read, and parameters that contradict each other or the camera path.
[[nodiscard]] Result<void> check(const Settings& settings);

// Returns the metadata of an image: {"tyndall.version", "0.2.0"}, then each parameter as {"tyndall.camera.yaw_deg",
// "332"}.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> metadata(const Settings& settings);

// Returns metadata(), the meaning of the channels of linear radiance ("tyndall.channels"), and their unit
// ("tyndall.unit"), by default that of a relative scene.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> radiance_metadata(const Settings& settings,
                                                                                 std::string_view unit = {});

// Sets a value whose components have been separated already, for readers of other syntaxes. Numbers are given as text.
// A vector has one part for each component; a colour may also have one part for all three.
[[nodiscard]] Result<void> store(Settings& settings, const Row& row, const std::vector<std::string>& parts,
                                 std::string_view where);

}  // namespace tyndall::config
