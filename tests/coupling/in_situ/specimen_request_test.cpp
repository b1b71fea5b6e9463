// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/in_situ/specimen_request.hpp"

#include "base/error.hpp"
#include "tests/coupling/rve_column.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;

LibraryEntry entry(const std::string &name, double seed, double density, double vertical, double k0)
{
  return {name, {}, {{"seed", seed}, {"relative_density", density}, {"vertical_stress_Pa", vertical}, {"K0", k0}}};
}

class Library : public TemporaryFolder
{};
} // namespace

TEST(NearestEntry, IsNearestInStressOfTheDensityAndSeed)
{
  const std::vector<LibraryEntry> entries = {entry("a", 1, 0.50, 50e3, 1),    entry("b", 1, 0.50, 100e3, 1),
                                             entry("c", 1, 0.50, 100e3, 0.5), entry("d", 7, 0.51, 100e3, 1),
                                             entry("e", 1, 0.80, 100e3, 1),   entry("f", 1, 0.50, 100e3, 1)};
  EXPECT_EQ(nearest_entry(entries, {0.5, 0}, 90e3, 90e3).name, "b"); // f is the same, but later
  EXPECT_EQ(nearest_entry(entries, {0.5, 0}, 90e3, 45e3).name, "c");
  EXPECT_EQ(nearest_entry(entries, {0.5, 0}, 20e3, 20e3).name, "a");
  EXPECT_EQ(nearest_entry(entries, {0.5, 1}, 20e3, 20e3).name, "d");
  EXPECT_EQ(nearest_entry(entries, {0.8, 0}, 20e3, 20e3).name, "e");
  EXPECT_THAT(message_of<InputError>([&] {
                nearest_entry(entries, {0.5, 2}, 1e4, 1e4);
              }),
              AllOf(HasSubstr("2 realisations of D_r within 0.05 of 0.5, the soil needs 3"), HasSubstr("sigma_v")));
  EXPECT_THROW(nearest_entry(entries, {0.65, 0}, 1e4, 1e4), InputError);
}

TEST(SpecimenRequest, SeedsOfAPointFollowEachOtherOrGoRoundTheMixedOnes)
{
  SpecimenRequest request{0.5, 3};
  EXPECT_EQ(request.seed_of(0), 3u);
  EXPECT_EQ(request.seed_of(4), 7u);
  request.mixed = 3;
  request.drawn = 2;
  EXPECT_EQ(request.seed_of(0), 5u);
  EXPECT_EQ(request.seed_of(1), 3u);
  EXPECT_EQ(request.seed_of(2), 4u);
}

TEST(SpecimenRequest, NeedsSeedsForAllPackingsOrForTheDraw)
{
  SpecimenRequest request{0.5, 3};
  EXPECT_EQ(request.n_seeds(2), 5u);
  request.mixed = 4;
  EXPECT_EQ(request.n_seeds(2), 7u);
}

TEST_F(Library, MustHaveThisManySeeds)
{
  test::write_library(folder / "library.h5");
  EXPECT_NO_THROW(check_seeds(folder / "library.h5", {0.5, 0}, 1, "soil", "grains"));
  EXPECT_THAT(message_of<InputError>([&] {
                check_seeds(folder / "library.h5", {0.5, 0}, 99, "soil", "grains");
              }),
              AllOf(testing::StartsWith("soil.realisation = 0, grains.realisations = 99: "), HasSubstr("library.h5"),
                    HasSubstr("the soil needs 99")));
}

TEST_F(Library, ReadsEachSpecimenOnce)
{
  test::write_library(folder / "library.h5");
  NearestSpecimens library(folder / "library.h5");
  const auto first = library.find({0.5, 0}, 90e3, 90e3);
  EXPECT_EQ(first->state.grains.n_grains(), 200u);
  EXPECT_THAT(first->source, testing::StartsWith("s000"));
  EXPECT_EQ(library.find({0.5, 0}, 95e3, 95e3), first);
  EXPECT_NE(library.find({0.5, 0}, 50e3, 50e3), first);
  EXPECT_THROW(NearestSpecimens(folder / "none.h5"), InputError);
}
} // namespace isostat
