// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/specimen_library.hpp"

#include "base/error.hpp"
#include "dem/scene/scene.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/temporary_folder.hpp"

#include <cmath>
#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// A periodic specimen whose numbers distinguish it from others.
Specimen realisation(double seed)
{
  Specimen s{small_snapshot(), {{"consolidation", "k0"}, {"recipe", "# recipe\nof it"}}, {}};
  s.state.wall_contacts.clear();
  s.state.cell = PeriodicCell::with_edges({3, 3, 3});
  s.state.cell->volume_strain = -0.1 / seed;
  s.state.grains.position[0] += 0.1 * seed;
  s.numbers = {{"seed", seed}, {"pressure_Pa", 1e5 * seed}, {"relative_density", 0.1 + 0.2}, {"K0", 0.437}};
  return s;
}

void expect_same(const Specimen &a, const Specimen &b)
{
  EXPECT_EQ(a.provenance, b.provenance);
  EXPECT_EQ(a.numbers, b.numbers);
  test::expect_same_bits(a.state, b.state);
}

class SpecimenLibrary : public TemporaryFolder
{
protected:
  const std::filesystem::path path = folder / "library.h5";

  void write_two() const
  {
    LibraryWriter library = LibraryWriter::create(path);
    for (const double seed : {1.0, 2.0})
      library.add(library.next_name(), realisation(seed));
    library.commit();
  }
  std::vector<std::string> names() const
  {
    std::vector<std::string> found;
    for (const LibraryEntry &entry : list_library(path))
      found.push_back(entry.name);
    return found;
  }
  /// What reading says, entries or one of them: the same.
  std::string refusal() const
  {
    const std::string message = message_of<InputError>([&] { list_library(path); });
    EXPECT_EQ(message_of<InputError>([&] { read_library_entry(path, "s0001"); }), message);
    EXPECT_EQ(message_of<InputError>([&] { LibraryWriter::append(path); }), message);
    EXPECT_THAT(message, HasSubstr("library.h5"));
    return message;
  }
};

TEST_F(SpecimenLibrary, RoundTripBitForBit)
{
  write_two();
  EXPECT_TRUE(is_specimen_library(path));
  expect_same(read_library_entry(path, "s0001"), realisation(1));
  expect_same(read_library_entry(path, "s0002"), realisation(2));
}

TEST_F(SpecimenLibrary, ListDistinguishesEntries)
{
  write_two();
  const std::vector<LibraryEntry> entries = list_library(path);
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[1].name, "s0002");
  EXPECT_EQ(entries[1].number("seed"), 2);
  EXPECT_EQ(entries[1].text("recipe"), "# recipe\nof it");
  EXPECT_TRUE(std::isnan(entries[1].number("void_ratio")));
  EXPECT_EQ(entries[1].text("colour"), "");
  const std::string table = library_table(entries);
  EXPECT_THAT(table, HasSubstr("s0001    k0"));
  EXPECT_THAT(table, HasSubstr("200.00  0.437       -  0.300"));
  EXPECT_THAT(table, Not(HasSubstr("more")));
  EXPECT_THAT(library_table(entries, 1), HasSubstr("and 1 more"));
}

TEST_F(SpecimenLibrary, AppendKeepsTheOld)
{
  write_two();
  LibraryWriter library = LibraryWriter::append(path);
  EXPECT_EQ(library.next_name(), "s0003");
  library.add("s0010", realisation(3));
  EXPECT_EQ(library.next_name(), "s0011");
  library.add("dense_k0-a", realisation(4));
  EXPECT_THAT(names(), ElementsAre("s0001", "s0002")); // not before commit
  library.commit();
  EXPECT_THAT(names(), ElementsAre("dense_k0-a", "s0001", "s0002", "s0010"));
  expect_same(read_library_entry(path, "s0001"), realisation(1));
  expect_same(read_library_entry(path, "s0010"), realisation(3));
}

TEST_F(SpecimenLibrary, NothingIsLostWhenWritingFails)
{
  write_two();
  const std::string before = get(path);
  for (const bool append : {false, true})
    {
      LibraryWriter library = append ? LibraryWriter::append(path) : LibraryWriter::create(path);
      library.add("s0003", realisation(3));
      EXPECT_THAT(message_of<InputError>([&] { library.add("s0003", realisation(3)); }), HasSubstr("already"));
      for (const std::string name : {"", "a/b", "a b", "#"})
        EXPECT_THAT(message_of<InputError>([&] { library.add(name, realisation(3)); }), HasSubstr("cannot name"));
      Specimen bad = realisation(4);
      bad.state.grains.position[3] = NAN;
      EXPECT_THAT(message_of<RunFailure>([&] { library.add("s0004", bad); }), HasSubstr("library.h5:/s0004"));
    }
  EXPECT_EQ(get(path), before);
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".tmp"));
  const auto file = put("a_file", "x");
  EXPECT_THAT(message_of<RunFailure>([&] { LibraryWriter::create(file / "l.h5"); }), HasSubstr("cannot create"));
}

TEST_F(SpecimenLibrary, UnknownEntriesAreAnsweredWithTheList)
{
  write_two();
  EXPECT_THAT(message_of<InputError>([&] { read_library_entry(path, "s0003"); }),
              testing::AllOf(HasSubstr("library.h5: has no entry \"s0003\""), HasSubstr("one of its 2 entries"),
                             HasSubstr("library.h5#s0001"), HasSubstr("seed"), HasSubstr("s0002"),
                             HasSubstr("200.00")));
  EXPECT_THAT(message_of<InputError>([&] { read_library_entry(path, ""); }),
              testing::AllOf(HasSubstr("none of them is named"), HasSubstr("s0002")));
  EXPECT_THAT(message_of<InputError>([&] { read_library_entry(path, "s0001/snapshot"); }), HasSubstr("has no entry"));
  LibraryWriter::create(path).commit();
  EXPECT_THAT(message_of<InputError>([&] { read_library_entry(path, "s0001"); }), HasSubstr("without entries"));
}

TEST_F(SpecimenLibrary, OtherFormatsAreRefused)
{
  hdf5::File file = hdf5::File::create(path);
  file.root().write("data", std::vector<double>{1}, "m");
  file.commit();
  EXPECT_THAT(refusal(), HasSubstr("without the attribute format"));
  write_specimen(path, realisation(1));
  EXPECT_FALSE(is_specimen_library(path));
  EXPECT_THAT(refusal(), HasSubstr("\"isostat-specimen\", expected format = \"isostat-specimen-library\""));
  write_two();
  EXPECT_THAT(message_of<InputError>([&] { read_specimen(path); }), HasSubstr("library.h5#s0001"));
  file = hdf5::File::update(path);
  file.root().set_attribute("schema_version", std::uint64_t{2});
  file.commit();
  EXPECT_THAT(refusal(), HasSubstr("schema_version = 2, this program reads 1"));
}

TEST_F(SpecimenLibrary, DamagedEntriesAreNamed)
{
  write_two();
  hdf5::File file = hdf5::File::update(path);
  file.root().create_group("s0003").create_group("numbers");
  file.commit();
  EXPECT_THAT(message_of<InputError>([&] { list_library(path); }), HasSubstr("/s0003/provenance"));
  EXPECT_THAT(message_of<InputError>([&] { read_library_entry(path, "s0003"); }), HasSubstr("/s0003/provenance"));
  expect_same(read_library_entry(path, "s0002"), realisation(2)); // the others can still be read
}

TEST(SpecimenPlace, NamesFileAndEntry)
{
  const auto parts = [](const std::string &file) {
    const SpecimenPlace place = specimen_place(file);
    return place.path + " " + place.entry;
  };
  EXPECT_EQ(parts("a/library.h5#s0007"), "a/library.h5 s0007");
  EXPECT_EQ(parts("library.h5#"), "library.h5 ");
  EXPECT_EQ(parts("dr64.h5"), "dr64.h5 ");
  EXPECT_EQ(parts("run#3/tables"), "run#3/tables ");
  EXPECT_EQ(parts("run#3/library.h5#x"), "run#3/library.h5 x");
}
} // namespace
} // namespace isostat
