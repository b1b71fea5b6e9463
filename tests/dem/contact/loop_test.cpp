// SPDX-License-Identifier: BSD-3-Clause
// The SIMD contact loop against its scalar twin, for every variant of the law and every instruction set of this
// machine.
#include "base/record/instruction_set.hpp"
#include "dem/contact/loop.hpp"
#include "tests/dem/contact/scalar_twin.hpp"
#include "tests/support/instruction_sets.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <hwy/targets.h>

namespace isostat
{
namespace
{
constexpr double tolerance = 1e-13;
using namespace test;
using Pair = ContactList::Pair;

ContactList make_list(const Cloud &cloud, const ContactLaw &law, bool touching_only = false)
{
  std::vector<Pair> pairs;
  std::vector<ContactHistory> histories;
  for (std::size_t p = 0; p < cloud.pairs.size(); ++p)
    if (!touching_only || cloud.gap(cloud.pairs[p]) < 0)
      {
        pairs.push_back(cloud.pairs[p]);
        histories.push_back(cloud.histories[p]);
      }
  ContactList list(law.history());
  list.replace_pairs(pairs, static_cast<std::uint32_t>(cloud.packing.n_grains()));
  for (std::size_t p = 0; p < pairs.size(); ++p)
    list.set_history(p, histories[p]);
  return list;
}

Outcome simd_outcome(const ContactLaw &law, const Cloud &cloud, bool with_energy, bool touching_only = false,
                     double beta = 0)
{
  Outcome out;
  ContactList list = make_list(cloud, law, touching_only);
  out.action.assign(8 * (cloud.packing.n_grains() + Packing::n_padding), 0.0);
  add_contact_forces(law, cloud.packing, dt, list, out.action.data(), with_energy ? &out.loss : nullptr, nullptr, beta);
  for (std::size_t p = 0; p < list.n_pairs(); ++p)
    out.histories.push_back(list.history(p));
  return out;
}

} // namespace

class ContactKernel : public test::OnInstructionSet
{
protected:
  void SetUp() override
  {
    OnInstructionSet::SetUp();
    ASSERT_EQ(instruction_set(), hwy::TargetName(GetParam()));
  }
};

/// Worst misfit over ten clouds.
template <typename Concrete>
double worst_misfit(const Concrete &law, bool with_energy, double beta)
{
  double worst = 0;
  for (unsigned seed = 1; seed <= 10; ++seed)
    {
      const Cloud cloud = random_cloud(seed);
      const auto see = [&](std::size_t p) { return pair_in_box(cloud, p); };
      worst = std::max(worst, misfit(simd_outcome(law, cloud, with_energy, false, beta),
                                     scalar_outcome(law, cloud, see, beta), with_energy));
    }
  return worst;
}

TEST_P(ContactKernel, EqualsTheScalarLaw)
{
  for (const Variant &v : variants)
    for_each_law(v, [&](const auto &law) {
      for (const auto &[with_energy, beta] : {std::pair(false, 0.0), {true, 0.0}, {false, 0.3}, {true, 0.3}})
        {
          const double worst = worst_misfit(law, with_energy, beta);
          EXPECT_LE(worst, tolerance) << (with_energy ? "with energy" : "") << " beta " << beta;
          std::printf("%-9s %-14s %-12s %-6s %.1e\n", instruction_set().c_str(), law.name(), v.name,
                      with_energy ? "energy" : "", worst);
        }
    });
}

TEST_P(ContactKernel, ForcesAndMomentsBalance)
{
  for (const Variant &v : variants)
    for_each_law(v, [&](const auto &law) {
      const Cloud cloud = random_cloud(11);
      const Outcome out = simd_outcome(law, cloud, false);
      Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
      double force_scale = 0;
      for (std::size_t i = 0; i < cloud.packing.n_grains(); ++i)
        {
          const Vec3 f(&out.action[8 * i]);
          force += f;
          moment += cloud.packing.centre(i).cross(f) + Vec3(&out.action[8 * i + 4]);
          force_scale += f.norm();
          EXPECT_EQ(out.action[8 * i + 3], 0);
          EXPECT_EQ(out.action[8 * i + 7], 0);
        }
      EXPECT_BELOW_BECAUSE(force.norm(), 1e-14 * force_scale, "round-off of a sum over the grains");
      EXPECT_BELOW_BECAUSE(moment.norm(), 1e-14 * force_scale * 1e-3,
                           "round-off of a sum over the grains, arms being some 1e-3 m");
    });
}

TEST_P(ContactKernel, PairsThatDoNotTouchChangeNoBit)
{
  for (const Variant &v : variants)
    for_each_law(v, [&](const auto &law) {
      const Cloud cloud = random_cloud(12);
      const Outcome all = simd_outcome(law, cloud, false), touching = simd_outcome(law, cloud, false, true);
      ASSERT_GT(all.histories.size(), touching.histories.size() + 8);
      EXPECT_EQ(std::memcmp(all.action.data(), touching.action.data(), 8 * all.action.size()), 0);
    });
}

TEST_P(ContactKernel, EnergySumsChangeNoBit)
{
  for (const Variant &v : variants)
    for_each_law(v, [&](const auto &law) {
      const Cloud cloud = random_cloud(13);
      const Outcome plain = simd_outcome(law, cloud, false), measured = simd_outcome(law, cloud, true);
      EXPECT_EQ(std::memcmp(plain.action.data(), measured.action.data(), 8 * plain.action.size()), 0);
      EXPECT_EQ(misfit(plain, measured, false), 0);
    });
}

TEST_P(ContactKernel, DissipationIsNotNegativeAndNotNaN)
{
  for_each_law(variants[4], [](const auto &law) {
    const Outcome out = simd_outcome(law, random_cloud(14), true);
    double sliding = 0, rolling = 0, released = 0;
    for (std::size_t p = 0; p < out.loss.sliding.size(); ++p)
      {
        sliding += out.loss.sliding[p];
        rolling += out.loss.rolling[p];
        released += out.loss.released[p];
        EXPECT_GE(out.loss.released[p], 0);
      }
    EXPECT_GT(sliding, 0);
    EXPECT_GT(rolling, 0);
    EXPECT_GT(released, 0);
  });
}

TEST_P(ContactKernel, ChunksAndGhostsAddUpToTheScalarSums)
{
  // random clouds side by side, as many as make several chunks; pairs that reach across from each cloud to the next
  const auto law = law_of(variants[4]);
  const Cloud cloud = random_cloud(15);
  const auto n = static_cast<std::uint32_t>(cloud.packing.n_grains());
  const std::uint32_t copies = 3000 / n + 1, total = n * copies;
  std::vector<Vec3> centres;
  std::vector<double> radii;
  std::vector<Pair> pairs;
  for (std::uint32_t copy = 0; copy < copies; ++copy)
    for (std::uint32_t i = 0; i < n; ++i)
      {
        centres.push_back(cloud.packing.centre(i)); // copies lie upon each other: a grain touches its next image, too
        radii.push_back(cloud.packing.radius(i));
        for (const Pair &p : cloud.pairs)
          if (p.first == i)
            pairs.emplace_back(copy * n + i, copy * n + p.second);
        if (const auto p = std::ranges::find(cloud.pairs, i, &Pair::first); p != cloud.pairs.end() && copy + 1 < copies)
          pairs.emplace_back(copy * n + i, (copy + 1) * n + p->second);
      }
  Packing packing = make_packing(centres, radii, 2650);
  ContactList list(law.history());
  list.replace_pairs(pairs, total);
  ASSERT_GT(list.partition().n_chunks, 3u);
  ASSERT_GT(list.n_slots(), total + Packing::n_padding);
  AlignedVector<double> action(8 * list.n_slots(), 0.0), expected(8 * total, 0.0);
  add_contact_forces(law, packing, dt, list, action.data());
  for (const auto &[i, j] : pairs)
    {
      const ContactPair pair{packing.centre(i), Vec3::Zero(), Vec3::Zero(),      packing.centre(j),
                             Vec3::Zero(),      Vec3::Zero(), packing.radius(i), packing.radius(j)};
      ContactHistory fresh;
      const ContactForce f = contact_force(law, pair, dt, fresh);
      for (int k = 0; k < 3; ++k)
        {
          expected[8 * i + k] -= f.force[k];
          expected[8 * j + k] += f.force[k];
        }
    }
  const auto force = [](const AlignedVector<double> &v, std::size_t i) { return Vec3(&v[8 * i]); };
  EXPECT_LE(misfit(action, expected, total, force), tolerance);
  for (std::size_t slot = total; slot < list.n_slots(); ++slot)
    EXPECT_EQ(force(action, slot), Vec3::Zero()) << "ghosts are left empty";
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, ContactKernel, testing::ValuesIn(test::instruction_sets()),
                         [](const auto &set) { return std::string(hwy::TargetName(set.param)); });
} // namespace isostat
