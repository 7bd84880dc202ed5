// Checksums of shaders with the files that they include.
#include "files/glsl_sources.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace tyndall::files {
namespace {

namespace fs = std::filesystem;

class GlslSourcesTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "tyndall-glsl-XXXXXX").string();
    root_ = ::mkdtemp(pattern.data());
    write("shaders/main.comp", "#version 460\n#include \"lib/a.glsl\"\n  #  include  \"shared/c.h\"\nvoid main() {}\n");
    write("shaders/other.comp", "#version 460\n");
    write("shaders/lib/a.glsl", "#include \"lib/b.glsl\"\nint a;\n");
    write("shaders/lib/b.glsl", "#include \"lib/a.glsl\"\nint b;\n");
    write("include/shared/c.h", "int c;\n");
  }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] std::string checksum(const std::string& shader = "main.comp") const {
    return GlslSources((root_ / "shaders").string()).checksum(shader);
  }

  fs::path root_;
};

TEST_F(GlslSourcesTest, EveryIncludedFileCounts) {
  const std::string before = checksum();
  const std::string other = checksum("other.comp");
  EXPECT_EQ(before.size(), 16U);
  EXPECT_EQ(checksum(), before);
  const char* const names[] = {"shaders/main.comp", "shaders/lib/a.glsl", "shaders/lib/b.glsl", "include/shared/c.h"};
  for (const char* name : names) {
    std::ifstream file(root_ / name, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    write(name, text + "// changed\n");
    EXPECT_NE(checksum(), before) << name;
    EXPECT_EQ(checksum("other.comp"), other) << name;
    write(name, text);
    EXPECT_EQ(checksum(), before) << name;
  }
}

TEST_F(GlslSourcesTest, TextsDoNotRunIntoEachOther) {
  write("shaders/lib/a.glsl", "int a;\n");
  const std::string before = checksum();
  // The same bytes in the same order, but another division into files.
  write("shaders/main.comp", "#version 460\n#include \"lib/a.glsl\"\n  #  include  \"shared/c.h\"\n");
  write("shaders/lib/a.glsl", "void main() {}\nint a;\n");
  EXPECT_NE(checksum(), before);
}

TEST_F(GlslSourcesTest, MissingFilesAreNoticed) {
  EXPECT_EQ(checksum("missing.comp"), "");
  const std::string before = checksum();
  fs::remove(root_ / "include/shared/c.h");
  EXPECT_NE(checksum(), before);
  EXPECT_NE(checksum(), "");
}

TEST_F(GlslSourcesTest, ListsTheFilesThatWereRead) {
  GlslSources sources((root_ / "shaders").string());
  ASSERT_NE(sources.checksum("main.comp"), "");
  EXPECT_EQ(sources.paths().size(), 4U);
  EXPECT_TRUE(sources.paths().contains((root_ / "shaders/lib/b.glsl").string()));
}

}  // namespace
}  // namespace tyndall::files
