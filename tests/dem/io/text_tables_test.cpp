// SPDX-License-Identifier: BSD-3-Clause
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/io/text_tables.hpp"

#include "base/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <zlib.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;

const std::string contact_header = "id1,id2,un,nx,ny,nz,kn,ks,fn,fsx,fsy,fsz,mbx,mby,mbz,mtx,mty,mtz\n";

/// Grains 5 and 2 touch, each touches a wall; the tables are in no particular order.
class TextTables : public TemporaryFolder
{
protected:
  TextTables()
  {
    put("comp_particles_step0.csv", "id,x,y,z,r,vx,vy,vz,wx,wy,wz\r\n5,0.25,0.5,0.5,0.3,1,2,3,4,5,6\r\n"
                                    "2,0.71,0.5,0.5,0.2,0.10000000000000001,0,0,0,0,0\r\n");
    put("comp_contacts_step0.csv", contact_header + "-2,2,nan,-1,-0,-0,10,3,0.5,0,0,0,0,0,0,0,0,0\n"
                                                    "2,5,0.04,-1,0,0,100,30,4,0,1,2,3,4,5,6,7,8\n"
                                                    "-1,5,0.05,1,0,0,10,3,0.5,0,0,0,0,0,0,0,0,0\n");
    put("comp_walls_step0.csv", "wall,axis,side,pos\n0,x,-,0\n1,x,+,0.9\n2,y,-,-1\n3,y,+,1\n4,z,-,0\n5,z,+,1e0\n");
  }
  Snapshot import() const { return import_tables(folder, LinearRolling{}, 2650); }
  std::string refusal() const
  {
    return message_of<InputError>([&] { import(); });
  }
  std::string refusal_of_contact(const std::string &row) const
  {
    put("comp_contacts_step0.csv", contact_header + row + "\n");
    return refusal();
  }
  std::filesystem::path put_gzip(const std::string &name, const std::string &text) const
  {
    gzFile file = gzopen((folder / name).c_str(), "wb");
    gzwrite(file, text.data(), text.size());
    gzclose(file);
    return folder / name;
  }
};

TEST_F(TextTables, GrainsBoxAndContacts)
{
  const Snapshot s = import();
  ASSERT_EQ(s.grains.n_grains(), 2u);
  EXPECT_EQ(s.grains.id, (std::vector<std::uint32_t>{5, 2}));
  EXPECT_EQ(s.grains.centre(1), Vec3(0.71, 0.5, 0.5));
  EXPECT_EQ(s.grains.linear_velocity(1).x(), 0.1);
  EXPECT_EQ(s.grains.angular_velocity(0), Vec3(4, 5, 6));
  EXPECT_EQ(s.box.lower, Vec3(0, -1, 0));
  EXPECT_EQ(s.box.upper, Vec3(0.9, 1, 1));
  ASSERT_EQ(s.contacts.size(), 1u); // turned: id 5 is stored first
  const Contact &c = s.contacts[0];
  EXPECT_TRUE(c.first == 0 && c.second == 1 && c.overlap == 0.04 && c.normal_force == 4);
  EXPECT_EQ(c.history.normal, Vec3(1, 0, 0));
  EXPECT_EQ(c.history.shear_force, Vec3(0, -1, -2));
  EXPECT_EQ(c.history.bending_moment, Vec3(-3, -4, -5));
  EXPECT_EQ(c.history.twisting_moment, Vec3(-6, -7, -8));
  ASSERT_EQ(s.wall_contacts.size(), 2u);
  EXPECT_TRUE(s.wall_contacts[0].wall == 0 && s.wall_contacts[0].grain == 0 && s.wall_contacts[0].overlap == 0.05);
  EXPECT_TRUE(s.wall_contacts[1].wall == 1 && s.wall_contacts[1].grain == 1 && s.wall_contacts[1].overlap == 0.05);
}

TEST_F(TextTables, GzippedTables)
{
  const Snapshot plain = import();
  for (const std::string what : {"particles", "contacts", "walls"})
    {
      const std::string name = "comp_" + what + "_step0.csv";
      put_gzip(name + ".gz", get(folder / name));
      std::filesystem::remove(folder / name);
    }
  const Snapshot s = import();
  EXPECT_EQ(s.grains.position, plain.grains.position);
  EXPECT_EQ(s.contacts.size(), 1u);
  std::filesystem::remove(folder / "comp_walls_step0.csv.gz");
  EXPECT_THAT(refusal(), HasSubstr("comp_walls_step0.csv"));
}

TEST_F(TextTables, CutGzipIsRefused)
{
  std::string text = "id,x,y,z,r,vx,vy,vz,wx,wy,wz\n";
  for (int i = 0; i < 2000; ++i)
    text += std::to_string(i) + "," + std::to_string(i * 7919 % 1000003) + ",0,0,1,0,0,0,0,0,0\n";
  std::filesystem::remove(folder / "comp_particles_step0.csv");
  cut_to_half(put_gzip("comp_particles_step0.csv.gz", text));
  EXPECT_THAT(refusal(), HasSubstr("cut off"));
}

TEST_F(TextTables, UnknownOverlapFollowsFromForceAndStiffness)
{
  put("comp_contacts_step0.csv", contact_header + "5,2,nan,1,0,0,200,1,3,0,0,0,0,0,0,0,0,0\n");
  EXPECT_EQ(import().contacts.at(0).overlap, 3.0 / 200);
}

TEST_F(TextTables, RowsThatDoNotTouchAreLeftOut)
{
  put("comp_contacts_step0.csv", contact_header + "2,5,-0.1,1,0,0,1,1,0,0,0,0,0,0,0,0,0,0\n");
  EXPECT_TRUE(import().contacts.empty());
}

TEST_F(TextTables, BadContactRowsNameFileLineAndValue)
{
  const std::string zeros = ",0,0,0,0,0,0,0,0,0";
  EXPECT_THAT(refusal_of_contact("2,5,0.1x,1,0,0,1,1,1" + zeros),
              HasSubstr("comp_contacts_step0.csv:2: un = \"0.1x\""));
  EXPECT_THAT(refusal_of_contact("2,5,0.1,1,0,0,1,1,inf" + zeros), HasSubstr(":2: fn = \"inf\""));
  EXPECT_THAT(refusal_of_contact("2,5,0.1,1,0"), HasSubstr(":2: 5 values; the header names 18 columns"));
  EXPECT_THAT(refusal_of_contact("2,9,0.1,1,0,0,1,1,1" + zeros), HasSubstr(":2: contact of 2 and 9"));
  EXPECT_THAT(refusal_of_contact("-7,2,0.1,1,0,0,1,1,1" + zeros), HasSubstr(":2: contact of -7 and 2"));
  EXPECT_THAT(refusal_of_contact("2,2,0.1,1,0,0,1,1,1" + zeros), HasSubstr(":2: contact of 2 and 2"));
  EXPECT_THAT(refusal_of_contact("2,5,inf,1,0,0,1,1,1" + zeros), HasSubstr(":2: un = \"inf\""));
  EXPECT_THAT(refusal_of_contact("2,5,nan,1,0,0,0,1,1" + zeros), HasSubstr(":2: kn = 0"));
  EXPECT_THAT(refusal_of_contact("2,5,0.1,1,1,0,1,1,1" + zeros), HasSubstr("unit vector"));
  EXPECT_THAT(refusal_of_contact("2,5,0.1,1,0,0,1,1,-1" + zeros), HasSubstr(":2: fn = -1"));
  const std::string good = "2,5,0.1,1,0,0,1,1,1" + zeros;
  EXPECT_THAT(refusal_of_contact(good + "\n" + good), HasSubstr("listed twice"));
}

TEST_F(TextTables, BadGrainsAndWalls)
{
  const std::string header = "id,x,y,z,r,vx,vy,vz,wx,wy,wz\n", rest = ",0,0,0,0,0,0\n";
  put("comp_particles_step0.csv", header + "5,0.2,0.5,0.5,0" + rest);
  EXPECT_THAT(refusal(), HasSubstr("comp_particles_step0.csv:2: radius r = 0"));
  put("comp_particles_step0.csv", header + "5,0.2,0.5,0.5,1" + rest + "5,0.2,0.5,0.5,1" + rest);
  EXPECT_THAT(refusal(), HasSubstr(":3: id = 5"));
  put("comp_particles_step0.csv", header + "5,0.2,0.5,500,1" + rest);
  EXPECT_THAT(refusal(), HasSubstr(":2: centre z = 500 m lies outside the box, [0, 1] m"));
  put("comp_particles_step0.csv", "id,x,y\n");
  EXPECT_THAT(refusal(), HasSubstr(":1: no column \"z\""));
  put("comp_walls_step0.csv", "wall,pos\n0,0\n0,1\n");
  EXPECT_THAT(refusal(), HasSubstr("comp_walls_step0.csv:3: wall = 0"));
  put("comp_walls_step0.csv", "wall,pos\n0,0\n1,1\n");
  EXPECT_THAT(refusal(), HasSubstr("2 walls; expected six"));
}

TEST_F(TextTables, PlacesAndDensitiesThatAreNone)
{
  EXPECT_THAT(message_of<InputError>([&] { import_tables(folder / "absent", LinearRolling{}, 2650); }),
              HasSubstr("absent: neither comp_walls_step0.csv nor comp_walls_step0.csv.gz exists"));
  EXPECT_THROW(import_tables(folder, LinearRolling{}, 0), InputError);
}
} // namespace
} // namespace isostat
