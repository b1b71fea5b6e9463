// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/batch/realisations.hpp"

#include "tests/support/near.hpp"

namespace isostat
{
namespace
{
const Realisations pairs{2, 2};
const std::vector<Stress> stresses = {
    {-3, -4, -5, 0, 1, 2}, {-5, -4, -3, 2, 1, 0}, {1, 2, 3, 4, 5, 6}, {1, 2, 3, 4, 5, 8}};
} // namespace

TEST(Realisations, AreNumberedPointByPoint)
{
  EXPECT_EQ(pairs.n_elements(), 4u);
  for (std::size_t id = 0; id < 4; ++id)
    EXPECT_EQ(pairs.id_of(pairs.point_of(id), id % 2), id);
  EXPECT_EQ(pairs.label(3), "rve: point 1, realisation 1");
  EXPECT_EQ((Realisations{4, 1}.label(3)), "rve: point 3");
  EXPECT_EQ((Realisations{2, 1, {"clay", "sand, depth 2 m"}}.label(1)), "rve: sand, depth 2 m");
  EXPECT_EQ((Realisations{2, 2, {"clay", "sand, depth 2 m"}}.label(2)), "rve: sand, depth 2 m, realisation 0");
}

TEST(Realisations, AreAveraged)
{
  std::vector<Stress> means(2), of_one(4);
  pairs.mean(stresses, means);
  EXPECT_EQ(means[0], (Stress{-4, -4, -4, 1, 1, 1}));
  EXPECT_EQ(means[1], (Stress{1, 2, 3, 4, 5, 7}));
  Realisations{4, 1}.mean(stresses, of_one);
  EXPECT_EQ(of_one, stresses);
  std::vector<WaveModuli> moduli(1);
  Realisations{1, 2}.mean(std::vector<WaveModuli>{{4, 1}, {8, 2}}, moduli);
  EXPECT_EQ(moduli[0].p, 6);
  EXPECT_EQ(moduli[0].s, 1.5);
  std::vector<Stiffness> stiffness(1);
  Realisations{1, 2}.mean(std::vector<Stiffness>{Stiffness::Identity(), 3 * Stiffness::Identity()}, stiffness);
  EXPECT_EQ(stiffness[0], 2 * Stiffness::Identity());
}

TEST(Realisations, DeviateAsASample)
{
  std::vector<Stress> deviations(2), of_one(4);
  pairs.deviation(stresses, deviations);
  EXPECT_CLOSE_BECAUSE(deviations[0][0], std::sqrt(2), 1e-15, "round-off of a square root"); // -3 and -5
  EXPECT_CLOSE_BECAUSE(deviations[1][5], std::sqrt(2), 1e-15, "round-off of a square root"); // 6 and 8
  EXPECT_EQ(deviations[0][1], 0);
  Realisations{4, 1}.deviation(stresses, of_one);
  EXPECT_EQ(of_one[3], Stress{});
}
} // namespace isostat
