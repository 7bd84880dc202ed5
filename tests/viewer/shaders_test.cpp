// F8 rebuilds the shaders while the viewer runs.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "window_tools.hpp"

namespace tyndall {
namespace {

using namespace desk;

namespace fs = std::filesystem;

// Tests F8 with a copy of the sources: unchanged, with another comment, invalid, and changed.
TEST(Window, RebuildsShadersWhileItRuns) {
  NEEDS_A_DESK();
  Desk desk("shaders");
  const fs::path data = fs::path(desk.folder()) / "data";
  fs::create_directories(data);
  for (const char* part : {"shaders", "include", "src", "scenes"}) {
    fs::copy(fs::path(TYNDALL_SOURCE_DIR) / part, data / part, fs::copy_options::recursive);
  }
  ASSERT_TRUE(desk.open(kSmall, {"TYNDALL_DATA=" + data.string()})) << desk.errors();
  std::size_t from = desk.lines();
  desk.input("key F8");
  ASSERT_TRUE(desk.wait_for({"shaders same"}, from)) << log_text(desk);

  const fs::path path = data / "shaders/scene/background.frag";
  std::ifstream source(path);
  std::stringstream text;
  text << source.rdbuf();
  source.close();
  // The compiler makes the same shader as the build from a source that differs in a comment only.
  std::ofstream(path) << text.str() << "\n// changed\n";
  from = desk.lines();
  desk.input("key F8");
  ASSERT_TRUE(desk.wait_for({"shaders same"}, from)) << log_text(desk);

  std::ofstream(path) << text.str() << "\nvoid broken( {\n";
  from = desk.lines();
  desk.input("key F8");
  const std::optional<std::string> failed = desk.wait_for({"shaders failed"}, from);
  ASSERT_TRUE(failed);
  EXPECT_NE(failed->find("background.frag"), std::string::npos) << *failed;
  desk.picture("broken");

  const std::string changed = std::regex_replace(text.str(), std::regex("void main\\(\\) \\{"),
                                                 "void main() {\n  if (gl_FragCoord.x < -1.0) discard;");
  ASSERT_NE(changed, text.str());
  std::ofstream(path) << changed;
  from = desk.lines();
  desk.input("key F8");
  ASSERT_TRUE(desk.wait_for({"shaders rebuilt"}, from));
  desk.picture("rebuilt");
  EXPECT_EQ(desk.leave(), 0) << desk.errors();
}

}  // namespace
}  // namespace tyndall
