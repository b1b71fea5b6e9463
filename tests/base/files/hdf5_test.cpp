// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/hdf5.hpp"

#include "base/error.hpp"
#include "base/files/hdf5.hpp"
#include "tests/support/temporary_folder.hpp"

#include <cmath>
#include <csignal>
#include <cstring>
#include <gmock/gmock.h>
#include <limits>
#include <sys/mount.h>
#include <sys/resource.h>

extern "C" int H5close(void); // of HDF5, whose header needs MPI's

namespace isostat
{
namespace
{
using hdf5::File;
using hdf5::Group;
using hdf5::Shape;
using testing::HasSubstr;

class Hdf5 : public TemporaryFolder
{
protected:
  std::filesystem::path write_some()
  {
    const std::filesystem::path path = folder / "some.h5";
    File file = File::create(path);
    Group group = file.root().create_group("group");
    group.write("values", std::vector<double>(1000, 1.5), "m");
    group.write("count", std::vector<std::uint64_t>{1, 2}, "-");
    group.set_attribute("number", 2.5);
    file.commit();
    return path;
  }
};

TEST_F(Hdf5, ArraysComeBackBitForBit)
{
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::vector<double> reals{0.1, -0.0, 5e-324, 1.7976931348623157e308, nan, -inf};
  const std::vector<std::uint64_t> longs{0, ~std::uint64_t{0}};
  const std::vector<std::uint32_t> ints{0, ~std::uint32_t{0}, 5};
  const std::vector<std::string> texts{"", "two words", "Grüße\nline"};
  File file = File::create(folder / "a.h5");
  Group root = file.root();
  root.write("reals", reals, "m/s", 2);
  root.write("longs", longs, "-");
  root.write("ints", ints, "-");
  root.write("texts", texts, "-");
  root.write("none", std::vector<double>{}, "m", 3);
  root.write("no_text", std::vector<std::string>{}, "-");
  file.commit();

  const File again = File::open(folder / "a.h5");
  const Group in = again.root();
  EXPECT_EQ(in.shape("reals"), (Shape{3, 2}));
  EXPECT_EQ(in.unit("reals"), "m/s");
  const std::vector<double> back = in.read<double>("reals", {3, 2});
  EXPECT_EQ(std::memcmp(back.data(), reals.data(), sizeof(double) * reals.size()), 0);
  EXPECT_EQ(in.read<std::uint64_t>("longs"), longs);
  EXPECT_EQ(in.read<std::uint32_t>("ints"), ints);
  EXPECT_EQ(in.read<std::string>("texts"), texts);
  EXPECT_TRUE(in.read<double>("none", {0, 3}).empty());
  EXPECT_TRUE(in.read<std::string>("no_text").empty());
}

TEST_F(Hdf5, AttributesAndNames)
{
  File file = File::create(folder / "a.h5");
  Group group = file.root().create_group("group");
  group.set_attribute("real", 0.1);
  group.set_attribute("real", 0.2); // changed
  group.set_attribute("count", ~std::uint64_t{0});
  group.set_attribute("text", std::string(100000, 'x'));
  group.set_attribute("empty", std::string());
  group.write("data", std::vector<double>{1}, "Pa");
  group.set_attribute("columns", std::string("p"), "data");
  file.commit();

  const File again = File::open(folder / "a.h5");
  const Group in = again.root().group("group");
  EXPECT_EQ(in.attribute<double>("real"), 0.2);
  EXPECT_EQ(in.attribute<std::uint64_t>("count"), ~std::uint64_t{0});
  EXPECT_EQ(in.attribute<std::string>("text").size(), 100000u);
  EXPECT_EQ(in.attribute<std::string>("empty"), "");
  EXPECT_EQ(in.attribute<std::string>("columns", "data"), "p");
  EXPECT_EQ(in.attribute_names(), (std::vector<std::string>{"count", "empty", "real", "text"}));
  EXPECT_EQ(again.root().names(), std::vector<std::string>{"group"});
  EXPECT_TRUE(in.has("data") && in.has_attribute("real"));
  EXPECT_FALSE(in.has("date") || in.has_attribute("unreal"));
}

TEST_F(Hdf5, SeriesGrowAndShrink)
{
  File file = File::create(folder / "a.h5");
  Group root = file.root();
  root.create_series("one", "s", 1, 4);
  root.create_series("three", "m", 3, 4);
  root.append("one", std::vector<double>{1, 2, 3, 4, 5, 6});
  root.append("three", std::vector<double>{1, 2, 3, 4, 5, 6});
  file.commit();

  File more = File::update(folder / "a.h5");
  more.root().resize("one", 5);
  more.root().append("one", std::vector<double>{7});
  more.root().append("three", std::vector<double>{7, 8, 9});
  more.root().append("three", std::vector<double>{});
  more.commit();
  const File again = File::open(folder / "a.h5");
  EXPECT_EQ(again.root().read<double>("one"), (std::vector<double>{1, 2, 3, 4, 5, 7}));
  EXPECT_EQ(again.root().read<double>("three", {3, 3}), (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(again.root().unit("one"), "s");
}

TEST_F(Hdf5, NothingChangesWithoutCommit)
{
  const std::filesystem::path path = write_some();
  const std::string before = get(path);
  {
    File replaced = File::create(path);
    replaced.root().set_attribute("x", 1.0);
  }
  {
    File changed = File::update(path);
    changed.root().set_attribute("x", 1.0);
  }
  EXPECT_EQ(get(path), before);
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".tmp"));
}

TEST_F(Hdf5, BadFilesAreInputErrors)
{
  EXPECT_THAT(message_of<InputError>([&] { File::open(folder / "absent.h5"); }),
              HasSubstr("absent.h5: there is no such"));
  EXPECT_THAT(message_of<InputError>([&] { File::open(folder); }), HasSubstr("not a file"));
  const auto text = put("text.h5", "time,p\n0,1\n");
  EXPECT_THAT(message_of<InputError>([&] { File::open(text); }), HasSubstr("not an HDF5 file"));
  const auto empty = put("empty.h5", "");
  EXPECT_THAT(message_of<InputError>([&] { File::open(empty); }), HasSubstr("not an HDF5 file"));
  const auto half = write_some();
  cut_to_half(half);
  EXPECT_THAT(message_of<InputError>([&] { File::open(half); }), HasSubstr("truncated"));
  EXPECT_THAT(message_of<InputError>([&] { File::update(half); }), HasSubstr("truncated"));
}

TEST_F(Hdf5, BadItemsNameFileItemAndExpectation)
{
  const File file = File::open(write_some());
  const Group group = file.root().group("group");
  EXPECT_THAT(message_of<InputError>([&] { group.read<double>("absent"); }), HasSubstr("/group/absent"));
  EXPECT_THAT(message_of<InputError>([&] { group.attribute<double>("absent"); }), HasSubstr("/group@absent"));
  EXPECT_THAT(message_of<InputError>([&] { file.root().group("absent"); }), HasSubstr("no such group"));
  EXPECT_THAT(message_of<InputError>([&] {
                group.read<double>("values", {10, 3});
              }),
              HasSubstr("some.h5: cannot read /group/values: its shape is [1000], expected [10, 3]"));
  EXPECT_THAT(message_of<InputError>([&] { group.read<std::uint64_t>("values"); }), HasSubstr("unsigned integers"));
  EXPECT_THAT(message_of<InputError>([&] { group.read<std::uint32_t>("count"); }), HasSubstr("unsigned integers"));
  EXPECT_THAT(message_of<InputError>([&] { group.attribute<std::string>("number"); }), HasSubstr("text"));
}

TEST_F(Hdf5, RowsThatDoNotExistAskForNoMemory)
{
  File file = File::create(folder / "huge.h5");
  Group root = file.root();
  root.create_series("x", "m");
  root.append("x", std::vector<double>{1, 2});
  root.resize("x", 1'000'000'000'000);
  file.commit();
  EXPECT_LT(std::filesystem::file_size(folder / "huge.h5"), 100'000u);
  const File again = File::open(folder / "huge.h5");
  EXPECT_THROW(again.root().shape("x"), InputError);
  EXPECT_THAT(message_of<InputError>([&] { again.root().read<double>("x"); }),
              HasSubstr("/x: it claims 1000000000000 values, but stores "));
}

TEST_F(Hdf5, BytesComeBackWhateverTheirNumber)
{
  const std::filesystem::path path = folder / "bytes.h5";
  std::vector<std::byte> bytes(19);
  for (std::size_t k = 0; k < bytes.size(); ++k)
    bytes[k] = static_cast<std::byte>(7 * k + 250);
  {
    File file = File::create(path);
    write_bytes(file.root(), "some", bytes);
    write_bytes(file.root(), "none", {});
    write_bytes(file.root(), "cut", bytes);
    file.root().set_attribute("bytes", std::uint64_t{25}, "cut");
    file.commit();
  }
  const File file = File::open(path);
  EXPECT_EQ(read_bytes(file.root(), "some"), bytes);
  EXPECT_TRUE(read_bytes(file.root(), "none").empty());
  EXPECT_THAT(message_of<InputError>([&] { read_bytes(file.root(), "cut"); }), HasSubstr("cut holds 24 bytes of 25"));
}

TEST_F(Hdf5, UnwritablePlacesAreRunFailures)
{
  const auto file = put("a_file", "x");
  EXPECT_THAT(message_of<RunFailure>([&] { File::create(file / "below.h5"); }), HasSubstr("cannot create"));
  EXPECT_THAT(message_of<RunFailure>([&] { File::create(folder / "absent" / "a.h5"); }),
              HasSubstr("the folder must exist"));
}

/// A full disk, imitated by a limit on the size of files: what is lacking is room for the values, or for all there is.
TEST_F(Hdf5, FullDiskKeepsTheOldFile)
{
  const std::filesystem::path path = write_some();
  const std::string before = get(path);
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const auto old_signal = std::signal(SIGXFSZ, SIG_IGN);
  for (const rlim_t room : {100000, 3000, 500, 0})
    {
      SCOPED_TRACE(room);
      const rlimit small{room, old.rlim_max};
      setrlimit(RLIMIT_FSIZE, &small);
      const std::string message = message_of<RunFailure>([&] {
        File file = File::create(path);
        file.root().write("large", std::vector<double>(100000, 1.0), "m");
        file.root().set_attribute("number", 1.0);
        file.commit();
      });
      setrlimit(RLIMIT_FSIZE, &old);
      EXPECT_THAT(message, HasSubstr("free space"));
      EXPECT_EQ(get(path), before);
      EXPECT_FALSE(std::filesystem::exists(path.string() + ".tmp"));
    }
  std::signal(SIGXFSZ, old_signal);
  write_some(); // and the library still works
  EXPECT_EQ(File::open(path).root().group("group").attribute<double>("number"), 2.5);
}

using Hdf5DeathTest = Hdf5;

/// As at the end of a program with MPI. HDF5 1.10 would crash then on a file that it could not close.
TEST_F(Hdf5DeathTest, ShutsDownAfterAFullDisk)
{
  const auto end = [&] {
    (void)message_of<RunFailure>([&] {
      File file = File::create(folder / "new.h5");
      for (int k = 0; k < 50; ++k)
        file.root().create_group(std::to_string(k)).write("values", std::vector<double>(300, 1.0), "m");
      file.commit();
    });
    std::_Exit(H5close() < 0 ? 3 : 0);
  };
  for (const char *size : {"size=4k", "size=24k", "size=100k"})
    {
      if (::mount("tmpfs", folder.c_str(), "tmpfs", 0, size) != 0)
        GTEST_SKIP() << "no right to mount a small disk";
      EXPECT_EXIT(end(), testing::ExitedWithCode(0), "") << size;
      ::umount2(folder.c_str(), MNT_DETACH);
    }
}
} // namespace
} // namespace isostat
