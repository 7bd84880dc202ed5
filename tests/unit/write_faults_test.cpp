// While a file is written, each of its system calls is made to fail in turn, with several error numbers. Then either
// the file is unchanged and the returned error names it, or it is complete.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>

#include "config/scene_file.hpp"
#include "faults/write_faults.hpp"
#include "files/file_cache.hpp"
#include "files/files.hpp"
#include "image/image.hpp"

namespace tyndall {
namespace {

namespace fs = std::filesystem;

class WriteFaults : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "tyndall-faults-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override {
    stop();
    fs::remove_all(folder_);
  }
  void fail(long at, int error, const char* call = "") { tyndall_write_faults(folder_.c_str(), at, error, call); }
  static void stop() { tyndall_write_faults("", 0, 0, ""); }
  static std::string contents_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  // Writes with a fault at each call, over an old file or to a new one. Returns the number of faults.
  int try_all(const std::string& name, const std::function<Result<void>(const std::string&)>& write, bool over_old) {
    const fs::path path = folder_ / name;
    const auto prepare = [&] {
      fs::remove_all(path);
      if (over_old) std::ofstream(path) << "old";
    };
    prepare();
    fail(0, 0);
    EXPECT_TRUE(write(path.string()).ok());
    const long calls = tyndall_write_calls();
    EXPECT_GE(calls, 4);
    stop();
    const std::string good = contents_of(path);
    int faults = 0;
    for (const int error : {ENOSPC, EACCES, EINTR, 0}) {
      for (long at = 1; at <= calls; ++at) {
        prepare();
        fail(at, error);
        const Result<void> written = write(path.string());
        EXPECT_GE(tyndall_write_calls(), at);
        stop();
        ++faults;
        const std::string what = name + ", call " + std::to_string(at) + ": " + std::strerror(error);
        if (written.ok()) {
          EXPECT_EQ(contents_of(path), good) << what;
        } else {
          EXPECT_NE(error, 0) << what;
          EXPECT_EQ(written.error().code, ErrorCode::io) << what;
          EXPECT_NE(written.error().message.find(path.string()), std::string::npos) << written.error().message;
          EXPECT_EQ(contents_of(path), over_old ? "old" : "") << what;
          EXPECT_EQ(fs::exists(path), over_old) << what;
        }
        EXPECT_EQ(files(), fs::exists(path) ? 1 : 0) << what << ": a temporary file is left";
      }
    }
    return faults;
  }
  void expect_safe(const std::string& name, const std::function<Result<void>(const std::string&)>& write) {
    const int faults = try_all(name, write, false) + try_all(name, write, true);
    std::cout << faults << " faults of writing " << name << "\n";
    fs::remove(folder_ / name);
  }
  // Expects that a call of this name may fail without consequences.
  void expect_unneeded(const char* call, int error) {
    const fs::path path = folder_ / "file";
    std::ofstream(path) << "old";
    fail(1, error, call);
    EXPECT_TRUE(files::write_file(path.string(), "new").ok()) << call;
    EXPECT_GE(tyndall_write_calls(), 1) << call;
    stop();
    EXPECT_EQ(contents_of(path), "new") << call;
    EXPECT_EQ(files(), 1) << call;
  }

  fs::path folder_;
};

image::Image picture() {
  image::Image out(7, 5);
  for (std::size_t i = 0; i < out.rgb.size(); ++i) out.rgb[i] = 0.01F * static_cast<float>(i);
  return out;
}

TEST_F(WriteFaults, Texts) {
  expect_safe("a.txt", [](const std::string& path) { return files::write_file(path, std::string(100000, 'x')); });
}

TEST_F(WriteFaults, Pictures) {
  expect_safe("a.png", [](const std::string& path) {
    return image::write_png(path, picture(), {{"key", "value"}}, {});
  });
  expect_safe("a.exr", [](const std::string& path) {
    return image::write_exr(path, picture(), {{"key", "value"}}, {});
  });
}

TEST_F(WriteFaults, Scenes) {
  expect_safe("a.toml", [](const std::string& path) { return config::save({}, path); });
}

// Locks and modes are missing on some file systems, and unnamed files on many.
TEST_F(WriteFaults, WhatAFileSystemMayLack) {
  expect_unneeded("fchmod", EPERM);
  expect_unneeded("fchmod", EOPNOTSUPP);
  expect_unneeded("flock", ENOLCK);
  expect_unneeded("open", EOPNOTSUPP);  // O_TMPFILE
  expect_unneeded("linkat", EPERM);
  expect_unneeded("write", EINTR);
}

// A cache that cannot be written costs one line. What it holds stays as it was.
TEST_F(WriteFaults, Cache) {
  const std::string old(1000, 'o');
  const std::string contents(300000, 'n');
  const auto store = [&](const std::string& text) {
    files::FileCache cache((folder_ / "cache").string(), 1U << 20U, "1");
    {
      const files::BuildLock lock = cache.try_lock("key");
      cache.write("key", std::as_bytes(std::span(text)));
    }
    return cache.note();
  };
  fail(0, 0);
  EXPECT_EQ(store(contents), "");
  const long calls = tyndall_write_calls();
  int faults = 0;
  for (const int error : {ENOSPC, EIO, EACCES, EROFS, ENOLCK}) {
    for (long at = 1; at <= calls; ++at) {
      stop();
      fs::remove_all(folder_ / "cache");
      if (at % 2 == 0) {
        EXPECT_EQ(store(old), "");
      }
      fail(at, error);
      const std::string note = store(contents);
      stop();
      ++faults;
      files::FileCache cache((folder_ / "cache").string(), 1U << 20U, "1");
      if (note.empty()) {
        EXPECT_EQ(cache.read("key", contents.size()), contents) << at;
      } else {
        EXPECT_EQ(note.find('\n'), std::string::npos);
        EXPECT_EQ(note.rfind("nothing is cached: ", 0), 0U) << note;
        EXPECT_EQ(cache.read("key", old.size()).has_value(), at % 2 == 0) << at;
      }
      if (!fs::exists(folder_ / "cache")) continue;
      for (const auto& entry : fs::directory_iterator(folder_ / "cache"))
        EXPECT_EQ(entry.path().extension(), ".cache") << at << entry.path();
    }
  }
  std::cout << faults << " faults of writing to the cache\n";
}

}  // namespace
}  // namespace tyndall
