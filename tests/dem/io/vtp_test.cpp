// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/pvd.hpp"
#include "dem/io/vtp.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <cstring>
#include <gmock/gmock.h>
#include <numbers>
#include <pugixml.hpp>

namespace isostat
{
namespace
{
using testing::HasSubstr;

class Vtp : public TemporaryFolder
{
protected:
  /// The piece of a well-formed file, its arrays all of the length their header says.
  pugi::xml_node load(const std::filesystem::path &path)
  {
    EXPECT_TRUE(document.load_file(path.c_str()));
    EXPECT_STREQ(document.child("VTKFile").attribute("header_type").value(), "UInt64");
    EXPECT_FALSE(std::filesystem::exists(path.string() + ".tmp"));
    return document.child("VTKFile").child("PolyData").child("Piece");
  }
  pugi::xml_document document;
};

/// Decodes base64 written by any correct encoder (bit by bit, unlike the encoder).
std::string decoded(const std::string &text)
{
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned value = 0, bits = 0;
  for (char c : text)
    {
      if (c == '=')
        break;
      value = (value << 6 | static_cast<unsigned>(digits.find(c))) & 0xffff;
      if ((bits += 6) >= 8)
        bytes += static_cast<char>(value >> (bits -= 8) & 0xff);
    }
  return bytes;
}

template <typename T>
std::vector<T> array(pugi::xml_node parent, const char *name)
{
  const pugi::xml_node node = parent.find_child_by_attribute("DataArray", "Name", name);
  EXPECT_TRUE(node) << name;
  const std::string text = node.text().get(), bytes = decoded(text);
  EXPECT_EQ(text.size() % 4, 0u);
  std::uint64_t n_bytes = 0;
  std::memcpy(&n_bytes, bytes.data(), sizeof n_bytes);
  EXPECT_EQ(bytes.size(), sizeof n_bytes + n_bytes) << name;
  std::vector<T> values(n_bytes / sizeof(T));
  std::memcpy(values.data(), bytes.data() + sizeof n_bytes, n_bytes);
  return values;
}

TEST_F(Vtp, GrainsKeepTheirNumbers)
{
  const Snapshot s = small_snapshot();
  write_grains_vtp(folder / "g.vtp", s);
  const pugi::xml_node piece = load(folder / "g.vtp");
  EXPECT_EQ(piece.attribute("NumberOfPoints").as_int(), 3);
  EXPECT_EQ(piece.attribute("NumberOfVerts").as_int(), 3);
  const std::vector<double> position = array<double>(piece.child("Points"), "position");
  ASSERT_EQ(position.size(), 9u);
  EXPECT_EQ(Vec3(&position[6]), s.grains.centre(2));
  const pugi::xml_node data = piece.child("PointData");
  EXPECT_EQ(array<std::uint32_t>(data, "id"), s.grains.id);
  EXPECT_EQ(array<double>(data, "radius"), (std::vector<double>{0.16, 0.15, 0.16}));
  EXPECT_EQ(array<double>(data, "velocity")[4], s.grains.linear_velocity(1).y());
  EXPECT_EQ(array<double>(data, "spin")[8], s.grains.angular_velocity(2).z());
  EXPECT_EQ(array<std::uint32_t>(data, "coordination"), (std::vector<std::uint32_t>{2, 2, 1}));
  EXPECT_EQ(array<std::int64_t>(piece.child("Verts"), "offsets"), (std::vector<std::int64_t>{1, 2, 3}));
}

TEST_F(Vtp, ForceChainsKeepTheirNumbers)
{
  Snapshot s = small_snapshot();
  write_force_chains_vtp(folder / "c.vtp", s);
  const pugi::xml_node piece = load(folder / "c.vtp");
  EXPECT_EQ(piece.attribute("NumberOfLines").as_int(), 2);
  EXPECT_EQ(array<std::int64_t>(piece.child("Lines"), "connectivity"), (std::vector<std::int64_t>{0, 1, 2, 3}));
  const std::vector<double> ends = array<double>(piece.child("Points"), "position");
  ASSERT_EQ(ends.size(), 12u);
  EXPECT_EQ(Vec3(&ends[6]), s.grains.centre(1));
  EXPECT_EQ(Vec3(&ends[9]), s.grains.centre(2));
  EXPECT_EQ(array<std::int64_t>(piece.child("Lines"), "offsets"), (std::vector<std::int64_t>{2, 4}));
  const pugi::xml_node data = piece.child("PointData"); // which "Tube" wants
  EXPECT_EQ(array<double>(data, "normal_force"), (std::vector<double>{12.3, 12.3, 4.5, 4.5}));
  EXPECT_EQ(array<double>(data, "shear_force")[0], 8.61);
  EXPECT_EQ(array<std::uint8_t>(data, "sliding"), (std::vector<std::uint8_t>{1, 1, 0, 0})); // 8.61 = 0.7 * 12.3
  EXPECT_EQ(array<std::uint8_t>(data, "rolling"), (std::vector<std::uint8_t>{0, 0, 0, 0}));
  s.contacts.clear();
  write_force_chains_vtp(folder / "c.vtp", s);
  EXPECT_EQ(load(folder / "c.vtp").attribute("NumberOfLines").as_int(), 0);
}

/// A contact through a face of the cell ends at the point of contact on either side; none is as long as the cell.
TEST_F(Vtp, ForceChainsAreCutAtTheCell)
{
  Snapshot s;
  s.grains = make_packing({Vec3(0.2, 1, 1), Vec3(1.9, 1, 1), Vec3(1.41, 1, 1)}, {0.25, 0.25, 0.25}, 2650);
  s.cell = PeriodicCell::with_edges(Vec3(2, 2, 2));
  s.contacts = {{0, 1, 0.2, 3, {-Vec3::UnitX(), {}, {}, {}}}, {1, 2, 0.01, 4, {-Vec3::UnitX(), {}, {}, {}}}};
  for (Contact &c : s.contacts)
    c.history.shear_force = c.history.bending_moment = c.history.twisting_moment = Vec3::Zero();
  write_force_chains_vtp(folder / "c.vtp", s);
  const pugi::xml_node piece = load(folder / "c.vtp");
  EXPECT_EQ(piece.attribute("NumberOfLines").as_int(), 3);
  const std::vector<double> ends = array<double>(piece.child("Points"), "position");
  ASSERT_EQ(ends.size(), 18u);
  const double x[] = {0.2, 0.05, 2.05, 1.9, 1.9, 1.41};
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR_BECAUSE(ends[3 * k], x[k], 1e-15, "round-off of one sum");
  EXPECT_EQ(array<double>(piece.child("PointData"), "normal_force"), (std::vector<double>{3, 3, 3, 3, 4, 4}));
}

/// Two opposite forces on a grain: sigma = f (r - u/2) 2 / V along one axis, p a third of it.
TEST_F(Vtp, GrainPressureOfASquashedSphere)
{
  Snapshot s;
  s.grains = make_packing({Vec3::Zero()}, {0.5}, 2650);
  s.wall_contacts = {{0, 0, 0.1, 6.0}, {0, 1, 0.1, 6.0}};
  const double volume = 4.0 / 3 * std::numbers::pi * 0.125;
  EXPECT_NEAR_BECAUSE(grain_pressure(s)[0], 2 * 6.0 * 0.45 / volume / 3, 1e-12, "round-off of ten operations");
}

TEST_F(Vtp, CollectionGrowsAndResumes)
{
  const auto path = folder / "grains.pvd";
  PvdCollection first(path);
  first.append(0, "fields/a_0000.vtp");
  first.append(0.1, "fields/b & c_0001.vtp");
  const std::string two = get(path);
  first.append(0.2, "fields/d_0002.vtp");
  const std::string three = get(path);
  ASSERT_TRUE(document.load_file(path.c_str()));
  const pugi::xml_node list = document.child("VTKFile").child("Collection");
  EXPECT_EQ(std::distance(list.begin(), list.end()), 3);
  EXPECT_STREQ(list.first_child().next_sibling().attribute("file").value(), "fields/b & c_0001.vtp");
  EXPECT_EQ(list.last_child().attribute("timestep").as_double(), 0.2);

  PvdCollection resumed(path, 2);
  EXPECT_EQ(resumed.n_entries(), 2u);
  resumed.append(0.2, "fields/d_0002.vtp");
  EXPECT_EQ(get(path), three);
  PvdCollection anew(path);
  anew.append(0, "fields/a_0000.vtp");
  anew.append(0.1, "fields/b & c_0001.vtp");
  EXPECT_EQ(get(path), two);
  for (const auto &shortened : {path, put("bad.pvd", "<VTKFile"), folder / "missing.pvd"})
    {
      PvdCollection more(shortened, 5);
      EXPECT_EQ(more.n_entries(), 5u);
      more.append(0.5, "fields/f_0005.vtp");
      EXPECT_EQ(more.n_entries(), 6u);
      more.append(0.6, "fields/g_0006.vtp");
      PvdCollection once_more(shortened, 6);
      EXPECT_EQ(once_more.n_entries(), 6u);
      once_more.append(0.6, "fields/g_0006.vtp");
      const std::string text = get(shortened);
      EXPECT_EQ(text.find("fields/a_0000.vtp") != std::string::npos, shortened == path);
      EXPECT_NE(text.find("fields/f_0005.vtp"), std::string::npos);
      EXPECT_EQ(text.find("fields/g_0006.vtp"), text.rfind("fields/g_0006.vtp")) << "once";
    }
}

TEST_F(Vtp, UnwritablePlacesAreRunFailures)
{
  const auto file = put("a_file", "x");
  EXPECT_THAT(message_of<RunFailure>([&] { write_grains_vtp(file / "g.vtp", small_snapshot()); }), HasSubstr("g.vtp"));
  EXPECT_THROW(PvdCollection(file / "g.pvd").append(0, "a.vtp"), RunFailure);
}
} // namespace
} // namespace isostat
