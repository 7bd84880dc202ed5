// The handlers write to a pipe, and a thread that reads from it does the rest, because a handler may do very little.
#include "interruption.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>

#include "files/text.hpp"

namespace tyndall::cli {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM};

// Variables that the signal handlers read. They are written only while no handler is installed.
int written_end = -1;
pid_t owner = 0;

extern "C" void tyndall_on_signal(int number) {
  if (::getpid() != owner) {  // a child process before it runs another program
    std::signal(number, SIG_DFL);
    std::raise(number);
    return;
  }
  const int error = errno;
  const auto byte = static_cast<char>(number);
  static_cast<void>(!::write(written_end, &byte, 1));
  errno = error;
}

}  // namespace

Interruption::Interruption() {
  if (::pipe2(pipe_, O_CLOEXEC) != 0) return;  // signals then end the program without a message
  written_end = pipe_[1];
  owner = ::getpid();
  thread_ = std::thread([this] { wait(); });
  for (const int number : kSignals) {
    struct sigaction now {};
    if (::sigaction(number, nullptr, &now) != 0 || now.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = tyndall_on_signal;
    action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
    ::sigemptyset(&action.sa_mask);
    ::sigaction(number, &action, nullptr);
  }
}

Interruption::~Interruption() {
  if (!thread_.joinable()) return;
  for (const int number : kSignals) {
    struct sigaction now {};
    if (::sigaction(number, nullptr, &now) == 0 && now.sa_handler == tyndall_on_signal) std::signal(number, SIG_IGN);
  }
  const char end = 0;
  static_cast<void>(!::write(pipe_[1], &end, 1));
  thread_.join();
  ::close(pipe_[0]);
  ::close(pipe_[1]);
}

void Interruption::describe_by(std::function<std::string()> describe) {
  const std::scoped_lock lock(mutex_);
  describe_ = std::move(describe);
}

void Interruption::wait() {
  char number = 0;
  while (::read(pipe_[0], &number, 1) != 1) {
    if (errno != EINTR) return;
  }
  if (number == 0) return;
  std::string text = "nothing is finished";
  {
    const std::scoped_lock lock(mutex_);
    if (describe_) text = describe_();
  }
  // Erases a progress bar.
  std::fprintf(stderr, "%styndall: interrupted: %s\n", ::isatty(STDERR_FILENO) == 1 ? "\r\x1b[K" : "", text.c_str());
  std::signal(number, SIG_DFL);
  ::kill(::getpid(), number);
}

}  // namespace tyndall::cli
