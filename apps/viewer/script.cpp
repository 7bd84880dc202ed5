#include "viewer/script.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include "files/text.hpp"
#include "viewer/gui/widgets.hpp"

namespace tyndall::viewer {
namespace {

// Returns whether a soak changes the parameter. It leaves out sizes that take minutes on a device without a GPU, and
// text.
bool is_soaked(const config::Row& row) {
  constexpr std::string_view kNot[] = {
      "tables.size",          "tables.orders",    "tables.cache",   "tables.cache_limit_mib", "shadows.resolution",
      "epipolar.slices",      "epipolar.samples", "camera.samples", "camera.position_m",      "scattering.model",
      "scattering.technique", "froxels.columns",  "froxels.rows",   "froxels.slices"};
  if (row.info.type == ParamType::string || row.info.group == "meshes") return false;
  return std::find(std::begin(kNot), std::end(kNot), row.key()) == std::end(kNot);
}

// Returns whether the parameter selects a variant of shaders. A device without a GPU caches every compiled variant,
// some MiB each, so that all combinations together would fill the memory for hours without being a leak.
bool chooses_shaders(const config::Row& row) {
  return row.info.type == ParamType::enumeration || row.info.type == ParamType::flag ||
         row.key() == "scattering.downscale";
}

// Returns each choice that selects shaders, as the key and value of a parameter.
std::vector<std::pair<std::string, std::string>> choices_of_shaders() {
  std::vector<std::pair<std::string, std::string>> out;
  for (const config::Row& row : config::rows()) {
    if (!is_soaked(row) || !chooses_shaders(row)) continue;
    if (row.info.type == ParamType::enumeration) {
      for (std::size_t i = 0; i < files::count_parts(row.info.choices, '|'); ++i) {
        out.emplace_back(row.key(), std::string(files::part(row.info.choices, '|', i)));
      }
    } else if (row.info.type == ParamType::flag) {
      out.emplace_back(row.key(), "off");
      out.emplace_back(row.key(), "on");
    } else {
      out.emplace_back(row.key(), "2");
      out.emplace_back(row.key(), "4");
    }
  }
  return out;
}

std::string random_value(const config::Row& row, std::mt19937& random) {
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const auto number = [&] {
    // Wide ranges are sampled mostly in their lowest tenth, where the usual values are.
    const double t = row.info.max - row.info.min > 1000.0 ? 0.1 * part(random) * part(random) : part(random);
    return row.info.min + t * (row.info.max - row.info.min);
  };
  switch (row.info.type) {
    case ParamType::float32: return files::number_text(static_cast<float>(number()));
    case ParamType::uint32: return std::to_string(static_cast<std::uint32_t>(number()));
    case ParamType::flag: return part(random) < 0.5 ? "off" : "on";
    case ParamType::enumeration: {
      const std::size_t count = files::count_parts(row.info.choices, '|');
      const auto chosen = std::min(static_cast<std::size_t>(part(random) * static_cast<double>(count)), count - 1);
      return std::string(files::part(row.info.choices, '|', chosen));
    }
    case ParamType::vec3: {
      std::string text;
      for (int i = 0; i < 3; ++i) text += (i > 0 ? "," : "") + files::number_text(static_cast<float>(number()));
      return text;
    }
    default: return {};
  }
}

}  // namespace

Script::Script(const std::string& text, const config::Settings& start) : start_(start) {
  constexpr std::string_view kSoak = "soak=";
  constexpr std::string_view kSoakFrames = "soak-frames=";
  if (text == "walk") kind_ = Kind::walk;
  if (text.starts_with(kSoak)) {
    kind_ = Kind::soak;
    seconds_ = std::strtod(text.c_str() + kSoak.size(), nullptr);
  }
  if (text.starts_with(kSoakFrames)) {
    kind_ = Kind::soak;
    frames_ = std::strtoull(text.c_str() + kSoakFrames.size(), nullptr, 10);
  }
}

std::string Script::advance(config::Settings& settings, GuiState& gui, double now, std::uint64_t frames) {
  if (!on()) return {};
  if (begun_ < 0.0) begun_ = now;
  if (kind_ == Kind::walk) return walk(settings);
  if (frames_ > 0 ? frames < frames_ : now - begun_ <= seconds_) return soak(settings, gui);
  done_ = true;
  settings = start_;
  return "done after " + std::to_string(changes_) + " changes and " + std::to_string(frames) + " frames";
}

// Sets each parameter to its smallest value, its largest value and back, with a frame for each.
std::string Script::walk(config::Settings& settings) {
  const std::vector<config::Row>& rows = config::rows();
  while (next_ / 3 < rows.size() && rows[next_ / 3].info.type == ParamType::string) next_ += 3;
  if (next_ / 3 >= rows.size()) {
    done_ = true;
    settings = start_;
    return "done";
  }
  const config::Row& row = rows[next_ / 3];
  const std::size_t turn = next_++ % 3;
  settings = start_;
  if (turn < 2) set_to_end(row, settings, turn == 1);
  return row.key() + (turn == 0 ? " minimum" : turn == 1 ? " maximum" : " back");
}

std::string Script::soak(config::Settings& settings, GuiState& gui) {
  // First selects every shader once, then changes parameters at random; from then on memory must not grow.
  static const std::vector<std::pair<std::string, std::string>> choices = choices_of_shaders();
  if (next_ < choices.size()) {
    settings = start_;
    const auto& [key, value] = choices[next_++];
    (void)config::set(settings, key, value, "soak");
    return key + "=" + value;
  }
  // Returns to the start now and then, so that the soak does not stay in one corner of the parameters.
  if (changes_++ % 24 == 0) {
    settings = start_;
    gui.resolution_scale = 0.25F + 0.01F * static_cast<float>(changes_ % 7);
    return "start";
  }
  const std::vector<config::Row>& rows = config::rows();
  std::uniform_int_distribution<std::size_t> any(0, rows.size() - 1);
  const config::Row* row = &rows[any(random_)];
  while (!is_soaked(*row)) row = &rows[any(random_)];
  const std::string value = random_value(*row, random_);
  if (chooses_shaders(*row)) settings = start_;
  if (!config::set(settings, row->key(), value, "soak").ok()) return row->key() + " refused";
  return row->key() + "=" + value;
}

}  // namespace tyndall::viewer
