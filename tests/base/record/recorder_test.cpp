// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/recorder.hpp"

#include "base/error.hpp"
#include "base/files/hdf5.hpp"
#include "tests/support/temporary_folder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <gmock/gmock.h>
#include <sys/resource.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;

const std::vector<RecordColumn> columns{{"time", "s"}, {"p", "Pa"}, {"e"}};

class RecorderFiles : public TemporaryFolder
{
protected:
  static void add(Recorder &recorder, int first, int last)
  {
    for (int i = first; i < last; ++i)
      recorder.append(std::array{0.1 * i, 200e3 / (i + 1), 1.0 / 3});
  }
  std::vector<double> stored(const std::string &column) const
  {
    const hdf5::File file = hdf5::File::open(folder / "run" / "history.h5");
    return file.root().group("history").read<double>(column);
  }
  std::string csv() const { return get(folder / "run" / "history.csv"); }
};

TEST_F(RecorderFiles, BothFormsHoldTheRows)
{
  Recorder recorder(folder / "run", columns);
  add(recorder, 0, 3);
  recorder.flush();
  EXPECT_EQ(csv(), "time (s),p (Pa),e (-)\n0,200000,0.3333333333\n0.1,100000,0.3333333333\n"
                   "0.2,66666.66667,0.3333333333\n");
  EXPECT_EQ(stored("p"), (std::vector<double>{200e3, 100e3, 200e3 / 3}));
  const hdf5::File file = hdf5::File::open(folder / "run" / "history.h5");
  EXPECT_EQ(file.root().group("history").unit("p"), "Pa");
  EXPECT_EQ(file.root().group("history").unit("e"), "-");
}

TEST_F(RecorderFiles, AZeroHasNoSign)
{
  Recorder recorder(folder / "run", columns);
  recorder.append(std::array{0.0, -0.0, -1e-300});
  recorder.flush();
  EXPECT_THAT(csv(), HasSubstr("\n0,0,-1e-300\n"));
  EXPECT_FALSE(std::signbit(stored("p").front()));
}

TEST_F(RecorderFiles, NumbersThatAreInfiniteOrNoneEndTheRun)
{
  Recorder recorder(folder / "run", columns);
  recorder.append(std::array{0.0, 1.0, 2.0});
  for (const double bad : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THAT(message_of<RunFailure>([&] {
                  recorder.append(std::array{0.1, bad, 2.0});
                }),
                AllOf(HasSubstr("history.csv: p = "), HasSubstr("in row 2; the run has gone wrong")));
  recorder.flush();
  EXPECT_EQ(recorder.n_rows(), 1u);
  EXPECT_EQ(stored("p"), std::vector<double>{1.0});
  EXPECT_TRUE(csv().ends_with("\n0,1,2\n")) << csv();
}

TEST_F(RecorderFiles, LinesAppearWholeAndInTime)
{
  Recorder recorder(folder / "run", columns);
  add(recorder, 0, 100);
  const std::string text = csv();
  EXPECT_EQ(text.back(), '\n');
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + static_cast<int>(Recorder::rows_per_line_flush));
}

TEST_F(RecorderFiles, DestructorFlushes)
{
  {
    Recorder recorder(folder / "run", columns);
    add(recorder, 0, 5);
  }
  EXPECT_EQ(stored("e").size(), 5u);
}

TEST_F(RecorderFiles, LongHistoryReachesHdf5ByItself)
{
  Recorder recorder(folder / "run", columns);
  add(recorder, 0, 5000);
  EXPECT_EQ(stored("time").size(), 4097u);
  recorder.flush();
  EXPECT_EQ(stored("time").size(), 5000u);
}

TEST_F(RecorderFiles, ResumedEqualsUninterrupted)
{
  {
    Recorder recorder(folder / "run", columns);
    add(recorder, 0, 300);
  }
  const std::string text = csv();
  const std::vector<double> p = stored("p");
  std::ofstream(folder / "run" / "history.csv", std::ios::app) << "0.5,12"; // killed while writing
  {
    Recorder recorder(folder / "run", columns, 120);
    EXPECT_EQ(recorder.n_rows(), 120u);
    EXPECT_EQ(stored("p").size(), 120u);
    add(recorder, 120, 300);
  }
  EXPECT_EQ(csv(), text);
  EXPECT_EQ(stored("p"), p);
}

TEST_F(RecorderFiles, ResumeZeroStartsAgain)
{
  {
    Recorder recorder(folder / "run", columns);
    add(recorder, 0, 3);
  }
  Recorder recorder(folder / "run", {{"q", "Pa"}}, 0);
  EXPECT_EQ(csv(), "q (Pa)\n");
  EXPECT_TRUE(stored("q").empty());
}

TEST_F(RecorderFiles, WrongResumesAreInputErrorsAndChangeNothing)
{
  EXPECT_THAT(message_of<InputError>([&] { Recorder(folder / "run", columns, 2); }), HasSubstr("history.h5"));
  {
    Recorder recorder(folder / "run", columns);
    add(recorder, 0, 3);
  }
  const std::string text = csv(), numbers = get(folder / "run/history.h5");
  EXPECT_THAT(message_of<InputError>([&] { Recorder(folder / "run", columns, 4); }),
              HasSubstr("has the shape [3], the checkpoint expects 4 rows"));
  EXPECT_THAT(message_of<InputError>([&] {
                Recorder(folder / "run", {{"q", "Pa"}}, 2);
              }),
              HasSubstr("3 columns, expected 1"));
  EXPECT_EQ(get(folder / "run/history.h5"), numbers);
  hdf5::File wide = hdf5::File::update(folder / "run/history.h5");
  wide.root().group("history").create_series("q", "Pa", 2);
  wide.commit();
  const std::string changed = get(folder / "run/history.h5");
  std::vector<RecordColumn> more = columns;
  more.push_back({"q", "Pa"});
  EXPECT_THAT(message_of<InputError>([&] { Recorder(folder / "run", more, 2); }),
              HasSubstr("\"q\" has the shape [0, 2]"));
  EXPECT_EQ(get(folder / "run/history.h5"), changed);
  put("run/history.h5", "text");
  EXPECT_THAT(message_of<InputError>([&] { Recorder(folder / "run", columns, 2); }), HasSubstr("not an HDF5 file"));
  EXPECT_EQ(csv(), text);
}

TEST_F(RecorderFiles, BytesDoNotShowWhenRowsWereFlushed)
{
  std::string at_once;
  for (const int every : {20'000, 1, 7, 700, 1024, 5000})
    {
      std::filesystem::remove_all(folder / "run");
      {
        Recorder recorder(folder / "run", columns);
        for (int i = 0; i < 20'000; i += every)
          {
            add(recorder, i, std::min(i + every, 20'000));
            if (every > 100 || i < 50 * every)
              recorder.flush();
          }
        recorder.flush();
      }
      if (every == 700)
        {
          Recorder resumed(folder / "run", columns, 9'876);
          add(resumed, 9'876, 20'000);
        }
      const std::string bytes = get(folder / "run/history.h5");
      if (at_once.empty())
        at_once = bytes;
      EXPECT_EQ(bytes.size(), at_once.size()) << every;
      EXPECT_TRUE(bytes == at_once) << every;
    }
}

TEST_F(RecorderFiles, ResumeWritesTheCsvAgainWhateverBecameOfIt)
{
  {
    Recorder recorder(folder / "run", columns);
    add(recorder, 0, 9000);
  }
  const std::string text = csv();
  std::string zeros = text;
  zeros.replace(500, 4000, 4000, '\0'); // as a loss of power leaves a file
  for (const std::string &found : {std::string(), text.substr(0, 1000), zeros, std::string("other,columns\n")})
    {
      put("run/history.csv", found);
      Recorder(folder / "run", columns, 9000);
      EXPECT_EQ(csv(), text);
    }
  std::filesystem::remove(folder / "run/history.csv");
  Recorder(folder / "run", columns, 9000);
  EXPECT_EQ(csv(), text);
}

TEST_F(RecorderFiles, ACsvThatOthersChangeIsWrittenAgain)
{
  {
    Recorder recorder(folder / "run", columns);
    add(recorder, 0, 9000);
  }
  const std::string text = csv();
  Recorder recorder(folder / "run", columns);
  add(recorder, 0, 4200);
  std::filesystem::remove(folder / "run/history.csv");
  add(recorder, 4200, 5000);
  put("run/history.csv", csv().substr(0, 300));
  recorder.flush(); // also where no row is waiting
  put("run/history.csv", csv() + "1,2,3\n");
  add(recorder, 5000, 9000);
  recorder.flush();
  EXPECT_EQ(csv(), text);
  EXPECT_EQ(stored("time").size(), 9000u);
}

TEST_F(RecorderFiles, WhatOthersDoToItsHdf5IsAFailureOfTheRun)
{
  Recorder recorder(folder / "run", columns);
  add(recorder, 0, 5);
  recorder.flush();
  const std::string older = get(folder / "run/history.h5");
  add(recorder, 5, 9);
  recorder.flush();
  const std::string newer = get(folder / "run/history.h5");
  add(recorder, 9, 11);
  for (const std::string &found : {older, std::string("text")})
    {
      put("run/history.h5", found);
      EXPECT_THAT(message_of<RunFailure>([&] { recorder.flush(); }),
                  HasSubstr("another program has removed or changed"));
    }
  std::filesystem::remove(folder / "run/history.h5");
  EXPECT_THAT(message_of<RunFailure>([&] { recorder.flush(); }), HasSubstr("Put it back"));
  put("run/history.h5", newer);
  recorder.flush();
  EXPECT_EQ(stored("time").size(), 11u);
}

TEST_F(RecorderFiles, AFolderInPlaceOfTheCsvIsRefused)
{
  {
    Recorder recorder(folder / "run", columns);
    add(recorder, 0, 3);
  }
  std::filesystem::remove(folder / "run/history.csv");
  std::filesystem::create_directory(folder / "run/history.csv");
  EXPECT_THAT(message_of<InputError>([&] { Recorder(folder / "run", columns, 3); }), HasSubstr("is a folder"));
}

TEST_F(RecorderFiles, UnwritableFolderIsARunFailure)
{
  const auto file = put("a_file", "x");
  EXPECT_THAT(message_of<RunFailure>([&] { Recorder(file / "run", columns); }), HasSubstr("cannot be made"));
}

/// A full disk, imitated by a limit on the size of files: whole lines stay, and rows are not lost once there is room.
TEST_F(RecorderFiles, FullDiskKeepsWholeLinesAndWaitingRows)
{
  Recorder recorder(folder / "run", columns);
  add(recorder, 0, 3);
  recorder.flush();
  const std::string before = csv();
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const auto old_signal = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{before.size() + 10, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  add(recorder, 3, 6);
  const std::string message = message_of<RunFailure>([&] { recorder.flush(); });
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_signal);
  EXPECT_THAT(message, HasSubstr("free space"));
  EXPECT_EQ(csv(), before);
  recorder.flush();
  const std::string after = csv();
  EXPECT_EQ(std::count(after.begin(), after.end(), '\n'), 7);
  EXPECT_EQ(stored("p").size(), 6u);
}
} // namespace
} // namespace isostat
