#include "viewer/platform/files.hpp"

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>

namespace tyndall::viewer {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> data_folders() {
  std::vector<fs::path> out;
  if (const char* place = std::getenv("TYNDALL_DATA"); place != nullptr && *place != '\0') out.emplace_back(place);
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) out.push_back(program.parent_path() / TYNDALL_DATA_FROM_PROGRAM);
  if (const fs::path sources = TYNDALL_SOURCE_FOLDER; !sources.empty()) out.push_back(sources);
  return out;
}

fs::path first_run_mark(const std::string& state_file) { return fs::path(state_file).parent_path() / "view-seen"; }

}  // namespace

std::string shipped_folder(std::string_view folder) {
  std::error_code error;
  for (const fs::path& data : data_folders()) {
    const fs::path found = data / folder;
    if (fs::is_directory(found, error)) return found.lexically_normal().string();
  }
  return {};
}

std::vector<SceneFile> shipped_scenes(std::string_view folder) {
  std::vector<SceneFile> out;
  const std::string found = shipped_folder(folder);
  if (found.empty()) return out;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(found, error)) {
    if (entry.path().extension() == ".toml") out.push_back({entry.path().stem().string(), entry.path().string()});
  }
  std::sort(out.begin(), out.end(), [](const SceneFile& a, const SceneFile& b) { return a.name < b.name; });
  return out;
}

std::string default_state_file() {
  const auto absolute = [](const char* name) -> std::string {
    const char* value = std::getenv(name);
    return value != nullptr && *value == '/' ? value : "";
  };
  if (const std::string state = absolute("XDG_STATE_HOME"); !state.empty()) return state + "/tyndall/view.toml";
  if (const std::string home = absolute("HOME"); !home.empty()) return home + "/.local/state/tyndall/view.toml";
  return "tyndall-view.toml";
}

bool make_folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) return true;
  std::error_code error;
  fs::create_directories(folder, error);
  return fs::is_directory(folder, error);
}

std::string screenshot_stem(const std::string& folder, const std::vector<std::string>& endings) {
  const std::time_t now = std::time(nullptr);
  std::tm parts = {};
  localtime_r(&now, &parts);
  char name[64];
  std::strftime(name, sizeof name, "tyndall-%Y%m%d-%H%M%S", &parts);
  const fs::path base = fs::path(folder) / name;
  std::string stem = base.string();
  std::error_code error;
  const auto taken = [&] {
    return std::any_of(endings.begin(), endings.end(),
                       [&](const std::string& e) { return fs::exists(stem + e, error); });
  };
  for (int i = 2; taken(); ++i) stem = base.string() + "-" + std::to_string(i);
  return stem;
}

bool first_run(const std::string& state_file) {
  std::error_code error;
  return !fs::exists(first_run_mark(state_file), error);
}

void leave_first_run_mark(const std::string& state_file) {
  if (!make_folder_of(state_file)) return;
  std::ofstream(first_run_mark(state_file)) << "The help of the first run has been read.\n";
}

}  // namespace tyndall::viewer
