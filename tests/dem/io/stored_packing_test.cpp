// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/stored_packing.hpp"

#include "base/error.hpp"
#include "dem/io/snapshot_file.hpp"
#include "dem/io/specimen_library.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;

class StoredPacking : public TemporaryFolder
{};

TEST_F(StoredPacking, SpecimensKeepContactsAndTime)
{
  Specimen specimen{small_snapshot(), {{"recipe", "by hand"}}, {}};
  specimen.state.step = 7;
  write_specimen(folder / "a.h5", specimen);
  LibraryWriter library = LibraryWriter::create(folder / "library.h5");
  library.add("s0001", specimen);
  library.commit();
  for (const Specimen &read :
       {read_stored_packing(folder / "a.h5"), read_stored_packing(folder / "library.h5", "s0001")})
    {
      EXPECT_EQ(read.state.contacts.size(), 2u);
      EXPECT_EQ(read.state.step, 7u);
      EXPECT_EQ(read.provenance.at("recipe"), "by hand");
    }
}

TEST_F(StoredPacking, ASnapshotOfARunCountsFromHere)
{
  Snapshot s = small_snapshot();
  s.step = 7;
  s.time = 0.5;
  s.strain.setConstant(0.1);
  write_snapshot_file(folder / "snapshot.h5", s);
  const Specimen read = read_stored_packing(folder / "snapshot.h5");
  EXPECT_EQ(read.state.grains.position, s.grains.position);
  EXPECT_EQ(read.state.step, 0u);
  EXPECT_EQ(read.state.time, 0);
  EXPECT_EQ(read.state.strain, Vec3::Zero());
  EXPECT_THAT(read.provenance.at("recipe"), HasSubstr("snapshot.h5"));
}
} // namespace
} // namespace isostat
