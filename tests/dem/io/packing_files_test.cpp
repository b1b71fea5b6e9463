// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/packing_files.hpp"

#include "base/error.hpp"
#include "dem/io/sphere_table.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <fmt/format.h>
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
  EXPECT_EQ(write_packing(folder / "a.txt", specimen, PackingFormat::text).size(), 3u); // contacts, density, cell
  EXPECT_EQ(write_packing(folder / "a.dump", specimen, PackingFormat::lammps_dump).size(),
            3u); // contacts, density, turned
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

TEST_F(PackingFiles, SpherePacksOfYade)
{
  const auto read = [&](const std::string &text) { return read_foreign_packing(put("y.txt", text), {}); };
  const ForeignPacking cell = read("##PERIODIC:: 4 5 6\n0 0 0 1\n4.5 2 2 0.5\n");
  ASSERT_TRUE(cell.state.cell);
  EXPECT_EQ(cell.state.cell->edges, Mat3(Vec3(4, 5, 6).asDiagonal()));
  EXPECT_EQ(cell.state.volume(), 120);
  EXPECT_TRUE(cell.notes.empty());
  EXPECT_EQ(read("##PERIODIC:: 4 4 4\n0 0 0 1 -1\n2 2 2 0.5 -1\n").state.grains.radius(1), 0.5);
  EXPECT_THAT(refusal("y.txt", "0 0 0 1 -1\n2 2 2 0.5 7\n"), HasSubstr("y.txt:2: clump id 7; expected -1"));
  EXPECT_THAT(refusal("y.txt", "0 0 0 1 -1\n2 2 2 0.5\n"),
              HasSubstr("y.txt:2: \"2 2 2 0.5\"; expected four numbers x y z r (m) in every line, or five"));
  for (const char *edges : {"4 4 0", "4 4", "4 4 -4", "4 4 x"})
    EXPECT_THAT(refusal("y.txt", fmt::format("##PERIODIC:: {}\n0 0 0 1\n", edges)), HasSubstr("y.txt:1")) << edges;
  EXPECT_THAT(refusal("y.txt", "# box 0 4 0 4 0 4\n##PERIODIC:: 4 4 4\n1 1 1 1\n"),
              HasSubstr("y.txt:2: a second domain"));
}

TEST_F(PackingFiles, FormatsOfYade)
{
  const auto grains = [&](const std::string &text) {
    return read_foreign_packing(put("y.txt", text), {}).state.grains;
  };
  EXPECT_EQ(grains("#format x_y_z_r_matId\n# made up\n1\t2\t3\t0.5\t0\n").centre(0), Vec3(1, 2, 3));
  const Packing with_id = grains("#format id_x_y_z_r_matId\n7\t1\t2\t3\t0.5\t0\n");
  EXPECT_EQ(with_id.id[0], 7u);
  EXPECT_EQ(with_id.radius(0), 0.5);
  EXPECT_EQ(grains("#format x_y_z_r_attrs\n1\t2\t3\t0.5\t9\t9\t9\n").radius(0), 0.5);
  EXPECT_EQ(grains("#format x_y_z_r_clumpId\n1\t2\t3\t0.5\t-1\n").radius(0), 0.5);
  EXPECT_EQ(grains("# x y z diameter\n1 2 3 0.5\n").radius(0), 0.25);
  EXPECT_THAT(refusal("y.txt", "#format x_y_z_r_clumpId\n1\t2\t3\t0.5\t0\n"), HasSubstr("y.txt:2: clump id 0"));
  EXPECT_THAT(refusal("y.txt", "#format jointedPM\n1\t2\t3\t0.5\t0\n"),
              HasSubstr("y.txt:1: this format does not have a column x"));
}

TEST_F(PackingFiles, NamesOfColumns)
{
  for (const char *header :
       {"ID,X,Y,Z,RADIUS", "\"id\",\"x\",\"y\",\"z\",\"r\"", "Id, pos_x, pos_y, pos_z, Rad",
        "ball.id ball.pos.x ball.pos.y ball.pos.z ball.radius", "type x (m) y (m) z (m) radius (m)"})
    {
      const auto path = put("p.csv", fmt::format("{}\n3,1,2,4,0.5\n", header));
      const Packing grains = read_foreign_packing(path, {}).state.grains;
      EXPECT_EQ(grains.centre(0), Vec3(1, 2, 4)) << header;
      EXPECT_EQ(grains.radius(0), 0.5) << header;
    }
  const std::string in_mm = "X (mm),Y (mm),Z (mm),Diameter [mm]\n1,2,3,1\n";
  EXPECT_THAT(refusal("p.csv", in_mm), HasSubstr("p.csv:1: the column diameter is in mm"));
  ReadOptions mm;
  mm.scale = 1e-3;
  EXPECT_EQ(read_foreign_packing(put("p.csv", in_mm), mm).state.grains.radius(0), 0.5e-3);
  EXPECT_EQ(read_foreign_packing(put("p.csv", "x,y,z,r,Density (kg/m3)\n1,2,3,1,2700\n"), {}).state.grains.density,
            2700);
  EXPECT_THAT(refusal("p.csv", "x,y,z,r,density (g/cm3)\n1,2,3,1,2.7\n"), HasSubstr("is in g/cm3; expected kg/m3"));
  for (const char *header : {"id,x,y,z", "x,y,z,size"}) // as many as x y z r, but others
    EXPECT_THAT(refusal("p.csv", fmt::format("{}\n1,2,3,0.5\n", header)),
                HasSubstr("p.csv:2: the header above does not"));
  EXPECT_EQ(read_foreign_packing(put("p.csv", "X,Y,Z,Dia\n1,2,4,1\n"), {}).state.grains.radius(0), 0.5);
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
  const auto with = [&](const std::string &before, const std::string &more) {
    std::string changed = text;
    return changed.insert(changed.find(before), more);
  };
  const std::string array = R"(<DataArray type="Float32" Name="{}" format="ascii"> {} </DataArray>)";
  EXPECT_EQ(
      read_foreign_packing(put("a.vtp", with("</PointData>", fmt::format(fmt::runtime(array), "density", "99 99"))), {})
          .state.grains.density,
      99);
  EXPECT_THAT(refusal("a.vtp", with("<Piece", "<FieldData>" + fmt::format(fmt::runtime(array), "box", "0 9 0 9") +
                                                  "</FieldData>")),
              HasSubstr("a.vtp: field data `box` of 4"));
  EXPECT_THAT(refusal("a.vtp", with("</PolyData>", "<Piece NumberOfPoints=\"0\"/>")), HasSubstr("several pieces"));
  EXPECT_THAT(refusal("a.vtp", with("type=\"PolyData\"", "byte_order=\"BigEndian\" ")), HasSubstr("BigEndian"));
}
} // namespace
} // namespace isostat
