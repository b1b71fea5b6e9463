// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/packing_files.hpp"

#include "base/error.hpp"
#include "dem/io/sphere_table.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;

class PackingFiles : public TemporaryFolder
{
protected:
  static Snapshot periodic()
  {
    Snapshot s = small_snapshot();
    s.cell.emplace();
    s.cell->edges << 0.9, 0.1, 0.0, 0.05, 1.1, 0.02, -0.01, 0.3, 1.0 / 3 + 0.7;
    s.cell->reference_volume = s.cell->edges.determinant();
    return s;
  }
  Snapshot through(const std::string &name, const Snapshot &s) const
  {
    write_packing(folder / name, {s, {}, {}}, format_of_file(name));
    return read_foreign_packing(folder / name, {s.law, s.grains.density}).state;
  }
  std::string refusal(const std::string &name, const std::string &text) const
  {
    const auto path = put(name, text);
    return message_of<InputError>([&] { read_foreign_packing(path, {}); });
  }
};

TEST_F(PackingFiles, EveryFormatBringsBackTheBits)
{
  for (const Snapshot &s : {small_snapshot(), periodic()})
    for (const char *name : {"a.txt", "a.csv", "a.vtp"})
      {
        const Snapshot back = through(name, s);
        EXPECT_EQ(back.grains.position, s.grains.position) << name;
        ASSERT_EQ(back.cell.has_value(), s.cell.has_value()) << name;
        if (s.cell)
          EXPECT_EQ(back.cell->edges, s.cell->edges) << name;
        else
          EXPECT_EQ(back.box.upper, s.box.upper) << name;
        if (std::string(name) == "a.txt")
          continue; // x y z r only
        EXPECT_EQ(back.grains.id, s.grains.id) << name;
        EXPECT_EQ(back.grains.velocity, s.grains.velocity) << name;
        EXPECT_EQ(back.grains.spin, s.grains.spin) << name;
      }
}

TEST_F(PackingFiles, WhatAFormatCannotHoldIsSaid)
{
  const Specimen specimen{periodic(), {}, {}};
  EXPECT_EQ(write_packing(folder / "a.txt", specimen, PackingFormat::text).size(), 2u);         // contacts, cell
  EXPECT_EQ(write_packing(folder / "a.dump", specimen, PackingFormat::lammps_dump).size(), 2u); // contacts, turned
  EXPECT_TRUE(write_packing(folder / "a.h5", specimen, PackingFormat::specimen).empty());
  EXPECT_EQ(read_stored_packing(folder / "a.h5").state.contacts.size(), 2u);
}

TEST_F(PackingFiles, ColumnsOfCsvStandInAnyOrder)
{
  const auto path = put("a.csv", "radius,id,z,y,x,colour\n0.25,9,3,2,1,7\n");
  const ForeignPacking found = read_foreign_packing(path, {});
  EXPECT_EQ(found.state.grains.centre(0), Vec3(1, 2, 3));
  EXPECT_EQ(found.state.grains.id[0], 9u);
  EXPECT_EQ(found.notes.size(), 1u); // bounding box
  EXPECT_THAT(refusal("b.csv", "id,x,y,z,r\n1,0,0,0,1\n1,5,0,0,1\n"), HasSubstr("b.csv:3: its id"));
  EXPECT_THAT(refusal("b.csv", "id,x,y,z,r\n1,0,0,0\n"), HasSubstr("b.csv:2: \"1,0,0,0\"; expected 5 columns"));
  EXPECT_THAT(refusal("b.csv", "id,x,y,z,r\n-1,0,0,0,1\n"), HasSubstr("b.csv:2: id = -1"));
  EXPECT_THAT(refusal("b.txt", "# cell 1 0 0 0 1 0 0 0\n0 0 0 1\n"), HasSubstr("b.txt:1"));
  EXPECT_THAT(refusal("b.txt", "# cell 1e200 0 0 0 1e200 0 0 0 1e200\n0 0 0 1\n"), HasSubstr("b.txt:1"));
  EXPECT_THAT(refusal("b.txt", "0 0 0 1\n5 0 0 1e-12\n"), HasSubstr("b.txt:2: radius r = 1e-12 m; expected 1e-09"));
  EXPECT_THAT(refusal("b.txt", "0 0 0 1\n0 0 1e9 1e-8\n"), HasSubstr("b.txt:2: radius r = 1e-08 m is less than"));
  EXPECT_THAT(refusal("b.txt", "0 -2e9 0 1\n"), HasSubstr("b.txt:1: centre y = -2000000000 m; expected"));
  EXPECT_THAT(refusal("b.vtp", "<VTKFile"), HasSubstr("b.vtp: no VTK PolyData"));
}

TEST_F(PackingFiles, LengthsAreScaledWithTheBox)
{
  ReadOptions mm;
  mm.scale = 1e-3;
  const Snapshot s = read_foreign_packing(put("a.txt", "# box 0 4 0 4 0 4\n1 2 3 0.5\n"), mm).state;
  EXPECT_EQ(s.grains.centre(0), 1e-3 * Vec3(1, 2, 3));
  EXPECT_EQ(s.box.upper, 1e-3 * Vec3(4, 4, 4));
  EXPECT_EQ(s.grains.mass(0), make_packing({Vec3::Zero()}, {0.5e-3}, 2650).mass(0));
  EXPECT_THAT(message_of<InputError>([&] {
                read_foreign_packing(folder / "a.txt", {Law(), 2650, -1});
              }),
              HasSubstr("scale = -1"));
  EXPECT_THAT(message_of<InputError>([&] {
                read_foreign_packing(folder / "a.txt", {Law(), 0, 1});
              }),
              HasSubstr("density"));
}

TEST_F(PackingFiles, NamesOfFormats)
{
  EXPECT_EQ(format_named("lammps-data"), PackingFormat::lammps_data);
  EXPECT_THAT(message_of<InputError>([] { format_named("pdb"); }), HasSubstr("lammps-dump (.dump, .lammpstrj)"));
  EXPECT_THAT(message_of<InputError>([] { format_of_file("a.pdb"); }), HasSubstr("a.pdb"));
}

/// Ascii and 32 bits, as ParaView writes it.
TEST_F(PackingFiles, VtpOfAnotherProgram)
{
  const std::string text = R"(<?xml version="1.0"?><VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="2">
<PointData><DataArray type="Float32" Name="radius" format="ascii"> 1 0.5 </DataArray></PointData>
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0
 2 0 0</DataArray></Points></Piece></PolyData></VTKFile>)";
  const Snapshot s = read_foreign_packing(put("a.vtp", text), {}).state;
  EXPECT_EQ(s.grains.centre(1), Vec3(2, 0, 0));
  EXPECT_EQ(s.box.upper, Vec3(2.5, 1, 1));
}
} // namespace
} // namespace isostat
