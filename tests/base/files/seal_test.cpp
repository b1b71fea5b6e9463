// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/seal.hpp"

#include "base/files/csv_table.hpp"
#include "base/files/hdf5.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

#include <chrono>
#include <thread>

namespace isostat
{
namespace
{
class Sealed : public TemporaryFolder
{
protected:
  std::string opened(const std::string &bytes) const
  {
    put("file.h5", bytes);
    return test::refusal([&] { hdf5::File::open(folder / "file.h5").root().read<double>("row"); });
  }
};

TEST_F(Sealed, EveryByteCounts)
{
  const std::string bytes = "some bytes of a file, whatever they are", whole = sealed(bytes);
  EXPECT_EQ(unsealed(whole, "file"), bytes);
  EXPECT_EQ(unsealed(bytes, "file"), bytes);
  EXPECT_EQ(unsealed("", "file"), "");
  for (std::size_t at = 0; at < whole.size(); ++at)
    {
      std::string damaged = whole;
      damaged[at] ^= 1;
      const bool is_mark = at >= bytes.size() && at < bytes.size() + 16; // then it has no seal
      EXPECT_EQ(test::refusal([&] { unsealed(damaged, "file"); }) != "accepted", !is_mark) << at;
    }
  test::expect_parts(test::refusal([&] { unsealed(whole.substr(1), "file"); }),
                     {"file: damaged: its content has 38 bytes", "but 39 bytes", "write or copy it again"});
}

TEST_F(Sealed, AFileOfManyBlocksIsJudgedAsItsBytesAre)
{
  std::string whole = sealed(std::string(3'000'001, 'x'));
  put("large", whole);
  check_seal(folder / "large");
  std::this_thread::sleep_for(std::chrono::milliseconds(2100)); // old enough to be remembered as whole
  check_seal(folder / "large");
  check_seal(folder / "large");
  for (const std::size_t at : {0ul, 1'048'576ul, 3'000'000ul, whole.size() - 1})
    {
      std::string damaged = whole;
      damaged[at] ^= 1;
      put("large", damaged);
      test::expect_parts(test::refusal([&] { check_seal(folder / "large"); }), {"large: damaged"});
    }
}

TEST_F(Sealed, FilesOfHdf5AreAndStayReadable)
{
  hdf5::File file = hdf5::File::create(folder / "file.h5");
  file.root().write("row", std::vector<double>{1, 2, 3}, "-");
  file.commit();
  hdf5::File more = hdf5::File::update(folder / "file.h5");
  more.root().write("another", std::vector<double>{4}, "-");
  more.commit();
  const std::string bytes = read_text(folder / "file.h5");
  EXPECT_EQ(bytes.size(), unsealed(bytes, "file").size() + 32) << "one seal";
  EXPECT_EQ(opened(bytes), "accepted");
  EXPECT_EQ(opened(std::string(unsealed(bytes, "file"))), "accepted") << "as files before there were seals";
  for (std::size_t at = 8; at < bytes.size() - 32; at += 37)
    {
      std::string damaged = bytes;
      damaged[at] ^= 0x10;
      EXPECT_NE(opened(damaged).find("were written"), std::string::npos) << at;
    }
  for (std::size_t n = 0; n < bytes.size() - 32; n += 101)
    EXPECT_NE(opened(bytes.substr(0, n)), "accepted") << n;
  for (std::size_t n = 1; n < 200;
       n += n < 40 ? 1 : 13) // the seal is damaged, too, and nothing says so but the end of the content
    {
      std::string zeros = bytes;
      zeros.replace(bytes.size() - n, n, n, '\0');
      EXPECT_NE(opened(zeros), "accepted") << n;
      EXPECT_NE(opened(bytes + std::string(n, 'x')), "accepted") << n;
      EXPECT_EQ(opened(bytes.substr(0, bytes.size() - n)) == "accepted", n == 32) << n;
    }
  const std::string content(unsealed(bytes, "file"));
  EXPECT_EQ(opened(content + std::string(2120, '\0')), "accepted") << "as HDF5 itself may leave a file on the disk";
}
} // namespace
} // namespace isostat
