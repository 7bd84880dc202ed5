// `tyndall report`: measures whether Tyndall is right and fast on a device, and writes a folder with a page and JSON.
#include <sys/utsname.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include "arguments.hpp"
#include "cli.hpp"
#include "features.hpp"
#include "files/files.hpp"
#include "files/text.hpp"
#include "report_parts.hpp"
#include "report_process.hpp"
#include "tyndall/version.hpp"

namespace tyndall::cli {
namespace {

namespace fs = std::filesystem;
using files::concat;
using Json = nlohmann::ordered_json;

// The folder beside the output that becomes the output when it is complete. Removed otherwise.
class Folder {
 public:
  explicit Folder(const std::string& path) : path_(path + ".part") {
    std::error_code error;
    // A folder that exists is not ours.
    made_ = !fs::exists(path_, error) && fs::create_directories(path_ + "/work/cache", error);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    if (made_ && !path_.empty()) fs::remove_all(path_, ignored);
  }

  [[nodiscard]] bool made() const { return made_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string work() const { return path_ + "/work"; }
  // Returns whether the folder got its name.
  bool finish(const std::string& name) {
    std::error_code error;
    fs::remove_all(work(), error);
    fs::rename(path_, name, error);
    if (error) return false;
    path_.clear();
    return true;
  }

 private:
  std::string path_;
  bool made_ = false;
};

std::string first_line_with(const char* path, std::string_view start) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(start)) return line.substr(std::min(line.find(':') + 2, line.size()));
  }
  return "";
}

Json system_of() {
  utsname names = {};
  ::uname(&names);
  return {{"kernel", concat({names.sysname, " ", names.release})},
          {"processor", first_line_with("/proc/cpuinfo", "model name")},
          {"threads", std::thread::hardware_concurrency()}};
}

std::string now_text() {
  const std::time_t now = std::time(nullptr);
  std::tm parts = {};
  ::gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

// Samples clocks, temperature and power once a second while the report runs, with nvidia-smi where it exists.
constexpr const char* kClockColumns[] = {"clocks.sm", "clocks.mem", "temperature.gpu", "power.draw"};

std::unique_ptr<Companion> start_clocks(ReportRun& run) {
  constexpr double kShort_s = 20.0;
  const ProgramRun found = run_program("nvidia-smi", {"-L"}, {kShort_s, run.work, ""});
  if (!found.done()) {
    run.leave_out("clocks", "nvidia-smi is not there or does not answer");
    return nullptr;
  }
  std::string query = "--query-gpu=";
  for (const char* const column : kClockColumns) query.append(query.back() == '=' ? "" : ",").append(column);
  return std::make_unique<Companion>("nvidia-smi",
                                     std::vector<std::string>{query, "--format=csv,noheader,nounits", "-l", "1"},
                                     run.work + "/clocks.csv");
}

// Adds all samples in time order. A machine with several devices gives one line for each of them every second.
void add_clocks(ReportRun& run) {
  std::ifstream file(run.work + "/clocks.csv");
  Json samples = Json::array();
  for (std::string line; std::getline(file, line);) {
    Json sample = Json::array();
    for (std::size_t i = 0; i < files::count_parts(line, ','); ++i) {
      double value = 0.0;
      const bool number = files::read_number(files::part(line, ',', i), value) == files::NumberError::none;
      sample.push_back(number ? Json(value) : Json());
    }
    if (sample.size() == std::size(kClockColumns)) samples.push_back(std::move(sample));
  }
  if (samples.empty()) return;
  run.json["clocks"] = {{"source", "nvidia-smi, one line a second for each of its devices"},
                        {"columns", kClockColumns},
                        {"samples", std::move(samples)}};
}

std::uint64_t bytes_in(const std::string& folder) {
  std::uint64_t sum = 0;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) sum += entry.file_size(error);
  }
  return sum;
}

// Removes pictures, in this order, until the folder has at most 16 MiB.
void limit_size(ReportRun& run) {
  constexpr std::uint64_t kLargest = std::uint64_t{16} << 20;
  constexpr std::uint64_t kPages = std::uint64_t{1} << 20;  // for the page and the JSON, which come last
  for (const char* const name : {"brute_force.png", "epipolar.png", "difference_hall.exr", "difference_twilight.exr",
                                 "difference_noon.exr", "difference_demo.exr"}) {
    if (bytes_in(run.folder) <= kLargest - kPages) return;
    std::error_code ignored;
    if (fs::remove(fs::path(run.folder) / name, ignored)) run.leave_out(name, "the folder would exceed 16 MiB");
  }
}

void run_parts(ReportRun& run) {
  Progress progress("report");
  const std::unique_ptr<Companion> clocks = start_clocks(run);
  struct Part {
    void (*run)(ReportRun&, double);
    double share;
  };
  const Part parts[] = {{report_tables, 0.12},   {report_probe, 0.05},      {report_pictures, 0.05},
                        {report_epipolar, 0.04}, {report_validation, 0.06}, {report_pipelines, 0.06}};
  constexpr std::uint64_t kSteps = std::size(parts) + 2;
  std::uint64_t step = 0;
  report_device(run);
  // Without a device there is nothing to measure.
  if (run.json["device"].is_null()) return;
  for (const Part& part : parts) {
    progress.update(++step, kSteps);
    part.run(run, run.is_short ? 1.0 : part.share);
  }
  progress.update(++step, kSteps);
  report_times(run);
}

int write_report(ReportRun& run, Folder& folder, const std::string& output) {
  add_clocks(run);
  run.json["seconds"] = run.seconds - run.seconds_left();
  limit_size(run);
  const Result<void> page = files::write_file(run.folder + "/index.html", report_page(run.json));
  if (!page) return fail(page.error());
  const Result<void> json = files::write_file(run.folder + "/report.json", run.json.dump(1) + "\n");
  if (!json) return fail(json.error());
  if (!folder.finish(output)) {
    return fail(concat({"-o: cannot rename '", files::one_line(folder.path(), 300), "'; expected a writable folder"}),
                kFailed);
  }
  std::size_t failed = 0;
  for (const Json& check : run.json["checks"]) failed += check["passed"].get<bool>() ? 0 : 1;
  const std::string text =
      concat({output, "/index.html: ", std::to_string(run.json["checks"].size()), " checks, ", std::to_string(failed),
              " failed, ", std::to_string(run.json["left_out"].size()), " parts left out\n"});
  return print(text);
}

struct Options {
  CommonOptions common;
  std::string data, part;
  double seconds = 480.0;
  bool is_short = false, reference = false;
};

std::optional<int> parse(Args args, Options& options) {
  Arguments arguments("report");
  add_common(arguments, options.common, kDevice);
  arguments.text("-o,--output", options.common.output, "DIR",
                 "new folder for the report: index.html, report.json, pictures");
  arguments.number("--seconds", options.seconds, 10.0, 3600.0, "end after this time at the latest");
  arguments.text("--data", options.data, "DIR",
                 "folder with scenes/ and report/, the values computed on the CPU device [share/tyndall "
                 "beside the folder of the program]");
  arguments.flag(
      "--short", options.is_short,
      "tiny pictures, small tables and few runs, as a test; compares only with values of --reference --short");
  arguments.flag("--reference", options.reference,
                 "instead of a report, compute the values of this device for report/ in the folder of --data");
  arguments.text("--part", options.part, "NAME", "for internal use: print one part as JSON: validation or pipelines");
  if (const std::optional<int> status = arguments.parse(args)) return *status;
  if (options.part == "validation") return run_validation_part(options.common.device);
  if (options.part == "pipelines") return run_pipelines_part(options.common.device);
  if (!options.part.empty()) {
    return fail(files::input_error(concat({"unknown part '", files::one_line(options.part), "'"}), "--part",
                                   "expected validation or pipelines"));
  }
  if (options.data.empty()) options.data = (fs::path(own_path()).parent_path() / "../share/tyndall").lexically_normal();
  std::error_code error;
  if (!fs::exists(fs::path(options.data) / "scenes/demo.toml", error)) {
    return fail(
        files::input_error(concat({"there is no scenes/demo.toml in '", files::one_line(options.data, 300), "'"}),
                           "--data", "expected the folder share/tyndall of the bundle, or the sources"));
  }
  if (options.reference && options.common.output.empty()) options.common.output = options.data + "/report-work";
  if (options.common.output.empty()) return fail(files::input_error("no output folder", "-o", "expected -o DIR"));
  if (fs::exists(options.common.output, error)) {
    return fail(files::input_error(concat({"'", files::one_line(options.common.output, 300), "' exists"}), "-o",
                                   "expected a new folder"));
  }
  return std::nullopt;
}

}  // namespace

int run_report(Args args) {
  Options options;
  if (const std::optional<int> status = parse(args, options)) return *status;
  while (options.common.output.size() > 1 && options.common.output.ends_with('/')) options.common.output.pop_back();
  Folder folder(options.common.output);
  if (!folder.made()) {
    return fail(concat({"-o: cannot create '", files::one_line(folder.path(), 300),
                        "'; expected a writable folder in which it does not exist"}),
                kFailed);
  }
  // The tables are built again by each report, and their 96 MiB do not stay on the machine. The short form saves time
  // with the cache that is there.
  if (!options.is_short) ::setenv("XDG_CACHE_HOME", fs::absolute(folder.work() + "/cache").c_str(), 1);
  catch_interruption();
  ReportRun run;
  run.folder = folder.path();
  run.work = folder.work();
  run.data = options.data;
  run.device = options.common.device;
  run.seconds = options.seconds;
  run.is_short = options.is_short;
  run.json = {{"program", "tyndall " TYNDALL_VERSION_STRING},
              {"started", now_text()},
              {"limit_seconds", options.seconds},
              {"short", options.is_short},
              {"system", system_of()},
              {"checks", Json::array()},
              {"left_out", Json::array()}};
  if (options.reference) {
    if (make_reference(run)) return kDone;
    return fail(concat({"--reference: ", run.json["left_out"].dump()}), kFailed);
  }
  run_parts(run);
  if (interrupted()) return fail("tyndall report: interrupted; expected an undisturbed run", kFailed);
  return write_report(run, folder, options.common.output);
}

}  // namespace tyndall::cli
