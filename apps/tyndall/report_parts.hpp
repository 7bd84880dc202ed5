// The parts of `tyndall report`: each runs verbs of this program and adds what they measured to a JSON object. A part
// that cannot run is listed under "left_out" with the reason; nothing is filled in for it.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tyndall::cli {

// The results of a run and what its parts share.
struct ReportRun {
  nlohmann::ordered_json json;
  std::string folder;     // folder of the report
  std::string work;       // folder for files that are removed at the end
  std::string data;       // folder with scenes/ and report/ (the values computed on the CPU device)
  std::string device;     // name of the device, as for --device
  double seconds = 0.0;   // time limit of the whole run
  bool is_short = false;  // the report has tiny pictures and few runs
  std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();

  [[nodiscard]] double seconds_left() const;
  void leave_out(const std::string& part, const std::string& why);
  // Adds a check: `passed` or not, with the measured values.
  void check(const std::string& name, bool passed, const std::string& limit, nlohmann::ordered_json values);
};

// Each program that a part runs takes at most `share` of ReportRun::seconds, and ends at the latest when this is over.
void report_device(ReportRun& run);
void report_tables(ReportRun& run, double share);
void report_probe(ReportRun& run, double share);
void report_pictures(ReportRun& run, double share);
void report_epipolar(ReportRun& run, double share);
void report_validation(ReportRun& run, double share);
void report_pipelines(ReportRun& run, double share);
void report_times(ReportRun& run);

// Computes the values that other devices are compared with: the files of the folder `data`/report.
[[nodiscard]] bool make_reference(ReportRun& run);

// Parts that run in a process of their own, and print JSON: a frame under the validation layer, and the registers,
// spills and code sizes of the effect's pipelines. Return an exit status.
int run_validation_part(const std::string& device);
int run_pipelines_part(const std::string& device);

// Returns the page of a report.
[[nodiscard]] std::string report_page(const nlohmann::ordered_json& report);

}  // namespace tyndall::cli
