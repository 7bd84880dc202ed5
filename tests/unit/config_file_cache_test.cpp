// The cache on disk returns what was stored, and never anything else.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

#include "files/file_cache.hpp"

namespace tyndall::files {
namespace {

namespace fs = std::filesystem;

std::string pattern(std::size_t size, unsigned seed) {
  std::string out(size, '\0');
  for (std::size_t i = 0; i < size; ++i) {
    seed = seed * 1664525U + 1013904223U;
    out[i] = static_cast<char>(seed >> 24U);
  }
  return out;
}
std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

class ConfigFileCache : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "tyndall-cache-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    root_ = name;
  }
  void TearDown() override {
    ::chmod(root_.c_str(), 0700);
    fs::remove_all(root_);
  }
  [[nodiscard]] FileCache open(std::uint64_t limit = 1U << 20U, const std::string& version = "v1") const {
    return {(root_ / "a/b").string(), limit, version};
  }
  static std::string contents_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  static void overwrite(const std::string& path, const std::string& contents) {
    std::ofstream(path, std::ios::binary) << contents;
  }
  fs::path root_;
};

TEST_F(ConfigFileCache, StoredFilesAreRead) {
  FileCache cache = open();
  EXPECT_FALSE(cache.read("key", 10));
  EXPECT_EQ(cache.note(), "");
  EXPECT_FALSE(fs::exists(root_ / "a"));
  for (const std::size_t size : {0U, 1U, 31U, 32U, 33U, 262144U, 600001U, 100000U}) {
    const std::string contents = pattern(size, 1);
    cache.write("key", bytes_of(contents));
    EXPECT_EQ(cache.note(), "");
    EXPECT_EQ(open().read("key", size), contents) << size;
    std::vector<std::byte> memory(size);
    EXPECT_TRUE(open().read("key", std::span(memory)));
    EXPECT_TRUE(std::ranges::equal(memory, bytes_of(contents)));
  }
  EXPECT_FALSE(cache.read("another", 100000));
  cache.write("another", bytes_of("x"));
  EXPECT_EQ(cache.read("another", 1), "x");
  EXPECT_TRUE(cache.read("key", 100000));
}

TEST_F(ConfigFileCache, DamagedFilesAreReportedInOneLine) {
  FileCache cache = open();
  const std::string contents = pattern(1000, 2);
  cache.write("key", bytes_of(contents));
  const std::string file = cache.path("key");
  const std::string good = contents_of(file);
  const auto note = [&](const std::string& now) {
    overwrite(file, now);
    EXPECT_FALSE(cache.read("key", 1000));
    EXPECT_EQ(cache.note().find('\n'), std::string::npos);
    return cache.note();
  };
  const auto says = [&](const std::string& why) {
    return "the cached file " + file + " is " + why + " and is rebuilt";
  };
  for (const std::size_t length : {0U, 1U, 47U, 48U, 60U, 1000U})
    EXPECT_EQ(note(good.substr(0, length)), says("truncated"));
  EXPECT_EQ(note(good.substr(0, good.size() - 1)), says("truncated"));
  EXPECT_EQ(note(good + "x"), says("damaged"));
  EXPECT_EQ(note(pattern(2000, 3)), says("of another kind"));
  EXPECT_EQ(note(good + std::string(10000, 'x')), says("not readable or too large"));
  overwrite(file, good);
  EXPECT_EQ(cache.read("key", 1000), contents);
  EXPECT_EQ(cache.note(), "");
  EXPECT_FALSE(cache.read("key", 999));
  EXPECT_EQ(cache.note(), says("of another key"));
  FileCache newer = open(1U << 20U, "v2");
  EXPECT_FALSE(newer.read("key", 1000));
  EXPECT_EQ(newer.note(), says("of another version"));
  // Rewriting the entry repairs it.
  newer.write("key", bytes_of(contents));
  EXPECT_EQ(newer.read("key", 1000), contents);
  // A file of another key is rejected under this key's name.
  cache.write("other", bytes_of(contents));
  overwrite(file, contents_of(cache.path("other")));
  EXPECT_FALSE(cache.read("key", 1000));
}

// Flips every bit of a small file, and some of a large one.
TEST_F(ConfigFileCache, EveryFlippedBitIsNoticed) {
  FileCache cache = open();
  const auto flip = [&](std::size_t bit) {
    std::fstream file(cache.path("key"), std::ios::binary | std::ios::in | std::ios::out);
    const auto at = static_cast<std::streamoff>(bit / 8);
    const int byte = file.seekg(at).get();
    file.seekp(at).put(static_cast<char>(byte ^ (1 << (bit % 8))));
  };
  const auto expect_noticed = [&](std::size_t size, std::size_t bit) {
    flip(bit);
    EXPECT_FALSE(cache.read("key", size)) << bit;
    EXPECT_NE(cache.note(), "") << bit;
    flip(bit);
  };
  for (const std::size_t size : {std::size_t{40}, std::size_t{300001}}) {
    const std::string contents = pattern(size, 2);
    cache.write("key", bytes_of(contents));
    const std::size_t bits = 8 * fs::file_size(cache.path("key"));
    std::mt19937_64 random(21);
    for (std::size_t i = 0; i < (size == 40 ? bits : 200); ++i) expect_noticed(size, size == 40 ? i : random() % bits);
    EXPECT_EQ(cache.read("key", size), contents);
  }
}

// Something else that has the name of a file is reported like a damaged file, and nothing waits for it.
TEST_F(ConfigFileCache, PipesAndFoldersAreNotRead) {
  FileCache cache = open();
  cache.write("key", bytes_of("x"));
  fs::remove(cache.path("key"));
  ASSERT_EQ(::mkfifo(cache.path("key").c_str(), 0600), 0);
  EXPECT_FALSE(cache.read("key", 1));
  EXPECT_NE(cache.note().find("not readable"), std::string::npos) << cache.note();
  EXPECT_EQ(cache.size("key"), 0U);
  fs::remove(cache.path("key"));
  fs::create_directory(cache.path("key"));
  EXPECT_FALSE(cache.read("key", 1));
  EXPECT_NE(cache.note().find("not readable"), std::string::npos) << cache.note();
  cache.write("key", bytes_of("x"));
  EXPECT_NE(cache.note().find("nothing is cached"), std::string::npos) << cache.note();
}

TEST_F(ConfigFileCache, TheSizeOfAFileIsKnownBeforeItIsRead) {
  FileCache cache = open();
  EXPECT_EQ(cache.size("key"), 0U);
  for (const std::size_t size : {1U, 1000U, 600001U}) {
    const std::string contents = pattern(size, 2);
    cache.write("key", bytes_of(contents));
    EXPECT_EQ(cache.size("key"), size);
    EXPECT_EQ(cache.read("key", cache.size("key")), contents);
  }
  overwrite(cache.path("key"), "short");
  EXPECT_EQ(cache.size("key"), 0U);
  EXPECT_EQ(FileCache().size("key"), 0U);
}

TEST_F(ConfigFileCache, TheOldestFilesAreRemovedFirst) {
  FileCache cache = open(10000);
  const std::string contents = pattern(3000, 4);
  for (const char* const key : {"a", "b", "c"}) {
    cache.write(key, bytes_of(contents));
    ::usleep(20000);
  }
  EXPECT_TRUE(cache.read("a", 3000));  // now the most recently used
  cache.write("d", bytes_of(contents));
  EXPECT_TRUE(cache.read("a", 3000));
  EXPECT_FALSE(cache.read("b", 3000));
  EXPECT_TRUE(cache.read("c", 3000));
  EXPECT_TRUE(cache.read("d", 3000));
  // Foreign files are not deleted.
  overwrite((root_ / "a/b/notes.txt").string(), pattern(20000, 5));
  overwrite((root_ / "a/b/their.cache").string(), pattern(20000, 5));
  cache.write("e", bytes_of(contents));
  EXPECT_TRUE(fs::exists(root_ / "a/b/notes.txt"));
  EXPECT_TRUE(fs::exists(root_ / "a/b/their.cache"));
  const std::string large = pattern(10001, 6);
  cache.write("large", bytes_of(large));
  EXPECT_NE(cache.note().find("exceed its limit of 10000"), std::string::npos);
  EXPECT_TRUE(cache.read("e", 3000));
}

TEST_F(ConfigFileCache, ErrorsAreReportedAndNothingElseHappens) {
  overwrite((root_ / "file").string(), "");
  FileCache blocked((root_ / "file/below").string(), 1000, "v");
  blocked.write("key", bytes_of("x"));
  EXPECT_NE(blocked.note().find("nothing is cached: "), std::string::npos);
  EXPECT_FALSE(blocked.read("key", 1));
  FileCache off;
  off.write("key", bytes_of("x"));
  EXPECT_EQ(off.note(), "");
  EXPECT_FALSE(off.read("key", 1));
}

TEST_F(ConfigFileCache, SeveralProcessesShareIt) {
  constexpr int kProcesses = 4;
  const std::string contents = pattern(300000, 7);
  std::vector<pid_t> children;
  for (int p = 0; p < kProcesses; ++p) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      FileCache cache = open();
      bool good = true;
      for (int i = 0; i < 30; ++i) {
        const std::optional<std::string> read = cache.read("shared", contents.size());
        // Each read finds no entry or a complete one.
        good = good && cache.note().empty() && (!read || *read == contents);
        cache.write("shared", bytes_of(contents));
        good = good && cache.note().empty();
      }
      ::_exit(good ? 0 : 1);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  // No temporary files remain.
  EXPECT_EQ(std::distance(fs::directory_iterator(root_ / "a/b"), fs::directory_iterator()), 1);
}

// Runs a function in several processes at once and expects that it returns true in each of them.
void in_processes(int count, const std::function<bool(int)>& function) {
  std::vector<pid_t> children;
  for (int p = 0; p < count; ++p) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) ::_exit(function(p) ? 0 : 1);
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
}

TEST_F(ConfigFileCache, OneProcessBuildsAndTheOthersFindTheResult) {
  const std::string contents = pattern(100000, 8);
  const std::string log = (root_ / "builds").string();
  constexpr int kKeys = 10;
  in_processes(4, [&](int) {
    FileCache cache = open(kKeys * 200000);
    for (int i = 0; i < kKeys; ++i) {
      const std::string key = "key " + std::to_string(i);
      for (;;) {
        const BuildLock lock = cache.try_lock(key);
        if (lock.state() == BuildLock::State::busy) {
          ::usleep(500);
          continue;
        }
        if (lock.state() != BuildLock::State::held) return false;
        if (!cache.holds(key)) {
          std::ofstream(log, std::ios::app) << '.';
          cache.write(key, bytes_of(contents));
        }
        if (cache.read(key, contents.size()) != contents) return false;
        break;
      }
    }
    return true;
  });
  EXPECT_EQ(contents_of(log).size(), std::size_t{kKeys});
  EXPECT_EQ(std::distance(fs::directory_iterator(root_ / "a/b"), fs::directory_iterator()), kKeys);
}

TEST_F(ConfigFileCache, LocksEndWithTheirProcess) {
  const FileCache cache = open();
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const BuildLock lock = cache.try_lock("key");
    ::_exit(lock.state() == BuildLock::State::held ? 0 : 1);  // without removing the file
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(std::distance(fs::directory_iterator(root_ / "a/b"), fs::directory_iterator()), 1);
  {
    const BuildLock lock = cache.try_lock("key");
    EXPECT_EQ(lock.state(), BuildLock::State::held);
    EXPECT_EQ(cache.try_lock("key").state(), BuildLock::State::busy);
    EXPECT_EQ(cache.try_lock("other").state(), BuildLock::State::held);
  }
  EXPECT_TRUE(fs::is_empty(root_ / "a/b"));
  EXPECT_EQ(FileCache().try_lock("key").state(), BuildLock::State::unavailable);
  overwrite((root_ / "file").string(), "");
  EXPECT_EQ(FileCache((root_ / "file/below").string(), 1000, "v").try_lock("key").state(),
            BuildLock::State::unavailable);
}

TEST_F(ConfigFileCache, TheLimitHoldsForSeveralProcesses) {
  constexpr std::size_t kSize = 20000;
  constexpr std::uint64_t kLimit = 10 * kSize;
  const std::string contents = pattern(kSize, 9);
  in_processes(4, [&](int process) {
    FileCache cache = open(kLimit);
    for (int i = 0; i < 40; ++i) {
      cache.write(std::to_string(process * 7 + i), bytes_of(contents));
      if (!cache.note().empty()) return false;
      const std::optional<std::string> read = cache.read(std::to_string(i), kSize);
      if (!cache.note().empty() || (read && *read != contents)) return false;
    }
    return true;
  });
  std::uint64_t total = 0;
  for (const auto& entry : fs::directory_iterator(root_ / "a/b")) total += entry.file_size();
  EXPECT_LE(total, kLimit);
  EXPECT_GE(total, kLimit / 2);
}

TEST_F(ConfigFileCache, Directories) {
  EXPECT_EQ(cache_directory("off"), "");
  EXPECT_EQ(cache_directory("some/where"), "some/where");
  ::setenv("XDG_CACHE_HOME", "/x", 1);
  EXPECT_EQ(cache_directory("auto"), "/x/tyndall");
  ::setenv("XDG_CACHE_HOME", "relative", 1);
  ::setenv("HOME", "/h", 1);
  EXPECT_EQ(cache_directory("auto"), "/h/.cache/tyndall");
  ::unsetenv("XDG_CACHE_HOME");
  ::unsetenv("HOME");
  EXPECT_EQ(cache_directory("auto"), "");
}

}  // namespace
}  // namespace tyndall::files
