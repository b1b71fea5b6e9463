// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/checkpoint.hpp"

#include "base/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <fstream>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
Checkpoint example(double mark)
{
  Checkpoint checkpoint;
  checkpoint.state.grains = make_packing({Vec3(1e-3, 2e-3, mark), Vec3(4e-3, 5e-3, 6e-3)}, {1e-4, 2e-4}, 2650);
  checkpoint.state.box = {Vec3::Zero(), Vec3::Constant(1e-2)};
  checkpoint.state.step = 42;
  checkpoint.state.contacts.push_back({0, 1, 0, 0, {Vec3(1, 0, 0), Vec3(0, 0.1, 0.3), Vec3(1, 2, 3), Vec3(4, 5, 6)}});
  checkpoint.numbers = {{"drive_axial", 1.0 / 3.0}, {"mark", mark}};
  checkpoint.scene = "title = \"x\"\n";
  return checkpoint;
}

using CheckpointTest = TemporaryFolder;

TEST_F(CheckpointTest, ComesBackToTheBit)
{
  const Checkpoint kept = example(0.1);
  write_checkpoint(folder, kept);
  const Checkpoint read = read_checkpoint(folder);
  EXPECT_EQ(read.numbers, kept.numbers);
  EXPECT_EQ(read.scene, kept.scene);
  EXPECT_EQ(read.state.grains.position, kept.state.grains.position);
  EXPECT_EQ(read.state.contacts[0].history.bending_moment, kept.state.contacts[0].history.bending_moment);
  EXPECT_EQ(read.state.step, 42u);
}

TEST_F(CheckpointTest, KeepsTwoAndFallsBackWhenTheNewestIsDamaged)
{
  write_checkpoint(folder, example(1e-3));
  write_checkpoint(folder, example(2e-3));
  EXPECT_EQ(read_checkpoint(folder).numbers["mark"], 2e-3);
  const auto last = folder / "last.h5";
  std::filesystem::resize_file(last, std::filesystem::file_size(last) / 2);
  EXPECT_EQ(read_checkpoint(folder).numbers["mark"], 1e-3);
}

TEST_F(CheckpointTest, SaysWhatIsWrongWithEach)
{
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "last.h5") << "not HDF5 at all";
  try
    {
      read_checkpoint(folder);
      FAIL();
    }
  catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find("last.h5"), std::string::npos) << error.what();
    }
  std::filesystem::remove(folder / "last.h5");
  EXPECT_THROW(read_checkpoint(folder), InputError);
}
} // namespace
} // namespace isostat
