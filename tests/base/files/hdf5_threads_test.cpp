// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/hdf5.hpp"

#include "base/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <numeric>
#include <thread>

namespace isostat::hdf5
{
namespace
{
class Hdf5Threads : public TemporaryFolder
{
protected:
  /// Files of one thread: written, added to, read, and one that does not exist.
  void use_files(int thread, int rounds) const
  {
    const std::filesystem::path path = folder / fmt::format("thread{}.h5", thread);
    std::vector<double> numbers(500);
    for (int round = 0; round < rounds; ++round)
      {
        std::iota(numbers.begin(), numbers.end(), thread + 10.0 * round);
        File made = File::create(path);
        Group group = made.root().create_group("some");
        group.write("numbers", numbers, "m", 2);
        group.set_attribute("name", fmt::format("{} {}", thread, round));
        group.create_series("rows", "-", 4);
        made.commit();
        File more = File::update(path);
        more.root().group("some").append("rows", numbers);
        more.commit();
        const Group read = File::open(path).root().group("some");
        EXPECT_EQ(read.read<double>("numbers"), numbers);
        EXPECT_EQ(read.rows("rows", 0, 125), numbers);
        EXPECT_EQ(read.attribute<std::string>("name"), fmt::format("{} {}", thread, round));
        EXPECT_THROW(read.read<double>("missing"), InputError);
      }
  }
};

// Debian's HDF5 serves one thread at a time; without turns this ends with a crash within some rounds.
TEST_F(Hdf5Threads, AnyNumberUseFilesAtOnce)
{
  for (int n : {2, 3, 4})
    {
      std::vector<std::thread> threads;
      for (int thread = 0; thread < n; ++thread)
        threads.emplace_back([&, thread] { use_files(thread, 20); });
      for (std::thread &thread : threads)
        thread.join();
    }
}

TEST_F(Hdf5Threads, OneFileIsReadByMany)
{
  File made = File::create(folder / "shared.h5");
  made.root().write("numbers", std::vector<double>(1000, 3), "m");
  made.commit();
  const File shared = File::open(folder / "shared.h5");
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread)
    threads.emplace_back([&] {
      for (int round = 0; round < 50; ++round)
        EXPECT_THAT(shared.root().read<double>("numbers"), testing::Each(3.0));
    });
  for (std::thread &thread : threads)
    thread.join();
}
} // namespace
} // namespace isostat::hdf5
