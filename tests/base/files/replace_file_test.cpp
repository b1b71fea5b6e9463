// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/replace_file.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

namespace isostat
{
namespace
{
class ReplaceFile : public TemporaryFolder
{
protected:
  void expect_written()
  {
    write_replacing(folder / "a.txt", "new");
    EXPECT_EQ(read_text(folder / "a.txt"), "new");
    EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(folder / "a.txt.tmp")));
  }
};

TEST_F(ReplaceFile, WhatWasLeftAsideIsReplaced)
{
  write_replacing(folder / "a.txt.tmp", "the beginning of a file whose writer was killed");
  expect_written();
}

TEST_F(ReplaceFile, ALinkByTheNameOfTheFileAsideIsNotFollowed)
{
  write_replacing(folder / "theirs.txt", "theirs");
  std::filesystem::create_symlink("theirs.txt", folder / "a.txt.tmp");
  expect_written();
  EXPECT_EQ(read_text(folder / "theirs.txt"), "theirs");
  EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(folder / "a.txt")));
}

TEST_F(ReplaceFile, AFileThatHasTheNameOfTheFileAsideToIsNotWrittenTo)
{
  write_replacing(folder / "theirs.txt", "theirs");
  std::filesystem::create_hard_link(folder / "theirs.txt", folder / "a.txt.tmp");
  expect_written();
  EXPECT_EQ(read_text(folder / "theirs.txt"), "theirs");
}

TEST_F(ReplaceFile, FoldersAndPipesAreNotReplaced)
{
  std::filesystem::create_directory(folder / "a");
  ASSERT_EQ(::mkfifo((folder / "b").c_str(), 0600), 0);
  for (const char *name : {"a", "b"})
    EXPECT_THAT(message_of<InputError>([&] { write_replacing(folder / name, "new"); }),
                testing::HasSubstr("is a folder, a pipe or a device, which is not replaced. Give another path"));
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "b"));
  EXPECT_FALSE(std::filesystem::exists(folder / "b.tmp"));
}

TEST_F(ReplaceFile, APipeByTheNameOfTheFileAsideIsNotWaitedFor)
{
  ASSERT_EQ(::mkfifo((folder / "a.txt.tmp").c_str(), 0600), 0);
  expect_written();
}
} // namespace
} // namespace isostat
