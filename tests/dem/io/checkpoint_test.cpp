// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/checkpoint.hpp"

#include "base/error.hpp"
#include "base/fields.hpp"
#include "base/files/hdf5.hpp"
#include "tests/support/temporary_folder.hpp"

#include <fmt/format.h>
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
  checkpoint.assembly = {{"tally_0", 1.0 / 3.0}};
  checkpoint.specimen = {{"mark", mark}};
  checkpoint.written = {1000, (1ull << 53) + 1, 0.7};
  checkpoint.scene = "title = \"x\"\n";
  return checkpoint;
}

using CheckpointTest = TemporaryFolder;

TEST_F(CheckpointTest, ComesBackBitForBit)
{
  const Checkpoint kept = example(0.1);
  write_checkpoint(folder, kept);
  const Checkpoint read = read_checkpoint(folder);
  EXPECT_EQ(read.assembly, kept.assembly);
  EXPECT_EQ(read.specimen, kept.specimen);
  EXPECT_EQ(read.written.rows, 1000u);
  EXPECT_EQ(read.written.snapshots, (1ull << 53) + 1);
  EXPECT_EQ(read.scene, kept.scene);
  EXPECT_EQ(read.state.grains.position, kept.state.grains.position);
  EXPECT_EQ(read.state.contacts[0].history.bending_moment, kept.state.contacts[0].history.bending_moment);
  EXPECT_EQ(read.state.step, 42u);
}

TEST_F(CheckpointTest, KeepsTwoAndFallsBackWhenTheNewestIsDamaged)
{
  write_checkpoint(folder, example(1e-3));
  write_checkpoint(folder, example(2e-3));
  EXPECT_EQ(read_checkpoint(folder).specimen["mark"], 2e-3);
  const auto last = folder / "last.h5";
  std::filesystem::resize_file(last, std::filesystem::file_size(last) / 2);
  testing::internal::CaptureStderr();
  EXPECT_EQ(read_checkpoint(folder).specimen["mark"], 1e-3);
  test::expect_parts(testing::internal::GetCapturedStderr(),
                     {"warning:", "last.h5: truncated", "continues from the checkpoint before", "previous.h5"});
}

TEST_F(CheckpointTest, SaysWhatIsWrongWithEach)
{
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "last.h5") << "not HDF5 at all";
  test::expect_parts(message_of<InputError>([&] { read_checkpoint(folder); }),
                     {"last.h5", "Or start again with --overwrite"});
  std::filesystem::remove(folder / "last.h5");
  EXPECT_THROW(read_checkpoint(folder), InputError);
}

/// Numbers every field again; what is optional is there.
struct Fill
{
  int n = 0;
  template <class T>
  void operator()(const char *, T &field)
  {
    ++n;
    if constexpr (Listed<T>)
      T::for_each(field, *this);
    else if constexpr (std::is_same_v<T, Vec3>)
      field = Vec3(n, n + 0.1, n + 0.2) / 3;
    else if constexpr (std::is_enum_v<T>)
      field = last_of(T{});
    else
      field = static_cast<T>((1ull << 52) + static_cast<unsigned>(n));
  }
  template <class T>
  void operator()(const char *name, std::optional<T> &field)
  {
    (*this)(name, field.emplace());
  }
  template <class T>
  void operator()(const char *name, std::vector<T> &field)
  {
    for (int k = 0; k < 2; ++k)
      (*this)(name, field.emplace_back());
  }
};

/// All fields as text; what is missing is named as such.
struct Text
{
  std::string all;
  template <class T>
  void operator()(const char *name, const T &field)
  {
    if constexpr (Listed<T>)
      T::for_each(field, *this);
    else if constexpr (std::is_same_v<T, Vec3>)
      all += fmt::format("{} {:a} {:a} {:a}; ", name, field[0], field[1], field[2]);
    else if constexpr (std::is_same_v<T, double>)
      all += fmt::format("{} {:a}; ", name, field);
    else
      all += fmt::format("{} {}; ", name, static_cast<std::uint64_t>(field));
  }
  template <class T>
  void operator()(const char *name, const std::optional<T> &field)
  {
    if (field)
      (*this)(name, *field);
    else
      all += fmt::format("no {}; ", name);
  }
  template <class T>
  void operator()(const char *name, const std::vector<T> &field)
  {
    all += fmt::format("{} of {}; ", field.size(), name);
    for (const T &value : field)
      (*this)(name, value);
  }
};

std::string text(const DriveState &state)
{
  Text text;
  text("", state);
  return text.all;
}

TEST_F(CheckpointTest, KeepsEveryFieldOfTheDriversInItsType)
{
  Checkpoint full = example(1e-3), empty = full;
  Fill fill;
  fill("", full.drive);
  EXPECT_GT(fill.n, 30);
  for (const Checkpoint &kept : {full, empty})
    {
      write_checkpoint(folder, kept);
      EXPECT_EQ(text(read_checkpoint(folder).drive), text(kept.drive));
    }
}

TEST_F(CheckpointTest, OfAnOlderSchemaIsRefused)
{
  write_checkpoint(folder, example(1e-3));
  hdf5::File file = hdf5::File::update(folder / "last.h5");
  file.root().set_attribute("schema_version", std::uint64_t{1});
  file.commit();
  test::expect_parts(message_of<InputError>([&] { read_checkpoint(folder); }),
                     {"checkpoint schema 1 was written by another version"});
}
} // namespace
} // namespace isostat
