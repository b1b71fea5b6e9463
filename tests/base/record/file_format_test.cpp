// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/file_format.hpp"

#include "base/error.hpp"
#include "base/record/installation.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;

class FileFormat : public TemporaryFolder
{
protected:
  hdf5::File written(std::uint64_t version, const std::string &scene = "") const
  {
    hdf5::File file = hdf5::File::create(folder / "a.h5");
    set_format(file.root(), "isostat-example", version, scene);
    file.commit();
    return hdf5::File::open(folder / "a.h5");
  }
};

TEST_F(FileFormat, AFileSaysWhatItIsAndWhoWroteIt)
{
  const hdf5::File file = written(2, "title = \"x\"\n");
  const hdf5::Group root = file.root();
  EXPECT_EQ(format_of(root), "isostat-example");
  EXPECT_EQ(root.attribute<std::uint64_t>("schema_version"), 2u);
  EXPECT_THAT(root.attribute<std::string>("units"), HasSubstr("SI"));
  EXPECT_EQ(root.attribute<std::string>("program"), "unit_io");
  EXPECT_EQ(root.attribute<std::string>("program_version"), version());
  EXPECT_EQ(root.attribute<std::string>("scene"), "title = \"x\"\n");
  EXPECT_NO_THROW(expect_format(root, "isostat-example", 2));
}

TEST_F(FileFormat, WithoutSceneThereIsNoSuchAttribute) { EXPECT_FALSE(written(1).root().has_attribute("scene")); }

TEST_F(FileFormat, ANewerFileIsRefusedWithBothVersions)
{
  const hdf5::File file = written(3);
  for (const std::string &message : {message_of<InputError>([&] { refuse_newer(file.root(), 2); }),
                                     message_of<InputError>([&] { expect_format(file.root(), "isostat-example", 2); })})
    {
      EXPECT_THAT(message, HasSubstr("a.h5: schema_version = 3, this program reads 2"));
      EXPECT_THAT(message, HasSubstr("newer than the program, written by unit_io " + version()));
    }
  EXPECT_NO_THROW(refuse_newer(file.root(), 3));
  EXPECT_NO_THROW(refuse_newer(file.root(), 4));
}

TEST_F(FileFormat, AFileWithoutVersionIsOlderThanAll)
{
  hdf5::File file = hdf5::File::create(folder / "old.h5");
  file.root().set_attribute("x", 1.0);
  file.commit();
  const hdf5::File old = hdf5::File::open(folder / "old.h5");
  EXPECT_EQ(format_of(old.root()), "");
  EXPECT_NO_THROW(refuse_newer(old.root(), 1));
}
} // namespace
} // namespace isostat
