// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/replace_file.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "tests/support/temporary_folder.hpp"

#include <fcntl.h>
#include <fstream>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

class ReplaceFile : public TemporaryFolder
{
protected:
  std::vector<std::string> names() const
  {
    std::vector<std::string> found;
    for (const fs::directory_entry &entry : fs::directory_iterator(folder))
      found.push_back(entry.path().filename().string());
    return found;
  }

  /// A text of 64 KiB of one letter, many times under one name.
  void write_often(char letter) const
  {
    for (int round = 0; round < 25; ++round)
      write_replacing(folder / "a.txt", std::string(1 << 16, letter));
  }

  void expect_one_whole_file() const
  {
    const std::string text = read_text(folder / "a.txt");
    EXPECT_EQ(text, std::string(1 << 16, text.at(0)));
    EXPECT_THAT(names(), testing::ElementsAre("a.txt"));
  }

  /// What a killed writer leaves.
  fs::path leftover(const std::string &name, std::chrono::seconds age) const
  {
    std::ofstream(folder / name) << "half of";
    fs::last_write_time(folder / name, fs::file_time_type::clock::now() - age);
    return folder / name;
  }
};

TEST_F(ReplaceFile, ManyThreadsMayWriteOneFile)
{
  std::vector<std::thread> threads;
  for (char letter : {'a', 'b', 'c', 'd'})
    threads.emplace_back([&, letter] { write_often(letter); });
  for (std::thread &thread : threads)
    thread.join();
  expect_one_whole_file();
}

TEST_F(ReplaceFile, ManyProcessesMayWriteOneFile)
{
  std::vector<pid_t> children;
  for (char letter : {'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h'})
    if (const pid_t child = fork(); child != 0)
      children.push_back(child);
    else
      {
        int code = 1;
        try
          {
            write_often(letter);
            code = 0;
          }
        catch (...)
          {}
        _exit(code);
      }
  for (pid_t child : children)
    {
      int status = -1;
      waitpid(child, &status, 0);
      EXPECT_EQ(status, 0);
    }
  expect_one_whole_file();
}

TEST_F(ReplaceFile, WhatKilledWritersLeftIsRemovedAndNothingElse)
{
  using namespace std::chrono_literals;
  const fs::path old = leftover("a.txt.4711-0.tmp", 10min), young = leftover("a.txt.4711-1.tmp", 1s),
                 theirs = leftover("thesis.tex.tmp", 10min), written = leftover("b.h5.12-3.tmp", 10min);
  fs::create_symlink("thesis.tex.tmp", folder / "c.4711-2.tmp");
  const int file = ::open(written.c_str(), O_RDONLY);
  ASSERT_EQ(::flock(file, LOCK_EX | LOCK_NB), 0);
  remove_leftovers(folder);
  EXPECT_THAT(names(),
              testing::UnorderedElementsAre(young.filename(), theirs.filename(), written.filename(), "c.4711-2.tmp"));
  ::close(file);
  remove_leftovers(folder);
  EXPECT_FALSE(fs::exists(written)) << "its writer has ended";
  remove_leftovers(folder / "nowhere");
}

TEST_F(ReplaceFile, AFileThatHasTheNameOfAnEarlierOneAsideIsLeftAlone)
{
  std::ofstream(folder / "a.txt.tmp") << "theirs";
  write_replacing(folder / "a.txt", "new");
  EXPECT_EQ(read_text(folder / "a.txt"), "new");
  EXPECT_EQ(read_text(folder / "a.txt.tmp"), "theirs");
}

TEST_F(ReplaceFile, ALinkIsReplacedAndNotFollowed)
{
  write_replacing(folder / "theirs.txt", "theirs");
  fs::create_symlink("theirs.txt", folder / "a.txt");
  write_replacing(folder / "a.txt", "new");
  EXPECT_EQ(read_text(folder / "theirs.txt"), "theirs");
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder / "a.txt")));
}

TEST_F(ReplaceFile, FoldersAndPipesAreNotReplaced)
{
  fs::create_directory(folder / "a");
  ASSERT_EQ(::mkfifo((folder / "b").c_str(), 0600), 0);
  for (const char *name : {"a", "b"})
    EXPECT_THAT(message_of<InputError>([&] { write_replacing(folder / name, "new"); }),
                testing::HasSubstr("is a folder, a pipe or a device, which is not replaced. Give another path"));
  EXPECT_TRUE(fs::is_fifo(folder / "b"));
  EXPECT_THAT(names(), testing::UnorderedElementsAre("a", "b"));
}

TEST_F(ReplaceFile, WhatFailsLeavesNothingAside)
{
  write_replacing(folder / "a.txt", "old");
  EXPECT_THROW(write_replacing(folder / "a.txt", [](std::ostream &) { throw RunFailure("no"); }), RunFailure);
  EXPECT_THROW(write_replacing(folder / "nowhere/a.txt", "new"), RunFailure);
  EXPECT_EQ(read_text(folder / "a.txt"), "old");
  EXPECT_THAT(names(), testing::ElementsAre("a.txt"));
}
} // namespace
} // namespace isostat
