#include "slideway/base/file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <utility>

#include "base/temporary_folder.hpp"
#include "slideway/base/error.hpp"

namespace {

bool knows_nameless_files = true;

}  // namespace

// Stands before the C library's: a file system without O_TMPFILE is not at hand everywhere.
extern "C" int open(const char* path, int flags, ...) {
  if (!knows_nameless_files && (flags & O_TMPFILE) == O_TMPFILE) {
    errno = EOPNOTSUPP;
    return -1;
  }
  std::va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

namespace slideway {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::string contents_of(const fs::path& path) {
  std::ostringstream contents;
  contents << std::ifstream(path, std::ios::binary).rdbuf();
  return contents.str();
}

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

TEST(Sha256, AgreesWithFips180Examples) {
  // FIPS 180-2 appendix B.1 to B.3, and the empty message of NIST's CAVP vectors.
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(FileBytes, GivesEveryByteOfAFile) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\r\n\xff", 6);
  EXPECT_EQ(FileBytes(folder.file("a", bytes)).text(), bytes);
  EXPECT_EQ(FileBytes(folder.file("empty", "")).text(), "");
}

TEST(FileBytes, ReadsAgainWhatItForgot) {
  const TemporaryFolder folder;
  std::string bytes(70'000'000, 'x');  // several parts, and mapped
  for (std::size_t i = 0; i < bytes.size(); i += 1000) bytes[i] = static_cast<char>(i / 1000);
  const FileBytes file(folder.file("a", bytes));
  EXPECT_EQ(sha256(file), sha256(bytes));
  file.forget(0, bytes.size());
  EXPECT_EQ(file.text(), bytes);
}

// Whatever happens to the file meanwhile: its bytes or an error, never a signal.
TEST(FileBytes, AreThoseOfAFileThatNobodyChangedMeanwhile) {
  const TemporaryFolder folder;
  const std::string whole(3'000'000, 'x');
  const fs::path path = folder.file("a", whole);
  std::atomic<bool> done{false};
  std::thread other([&] {
    while (!done) {
      fs::resize_file(path, 1);
      fs::resize_file(path, whole.size());
    }
  });
  int refused = 0;
  // On a busy machine the other thread may not run for a while.
  for (int i = 0; i < 200 || (refused == 0 && i < 20'000); ++i) {
    try {
      const FileBytes bytes(path);
      EXPECT_THAT(bytes.text().size(), ::testing::AnyOf(1U, whole.size()));
    } catch (const DataError& error) {
      EXPECT_EQ(error.what(), path.string() + ": was changed while it was read");
      ++refused;
    }
  }
  done = true;
  other.join();
  EXPECT_GT(refused, 0);
}

TEST(FileBytes, ReadsAPipe) {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string bytes(200000, 'x');
  std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << bytes; });
  const FileBytes read(pipe);
  writer.join();
  EXPECT_EQ(read.text(), bytes);
}

TEST(FileBytes, OfARegularFileRefusesWhatMayNeverEnd) {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const fs::path& path : {pipe, fs::path("/dev/zero")})
    EXPECT_THAT(
        [&] { FileBytes::of_regular_file(path); },
        ThrowsMessage<DataError>(path.string() + ": is a pipe or a device, expected a file"));
  EXPECT_EQ(FileBytes::of_regular_file(folder.file("a", "bytes")).text(), "bytes");
}

TEST(FileBytes, OfAFileOrStdinReadsAPipeThatIsOpenAlready) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  ASSERT_EQ(::write(ends[1], "bytes", 5), 5);
  ::close(ends[1]);
  EXPECT_EQ(FileBytes::of_file_or_stdin("/dev/fd/" + std::to_string(ends[0])).text(), "bytes");
  ::close(ends[0]);
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const fs::path& path : {pipe, fs::path("/dev/zero")})
    EXPECT_THAT(
        [&] { FileBytes::of_file_or_stdin(path); },
        ThrowsMessage<DataError>(path.string() + ": is a pipe or a device, expected a file"));
}

TEST(FileBytes, KeepsItsBytesWhenMoved) {
  const TemporaryFolder folder;
  const std::string large(70'000'000, 'x');
  FileBytes mapped(folder.file("a", large));
  FileBytes moved(std::move(mapped));
  EXPECT_EQ(moved.text(), large);
  // Files of /proc have no size and are read; this one is short enough for a string's own buffer.
  FileBytes owned("/proc/sys/kernel/ostype");
  EXPECT_EQ(FileBytes(std::move(owned)).text(), "Linux\n");
  moved = FileBytes("/proc/sys/kernel/ostype");
  EXPECT_EQ(moved.text(), "Linux\n");
}

TEST(FileBytes, NamesWhatItCanNotRead) {
  const TemporaryFolder folder;
  const std::string missing = (folder.path() / "none.csv").string();
  EXPECT_THAT([&] { FileBytes{missing}; },
              ThrowsMessage<DataError>(missing + ": cannot be read: No such file or directory"));
  EXPECT_THAT(
      [&] { FileBytes{folder.path()}; },
      ThrowsMessage<DataError>(folder.path().string() + ": is a directory, expected a file"));
}

TEST(WriteFile, MakesAndReplacesAWholeFile) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "out.json";
  write_file(path, "first, and longer");
  write_file(path, "second");
  EXPECT_EQ(contents_of(path), "second");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(WriteFile, DoesWithoutFilesThatHaveNoName) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "out.json";
  knows_nameless_files = false;
  write_file(path, "first, and longer");
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  write_file(path, "second");
  EXPECT_EQ(contents_of(path), "second");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  {
    WholeFile broken_off(path);
    broken_off.append(std::string(2'000'000, 'x'));
    EXPECT_EQ(entries(folder.path()), 2U);
  }
  knows_nameless_files = true;
  EXPECT_EQ(contents_of(path), "second");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(WriteFile, IsThereOnceItIsFinished) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "out.jsonl";
  const std::string large(1'500'000, 'x');
  WholeFile file(path);
  for (const std::string& piece : {std::string("a"), large, std::string("b")}) file.append(piece);
  EXPECT_EQ(entries(folder.path()), 0U);
  file.finish();
  EXPECT_EQ(contents_of(path), "a" + large + "b");
}

TEST(WriteFile, KeepsPermissionsAndLinks) {
  const TemporaryFolder folder;
  const fs::path target = folder.file("target", "old");
  const fs::path link = folder.path() / "link";
  fs::permissions(target, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("target", link);
  write_file(link, "new");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(contents_of(target), "new");
  EXPECT_EQ(fs::status(target).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(WriteFile, WritesStraightIntoDevicesAndPipes) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(write_file("/dev/null", "gone"));
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { write_file(pipe, "through"); });
  EXPECT_EQ(contents_of(pipe), "through");
  writer.join();
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(WriteFile, LeavesNothingBehindWhenItFails) {
  const TemporaryFolder folder;
  const std::string nowhere = (folder.path() / "none" / "out.json").string();
  EXPECT_THAT([&] { write_file(nowhere, "x"); },
              ThrowsMessage<std::runtime_error>(nowhere +
                                                ": cannot be written: No such file or directory"));
  EXPECT_THAT([&] { write_file(folder.path(), "x"); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr(folder.path().string()), HasSubstr("Is a directory"))));
  EXPECT_THAT(
      [] { write_file("/dev/full", "x"); },
      ThrowsMessage<std::runtime_error>("/dev/full: cannot be written: No space left on device"));
  EXPECT_EQ(entries(folder.path()), 0U);
}

TEST(WriteFile, KeepsTheOldFileWholeWhenWritingBreaksOff) {
  const TemporaryFolder folder;
  const fs::path old = folder.file("old", "whole");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  for (const fs::path& path : {old, folder.path() / "new"})
    EXPECT_THAT(
        [&] { write_file(path, std::string(100000, 'x')); },
        ThrowsMessage<std::runtime_error>(path.string() + ": cannot be written: File too large"));
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(contents_of(old), "whole");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(WriteFile, LeavesAReadOnlyFolderAsItIs) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write into any folder";
  const TemporaryFolder folder;
  const fs::path old = folder.file("old", "whole");
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  for (const fs::path& path : {old, folder.path() / "new"})
    EXPECT_THAT([&] { write_file(path, "x"); },
                ThrowsMessage<std::runtime_error>(path.string() +
                                                  ": cannot be written: Permission denied"));
  fs::permissions(folder.path(), fs::perms::owner_all);
  EXPECT_EQ(contents_of(old), "whole");
  EXPECT_EQ(entries(folder.path()), 1U);
}

}  // namespace
}  // namespace slideway
