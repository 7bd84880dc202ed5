#include "report_process.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>
#include <thread>

#include "files/files.hpp"
#include "files/text.hpp"

namespace tyndall::cli {
namespace {

using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t stop_signal = 0;

void on_interruption(int /*signal*/) { stop_signal = 1; }

constexpr std::uint64_t kLargestOutput = std::uint64_t{64} << 20;

std::string contents(const std::string& path) {
  Result<std::string> text = files::read_file(path, kLargestOutput);
  return text ? std::move(text).value() : std::string();
}

// Ends a process and returns its status, or nothing if it does not end within some seconds: a process that waits for a
// device cannot be ended.
std::optional<int> kill_and_wait(int process) {
  ::kill(process, SIGKILL);
  for (int i = 0; i < 500; ++i) {
    int status = 0;
    if (::waitpid(process, &status, WNOHANG) == process) return status;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return std::nullopt;
}

// Starts a program with its output in files. Returns -1 on failure.
int start(const std::string& program, const std::vector<std::string>& arguments, const std::string& out,
          const std::string& err, const std::string& environment) {
  std::vector<std::string> words = {program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::string variable = environment;
  const pid_t child = ::fork();
  if (child != 0) return child;
  // Only async-signal-safe calls below, except for putenv(), because this thread is the only one.
  constexpr int kMode = 0644;
  const int in_file = ::open("/dev/null", O_RDONLY);
  const int out_file = ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
  const int err_file = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode);
  constexpr int kNotStarted = 127;
  if (in_file < 0 || ::dup2(in_file, STDIN_FILENO) < 0) ::_exit(kNotStarted);
  if (::dup2(out_file, STDOUT_FILENO) < 0 || ::dup2(err_file, STDERR_FILENO) < 0) ::_exit(kNotStarted);
  if (!variable.empty()) ::putenv(variable.data());
  ::execvp(argv[0], argv.data());
  ::_exit(kNotStarted);
}

}  // namespace

std::string own_path() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).string();
}

std::string ProgramRun::reason() const {
  if (interrupted) return "interrupted";
  if (timed_out) return files::concat({"not finished after ", std::to_string(static_cast<int>(seconds)), " s"});
  const std::string text = err.empty() ? "no message" : err;
  return files::concat({"exit status ", std::to_string(status), ": ", text});
}

ProgramRun run_program(const std::string& program, const std::vector<std::string>& arguments,
                       const ProgramLimits& limits) {
  ProgramRun run;
  run.interrupted = interrupted();
  if (run.interrupted) return run;
  const std::string out = limits.folder + "/stdout";
  const std::string err = limits.folder + "/stderr";
  const Clock::time_point begin = Clock::now();
  const int child = start(program.empty() ? own_path() : program, arguments, out, err, limits.environment);
  if (child < 0) return run;
  int status = 0;
  for (;;) {
    const int ended = ::waitpid(child, &status, WNOHANG);
    run.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    if (ended == child) break;
    run.timed_out = run.seconds > limits.seconds;
    run.interrupted = interrupted();
    if (run.timed_out || run.interrupted) {
      if (const std::optional<int> ended_with = kill_and_wait(child)) status = *ended_with;
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  constexpr int kSignalBase = 128;
  run.status = WIFEXITED(status) ? WEXITSTATUS(status) : kSignalBase + WTERMSIG(status);
  run.out = contents(out);
  constexpr std::size_t kLongestLine = 500;
  std::string text = contents(err);
  while (text.ends_with('\n')) text.pop_back();
  run.err = files::one_line(text, kLongestLine);
  return run;
}

Companion::Companion(const std::string& program, const std::vector<std::string>& arguments, const std::string& output)
    : process_(start(program, arguments, output, "/dev/null", "")) {}

Companion::~Companion() {
  if (process_ > 0) kill_and_wait(process_);
}

void catch_interruption() {
  std::signal(SIGINT, on_interruption);
  std::signal(SIGTERM, on_interruption);
}

bool interrupted() { return stop_signal != 0; }

}  // namespace tyndall::cli
