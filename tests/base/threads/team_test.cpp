// SPDX-License-Identifier: BSD-3-Clause
#include "base/threads/team.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numeric>
#include <sched.h>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace isostat
{
TEST(DefaultThreads, AreThoseThatAreAskedForOrTheProcessors)
{
  const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  ::setenv("OMP_NUM_THREADS", "3", 1);
  EXPECT_EQ(default_threads(), 3);
  ::setenv("OMP_NUM_THREADS", "5,2", 1);
  EXPECT_EQ(default_threads(), 5);
  for (const char *no_number : {"", "many", "0", "-2"})
    {
      ::setenv("OMP_NUM_THREADS", no_number, 1);
      EXPECT_THAT(default_threads(), testing::AllOf(testing::Ge(1), testing::Le(all)));
    }
  std::thread([all] { // bound to one processor, as mpirun does
    cpu_set_t one;
    sched_getaffinity(0, sizeof one, &one);
    for (int cpu = 0, kept = 0; cpu < CPU_SETSIZE; ++cpu)
      if (CPU_ISSET(cpu, &one) && kept++ > 0)
        CPU_CLR(cpu, &one);
    sched_setaffinity(0, sizeof one, &one);
    EXPECT_EQ(default_threads(), 1);
  })
      .join();
  ::unsetenv("OMP_NUM_THREADS");
}

TEST(Team, EveryThreadDoesItsPartOfEveryRound)
{
  for (int n : {1, 2, 3, 7})
    {
      std::vector<long> sums(n, 0);
      for (int round = 0; round < 300; ++round)
        Team::of(n).run(n, [&](int thread) { sums[thread] += round; });
      EXPECT_THAT(sums, testing::Each(299L * 150));
    }
}

TEST(Team, IsWokenFromSleep)
{
  int worked = 0;
  for (int round = 0; round < 5; ++round)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(20)); // long after the others have gone to sleep
      Team::of(2).run(2, [&](int thread) { worked += thread; });
      Team::of(2).run(2, [&](int thread) { // and so is the caller
        if (thread == 1)
          std::this_thread::sleep_for(std::chrono::milliseconds(20));
        worked += thread;
      });
    }
  EXPECT_EQ(worked, 10);
}

TEST(Team, FewerThreadsThanThereAre)
{
  int worked = 0;
  Team::of(4).run(4, [](int) {});
  Team::of(4).run(2, [&](int thread) { worked += thread; });
  Team::of(4).run(4, [&](int thread) { worked += thread == 3 ? 10 : 0; });
  EXPECT_EQ(worked, 11);
}

TEST(Team, FailureOfTheLowestThreadReachesTheCaller)
{
  const auto fail_from = [](int first) {
    Team::of(4).run(4, [&](int thread) {
      if (thread >= first)
        throw std::runtime_error(std::to_string(thread));
    });
  };
  for (int first : {0, 1, 2, 3})
    EXPECT_THAT([&] { fail_from(first); },
                testing::ThrowsMessage<std::runtime_error>(testing::StrEq(std::to_string(first))));
  EXPECT_NO_THROW(fail_from(4)); // nothing is left of it
}

TEST(Team, WorksInAForkedProcess)
{
  Team::of(3).run(3, [](int) {});
  const pid_t child = fork();
  if (child == 0)
    {
      std::atomic<int> sum{0};
      Team::of(3).run(3, [&](int thread) { sum += thread; });
      _exit(sum == 3 ? 0 : 1);
    }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(Pieces, AreAllDoneOnce)
{
  for (int threads : {1, 2, 5})
    {
      std::vector<int> done(100, 0);
      for_each_piece(threads, done.size(), [&](std::size_t i) { ++done[i]; });
      EXPECT_THAT(done, testing::Each(1)) << threads;
      for_each_in_ranges(threads, done.size(), [&](std::size_t i) { ++done[i]; });
      EXPECT_THAT(done, testing::Each(2)) << threads;
    }
}
} // namespace isostat
