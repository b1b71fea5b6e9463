// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/element/strain_record.hpp"

#include "base/error.hpp"
#include "base/files/hdf5.hpp"
#include "tests/coupling/rve_column.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using StrainRecordTest = TemporaryFolder;

StrainRecord example()
{
  StrainRecord record;
  record.depth = 3;
  record.settings.undrained = true;
  record.settings.halvings = 4;
  record.settings.rve.min_steps = 17;
  record.packing = Rve(test::soft_specimen(4), {}).pack();
  return record;
}

TEST_F(StrainRecordTest, IsReadAsItWasWritten)
{
  const StrainRecord kept = example();
  write_strain_record_start(folder, kept);
  {
    Recorder rows(folder, strain_record_columns());
    rows.append(strain_record_row(1, 0.5, Gradient{1, 2, 3, 4, 5, 6, 7, 8, 9}, Stress{10, 20, 30, 40, 50, 60}, 70));
    rows.flush();
  }
  const StrainRecord read = read_strain_record(folder);
  EXPECT_EQ(read.depth, kept.depth);
  EXPECT_EQ(read.settings.undrained, kept.settings.undrained);
  EXPECT_EQ(read.settings.halvings, kept.settings.halvings);
  EXPECT_EQ(read.settings.rve.min_steps, kept.settings.rve.min_steps);
  EXPECT_EQ(read.packing, kept.packing);
  EXPECT_THAT(read.time, testing::ElementsAre(0.5));
  EXPECT_THAT(read.increments, testing::ElementsAre(Gradient{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_THAT(read.stresses, testing::ElementsAre(Stress{10, 20, 30, 40, 50, 60}));
}

TEST_F(StrainRecordTest, OfAnOlderSchemaIsRefused)
{
  write_strain_record_start(folder, example());
  hdf5::File file = hdf5::File::update(folder / "packing.h5");
  file.root().set_attribute("schema_version", std::uint64_t{1});
  file.commit();
  const std::string message = message_of<InputError>([&] { read_strain_record(folder); });
  EXPECT_THAT(message, testing::StartsWith((folder / "packing.h5").string()));
  EXPECT_THAT(message, testing::HasSubstr("strain record schema 1 was written by another version; this one reads 5. "
                                          "Repeat it with the version that wrote it"));
}
} // namespace
} // namespace isostat
