// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/lammps.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <numbers>

namespace isostat
{
namespace
{
using testing::HasSubstr;

class Lammps : public TemporaryFolder
{
protected:
  /// small_snapshot() in a cell, without contacts.
  static Snapshot periodic(const Mat3 &edges)
  {
    Snapshot s = small_snapshot();
    s.contacts.clear();
    s.wall_contacts.clear();
    s.grains.id = {7, 3, 5};
    s.cell.emplace();
    s.cell->edges = edges;
    s.cell->reference_volume = edges.determinant();
    return s;
  }
  static Mat3 leaning()
  {
    Mat3 e = Vec3(0.9, 1.1, 1.0 / 3 + 0.7).asDiagonal();
    e(0, 1) = 0.2;
    e(0, 2) = -0.1 / 3;
    e(1, 2) = 0.3;
    return e;
  }
  Snapshot through_dump(const Snapshot &s) const
  {
    return read_lammps_dump(put("a.dump", lammps_dump(s)), {s.law, s.grains.density}).state;
  }
  Snapshot through_data(const Snapshot &s) const
  {
    return read_lammps_data(put("a.data", lammps_data(s)), {s.law, 2650}).state;
  }
  std::string refusal_of_dump(const std::string &text) const
  {
    const auto path = put("bad.dump", text);
    return message_of<InputError>([&] { read_lammps_dump(path, {}); });
  }
  std::string refusal_of_data(const std::string &text) const
  {
    const auto path = put("bad.data", text);
    return message_of<InputError>([&] { read_lammps_data(path, {}); });
  }
  static void expect_same_grains(const Packing &one, const Packing &other)
  {
    EXPECT_EQ(one.position, other.position);
    EXPECT_EQ(one.velocity, other.velocity);
    EXPECT_EQ(one.spin, other.spin);
    EXPECT_EQ(one.id, other.id);
  }
};

TEST_F(Lammps, ABoxComesBackToTheBit)
{
  Snapshot s = small_snapshot();
  s.grains.id = {7, 3, 5};
  for (const Snapshot &back : {through_dump(s), through_data(s)})
    {
      expect_same_grains(back.grains, s.grains);
      EXPECT_EQ(back.box.lower, s.box.lower);
      EXPECT_EQ(back.box.upper, s.box.upper);
      EXPECT_FALSE(back.cell);
    }
  EXPECT_EQ(through_data(s).grains.density, s.grains.density);
}

TEST_F(Lammps, ALeaningCellComesBackToTheBitInADataFile)
{
  const Snapshot s = periodic(leaning()), data = through_data(s), dump = through_dump(s);
  ASSERT_TRUE(data.cell && dump.cell);
  EXPECT_EQ(data.cell->edges, s.cell->edges);
  expect_same_grains(data.grains, s.grains);
  expect_same_grains(dump.grains, s.grains);
  EXPECT_NEAR_BECAUSE((dump.cell->edges - s.cell->edges).norm(), 0, 1e-15, "a dump holds the bounds: round-off");
}

TEST_F(Lammps, AGrainOutsideTheCellIsMovedByWholeEdges)
{
  Snapshot s = periodic(leaning());
  const Vec3 inside = s.grains.centre(1);
  s.grains.set_centre(1, inside + s.cell->edges * Vec3(1, 0, -2));
  const Snapshot back = through_data(s);
  const Vec3 part = s.cell->edges.inverse() * (back.grains.centre(1) - inside);
  EXPECT_NEAR_BECAUSE((part - Vec3(part.array().round())).norm(), 0, 1e-14, "round-off of ten operations");
}

TEST_F(Lammps, ACellInAnotherPositionIsTurned)
{
  const Mat3 q = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Snapshot upright = periodic(leaning()), s = turned(upright, q);
  EXPECT_FALSE(fits_lammps(s));
  const Snapshot back = lammps_frame(s);
  EXPECT_TRUE(fits_lammps(back));
  EXPECT_NEAR_BECAUSE((back.cell->edges - upright.cell->edges).norm(), 0, 1e-14, "round-off of two rotations");
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR_BECAUSE((back.grains.centre(i) - upright.grains.centre(i)).norm(), 0, 1e-14,
                        "round-off of two rotations");
}

TEST_F(Lammps, TheLastFrameOfADump)
{
  const std::string frame = "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n"
                            "ITEM: ATOMS id xu yu zu diameter\n4 0.25 0.5 0.5 0.5\n";
  const ForeignPacking found = read_lammps_dump(put("two.dump", frame + frame), {});
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_THAT(found.notes[0], HasSubstr("2 frames"));
  EXPECT_EQ(found.state.grains.radius(0), 0.25);
  EXPECT_EQ(found.state.grains.id[0], 3u);
  EXPECT_TRUE(found.state.cell);
  const std::string cut = (frame + frame).substr(0, 2 * frame.size() - 20);
  EXPECT_THAT(message_of<InputError>([&] { read_lammps_dump(put("cut.dump", cut.substr(0, cut.rfind("ITEM"))), {}); }),
              HasSubstr("It was cut off; `head -n 10"));
}

TEST_F(Lammps, BadDumpsNameFileAndLine)
{
  const std::string head = "ITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ";
  const std::string box = " \n0 1\n0 1\n0 1\n";
  EXPECT_THAT(refusal_of_dump(head + "pp pp ff" + box),
              HasSubstr("bad.dump:3: boundaries pp pp ff; expected pp pp pp"));
  EXPECT_THAT(refusal_of_dump(head + "pp pp pp" + box + "ITEM: ATOMS id x y z\n1 0 0 0\n"), HasSubstr("column radius"));
  EXPECT_THAT(refusal_of_dump(head + "ff ff ff" + box + "ITEM: ATOMS x y z radius\n"), HasSubstr("cut off"));
  EXPECT_THAT(refusal_of_dump(head + "ff ff ff" + box + "ITEM: ATOMS x y z radius\n2 0 0 1\n"),
              HasSubstr("bad.dump:8: centre x = 2"));
  EXPECT_THAT(refusal_of_dump(head + "pp pp pp\n0 1\n0 0\n0 1\n"), HasSubstr("no volume"));
  EXPECT_THAT(refusal_of_dump("ITEM: UNITS\nlj\n"), HasSubstr("units lj; expected si"));
  for (const char *n : {"-1", "1.5", "1e300"})
    EXPECT_THAT(refusal_of_dump("ITEM: NUMBER OF ATOMS\n" + std::string(n) + "\n"),
                HasSubstr("bad.dump:2: " + std::string(n) + " atoms; expected a whole number below 2^32"));
}

TEST_F(Lammps, ADataFileOfAnotherProgram)
{
  const std::string text =
      "title\n\n2 atoms # comment\n1 atom types\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nMasses\n\n"
      "1 1.0\n\nAtoms # sphere\n\n2 1 0.5 2600 0.5 0.5 0.5 0 0 0\n1 1 0.25 2600 0.1 0.2 0.3\n";
  const ForeignPacking found = read_lammps_data(put("b.data", text), {});
  EXPECT_EQ(found.state.grains.radius(0), 0.25);
  EXPECT_EQ(found.state.grains.id, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(found.state.grains.density, 2600);
  ASSERT_EQ(found.notes.size(), 1u); // taken for walls
}

TEST_F(Lammps, ADomainThatTheFileDoesNotSayIsTheCallers)
{
  const std::string rest = "1 atoms\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\nAtoms # sphere\n\n1 1 0.5 2600 0 1.2 0\n";
  ReadOptions periodic;
  periodic.domain = "periodic-cell";
  const ForeignPacking found = read_lammps_data(put("p.data", "of write_data, units = si\n" + rest), periodic);
  ASSERT_TRUE(found.state.cell);
  EXPECT_EQ(found.state.cell->edges, Mat3::Identity());
  EXPECT_TRUE(found.notes.empty());
  EXPECT_THAT(refusal_of_data("of write_data\n" + rest), HasSubstr("bad.data:8: centre y = 1.2"));
  EXPECT_THAT(refusal_of_data("of write_data, units = lj\n" + rest), HasSubstr("bad.data:1: units lj; expected si"));
  const std::string dump = "ITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS\n0 1\n0 1\n0 1\nITEM: ATOMS x y z radius\n"
                           "0 0.5 0.5 0.5\n";
  EXPECT_TRUE(read_lammps_dump(put("p.dump", dump), periodic).state.cell);
  const ForeignPacking walls = read_lammps_dump(put("p.dump", dump), {});
  EXPECT_FALSE(walls.state.cell);
  EXPECT_EQ(walls.notes.size(), 1u);
}

TEST_F(Lammps, MassesAndDensitiesOfADump)
{
  const auto dump = [](const std::string &column, const std::string &one, const std::string &other) {
    return "ITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: ATOMS x y z radius " + column +
           "\n0 0 0 0.1 " + one + "\n0.5 0.5 0.5 0.2 " + other + "\n";
  };
  const double unit = 4.0 / 3 * std::numbers::pi * 1e-3; // volume of the first
  const auto mass = [&](double density, double volume) { return fmt::format("{:.6g}", density * volume); };
  const auto density = [&](const std::string &text, double scale = 1) {
    ReadOptions options;
    options.scale = scale;
    return read_lammps_dump(put("m.dump", text), options).state.grains.density;
  };
  EXPECT_NEAR_BECAUSE(density(dump("mass", mass(2500, unit), mass(2500, 8 * unit))), 2500, 0.02, "six digits");
  EXPECT_NEAR_BECAUSE(density(dump("mass", mass(2.5e-6, unit), mass(2.5e-6, 8 * unit)), 1e-3), 2500, 0.02,
                      "six digits; millimetres and kg");
  EXPECT_EQ(density(dump("density", "2600", "2600")), 2600);
  EXPECT_THAT(refusal_of_dump(dump("density", "2600", "2650")), HasSubstr("bad.dump:9: density 2650"));
  EXPECT_THAT(refusal_of_dump(dump("mass", mass(2500, unit), mass(2700, 8 * unit))), HasSubstr("bad.dump:8: mass = "));
  EXPECT_THAT(refusal_of_dump(dump("mass", "1", "-1")), HasSubstr("bad.dump:9: mass = -1 kg"));
  EXPECT_THAT(refusal_of_dump(dump("mass density", mass(2500, unit) + " 2600", mass(2500, 8 * unit) + " 2600")),
              HasSubstr("bad.dump:8: mass = "));
}

TEST_F(Lammps, BadDataFilesNameFileAndLine)
{
  const std::string head = "title\n2 atoms\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n";
  EXPECT_THAT(refusal_of_data(head + "Atoms # atomic\n"), HasSubstr("bad.data:6: atom_style atomic; expected sphere"));
  EXPECT_THAT(refusal_of_data(head + "Atoms\n\n1 1 0.1 2600 0.5 0.5 0.5\n"), HasSubstr("2 atoms are promised, 1 are"));
  EXPECT_THAT(refusal_of_data(head + "Atoms\n\n1 1 0.1 2600 0.5 0.5 0.5\n2 1 0.1 2650 0.5 0.5 0.5\n"),
              HasSubstr("bad.data:9: density 2650"));
  EXPECT_THAT(refusal_of_data("title\n1 atoms\nAtoms\n\n1 1 0.1 2600 0.5 0.5 0.5\n"), HasSubstr("box is not complete"));
  EXPECT_THAT(refusal_of_data("title\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\nAtoms\n\n1 1 0.1 2600 0.5 0.5 0.5\n"),
              HasSubstr("no line `N atoms`"));
  EXPECT_THAT(refusal_of_data(head + "Atoms\n\n0 1 0.1 2600 0.5 0.5 0.5\n"), HasSubstr("bad.data:8: id = 0"));
}
} // namespace
} // namespace isostat
