// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/in_situ/in_situ_start.hpp"

#include "base/error.hpp"
#include "tests/coupling/rve_column.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
class Start : public TemporaryFolder
{
protected:
  std::shared_ptr<const StartingSpecimen> specimen =
      std::make_shared<StartingSpecimen>(StartingSpecimen{test::soft_specimen(4), "s0000"});
  Mat3 target = Vec3(-80e3, -90e3, -80e3).asDiagonal();

  /// Elements 3 and 7 under the same stress, 5 under another.
  InSituStart start(const InSituCache &cache) const
  {
    InSituStart all({}, {}, cache);
    for (std::size_t id : {3, 5, 7})
      all.add(id, specimen, id == 5 ? Mat3(1.1 * target) : target);
    for (std::size_t id : {7, 5, 3})
      all.prepare(id);
    return all;
  }
};
} // namespace

TEST_F(Start, ElementsWithTheSameRecipeShareASpecimen)
{
  const InSituCache none("");
  const InSituStart all = start(none);
  EXPECT_EQ(&all.specimen(3), &all.specimen(7));
  EXPECT_NE(&all.specimen(3), &all.specimen(5));
  const std::vector<InSituState> prepared = all.prepared();
  ASSERT_EQ(prepared.size(), 2u);
  EXPECT_EQ(prepared[0].source, "s0000");
  EXPECT_EQ(specimen_of(prepared[0].packed).grains.position, all.specimen(3).grains.position);
  check_reached(Rve(all.specimen(5), {}).stress(), 1.1 * target, InSituPath::all_stresses);
}

TEST_F(Start, WhatTheCacheHoldsIsNotPreparedAgain)
{
  const std::filesystem::path path = folder / "cache.h5";
  const InSituCache empty(path);
  const InSituStart first = start(empty);
  std::vector<InSituState> travelled;
  append_states(travelled, to_bytes(first.prepared()));
  empty.add(travelled);
  const InSituCache full(path);
  const InSituStart second = start(full);
  EXPECT_TRUE(second.prepared().empty());
  for (std::size_t id : {3, 5, 7})
    EXPECT_EQ(second.specimen(id).grains.position, first.specimen(id).grains.position);
}

TEST_F(Start, ADamagedCacheIsMadeAgain)
{
  const std::filesystem::path path = folder / "cache.h5";
  const std::vector<InSituState> prepared = start(InSituCache("")).prepared();
  InSituCache(path).add(prepared);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const InSituCache damaged(path);
  EXPECT_EQ(start(damaged).prepared().size(), 2u);
  damaged.add(prepared);
  EXPECT_TRUE(std::filesystem::exists(folder / "cache.h5.damaged"));
  EXPECT_TRUE(start(InSituCache(path)).prepared().empty());
}

TEST_F(Start, ACacheThatCannotBeWrittenEndsNoRun)
{
  const std::vector<InSituState> prepared = start(InSituCache("")).prepared();
  put("file", "in the way of a folder");
  testing::internal::CaptureStderr();
  InSituCache(folder / "file/cache.h5").add(prepared);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("states in situ are not kept"), std::string::npos);
}

TEST_F(Start, AFileOfAnotherKindIsNoDamagedCache)
{
  const std::filesystem::path path = folder / "notes.txt";
  put(path, "precious");
  EXPECT_THROW(InSituCache cache(path), InputError);
  EXPECT_EQ(get(path), "precious");
}
} // namespace isostat
