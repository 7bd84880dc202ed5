// Ends the program within a second after SIGINT or SIGTERM, whatever it is computing, with one line on stderr that says
// what was finished: "tyndall: interrupted: 3 of 10 frames are finished". The program then ends by the signal itself,
// so that shells and schedulers see it. A second signal ends it at once. Files that are being written do not appear
// under their names. After the destruction of an Interruption, the signals are ignored, because the program is about to
// end by itself. Only one may exist at a time. Signals that were ignored when the program started stay ignored.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace tyndall::cli {

class Interruption {
 public:
  Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  ~Interruption();

  // Sets a function that returns what was finished. Another thread calls it, at most once. Until it is set,
  // nothing counts as finished.
  void describe_by(std::function<std::string()> describe);

 private:
  void wait();

  std::mutex mutex_;
  std::function<std::string()> describe_;  // guarded by mutex_
  int pipe_[2] = {-1, -1};
  std::thread thread_;
};

}  // namespace tyndall::cli
