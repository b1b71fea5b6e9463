// SPDX-License-Identifier: BSD-3-Clause
// Elements as bytes: the same bits continue, in this process and in another.
#include "base/error.hpp"
#include "dem/drive/rate_control.hpp"
#include "tests/support/near.hpp"
#include "tests/support/rve_paths.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;
using test::expect_same_bits, test::run, test::simple_shear;

const Snapshot &specimen() { return test::rve_specimen(); }
} // namespace

TEST(Rve, BytesContinueToTheSameBits)
{
  Rve rve(specimen(), {});
  run(rve, 0, 5);
  Rve copy = Rve::unpack(rve.pack(), {});
  expect_same_bits(copy.save(), rve.save());
  EXPECT_EQ(copy.cost().steps, rve.cost().steps);
  run(rve, 5, 40);
  run(copy, 5, 40);
  expect_same_bits(copy.save(), rve.save());
  EXPECT_EQ(copy.stress(), rve.stress());
}

// Runs only in the process that BytesGoOnInAnotherProcess starts.
TEST(RveChild, ContinuesFromAFile)
{
  const char *path = std::getenv("ISOSTAT_PACKED_RVE");
  if (!path)
    GTEST_SKIP() << "started by RveProcess.BytesContinueInAnotherProcess";
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> read((std::istreambuf_iterator<char>(in)), {});
  Rve rve = Rve::unpack(std::as_bytes(std::span(read)), {});
  run(rve, 5, 40);
  const RveState state = rve.save();
  std::ofstream out(std::string(path) + ".out", std::ios::binary);
  out.write(reinterpret_cast<const char *>(state.grains.grains.data()),
            static_cast<std::streamsize>(8 * state.grains.grains.size()));
}

TEST(RveProcess, BytesContinueInAnotherProcess)
{
  Rve rve(specimen(), {});
  run(rve, 0, 5);
  const fs::path path = fs::temp_directory_path() / ("isostat_rve_" + std::to_string(::getpid()));
  const std::vector<std::byte> bytes = rve.pack();
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char *>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  const std::string self = fs::read_symlink("/proc/self/exe").string();
  const std::string command = "ISOSTAT_PACKED_RVE='" + path.string() + "' '" + self +
                              "' --gtest_filter=RveChild.ContinuesFromAFile >/dev/null 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  run(rve, 5, 40);
  const RveState here = rve.save();
  std::vector<double> there(here.grains.grains.size());
  std::ifstream in(path.string() + ".out", std::ios::binary);
  in.read(reinterpret_cast<char *>(there.data()), static_cast<std::streamsize>(8 * there.size()));
  EXPECT_EQ(in.gcount(), static_cast<std::streamsize>(8 * there.size()));
  EXPECT_EQ(there, here.grains.grains);
  fs::remove(path);
  fs::remove(path.string() + ".out");
}

TEST(Rve, BytesContinueAtTheRateThatTheyAreGiven)
{
  const std::vector<std::byte> bytes = Rve(specimen(), {}).pack();
  RveSettings slow;
  slow.motion.inertial_number = controlled_inertial_number / 10;
  Rve usual = Rve::unpack(bytes, {}), slower = Rve::unpack(bytes, slow);
  const std::uint64_t steps = usual.advance(simple_shear(1e-4)).steps;
  EXPECT_NEAR_BECAUSE(static_cast<double>(slower.advance(simple_shear(1e-4)).steps) / static_cast<double>(steps), 10.0,
                      0.1, "whole numbers of some 200 and 2,000 steps");
}

TEST(Rve, DamagedBytesAreRefused)
{
  const Rve rve(specimen(), {});
  const std::vector<std::byte> whole = rve.pack();
  std::vector<std::byte> damaged = whole;
  damaged[damaged.size() / 2] ^= std::byte{1};
  EXPECT_THROW(Rve::unpack(damaged, {}), InputError);
  EXPECT_THROW(Rve::unpack(std::span(whole).first(whole.size() - 8), {}), InputError);
  EXPECT_THROW(Rve::unpack(std::span(whole).first(10), {}), InputError);
  EXPECT_THROW(Rve::unpack({}, {}), InputError);
  damaged = whole;
  damaged[0] ^= std::byte{1};
  EXPECT_THROW(Rve::unpack(damaged, {}), InputError);
}
} // namespace isostat
