// Runs this program again with other arguments, with a deadline: a crash, a lost device or a driver that never answers
// ends a part of the report, not the report.
#pragma once

#include <string>
#include <vector>

namespace tyndall::cli {

struct ProgramRun {
  int status = -1;         // exit status; 128 + the signal's number after a crash
  bool timed_out = false;  // the program was ended at the deadline
  bool interrupted = false;
  double seconds = 0.0;
  std::string out, err;  // stdout and stderr of the program; `err` is one line

  [[nodiscard]] bool done() const { return status == 0; }
  // Returns why the run gave no result, in words.
  [[nodiscard]] std::string reason() const;
};

struct ProgramLimits {
  double seconds;           // time after which the program is stopped
  std::string folder;       // folder for the files that hold the program's output
  std::string environment;  // environment variable to set, NAME=VALUE; empty: none
};

// Runs the program at the path `program`, or this one if `program` is empty. A name without a slash is sought in PATH.
[[nodiscard]] ProgramRun run_program(const std::string& program, const std::vector<std::string>& arguments,
                                     const ProgramLimits& limits);

// Returns the path of this program.
[[nodiscard]] std::string own_path();

// A program that runs beside others until it is destroyed. Its output goes to a file.
class Companion {
 public:
  Companion(const std::string& program, const std::vector<std::string>& arguments, const std::string& output);
  ~Companion();
  Companion(const Companion&) = delete;
  Companion& operator=(const Companion&) = delete;

 private:
  int process_ = -1;
};

// Interruption (Ctrl-C) ends the running program, and run_program() starts no other afterwards.
void catch_interruption();
[[nodiscard]] bool interrupted();

}  // namespace tyndall::cli
