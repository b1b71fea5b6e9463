// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/snapshot_file.hpp"

#include "base/error.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/temporary_folder.hpp"

#include <cmath>
#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using hdf5::File;
using testing::HasSubstr;

class SnapshotFile : public TemporaryFolder
{
protected:
  Snapshot round_trip(const Snapshot &s)
  {
    File out = File::create(folder / "s.h5");
    write_snapshot(out.root().create_group("snapshot"), s);
    out.commit();
    const File in = File::open(folder / "s.h5");
    return read_snapshot(in.root().group("snapshot"));
  }
};

TEST_F(SnapshotFile, APeriodicCellComesBackBitForBit)
{
  Snapshot s = small_snapshot();
  EXPECT_FALSE(round_trip(s).cell.has_value());
  s.cell = PeriodicCell::with_edges({1.0 / 3, 2.0 / 3, 0.7});
  Mat3 gradient = Mat3::Zero();
  gradient(0, 1) = 1e-3;
  gradient(2, 2) = -3e-4;
  s.cell->deform(gradient);
  s.cell->flips = 3;
  const Snapshot r = round_trip(s);
  test::expect_same_bits(s, r);
  EXPECT_EQ(s.volume(), r.volume());
}

TEST_F(SnapshotFile, RoundTripBitForBit)
{
  const Snapshot s = small_snapshot(), r = round_trip(s);
  test::expect_same_bits(s, r); // padding included
  EXPECT_EQ(s.strain, r.strain);
  EXPECT_TRUE(s.law == r.law);
  EXPECT_TRUE(std::signbit(r.grains.linear_velocity(0)[2]));
  ASSERT_EQ(r.wall_contacts.size(), 1u);
  EXPECT_EQ(r.wall_contacts[0].grain, 0u);
  EXPECT_EQ(r.wall_contacts[0].wall, 0);
  EXPECT_EQ(r.wall_contacts[0].normal_force, 3.3);
}

TEST_F(SnapshotFile, NoContactsNoGrains)
{
  Snapshot s = small_snapshot();
  s.contacts.clear();
  s.wall_contacts.clear();
  EXPECT_TRUE(round_trip(s).contacts.empty());
  s.grains = make_packing({}, {}, 2650);
  const Snapshot r = round_trip(s);
  EXPECT_EQ(r.grains.n_grains(), 0u);
  EXPECT_EQ(r.grains.position.size(), 4 * Packing::n_padding);
}

TEST_F(SnapshotFile, ContactOfAnAbsentGrainIsRefused)
{
  Snapshot s = small_snapshot();
  s.contacts[1].second = 3;
  EXPECT_THAT(message_of<InputError>([&] { round_trip(s); }), HasSubstr("contact 1 joins grains 1 and 3"));
  s = small_snapshot();
  s.wall_contacts[0].wall = 6;
  EXPECT_THAT(message_of<InputError>([&] { round_trip(s); }), HasSubstr("wall 6"));
}

/// One grain record fewer than ids, and a snapshot without its tables.
TEST_F(SnapshotFile, TablesThatDoNotMatchAreRefused)
{
  Snapshot s = small_snapshot();
  s.contacts.clear();
  s.wall_contacts.clear();
  s.grains.id.push_back(9); // the packing's padding passes as a fourth grain; the file then holds four records
  EXPECT_EQ(round_trip(s).grains.n_grains(), 4u);
  File out = File::create(folder / "t.h5");
  hdf5::Group grains = out.root().create_group("grains");
  grains.write("id", std::vector<std::uint32_t>{1, 2}, "-");
  grains.write("position", std::vector<double>(4), "m", 4);
  out.root().create_group("law");
  out.root().set_attribute("time", 0.0);
  out.commit();
  const File in = File::open(folder / "t.h5");
  EXPECT_THAT(message_of<InputError>([&] { read_snapshot(in.root()); }), HasSubstr("/@step"));
}
} // namespace
} // namespace isostat
