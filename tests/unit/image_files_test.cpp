// EXR and PNG on disk: what goes in comes out, and damaged files are one clear line.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "config/files.hpp"
#include "image/image.hpp"

namespace tyndall::image {
namespace {

// A smooth picture with values from 0 to `top`, another in each channel.
Image ramp(std::uint32_t width, std::uint32_t height, float top) {
  Image image(width, height);
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      float* const pixel = image.pixel(x, y);
      pixel[0] = top * static_cast<float>(x) / static_cast<float>(width - 1);
      pixel[1] = top * static_cast<float>(y) / static_cast<float>(height - 1);
      pixel[2] = top * static_cast<float>(x + y) / static_cast<float>(width + height - 2);
    }
  }
  return image;
}

class ImageFiles : public testing::Test {
 protected:
  ImageFiles() {
    std::string pattern = (std::filesystem::temp_directory_path() / "tyndall-test-XXXXXX").string();
    directory_ = ::mkdtemp(pattern.data());
  }
  ~ImageFiles() override { std::filesystem::remove_all(directory_); }

  std::string at(const std::string& name) const { return (directory_ / name).string(); }
  std::size_t entries() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(directory_)) ++count;
    return count;
  }
  std::string message_of(const std::string& path) const {
    const Result<File> file = read(path);
    return file ? "(accepted)" : file.error().message;
  }

  std::filesystem::path directory_;
  const Metadata metadata_ = {{"tyndall.camera.yaw_deg", "332"},
                              {"tyndall.terrain.source", "h\xc3\xb6he.tif"},
                              {"tyndall.empty", ""}};
};

TEST_F(ImageFiles, ExrKeepsEveryBit) {
  Image image = ramp(131, 77, 1.0e5F);
  image.pixel(3, 4)[0] = std::numeric_limits<float>::infinity();
  image.pixel(5, 6)[1] = -1.0e-30F;
  const Result<void> written = write_exr(at("a.exr"), image, metadata_);
  ASSERT_TRUE(written.ok()) << written.error().message;
  const Result<File> back = read(at("a.exr"));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back.value().kind, FileKind::exr);
  EXPECT_EQ(back.value().image.width, 131U);
  EXPECT_EQ(back.value().image.height, 77U);
  EXPECT_EQ(back.value().image.rgb, image.rgb);
  for (const auto& entry : metadata_) {
    EXPECT_EQ(std::count(back.value().metadata.begin(), back.value().metadata.end(), entry), 1)
        << entry.first;
  }
  EXPECT_EQ(count_non_finite(back.value().image), 1U);
  EXPECT_EQ(entries(), 1U);
}

TEST_F(ImageFiles, HalfExrIsWithinItsPrecision) {
  const Image image = ramp(40, 70, 3.0F);
  ASSERT_TRUE(write_exr(at("a.exr"), image, {}, ExrPrecision::half16).ok());
  const Result<File> back = read(at("a.exr"));
  ASSERT_TRUE(back.ok()) << back.error().message;
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    ASSERT_NEAR(back.value().image.rgb[i], image.rgb[i], image.rgb[i] / 2048.0F + 1e-7F);
  }
  const Result<void> too_large = write_exr(at("b.exr"), ramp(4, 4, 70000.0F), {}, ExrPrecision::half16);
  ASSERT_FALSE(too_large.ok());
  EXPECT_NE(too_large.error().message.find("65504"), std::string::npos);
  EXPECT_EQ(entries(), 1U);
}

TEST_F(ImageFiles, PngKeepsEightBitsAndMetadata) {
  Image image(256, 3);
  for (std::uint32_t x = 0; x < 256; ++x) {
    for (int i = 0; i < 9; ++i)
      image.pixel(x, static_cast<std::uint32_t>(i / 3))[i % 3] = static_cast<float>(x) / 255.0F;
  }
  const Result<void> written = write_png(at("a.png"), image, metadata_, {Encoding::srgb, false});
  ASSERT_TRUE(written.ok()) << written.error().message;
  const Result<File> back = read(at("a.png"));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back.value().kind, FileKind::png);
  EXPECT_EQ(back.value().image.rgb, image.rgb);
  EXPECT_EQ(back.value().metadata.size(), metadata_.size());
  for (const auto& entry : metadata_) {
    EXPECT_EQ(std::count(back.value().metadata.begin(), back.value().metadata.end(), entry), 1)
        << entry.first;
  }
}

TEST_F(ImageFiles, PngEncodesLinearValues) {
  Image image(2, 2);
  const float values[] = {0.0F, 0.002F, 0.2158605F, 1.0F};  // 0.2158605 is 128 / 255 encoded
  for (std::uint32_t i = 0; i < 4; ++i) std::fill_n(image.pixel(i % 2, i / 2), 3, values[i]);
  ASSERT_TRUE(write_png(at("a.png"), image, {}, {Encoding::linear, false}).ok());
  const Result<File> back = read(at("a.png"));
  ASSERT_TRUE(back.ok());
  const float expected[] = {0.0F, 7.0F, 128.0F, 255.0F};
  for (std::uint32_t i = 0; i < 4; ++i)
    EXPECT_EQ(std::round(back.value().image.pixel(i % 2, i / 2)[0] * 255.0F), expected[i]);
}

TEST_F(ImageFiles, TheSameImageGivesTheSameBytes) {
  const Image image = ramp(100, 50, 1.0F);
  for (const std::string ending : {".png", ".exr"}) {
    for (const std::string name : {"a", "b"}) {
      const std::string path = at(name + ending);
      ASSERT_TRUE(
          (ending == ".png" ? write_png(path, image, metadata_) : write_exr(path, image, metadata_)).ok());
    }
    EXPECT_EQ(config::read_file(at("a" + ending), 1U << 20U).value(),
              config::read_file(at("b" + ending), 1U << 20U).value());
  }
}

TEST_F(ImageFiles, NotFiniteIsReportedByPng) {
  Image image(10, 10);
  image.pixel(7, 3)[2] = std::numeric_limits<float>::quiet_NaN();
  image.pixel(8, 3)[2] = -std::numeric_limits<float>::infinity();
  const Result<void> written = write_png(at("a.png"), image, {});
  ASSERT_FALSE(written.ok());
  EXPECT_NE(written.error().message.find("2 values are not finite, the first at pixel 7,3"),
            std::string::npos)
      << written.error().message;
  EXPECT_EQ(entries(), 0U);
}

TEST_F(ImageFiles, WhatCannotBeWritten) {
  const Image image = ramp(8, 8, 1.0F);
  std::filesystem::create_symlink("/dev/full", at("full"));
  for (const std::string& path : {at("none/a"), directory_.string(), at("full")}) {
    EXPECT_FALSE(write_png(path, image, {}).ok()) << path;
    const Result<void> exr = write_exr(path, image, {});
    ASSERT_FALSE(exr.ok()) << path;
    EXPECT_EQ(exr.error().code, ErrorCode::io);
  }
  EXPECT_FALSE(write_png(at("a.png"), Image(), {}).ok());
  EXPECT_FALSE(write_exr(at("a.exr"), image, {{std::string(80, 'n'), "v"}}).ok());
  EXPECT_FALSE(write_png(at("a.png"), image, {{"n", "\xff"}}).ok());
  EXPECT_EQ(entries(), 1U);
  EXPECT_TRUE(kind_of_name("A.PNG").ok());
  EXPECT_EQ(kind_of_name("x.y.exr").value(), FileKind::exr);
  EXPECT_EQ(kind_of_name("out.jpg").error().message,
            "unknown image format, 'out.jpg', allowed is a name in .png or .exr");
}

TEST_F(ImageFiles, AFullDiskLeavesNothingAndTheOldFile) {
  ASSERT_TRUE(config::write_file(at("a.png"), "old").ok());
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit limit = {3000, 3000};
    ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const Image image = ramp(300, 300, 1.0F);
    const bool failed = !write_png(at("a.png"), image, {}).ok() && !write_exr(at("a.exr"), image, {}).ok();
    ::_exit(failed ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(entries(), 1U);
  EXPECT_EQ(config::read_file(at("a.png"), 100).value(), "old");
}

TEST_F(ImageFiles, MissingOrOfAnotherKind) {
  EXPECT_NE(message_of(at("none.png")).find("No such file or directory"), std::string::npos);
  EXPECT_NE(message_of(directory_.string()).find("Is a directory"), std::string::npos);
  ASSERT_TRUE(config::write_file(at("empty.png"), "").ok());
  EXPECT_NE(message_of(at("empty.png")).find("it is empty"), std::string::npos);
  ASSERT_TRUE(config::write_file(at("text.exr"), "hello\n").ok());
  EXPECT_NE(message_of(at("text.exr")).find("it is neither PNG nor EXR"), std::string::npos);
}

// Cut off at many places and with many bytes changed: either read, or one line. Never a crash.
TEST_F(ImageFiles, DamagedFiles) {
  const Image image = ramp(70, 90, 1.0F);
  ASSERT_TRUE(write_png(at("a.png"), image, metadata_).ok());
  ASSERT_TRUE(write_exr(at("a.exr"), image, metadata_).ok());
  for (const std::string name : {"a.png", "a.exr"}) {
    const std::string whole = config::read_file(at(name), 1U << 20U).value();
    const std::size_t step = whole.size() / 60 + 1;
    int refused = 0;
    for (std::size_t position = 0; position < whole.size(); position += step) {
      ASSERT_TRUE(config::write_file(at("cut"), whole.substr(0, position)).ok());
      const std::string cut = message_of(at("cut"));
      EXPECT_NE(cut, "(accepted)") << name << " cut at " << position;
      EXPECT_EQ(cut.find('\n'), std::string::npos);
      std::string changed = whole;
      changed[position] = static_cast<char>(changed[position] ^ 0x55);
      ASSERT_TRUE(config::write_file(at("changed"), changed).ok());
      const std::string damage = message_of(at("changed"));
      EXPECT_EQ(damage.find('\n'), std::string::npos);
      refused += damage != "(accepted)" ? 1 : 0;
    }
    EXPECT_GT(refused, 20) << name;
  }
}

}  // namespace
}  // namespace tyndall::image
