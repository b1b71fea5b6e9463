// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/specimen_file.hpp"

#include "base/error.hpp"
#include "base/files/hdf5.hpp"
#include "dem/io/snapshot_file.hpp"
#include "tests/support/temporary_folder.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>

namespace isostat
{
namespace
{
using testing::HasSubstr;

class SpecimenFile : public TemporaryFolder
{
protected:
  const std::filesystem::path path = folder / "specimen.h5";

  std::string refusal() const
  {
    const std::string message = message_of<InputError>([&] { read_specimen(path); });
    EXPECT_THAT(message, HasSubstr("specimen.h5"));
    return message;
  }
  /// A specimen file around any state, without the checks of write_specimen.
  void write_unchecked(const Snapshot &state, std::uint64_t version = specimen_schema_version) const
  {
    hdf5::File file = hdf5::File::create(path);
    hdf5::Group root = file.root();
    root.set_attribute("format", std::string("isostat-specimen"));
    root.set_attribute("schema_version", version);
    root.create_group("provenance");
    root.create_group("numbers");
    write_snapshot(root.create_group("snapshot"), state);
    file.commit();
  }
};

TEST_F(SpecimenFile, RoundTrip)
{
  const Specimen s{
      small_snapshot(), {{"title", "loose"}, {"recipe", "a\nb"}, {"key", ""}}, {{"void_ratio", 0.1 + 0.2}}};
  write_specimen(path, s);
  const Specimen r = read_specimen(path);
  EXPECT_EQ(r.provenance, s.provenance);
  EXPECT_EQ(r.numbers, s.numbers);
  EXPECT_EQ(r.state.grains.position, s.state.grains.position);
  EXPECT_EQ(r.state.contacts.size(), 2u);
}

TEST_F(SpecimenFile, SameSpecimenSameBytes)
{
  write_specimen(path, {small_snapshot(), {{"title", "t"}}, {}});
  write_specimen(folder / "b.h5", {small_snapshot(), {{"title", "t"}}, {}});
  EXPECT_EQ(get(path), get(folder / "b.h5"));
}

TEST_F(SpecimenFile, WrongFilesAreRefused)
{
  EXPECT_THAT(refusal(), HasSubstr("no such file"));
  put("specimen.h5", "x y z r\n");
  EXPECT_THAT(refusal(), HasSubstr("not an HDF5 file"));
  write_specimen(path, {small_snapshot(), {}, {}});
  cut_to_half(path);
  EXPECT_THAT(refusal(), HasSubstr("truncated"));
}

TEST_F(SpecimenFile, ForeignFormatsAreRefused)
{
  hdf5::File file = hdf5::File::create(path);
  file.root().write("data", std::vector<double>{1}, "m");
  file.commit();
  EXPECT_THAT(refusal(), HasSubstr("without the attribute format"));
  file = hdf5::File::create(path);
  file.root().set_attribute("format", std::string("isostat-checkpoint"));
  file.commit();
  EXPECT_THAT(refusal(), HasSubstr("\"isostat-checkpoint\", expected format = \"isostat-specimen\""));
  write_unchecked(small_snapshot(), 2);
  EXPECT_THAT(refusal(), HasSubstr("schema_version = 2, this program reads 1"));
}

TEST_F(SpecimenFile, BadStatesAreRefusedBothWays)
{
  const auto refused = [&](const Snapshot &state) {
    write_unchecked(state);
    EXPECT_THROW(write_specimen(folder / "never.h5", {state, {}, {}}), RunFailure);
    EXPECT_FALSE(std::filesystem::exists(folder / "never.h5"));
    return refusal();
  };
  Snapshot s = small_snapshot();
  s.grains.position[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refused(s), HasSubstr("grain 1 (id 3) has a value of nan in its position"));
  s = small_snapshot();
  s.grains.position[3] = -0.1;
  EXPECT_THAT(refused(s), HasSubstr("radius -0.1"));
  s = small_snapshot();
  s.contacts[0].history.shear_force[1] = INFINITY;
  EXPECT_THAT(refused(s), HasSubstr("contact 0"));
  s = small_snapshot();
  s.box.upper = s.box.lower;
  EXPECT_THAT(refused(s), HasSubstr("the box has edges 0"));
  s = small_snapshot();
  s.cell = PeriodicCell::with_edges({1e-3, 1e-3, 1e-3});
  s.grains.position[4] = 1e200;
  EXPECT_THAT(refused(s), HasSubstr("grain 1 (id 3) is 1e+203 edges away from the periodic cell"));
  s = small_snapshot();
  s.grains = make_packing({}, {}, 2650);
  s.contacts.clear();
  s.wall_contacts.clear();
  EXPECT_THAT(refused(s), HasSubstr("no grains"));
}

TEST_F(SpecimenFile, UnwritableFolderIsARunFailure)
{
  const auto file = put("a_file", "x");
  EXPECT_THAT(message_of<RunFailure>([&] {
                write_specimen(file / "s.h5", {small_snapshot(), {}, {}});
              }),
              HasSubstr("cannot create"));
}
} // namespace
} // namespace isostat
