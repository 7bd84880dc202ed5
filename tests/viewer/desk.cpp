#include "desk.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "image/image.hpp"

namespace tyndall::desk {
namespace {

namespace fs = std::filesystem;

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool installed(const std::string& program) {
  std::istringstream path(std::getenv("PATH") != nullptr ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(path, folder, ':');) {
    if (::access((folder + "/" + program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

constexpr double kLook_s = 0.02;   // polling interval
constexpr double kLong_s = 240.0;  // timeout

void pause(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// Starts a program and redirects its output to the file `output`.
int start(std::vector<std::string> words, const std::vector<std::string>& environment, const std::string& output) {
  const int child = ::fork();
  if (child != 0) return child;
  const int out = ::open(output.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  ::dup2(out, 1);
  ::dup2(out, 2);
  for (const std::string& assignment : environment) ::putenv(const_cast<char*>(assignment.c_str()));
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execvp(arguments[0], arguments.data());
  std::_Exit(127);
}

// Returns whether a child has ended, without consuming its exit status.
bool has_ended(int child) {
  siginfo_t info = {};
  return ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == child;
}

int status_of(int child, double seconds) {
  constexpr double kStep_s = 0.005;  // pause between events; real input takes some milliseconds
  for (double waited = 0.0; waited < seconds; waited += kStep_s) {
    int status = 0;
    if (::waitpid(child, &status, WNOHANG) == child) return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    pause(kStep_s);
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  return -1;
}

std::uint32_t big_endian(const std::string& bytes, std::size_t word) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = (value << 8U) | static_cast<unsigned char>(bytes[4 * word + i]);
  return value;
}

}  // namespace

bool equipped() { return installed("Xvfb") && installed("xdotool"); }

Desk::Desk(const std::string& name, int width, int height)
    : folder_(std::string(TYNDALL_VIEWER_ARTEFACTS) + "/" + name) {
  fs::remove_all(folder_);
  fs::create_directories(folder_ + "/screen");
  // The server chooses a free display and prints its number.
  const std::string said = folder_ + "/display";
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  server_ = start({"sh", "-c",
                   "exec Xvfb -displayfd 3 -screen 0 " + size + "x24 -fbdir '" + folder_ +
                       "/screen' -nolisten tcp 3>'" + said + "'"},
                  {}, folder_ + "/server.txt");
  for (int i = 0; i < 600 && display_.empty(); ++i) {
    const std::string text = read_text(said);
    if (text.ends_with('\n')) display_ = ":" + text.substr(0, text.size() - 1);
    pause(0.05);
  }
}

Desk::~Desk() {
  if (viewer_ > 0) {
    ::kill(viewer_, SIGKILL);
    ::waitpid(viewer_, nullptr, 0);
  }
  if (manager_ > 0) {
    ::kill(manager_, SIGTERM);
    ::waitpid(manager_, nullptr, 0);
  }
  end_server();
  std::error_code ignored;
  fs::remove_all(folder_ + "/screen", ignored);
}

void Desk::end_server() {
  if (server_ <= 0) return;
  ::kill(server_, SIGTERM);
  ::waitpid(server_, nullptr, 0);
  server_ = -1;
}

bool Desk::open(const std::vector<std::string>& arguments, const std::vector<std::string>& environment) {
  if (display_.empty()) return false;
  std::vector<std::string> words = {TYNDALL_EXECUTABLE,
                                    "view",
                                    "--log",
                                    folder_ + "/log.txt",
                                    "--state",
                                    folder_ + "/state.toml",
                                    "--screenshots",
                                    folder_,
                                    "--set",
                                    "tables.cache=" TYNDALL_TEST_CACHE};
  if (validation) words.emplace_back("--validation");
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> variables = environment;
  variables.push_back("DISPLAY=" + display_);
  log_.clear();
  log_read_ = 0;
  std::error_code ignored;
  fs::remove(folder_ + "/log.txt", ignored);
  fs::remove(folder_ + "/log.txt.places", ignored);
  viewer_ = start(words, variables, folder_ + "/errors.txt");
  if (!wait_for({"ready"})) return false;
  window_.clear();
  for (int i = 0; i < 100 && window_.empty(); ++i) {
    const std::string found = folder_ + "/window.txt";
    fs::remove(found, ignored);
    status_of(start({"xdotool", "search", "--onlyvisible", "--name", "Tyndall"}, {"DISPLAY=" + display_}, found), 20.0);
    std::istringstream text(read_text(found));
    text >> window_;
  }
  if (window_.empty()) return false;
  input("windowmove --sync " + window_ + " 0 0");
  input("windowfocus " + window_);
  return true;
}

bool Desk::manage() {
  if (!installed("openbox")) return false;
  manager_ = start({"openbox", "--config-file", "/dev/null"}, {"DISPLAY=" + display_, "HOME=" + folder_},
                   folder_ + "/manager.txt");
  // The window manager is ready when it has published its name.
  for (int i = 0; i < 200; ++i) {
    if (status_of(start({"xdotool", "get_num_desktops"}, {"DISPLAY=" + display_}, folder_ + "/input.txt"), 10.0) == 0)
      return true;
    pause(0.05);
  }
  return false;
}

void Desk::input(const std::string& commands) {
  std::vector<std::string> words = {"xdotool"};
  std::istringstream text(commands);
  for (std::string word; text >> word;) words.push_back(word);
  // "--sync" never returns if there is nothing to change, so there is a timeout.
  status_of(start(words, {"DISPLAY=" + display_}, folder_ + "/input.txt"), 10.0);
}

std::string log_text(const Desk& desk) { return read_text(desk.folder() + "/log.txt"); }
std::string Desk::errors() const { return read_text(folder_ + "/errors.txt"); }

// Reads the complete lines that the viewer has written since the last call.
void Desk::read_log() const {
  std::ifstream file(folder_ + "/log.txt", std::ios::binary);
  if (!file || !file.seekg(log_read_)) return;
  std::ostringstream text;
  text << file.rdbuf();
  const std::string more = text.str();
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = more.find('\n', begin)) != std::string::npos; begin = end + 1) {
    log_.push_back(more.substr(begin, end - begin));
  }
  log_read_ += static_cast<std::streamoff>(begin);
}

std::size_t Desk::lines() const {
  read_log();
  return log_.size();
}

std::optional<LogLine> Desk::wait_for_line(const std::vector<std::string>& words, std::size_t from, double seconds) {
  const auto has_all = [&words](const std::string& line) {
    return std::all_of(words.begin(), words.end(),
                       [&line](const std::string& word) { return line.find(word) != std::string::npos; });
  };
  for (double waited = 0.0; waited < seconds; waited += kLook_s) {
    // Determined before the log is read for the last time, so that no line is missed.
    const bool ended = viewer_ > 0 && has_ended(viewer_);
    for (const std::size_t count = lines(); from < count; ++from) {
      if (has_all(log_[from])) return LogLine{from, log_[from]};
    }
    if (ended) return std::nullopt;
    pause(kLook_s);
  }
  return std::nullopt;
}

std::optional<std::string> Desk::wait_for(const std::vector<std::string>& words, std::size_t from, double seconds) {
  const std::optional<LogLine> line = wait_for_line(words, from, seconds);
  if (!line) return std::nullopt;
  return line->text;
}

bool Desk::settles_after(const std::vector<std::string>& words, std::size_t from) {
  const std::optional<LogLine> line = wait_for_line(words, from, kLong_s);
  return line && wait_for({"settled"}, line->number + 1).has_value();
}

std::map<std::string, Desk::Rect> Desk::places() const {
  std::map<std::string, Rect> out;
  std::istringstream text(read_text(folder_ + "/log.txt.places"));
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    Rect rect = {};
    std::string name;
    words >> rect.x >> rect.y >> rect.width >> rect.height;
    std::getline(words >> std::ws, name);
    out[name] = rect;
  }
  return out;
}

bool Desk::wait_for_place(const std::string& place, bool there) {
  for (double waited = 0.0; waited < (there ? 60.0 : 20.0); waited += kLook_s) {
    if (places().contains(place) == there) return true;
    pause(kLook_s);
  }
  return false;
}

bool Desk::point_at(const std::string& place, double part) {
  // Menus move during their first frames. The place is reached if it is still under the pointer after the viewer has
  // processed the movement.
  for (int i = 0; i < 20; ++i) {
    if (!wait_for_place(place)) return false;
    const Rect rect = places()[place];
    const int x = static_cast<int>(rect.x + part * rect.width);
    const int y = static_cast<int>(rect.y + 0.5 * rect.height);
    if (x == pointer_[0] && y == pointer_[1]) return true;  // there would be no event
    const std::size_t from = lines();
    pointer_[0] = x;
    pointer_[1] = y;
    input("mousemove " + std::to_string(x) + " " + std::to_string(y));
    if (!wait_for({"pointer " + std::to_string(x) + " " + std::to_string(y)}, from)) return false;
  }
  return false;
}

bool Desk::click(const std::string& place, double part, int button) {
  if (!point_at(place, part)) return false;
  const std::string side = button == 1 ? "left" : "right";
  std::size_t from = lines();
  input("mousedown " + std::to_string(button));
  if (!wait_for({"press " + side}, from)) return false;
  from = lines();
  input("mouseup " + std::to_string(button));
  return wait_for({"release " + side}, from).has_value();
}

std::vector<std::string> Desk::place_names() const {
  std::vector<std::string> out;
  for (const auto& [name, rect] : places()) out.push_back(name);
  return out;
}

// Reads fields 14 and 15 of /proc/PID/stat (proc(5)), counted after the name in parentheses.
double Desk::cpu_s() const {
  const std::string text = read_text("/proc/" + std::to_string(viewer_) + "/stat");
  std::istringstream fields(text.substr(std::min(text.rfind(')') + 1, text.size())));
  std::string word;
  for (int i = 0; i < 11; ++i) fields >> word;
  double user = 0.0;
  double system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

int Desk::leave() {
  input("key --window " + window_ + " Escape");
  input("key Escape");
  return wait_for_end(120.0);
}

int Desk::wait_for_end(double seconds) {
  const int status = status_of(viewer_, seconds);
  viewer_ = -1;
  return status;
}

// Xvfb stores the screen in a file: an XWD header of big-endian words, a colour map with 12 bytes per entry, and the
// pixels.
bool Desk::picture(const std::string& name) {
  const std::string bytes = read_text(folder_ + "/screen/Xvfb_screen0");
  if (bytes.size() < 100) return false;
  const std::uint32_t header = big_endian(bytes, 0);
  const std::uint32_t width = big_endian(bytes, 4);
  const std::uint32_t height = big_endian(bytes, 5);
  const std::uint32_t stride = big_endian(bytes, 12);
  const std::uint32_t colors = big_endian(bytes, 19);
  const std::size_t first = header + 12U * colors;
  if (bytes.size() < first + std::size_t{stride} * height) return false;
  image::Image image(width, height);
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      for (std::uint32_t c = 0; c < 3; ++c) {
        const auto byte = static_cast<unsigned char>(bytes[first + std::size_t{stride} * y + 4 * x + 2 - c]);
        const double encoded = byte / 255.0;
        const double linear = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
        image.rgb[3 * (std::size_t{y} * width + x) + c] = static_cast<float>(linear);
      }
    }
  }
  image::PngOptions plain;
  plain.dither = false;
  return image::write_png(folder_ + "/" + name + ".png", image, {}, plain).ok();
}

}  // namespace tyndall::desk
