// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/file_lock.hpp"

#include "base/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

namespace isostat
{
namespace
{
const std::filesystem::path path = std::filesystem::temp_directory_path() / fmt::format("isostat_lock_{}", getpid());

bool is_unlocked() { return static_cast<bool>(FileLock::attempt(path)); }

TEST(FileLock, HasOneHolderAndEndsWithIt)
{
  {
    FileLock lock = FileLock::attempt(path);
    EXPECT_TRUE(lock);
    EXPECT_FALSE(is_unlocked());
    const FileLock moved = std::move(lock);
    EXPECT_TRUE(moved);
    EXPECT_FALSE(is_unlocked());
  }
  EXPECT_TRUE(is_unlocked());
  std::filesystem::remove(path);
}

TEST(FileLock, SaysWhyAFileCannotBeLocked)
{
  EXPECT_THAT(
      message_of<RunFailure>([&] { FileLock::attempt(path / "of" / "nothing"); }),
      testing::HasSubstr("nothing: cannot be opened for writing: No such file or directory; check free space and "));
  std::filesystem::create_directory(path);
  EXPECT_THAT(message_of<RunFailure>([&] { FileLock::attempt(path); }),
              testing::HasSubstr("cannot be opened for writing: Is a directory"));
  std::filesystem::remove(path);
}

TEST(FileLock, LastsAsLongAsAnyProcessHasTheFileOpen)
{
  int until[2];
  ASSERT_EQ(pipe(until), 0);
  pid_t child = 0;
  {
    const FileLock lock = FileLock::attempt(path);
    ASSERT_TRUE(lock);
    child = fork();
    if (child == 0)
      {
        char byte;
        close(until[1]);
        _exit(static_cast<int>(read(until[0], &byte, 1)));
      }
  }
  EXPECT_FALSE(is_unlocked()) << "the child has the file open";
  close(until[1]);
  int status = 1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(is_unlocked());
  close(until[0]);
  std::filesystem::remove(path);
}
} // namespace
} // namespace isostat
