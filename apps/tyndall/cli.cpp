// Implements cli.hpp: messages, common options, progress.
#include "cli.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "arguments.hpp"
#include "config/phase_file.hpp"
#include "config/scene_file.hpp"
#include "files/access.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "image/image.hpp"
#include "input_files.hpp"
#include "models/accuracy_notes.hpp"
#include "scene/description/unused_params.hpp"

namespace tyndall::cli {
namespace {

using files::concat;
using files::input_error;
using files::lower_case;
using files::one_line;

constexpr std::uint32_t kMaxFrames = 1000000;
constexpr std::size_t kLongestLine = 2000;

struct FramePattern {
  std::size_t start = 0;   // position of the percent sign
  std::size_t length = 0;  // including the d
  std::size_t digits = 1;
};

// Returns the first "%d" or "%0Nd" at or after `from`.
std::optional<FramePattern> find_pattern(std::string_view text, std::size_t from = 0) {
  for (std::size_t start = text.find('%', from); start != std::string_view::npos; start = text.find('%', start + 1)) {
    const std::string_view rest = text.substr(start + 1);
    if (rest.starts_with('d')) return FramePattern{start, 2, 1};
    const bool padded = rest.size() >= 3 && rest[0] == '0' && rest[1] >= '1' && rest[1] <= '9' && rest[2] == 'd';
    if (padded) return FramePattern{start, 4, static_cast<std::size_t>(rest[1] - '0')};
  }
  return std::nullopt;
}

std::string shown(std::string_view text) { return concat({"'", one_line(text), "'"}); }

}  // namespace

int fail(const Error& error) {
  return fail(error.message, error.code == ErrorCode::invalid_argument ? kBadUsage : kFailed);
}

int fail_input(const Error& error) {
  return error.code == ErrorCode::io ? fail(error.message, kBadUsage) : fail(error);
}

int fail(std::string_view message, int status) {
  std::fprintf(stderr, "tyndall: error: %s\n", one_line(message, kLongestLine).c_str());
  return status;
}

void note(std::string_view message) {
  std::fprintf(stderr, "tyndall: note: %s\n", one_line(message, kLongestLine).c_str());
}

int print(std::string_view text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  return written ? kDone : fail("standard output: cannot write; expected an open stream with free space", kFailed);
}

std::string size_text(const Size& size) {
  return concat({std::to_string(size.width), "x", std::to_string(size.height)});
}

Result<void> check_altitude(double altitude_m, const Params& params, std::string_view where) {
  const double lowest_m = -0.25 * static_cast<double>(params.planet.radius_m);
  if (altitude_m >= lowest_m) return {};
  return input_error(
      concat({"an eye at ", files::number_text(altitude_m), " m is too deep inside the planet"}), where,
      concat({"expected at least minus a quarter of planet.radius_m, ", files::number_text(lowest_m), " m"}));
}

void add_common(Arguments& arguments, CommonOptions& options, unsigned which) {
  if ((which & kScene) != 0)
    arguments.positional("SCENE.toml", options.scene_file, false, "scene file [default parameters]");
  if ((which & kSet) != 0) {
    arguments.texts("--set", options.sets, "KEY=VALUE",
                    "set a parameter; may be repeated; overrides the scene file and earlier --set");
  }
  if ((which & kScene) != 0) {
    arguments.flag("--allow-outside", options.allow_outside,
                   "let scene files and models name files outside their own folder, and files on a network");
  }
  if ((which & kOutput) != 0) arguments.text("-o,--output", options.output, "FILE", "output file");
  if ((which & kSize) != 0) {
    arguments.value("--size", "WxH", concat({"size of the picture in pixels [", size_text(options.size), "]"}),
                    [&options](const std::string& text) {
                      Result<Size> size = parse_size(text, "--size");
                      if (!size) return Result<void>(std::move(size).error());
                      options.size = size.value();
                      return Result<void>();
                    });
  }
  if ((which & kFrames) != 0) arguments.count("--frames", options.frames, 1, kMaxFrames, "number of frames");
  if ((which & kDevice) != 0) {
    arguments.text("--device", options.device, "NAME",
                   "Vulkan device, by index or part of its name (see tyndall devices)");
  }
  if ((which & kJson) != 0) arguments.flag("--json", options.json, "print the results as JSON");
}

namespace {

// Prints notes for a verb that computes a model and draws no picture: parameters without effect that --set assigns, and
// a scene that chooses another model.
void note_without_effect(const CommonOptions& options, const scene::ModelInfo& model) {
  // Groups end in a full stop.
  constexpr std::string_view kOfPictures[] = {"camera.",
                                              "terrain.",
                                              "meshes.",
                                              "shadows.",
                                              "epipolar.",
                                              "froxels.",
                                              "tonemap.",
                                              "moon.",
                                              "night.",
                                              "sun.elevation_deg",
                                              "sun.azimuth_deg",
                                              "scattering.enabled",
                                              "scattering.only",
                                              "scattering.technique",
                                              "scattering.multiple",
                                              "scattering.light_shafts",
                                              "scattering.downscale",
                                              "scattering.sections",
                                              "scattering.extinction"};
  std::vector<std::string> keys;
  for (const std::string& assignment : options.sets) {
    keys.emplace_back(files::trimmed(std::string_view(assignment).substr(0, assignment.find('='))));
  }
  const std::string found = scene::without_effect(keys, kOfPictures);
  if (!found.empty()) note(concat({found, " here, where no picture is drawn"}));
  const scene::ModelInfo& drawn = scene::drawn_model(options.settings.effect, options.settings.scene);
  if (drawn.id == model.id || drawn.id == scene::ModelId::precomputed) return;
  const bool medium = drawn.id == scene::ModelId::homogeneous_medium;
  note(concat({medium ? "scattering.medium = homogeneous" : "scattering.model = ", medium ? "" : drawn.name,
               " has no effect here; --model ", drawn.name, " computes this model"}));
}

// Prints notes on the accuracy of a model, or, if it is null, of the one that draws the scene.
void note_accuracy(const config::Settings& settings, const scene::ModelInfo* model) {
  using scene::ModelId;
  const ModelId id = (model != nullptr ? *model : scene::drawn_model(settings.effect, settings.scene)).id;
  if (id != ModelId::precomputed && id != ModelId::single) return;
  const bool tables = id == ModelId::precomputed &&
                      (model != nullptr || settings.effect.scattering.multiple != MultipleScattering::none);
  for (const std::string& text : models::accuracy_notes(settings.effect, tables)) note(text);
}

}  // namespace

Result<void> resolve(CommonOptions& options, const scene::ModelInfo* model) {
  options.settings = config::Settings();
  if (options.allow_outside) files::allow_outside();
  if (!options.scene_file.empty()) {
    if (Result<void> loaded = config::load(options.settings, options.scene_file); !loaded) {
      // An unreadable scene file is bad input, not a failure at run time.
      return Error{ErrorCode::invalid_argument, std::move(loaded).error().message};
    }
  }
  for (const std::string& assignment : options.sets) {
    if (Result<void> assigned = config::set(options.settings, assignment); !assigned) return assigned;
  }
  if (Result<void> loaded = config::load_files(options.settings); !loaded) return loaded;
  if (Result<void> checked = config::check(options.settings); !checked) return checked;
  if (const PhaseTable* const phase = options.settings.effect.phase_table.get(); phase != nullptr) {
    constexpr double kNoticed = 0.01;
    if (phase->deviation() > kNoticed) {
      note(concat({"atmosphere.phase_table: the integral over the sphere was off by ",
                   files::number_text(std::round(1000.0 * phase->deviation()) / 10.0), " % and has been corrected"}));
    }
  }
  if (model != nullptr) note_without_effect(options, *model);
  note_accuracy(options.settings, model);
  return {};
}

std::string frame_path(const std::string& pattern, std::uint32_t frame) {
  const std::optional<FramePattern> found = find_pattern(pattern);
  if (!found) return pattern;
  std::string number = std::to_string(frame);
  if (number.size() < found->digits) number.insert(0, found->digits - number.size(), '0');
  return concat({std::string_view(pattern).substr(0, found->start), number,
                 std::string_view(pattern).substr(found->start + found->length)});
}

Result<void> check_output(const CommonOptions& options, const std::vector<std::string>& endings) {
  std::string list;
  bool known = endings.empty();
  for (const std::string& ending : endings) {
    list.append(list.empty() ? "" : " or ").append(ending);
    known = known || lower_case(options.output).ends_with(ending);
  }
  if (options.output.empty()) {
    return input_error(
        "no output file", "-o",
        endings.empty() ? "expected -o FILE" : concat({"expected -o FILE with a name that ends in ", list}));
  }
  if (!known)
    return input_error(concat({"unknown format ", shown(options.output)}), "-o",
                       concat({"expected a name that ends in ", list}));
  if (lower_case(options.output).ends_with(".exr")) {
    if (Result<void> r = image::check_exr_supported(options.output); !r) return r;
  }
  const std::optional<FramePattern> pattern = find_pattern(options.output);
  const bool single = pattern && !find_pattern(options.output, pattern->start + pattern->length);
  if (options.frames > 1 && !single) {
    return input_error(
        concat({std::to_string(options.frames), " ", options.items, " in one file ", shown(options.output)}), "-o",
        "expected one frame number in the name, as in out.%04d.png");
  }
  const std::vector<InputFile> inputs = input_files(options);
  for (std::uint32_t frame = 0; frame < options.frames; ++frame) {
    if (Result<void> r = check_not_input(frame_path(options.output, frame), "-o", inputs); !r) return r;
  }
  return files::check_writable(frame_path(options.output, 0));
}

Progress::Progress(std::string_view label) : label_(label), visible_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (visible_ && drawn_percent_ >= 0) std::fputs("\r\x1b[K", stderr);
}

void Progress::update(std::uint64_t done, std::uint64_t total) {
  if (!visible_) return;
  const double fraction = total == 0 ? 1.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  const int percent = static_cast<int>(100.0 * fraction);
  if (percent == drawn_percent_) return;
  drawn_percent_ = percent;
  constexpr int kWidth = 40;  // characters
  const int filled = percent * kWidth / 100;
  const std::string bar =
      std::string(static_cast<std::size_t>(filled), '#') + std::string(static_cast<std::size_t>(kWidth - filled), '.');
  std::fprintf(stderr, "\r%s [%s] %3d %%\x1b[K", label_.c_str(), bar.c_str(), percent);
  std::fflush(stderr);
}

}  // namespace tyndall::cli
