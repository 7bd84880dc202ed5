// What the verbs share: exit statuses, the error line, output, values as text, and the options that
// mean the same everywhere. Part of the executable: this may print, the libraries may not.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "config/settings.hpp"
#include "tyndall/result.hpp"

namespace tyndall::cli {

class Arguments;

// Exit statuses of every verb (`compare` adds its own).
constexpr int kDone = 0;
constexpr int kFailed = 1;    // at run time: device, memory, input and output
constexpr int kBadUsage = 2;  // bad usage or bad input

// Prints "tyndall: error: MESSAGE" on stderr, as one line; the status that belongs to the error's code:
// kBadUsage for invalid_argument, kFailed for the rest.
int fail(const Error& error);
// For what is read from files that the user names: whatever cannot be read is bad input (kBadUsage).
int fail_input(const Error& error);
// The same with the status given.
int fail(std::string_view message, int status);

// Prints "tyndall: note: MESSAGE" on stderr, as one line: what the user should know of a run that goes on.
void note(std::string_view message);

// Writes to stdout and flushes; kDone, or kFailed (after the error line) when stdout does not take it.
int print(std::string_view text);

struct Size {
  std::uint32_t width = 1280;
  std::uint32_t height = 720;
};
constexpr std::uint32_t kLargestSize = 16384;  // pixels, each side

// The lowest altitude of an eye [m]: below the deepest sea floor of the Earth.
constexpr double kLowestAltitude_m = -11000.0;
// Fails for an eye deeper than a quarter of the planet's radius, where the ground beneath it is not defined any more.
// `where` names the source in errors.
[[nodiscard]] Result<void> check_altitude(double altitude_m, const Params& params, std::string_view where);

// `option` names the source in errors ("--size").
[[nodiscard]] Result<Size> parse_size(std::string_view text, std::string_view option);
[[nodiscard]] Result<std::uint32_t> parse_count(std::string_view text, std::string_view option, std::uint32_t min,
                                                std::uint32_t max);
[[nodiscard]] Result<double> parse_number(std::string_view text, std::string_view option, double min, double max);

// Which of the common options a verb has.
enum CommonOption : unsigned {
  kScene = 1U << 0U,   // [SCENE.toml]
  kSet = 1U << 1U,     // --set KEY=VALUE, repeated
  kDevice = 1U << 2U,  // --device
  kSize = 1U << 3U,    // --size WxH
  kFrames = 1U << 4U,  // --frames N
  kOutput = 1U << 5U,  // -o, --output
  kJson = 1U << 6U,    // --json
};

struct CommonOptions {
  std::string scene_file;         // empty: the defaults
  std::vector<std::string> sets;  // as given, in order
  std::string device;             // index or part of a name; empty: the best
  Size size;
  std::uint32_t frames = 1;
  std::string output;  // empty: not given
  bool json = false;
  config::Settings settings;  // filled by resolve()
};

// Adds the options of `which` (CommonOption bits) to the verb's arguments.
void add_common(Arguments& arguments, CommonOptions& options, unsigned which);

// After parsing: settings = defaults, then the scene file, then every --set; checked together. Errors are
// bad input whatever their cause (a scene file that cannot be read included).
[[nodiscard]] Result<void> resolve(CommonOptions& options);

// A sequence's file name: the one "%d" or "%04d" (any width up to %09d) of `pattern` becomes the number. A
// pattern without is returned as it is.
[[nodiscard]] std::string frame_path(const std::string& pattern, std::uint32_t frame);

// Before long work: the output is given, its name ends in one of `endings` (".png"; empty: any), a
// sequence of more than one frame has exactly one number pattern, no file of it is one that the run reads, and the
// first file can be written.
[[nodiscard]] Result<void> check_output(const CommonOptions& options, const std::vector<std::string>& endings);

// A progress bar on stderr, when that is a terminal; otherwise nothing. Removes itself.
class Progress {
 public:
  explicit Progress(std::string_view label);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();
  // Draws at most as often as the picture changes.
  void update(std::uint64_t done, std::uint64_t total);

 private:
  std::string label_;
  bool visible_;
  int drawn_percent_ = -1;
};

}  // namespace tyndall::cli
