// Runs the built executable, and collects its exit status and output.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace tyndall::cli {

// Tests must not use the user's cache. They share one of their own, which later runs reuse.
inline const int kOwnCache = ::setenv("XDG_CACHE_HOME", TYNDALL_TEST_CACHE, 1);

struct ProcessResult {
  int status = -1;  // exit status; 1000 + the signal's number if a signal ended the process
  std::string out;
  std::string err;
};

// A temporary directory that is removed at the end.
class Scratch {
 public:
  Scratch() {
    std::string pattern = (std::filesystem::temp_directory_path() / "tyndall-cli-XXXXXX").string();
    const char* const made = ::mkdtemp(pattern.data());
    if (made != nullptr) directory_ = made;
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() { std::filesystem::remove_all(directory_); }

  [[nodiscard]] std::string at(const std::string& name) const { return (directory_ / name).string(); }
  std::string write(const std::string& name, std::string_view contents) const {
    std::ofstream(at(name), std::ios::binary) << contents;
    return at(name);
  }

 private:
  std::filesystem::path directory_;
};

inline std::string contents_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Runs tyndall. `stdout_path` redirects stdout to a file, such as "/dev/full", instead of collecting it.
inline ProcessResult run_tyndall(const std::vector<std::string>& arguments, const std::string& stdout_path = "") {
  const Scratch scratch;
  const std::string out = stdout_path.empty() ? scratch.at("out") : stdout_path;
  const std::string err = scratch.at("err");
  const pid_t child = ::fork();
  if (child == 0) {
    const int out_file = ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err_file = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (::dup2(out_file, STDOUT_FILENO) < 0 || ::dup2(err_file, STDERR_FILENO) < 0) ::_exit(127);
    std::vector<char*> argv = {const_cast<char*>("tyndall")};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    ::execv(TYNDALL_EXECUTABLE, argv.data());
    ::_exit(127);
  }
  ProcessResult process;
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child) return process;
  process.status = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  if (stdout_path.empty()) process.out = contents_of(out);
  process.err = contents_of(err);
  return process;
}

// Expects that a run failed with this exit status, printed nothing, and explained it in one line that contains `part`.
inline void expect_one_line(const ProcessResult& process, int status, const std::string& part) {
  EXPECT_EQ(process.status, status) << part << "\n" << process.err;
  EXPECT_EQ(std::count(process.err.begin(), process.err.end(), '\n'), 1) << process.err;
  EXPECT_EQ(process.err.rfind("tyndall: error: ", 0), 0U) << process.err;
  EXPECT_NE(process.err.find(part), std::string::npos) << process.err;
  EXPECT_EQ(process.out, "");
}

}  // namespace tyndall::cli
