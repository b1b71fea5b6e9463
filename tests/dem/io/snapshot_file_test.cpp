// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/snapshot_file.hpp"

#include "base/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <cstring>
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

template <typename T>
bool same_bits(const T &a, const T &b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(*a.data())) == 0;
}

TEST_F(SnapshotFile, APeriodicCellComesBackToTheBit)
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
  ASSERT_TRUE(r.cell.has_value());
  for (auto m : {&PeriodicCell::edges, &PeriodicCell::deformation, &PeriodicCell::rotation, &PeriodicCell::strain_step})
    EXPECT_TRUE(same_bits((*s.cell).*m, (*r.cell).*m));
  EXPECT_EQ(s.cell->volume_strain, r.cell->volume_strain);
  EXPECT_EQ(s.cell->reference_volume, r.cell->reference_volume);
  EXPECT_EQ(s.cell->flips, r.cell->flips);
  EXPECT_EQ(s.volume(), r.volume());
}

TEST_F(SnapshotFile, RoundTripToTheBit)
{
  const Snapshot s = small_snapshot(), r = round_trip(s);
  EXPECT_TRUE(same_bits(s.grains.position, r.grains.position)); // padding included
  EXPECT_TRUE(same_bits(s.grains.velocity, r.grains.velocity));
  EXPECT_TRUE(same_bits(s.grains.spin, r.grains.spin));
  EXPECT_EQ(s.grains.id, r.grains.id);
  EXPECT_EQ(s.grains.density, r.grains.density);
  EXPECT_TRUE(same_bits(s.box.lower, r.box.lower) && same_bits(s.box.upper, r.box.upper));
  EXPECT_TRUE(same_bits(s.strain, r.strain));
  EXPECT_EQ(s.time, r.time);
  EXPECT_EQ(s.step, r.step);
  EXPECT_EQ(s.law->young, r.law->young);
  EXPECT_EQ(s.law->friction, r.law->friction);
  EXPECT_TRUE(s.law == r.law);
  ASSERT_EQ(r.contacts.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i)
    {
      const Contact &a = s.contacts[i], &b = r.contacts[i];
      EXPECT_TRUE(a.first == b.first && a.second == b.second && a.overlap == b.overlap &&
                  a.normal_force == b.normal_force);
      EXPECT_TRUE(same_bits(a.history.normal, b.history.normal));
      EXPECT_TRUE(same_bits(a.history.shear_force, b.history.shear_force));
      EXPECT_TRUE(same_bits(a.history.bending_moment, b.history.bending_moment));
      EXPECT_TRUE(same_bits(a.history.twisting_moment, b.history.twisting_moment));
    }
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
