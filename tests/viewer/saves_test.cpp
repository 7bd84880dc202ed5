// The viewer is killed at every call that writes a file while it saves: its state with F5, and a picture as PNG and
// EXR. Every file under its final name is then the old one or complete, and the next save removes what is left.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <map>
#include <thread>

#include "config/scene_file.hpp"
#include "faults/write_faults.hpp"
#include "viewer/screenshot.hpp"
#include "viewer/view_settings.hpp"

namespace tyndall::viewer {
namespace {

namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;  // contents by name

class ViewerSaves : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "tyndall-saves-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override {
    stop();
    fs::remove_all(folder_);
  }
  static void stop() {
    tyndall_write_faults("", 0, 0, "");
    tyndall_unnamed_files(true);
  }
  [[nodiscard]] Files files() const {
    Files out;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      std::ifstream file(entry.path(), std::ios::binary);
      // The names of pictures have the time.
      const std::string name = entry.path().filename().string();
      const std::string shown = name.starts_with("tyndall-") ? "picture" + entry.path().extension().string() : name;
      out[shown] = {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }
    return out;
  }
  void clear() const {
    for (const auto& entry : fs::directory_iterator(folder_)) fs::remove(entry.path());
  }
  // Saves in a process that is killed. Returns whether it was.
  bool kill_at(long at, int how, const std::function<Result<void>()>& save) const {
    const pid_t child = ::fork();
    if (child == 0) {
      tyndall_write_faults(folder_.c_str(), at, how, "");
      ::_exit(save().ok() ? 0 : 1);
    }
    int status = 0;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) ? WTERMSIG(status) == SIGKILL : WEXITSTATUS(status) == 0) << at;
    return WIFSIGNALED(status);
  }
  // Makes all files so old that they belong to no running process.
  void age_files() const {
    const auto old = fs::file_time_type::clock::now() - std::chrono::minutes(2);
    for (const auto& entry : fs::directory_iterator(folder_)) fs::last_write_time(entry.path(), old);
  }

  // Saves over the files `before` that `prepare` makes.
  void expect_whole(const char* what, const std::function<void()>& prepare, const std::function<Result<void>()>& save) {
    const char* const all = std::getenv("TYNDALL_ALL_KILLS");
    const long most = all != nullptr ? LONG_MAX : 24;
    int kills = 0, left = 0;
    for (const bool unnamed : {true, false}) {
      clear();
      prepare();
      const Files before = files();
      tyndall_write_faults(folder_.c_str(), 0, 0, "");
      tyndall_unnamed_files(unnamed);
      ASSERT_TRUE(save().ok());
      const long calls = tyndall_write_calls();
      EXPECT_GE(calls, 4);
      const Files good = files();
      for (const int how : {kKillBefore, kKillInside}) {
        const long tries = std::min(calls, most);
        for (long i = 0; i < tries; ++i) {
          const long at = tries == calls ? 1 + i : 1 + i * (calls - 1) / (tries - 1);
          clear();
          prepare();
          EXPECT_TRUE(kill_at(at, how, save)) << at;
          ++kills;
          std::size_t temporary = 0;
          for (const auto& [name, contents] : files()) {
            if (name.starts_with(".tyndall-")) {
              ++temporary;
              continue;
            }
            const auto complete = good.find(name), old = before.find(name);
            EXPECT_TRUE((complete != good.end() && complete->second == contents) ||
                        (old != before.end() && old->second == contents))
                << what << ": call " << at << ": '" << name << "' is half-written";
          }
          left += static_cast<int>(temporary);
          age_files();
          ASSERT_TRUE(save().ok());
          for (const auto& [name, contents] : files())
            EXPECT_FALSE(name.starts_with(".tyndall-")) << what << ": call " << at << ": '" << name << "' is left";
        }
      }
    }
    std::cout << what << ": killed at " << kills << " calls, " << left << " temporary files, all removed\n";
  }

  fs::path folder_;
};

TEST_F(ViewerSaves, State) {
  ViewSettings settings;
  settings.state_file = (folder_ / "view.toml").string();
  const auto save = [&] { return settings.save(); };
  expect_whole(
      "a new state", [] {}, save);
  const std::string old = config::to_toml(settings.left);
  settings.left.scene.camera.yaw_deg = 12.5F;
  expect_whole(
      "a changed state", [&] { std::ofstream(settings.state_file) << old; }, save);
}

TEST_F(ViewerSaves, Pictures) {
  Capture capture;
  capture.display = image::Image(7, 5);
  for (std::size_t i = 0; i < capture.display.rgb.size(); ++i) capture.display.rgb[i] = 0.01F * static_cast<float>(i);
  capture.radiance = capture.display;
  const auto save = [&]() -> Result<void> {
    Screenshot screenshot;
    screenshot.write(capture, folder_.string());
    std::optional<Result<std::string>> written;
    for (; !written; written = screenshot.take_written()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return written->ok() ? Result<void>() : Result<void>(written->error());
  };
  expect_whole(
      "a picture", [] {}, save);
}

}  // namespace
}  // namespace tyndall::viewer
