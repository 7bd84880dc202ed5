// Code for all verbs: exit statuses, error messages, output, parsing of values, and common options. Only the executable
// includes this; it may print, the libraries may not.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings.hpp"
#include "scene/description/model_registry.hpp"
#include "tyndall/result.hpp"

namespace tyndall::cli {

class Arguments;

// Exit statuses of every verb (`compare` adds its own).
constexpr int kDone = 0;
constexpr int kFailed = 1;    // failure at run time: device, memory, input and output
constexpr int kBadUsage = 2;  // bad usage or bad input

// Prints "tyndall: error: MESSAGE" on stderr, as one line. Returns the exit status for the error's code: kBadUsage for
// invalid_argument, kFailed for the rest.
int fail(const Error& error);
// Prints the error of an input file that the user names, and returns kBadUsage even if the file cannot be read.
int fail_input(const Error& error);
// Prints an error message in the same form and returns `status`.
int fail(std::string_view message, int status);

// Prints "tyndall: note: MESSAGE" on stderr, as one line: a remark on a run that continues.
void note(std::string_view message);

// Writes to stdout and flushes. Returns kDone, or kFailed (after an error message) if stdout fails.
int print(std::string_view text);

struct Size {
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
};
constexpr std::uint32_t kLargestSize = 16384;  // pixels, each side
// Returns "1280x720".
[[nodiscard]] std::string size_text(const Size& size);

// The lowest altitude of an eye [m]: below the deepest sea floor of the Earth.
constexpr double kLowestAltitude_m = -11000.0;
// Fails for an eye deeper than a quarter of the planet's radius, where the ground below it is undefined. `where` is the
// source for the error message.
[[nodiscard]] Result<void> check_altitude(double altitude_m, const Params& params, std::string_view where);

// Parse a value. `option` is the source for the error message ("--size").
[[nodiscard]] Result<Size> parse_size(std::string_view text, std::string_view option);
[[nodiscard]] Result<std::uint32_t> parse_count(std::string_view text, std::string_view option, std::uint32_t min,
                                                std::uint32_t max);
[[nodiscard]] Result<double> parse_number(std::string_view text, std::string_view option, double min, double max);

// Flags for the common options that a verb has.
enum CommonOption : unsigned {
  kScene = 1U << 0U,   // [SCENE.toml]
  kSet = 1U << 1U,     // --set KEY=VALUE, may be repeated
  kDevice = 1U << 2U,  // --device
  kSize = 1U << 3U,    // --size WxH
  kFrames = 1U << 4U,  // --frames N
  kOutput = 1U << 5U,  // -o, --output
  kJson = 1U << 6U,    // --json
};

struct CommonOptions {
  std::string scene_file;         // empty: default parameters
  std::vector<std::string> sets;  // in the order given
  std::string device;             // index or part of a name; empty: the best device
  Size size;
  std::uint32_t frames = 1;
  std::string items = "frames";  // name of what `frames` counts, for messages
  std::string output;            // empty: not given
  bool json = false;
  bool allow_outside = false;  // files that scenes and models name may be anywhere
  config::Settings settings;   // filled by resolve()
};

// Adds the options of `which` (CommonOption bits) to the verb's arguments.
void add_common(Arguments& arguments, CommonOptions& options, unsigned which);

// Computes the settings after parsing: the defaults, then the scene file, then every --set; checked together. All
// errors count as bad input, including unreadable scene files. Prints notes on the atmosphere for the model that draws
// the scene, or for `model`, which a verb computes instead of drawing. With a model, it also prints which assignments
// of --set have no effect.
[[nodiscard]] Result<void> resolve(CommonOptions& options, const scene::ModelInfo* model = nullptr);

// Returns the file name of a frame of a sequence: the "%d" or "%04d" (any width up to %09d) in `pattern` becomes the
// number. A pattern without one is returned as it is.
[[nodiscard]] std::string frame_path(const std::string& pattern, std::uint32_t frame);

// Checks the output before long work: it is given, its name ends in one of `endings` (".png"; empty: any), a sequence
// of several frames has exactly one number pattern, no output file is an input of the run, and the first file can be
// written.
[[nodiscard]] Result<void> check_output(const CommonOptions& options, const std::vector<std::string>& endings);

// A progress bar on stderr if that is a terminal; otherwise it prints nothing. It erases itself at the end.
class Progress {
 public:
  explicit Progress(std::string_view label);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();
  // Draws only if the displayed percentage changes.
  void update(std::uint64_t done, std::uint64_t total);

 private:
  std::string label_;
  bool visible_;
  int drawn_percent_ = -1;
};

}  // namespace tyndall::cli
