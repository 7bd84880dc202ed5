// Files are written completely or not at all.
#include "files/files.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

namespace {

// Simulate file systems (CIFS, FUSE, WSL drives) that reject these calls.
bool refuse_modes = false, refuse_links = false, refuse_nameless = false;

}  // namespace

extern "C" int fchmod(int descriptor, mode_t mode) noexcept {
  if (!refuse_modes) return static_cast<int>(::syscall(SYS_fchmod, descriptor, mode));
  errno = EPERM;
  return -1;
}

extern "C" int linkat(int from_directory, const char* from, int to_directory, const char* to, int flags) noexcept {
  if (!refuse_links) return static_cast<int>(::syscall(SYS_linkat, from_directory, from, to_directory, to, flags));
  errno = EPERM;
  return -1;
}

// access() decides whether unnamed temporary files are used.
extern "C" int access(const char* path, int mode) noexcept {
  if (!refuse_nameless || std::string(path) != "/proc/self/fd")
    return static_cast<int>(::syscall(SYS_access, path, mode));
  errno = EACCES;
  return -1;
}

namespace tyndall::files {
namespace {

class Files : public testing::Test {
 protected:
  Files() {
    std::string pattern = (std::filesystem::temp_directory_path() / "tyndall-test-XXXXXX").string();
    directory_ = ::mkdtemp(pattern.data());
  }
  ~Files() override { std::filesystem::remove_all(directory_); }

  std::string at(const std::string& name) const { return (directory_ / name).string(); }
  std::size_t entries() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(directory_)) ++count;
    return count;
  }

  std::filesystem::path directory_;
};

TEST_F(Files, AppearOnlyWhenComplete) {
  Result<AtomicFile> file = AtomicFile::create(at("a"));
  ASSERT_TRUE(file.ok());
  ASSERT_TRUE(file.value().write("hello").ok());
  EXPECT_FALSE(std::filesystem::exists(at("a")));
  ASSERT_TRUE(file.value().seek(0).ok());
  ASSERT_TRUE(file.value().write("J").ok());
  ASSERT_TRUE(file.value().commit().ok());
  EXPECT_EQ(read_file(at("a"), 100).value(), "Jello");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(Files, WithoutCommitNothingRemainsAndTheOldStays) {
  ASSERT_TRUE(write_file(at("a"), "old").ok());
  {
    Result<AtomicFile> file = AtomicFile::create(at("a"));
    ASSERT_TRUE(file.ok());
    ASSERT_TRUE(file.value().write("new").ok());
    AtomicFile moved = std::move(file).value();
    ASSERT_TRUE(moved.write("er").ok());
  }
  EXPECT_EQ(read_file(at("a"), 100).value(), "old");
  EXPECT_EQ(entries(), 1U);
  ASSERT_TRUE(write_file(at("a"), "newest").ok());
  EXPECT_EQ(read_file(at("a"), 100).value(), "newest");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(Files, LinksAndModesArePreserved) {
  ASSERT_TRUE(write_file(at("target"), "old").ok());
  ASSERT_EQ(::chmod(at("target").c_str(), 0640), 0);
  std::filesystem::create_symlink("target", at("link"));
  ASSERT_TRUE(write_file(at("link"), "new").ok());
  EXPECT_TRUE(std::filesystem::is_symlink(at("link")));
  EXPECT_EQ(read_file(at("target"), 100).value(), "new");
  struct stat info {};
  ASSERT_EQ(::stat(at("target").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777U, 0640U);
}

TEST_F(Files, AreReplacedWhereModesCannotBeSet) {
  ASSERT_TRUE(write_file(at("a"), "old").ok());
  refuse_modes = true;
  const Result<void> written = write_file(at("a"), "new");
  refuse_modes = false;
  ASSERT_TRUE(written.ok()) << written.error().message;
  EXPECT_EQ(read_file(at("a"), 100).value(), "new");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(Files, AreReplacedWhereNamelessFilesCannotBeLinked) {
  ASSERT_TRUE(write_file(at("a"), "old").ok());
  ASSERT_EQ(::chmod(at("a").c_str(), 0600), 0);
  refuse_links = true;
  const Result<void> written = write_file(at("a"), std::string(200000, 'n'));
  refuse_links = false;
  ASSERT_TRUE(written.ok()) << written.error().message;
  EXPECT_EQ(read_file(at("a"), 300000).value(), std::string(200000, 'n'));
  struct stat info {};
  ASSERT_EQ(::stat(at("a").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777U, 0600U);
  EXPECT_EQ(entries(), 1U);
}

TEST_F(Files, LinksToFilesThatDoNotExistYetAreFollowed) {
  std::filesystem::create_directory(at("folder"));
  std::filesystem::create_symlink("folder/target", at("link"));
  std::filesystem::create_symlink("link", at("link_to_link"));
  ASSERT_TRUE(check_writable(at("link_to_link")).ok());
  ASSERT_TRUE(write_file(at("link_to_link"), "new").ok());
  EXPECT_TRUE(std::filesystem::is_symlink(at("link")));
  EXPECT_TRUE(std::filesystem::is_symlink(at("link_to_link")));
  EXPECT_EQ(read_file(at("folder/target"), 100).value(), "new");
  std::filesystem::create_symlink("none/target", at("astray"));
  EXPECT_FALSE(write_file(at("astray"), "x").ok());
  EXPECT_TRUE(std::filesystem::is_symlink(at("astray")));
  std::filesystem::create_symlink("circle", at("circle"));
  EXPECT_FALSE(write_file(at("circle"), "x").ok());
}

TEST_F(Files, LeftoversOfKilledRunsAreRemoved) {
  const auto age = [&](const std::string& name) {
    std::filesystem::last_write_time(at(name), std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  };
  // The child is killed before it commits, on a file system without unnamed temporary files.
  const pid_t child = ::fork();
  if (child == 0) {
    refuse_nameless = true;
    Result<AtomicFile> file = AtomicFile::create(at("partial"));
    if (file) static_cast<void>(file.value().write("half").ok());
    ::kill(::getpid(), SIGKILL);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(entries(), 1U);
  const std::string left = std::filesystem::directory_iterator(directory_)->path().filename().string();
  remove_leftovers(directory_.string());
  EXPECT_EQ(entries(), 1U) << "too young: its writer may be about to take the lock";
  age(left);
  std::filesystem::create_directory(at(".tyndall-1"));  // a folder of an export
  std::ofstream(at(".tyndall-1/a.exr")) << "a";
  age(".tyndall-1");
  std::ofstream(at(".hidden")) << "not ours";
  age(".hidden");
  std::ofstream(at(".tyndall-2-0.tmp")) << "in use";
  age(".tyndall-2-0.tmp");
  const int in_use = ::open(at(".tyndall-2-0.tmp").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(in_use, LOCK_EX | LOCK_NB), 0);
  ASSERT_TRUE(check_writable(at("next")).ok());
  EXPECT_FALSE(std::filesystem::exists(at(left)));
  EXPECT_FALSE(std::filesystem::exists(at(".tyndall-1")));
  EXPECT_TRUE(std::filesystem::exists(at(".hidden")));
  EXPECT_TRUE(std::filesystem::exists(at(".tyndall-2-0.tmp")));
  ::close(in_use);
}

TEST_F(Files, DevicesAreWrittenAndNotReplaced) {
  std::filesystem::create_symlink("/dev/full", at("full"));
  EXPECT_TRUE(check_writable(at("full")).ok());
  const Result<void> result = write_file(at("full"), "x");
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::io);
  EXPECT_NE(result.error().message.find("No space left on device"), std::string::npos) << result.error().message;
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
  EXPECT_TRUE(write_file("/dev/null", "x").ok());
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(Files, PlacesThatCannotBeWritten) {
  for (const std::string& path : {at("none/a"), directory_.string(), at("a/"), std::string(), at(std::string(300, 'x')),
                                  std::string("a\0b", 3)}) {
    const Result<void> checked = check_writable(path);
    ASSERT_FALSE(checked.ok()) << path;
    EXPECT_EQ(checked.error().code, ErrorCode::io);
    EXPECT_EQ(checked.error().message.find('\n'), std::string::npos);
    EXPECT_FALSE(write_file(path, "x").ok()) << path;
  }
  EXPECT_TRUE(check_writable(at("fine")).ok());
  EXPECT_EQ(entries(), 0U);
}

TEST_F(Files, AFullDiskLeavesNothing) {
  const pid_t child = ::fork();
  if (child == 0) {
    // A limit on the file size simulates a full disk.
    const rlimit limit = {4096, 4096};
    ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const Result<void> result = write_file(at("big"), std::string(100000, 'x'));
    ::_exit(!result && result.error().message.find("File too large") != std::string::npos ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(entries(), 0U);
}

TEST_F(Files, AKilledWriterLeavesNothing) {
  if (::access("/proc/self/fd", X_OK) != 0) GTEST_SKIP() << "no nameless files here";
  const pid_t child = ::fork();
  if (child == 0) {
    Result<AtomicFile> file = AtomicFile::create(at("partial"));
    if (file) static_cast<void>(file.value().write(std::string(100000, 'x')).ok());
    ::kill(::getpid(), SIGKILL);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(entries(), 0U);
}

TEST_F(Files, ReadingStopsAtItsLimit) {
  ASSERT_TRUE(write_file(at("a"), "12345").ok());
  EXPECT_EQ(read_file(at("a"), 5).value(), "12345");
  EXPECT_FALSE(read_file(at("a"), 4).ok());
  EXPECT_FALSE(read_file("/dev/zero", 1000).ok());
  EXPECT_EQ(read_file("/dev/null", 10).value(), "");
}

}  // namespace
}  // namespace tyndall::files
