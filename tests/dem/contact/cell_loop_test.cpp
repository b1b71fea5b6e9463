// SPDX-License-Identifier: BSD-3-Clause
// The SIMD contact loop in a periodic cell against its scalar twin: images of grains, homogeneous strain, virial.
#include "base/record/instruction_set.hpp"
#include "dem/contact/linear_rolling/law.hpp"
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
using namespace test;
constexpr Tolerance tolerance{1e-13, "round-off of some hundred operations a contact in another order"};
/// Of a law whose stiffness goes with the overlap.
constexpr Tolerance small_overlap{1e-12, "what a barely touching contact loses is known to round-off of its overlap"};
using Pair = ContactList::Pair;

/// A random cloud whose grains are in other images of the cell: no pair is where it seems to be.
struct CloudInCell
{
  Cloud cloud;
  std::vector<ImageCode> images; ///< of each pair
  Mat3 edges, strain_step;

  Vec3 offset(std::size_t p) const { return edges * image_shift(images[p]).cast<double>(); }
  Vec3 branch(std::size_t p) const
  {
    const auto [i, j] = cloud.pairs[p];
    return cloud.packing.centre(j) - cloud.packing.centre(i) + offset(p);
  }
  /// The second grain at its image, with the velocity that homogeneous strain gives it there.
  ContactPair seen(std::size_t p) const
  {
    ContactPair pair = pair_in_box(cloud, p);
    pair.x2 += offset(p);
    pair.v2 += strain_step / dt * branch(p);
    return pair;
  }
};

/// @param far  whole edges that grains are shifted by
CloudInCell cloud_in_cell(unsigned seed, int far = 1)
{
  CloudInCell c{random_cloud(seed), {}, {}, {}};
  c.edges << 1.6e-3, 0.5e-3, -0.2e-3, 1e-5, 1.5e-3, 0.6e-3, 0, -2e-5, 1.7e-3;
  c.strain_step << 2e-5, 1e-5, -3e-5, 1e-5, -6e-5, 2e-5, -3e-5, 2e-5, 4e-5; // 1000/s: as fast as the grains
  Random random(seed + 100);
  std::vector<Eigen::Vector3i> shift;
  Packing &g = c.cloud.packing;
  for (std::size_t i = 0; i < g.n_grains(); ++i)
    {
      const Vec3 whole = ((far + 0.5) * (0.999 * random.vector())).array().round();
      shift.push_back(whole.cast<int>());
      g.set_centre(i, g.centre(i) + c.edges * whole);
    }
  for (const auto &[i, j] : c.cloud.pairs)
    c.images.push_back(image_code(shift[i] - shift[j]));
  return c;
}

/// What touches only.
CloudInCell touching_pairs(const CloudInCell &all)
{
  CloudInCell c{{all.cloud.packing, {}, {}}, {}, all.edges, all.strain_step};
  for (std::size_t p = 0; p < all.images.size(); ++p)
    if (const auto &[i, j] = all.cloud.pairs[p];
        all.branch(p).norm() < all.cloud.packing.radius(i) + all.cloud.packing.radius(j))
      {
        c.cloud.pairs.push_back(all.cloud.pairs[p]);
        c.cloud.histories.push_back(all.cloud.histories[p]);
        c.images.push_back(all.images[p]);
      }
  return c;
}

struct CellOutcome : Outcome
{
  Mat3 virial;
};

ContactList list_of(const CloudInCell &c, const HistoryLayout &layout, bool with_images = true)
{
  ContactList list(layout);
  const auto n = static_cast<std::uint32_t>(c.cloud.packing.n_grains());
  list.replace_pairs(c.cloud.pairs, n, 1, with_images ? c.images : std::vector<ImageCode>{});
  list.set_cell(c.edges);
  std::size_t p = 0;
  for (std::size_t lane = 0; lane < list.n_lanes(); ++lane)
    if (list.first()[lane] != n)
      list.set_history(lane, c.cloud.histories[p++]);
  return list;
}

/// @param bound  of the sum of F b, J
CellOutcome simd_outcome(const ContactLaw &law, const CloudInCell &c, bool with_energy, double bound, double beta = 0)
{
  CellOutcome out;
  ContactList list = list_of(c, law.history());
  Virial virial;
  virial.start(list.partition().n_chunks, bound);
  const CellMotion motion{c.strain_step, &virial};
  out.action.assign(8 * list.n_slots(), 0.0);
  add_contact_forces(law, c.cloud.packing, dt, list, out.action.data(), with_energy ? &out.loss : nullptr, &motion,
                     beta);
  out.virial = virial.sum();
  std::size_t p = 0;
  for (std::size_t lane = 0; lane < list.n_lanes(); ++lane)
    if (list.first()[lane] < c.cloud.packing.n_grains())
      {
        out.histories.push_back(list.history(lane));
        if (with_energy) // in order of pairs: chunks leave lanes idle
          for (auto *v :
               {&out.loss.sliding, &out.loss.rolling, &out.loss.released, &out.loss.created, &out.loss.viscous})
            (*v)[p] = (*v)[lane];
        ++p;
      }
  return out;
}

/// Symmetric part of the sum of F b by the scalar law, and sum of |F| |b|.
std::pair<Mat3, double> scalar_virial(const RollingResistance &law, const CloudInCell &c, double beta)
{
  Mat3 sum = Mat3::Zero();
  double size = 0;
  for (std::size_t p = 0; p < c.images.size(); ++p)
    {
      ContactHistory history = masked(c.cloud.histories[p], law);
      const auto [i, j] = c.cloud.pairs[p];
      const ContactPair seen = c.seen(p);
      const ContactForce f = contact_force(law, seen, dt, history);
      Vec3 force = f.force;
      double loss = 0;
      if (f.touching && beta > 0)
        force += scalar_dashpot(law, seen, c.cloud.packing.mass(i), c.cloud.packing.mass(j), f, beta, loss);
      const Vec3 b = c.branch(p);
      sum += force * b.transpose();
      size += force.norm() * b.norm();
    }
  return {0.5 * (sum + sum.transpose()), size};
}

/// Clouds upon each other, as many as make several chunks, with pairs from each cloud to the next.
CloudInCell many_clouds(unsigned seed)
{
  const CloudInCell one = cloud_in_cell(seed);
  const Packing &g = one.cloud.packing;
  const auto n = static_cast<std::uint32_t>(g.n_grains());
  const std::uint32_t copies = 3000 / n + 1, total = copies * n;
  CloudInCell all{{}, {}, one.edges, one.strain_step};
  std::vector<Vec3> centres;
  std::vector<double> radii;
  auto add = [&](std::uint32_t first, std::uint32_t second, std::size_t p) {
    all.cloud.pairs.emplace_back(first, second);
    all.cloud.histories.push_back(one.cloud.histories[p]);
    all.images.push_back(one.images[p]);
  };
  for (std::uint32_t at = 0; at < total; ++at)
    {
      const std::uint32_t i = at % n, copy = at - i;
      centres.push_back(g.centre(i));
      radii.push_back(g.radius(i));
      for (const std::uint32_t to : {copy, copy + n}) // to its own copy, and to the next one
        for (std::size_t p = 0; p < one.images.size(); ++p)
          if (one.cloud.pairs[p].first == i && to < total && (to == copy || p % 7 == 0))
            add(at, to + one.cloud.pairs[p].second, p);
    }
  all.cloud.packing = make_packing(centres, radii, 2650);
  for (std::uint32_t at = 0; at < total; ++at)
    {
      all.cloud.packing.set_linear_velocity(at, g.linear_velocity(at % n));
      all.cloud.packing.set_angular_velocity(at, g.angular_velocity(at % n));
    }
  return all;
}

/// Above the sums of F b of both laws.
double energy_of(const CloudInCell &c) { return 1e10 * c.edges.determinant(); }

/// Worst misfit of the loop: forces, histories and losses, and the virial in units of sum |F| |b|.
template <typename Concrete>
std::pair<double, double> worst_misfit(const Concrete &law, const CloudInCell &c, bool with_energy, double beta)
{
  const CellOutcome out = simd_outcome(law, c, with_energy, energy_of(c), beta);
  const auto [virial, size] = scalar_virial(law, c, beta);
  Outcome twin = scalar_outcome(
      law, c.cloud, [&](std::size_t p) { return c.seen(p); }, beta);
  return {misfit(out, twin, with_energy), (out.virial - virial).norm() / size};
}

bool same_bits(const Mat3 &a, const Mat3 &b) { return (a.array() == b.array()).all(); }
} // namespace

class CellKernel : public test::OnInstructionSet
{
protected:
  void SetUp() override
  {
    OnInstructionSet::SetUp();
    ASSERT_EQ(instruction_set(), hwy::TargetName(GetParam()));
  }
};

TEST_P(CellKernel, EqualsTheScalarLawAtTheImage)
{
  for (const Variant &v : variants)
    for_each_law(v, [&](const auto &law) {
      for (const auto &[with_energy, beta] : {std::pair(false, 0.0), {true, 0.0}, {false, 0.3}, {true, 0.3}})
        {
          double worst = 0, worst_virial = 0;
          for (unsigned seed = 1; seed <= 10; ++seed)
            {
              const auto [all, virial] = worst_misfit(law, cloud_in_cell(seed), with_energy, beta);
              worst = std::max(worst, all);
              worst_virial = std::max(worst_virial, virial);
            }
          std::printf("%-9s %-14s %-12s %-6s %.1e, virial %.1e\n", instruction_set().c_str(), law.name(), v.name,
                      with_energy ? "energy" : "", worst, worst_virial);
          EXPECT_BELOW_BECAUSE(worst, law.stiffness_varies() ? small_overlap : tolerance)
              << (with_energy ? "with energy" : "");
          EXPECT_BELOW_BECAUSE(worst_virial, 1e-12, "a sum of thousands of terms on a grid of 2^-52 of their bound");
        }
    });
}

TEST_P(CellKernel, ChunksAndGhostsAddUpToTheScalarSums)
{
  const CloudInCell c = many_clouds(15);
  ASSERT_GT(list_of(c, {}).partition().n_chunks, 3u);
  ASSERT_GT(list_of(c, {}).n_slots(), c.cloud.packing.n_grains() + Packing::n_padding);
  for (const Variant &v : variants)
    for_each_law(v, [&](const auto &law) {
      for (const auto &[with_energy, beta] : {std::pair(false, 0.0), {true, 0.0}, {false, 0.3}, {true, 0.3}})
        {
          const auto [worst, virial] = worst_misfit(law, c, with_energy, beta);
          EXPECT_BELOW_BECAUSE(worst, law.stiffness_varies() ? small_overlap : tolerance)
              << (with_energy ? "with energy" : "");
          EXPECT_BELOW_BECAUSE(virial, 1e-12, "a sum of thousands of terms on a grid of 2^-52 of their bound");
        }
    });
}

TEST_P(CellKernel, WithoutStrainAndImagesItChangesNoBit)
{
  for (const Variant &v : variants)
    for_each_law(v, [](const auto &law) {
      CloudInCell c = cloud_in_cell(16, 0);
      c.strain_step.setZero();
      ContactList box_list = list_of(c, law.history(), false);
      AlignedVector<double> action(8 * box_list.n_slots(), 0.0);
      add_contact_forces(law, c.cloud.packing, dt, box_list, action.data());
      const CellOutcome out = simd_outcome(law, c, false, energy_of(c));
      EXPECT_EQ(std::memcmp(action.data(), out.action.data(), 8 * action.size()), 0);
    });
}

TEST_P(CellKernel, PairsThatDoNotTouchAndEnergySumsChangeNoBit)
{
  // a low bound of the virial makes its grid coarse: rounding that went by what is already in a lane would show
  for (const Variant &v : variants)
    for_each_law(v, [](const auto &law) {
      for (unsigned seed = 20; seed < 40; ++seed)
        for (const double bound : {4.0, 1e6})
          {
            const CloudInCell c = cloud_in_cell(seed);
            const CellOutcome all = simd_outcome(law, c, false, bound),
                              few = simd_outcome(law, touching_pairs(c), false, bound),
                              measured = simd_outcome(law, c, true, bound);
            ASSERT_GT(all.histories.size(), few.histories.size() + 8);
            EXPECT_EQ(std::memcmp(all.action.data(), few.action.data(), 8 * all.action.size()), 0);
            EXPECT_EQ(std::memcmp(all.action.data(), measured.action.data(), 8 * all.action.size()), 0);
            EXPECT_TRUE(same_bits(all.virial, few.virial)) << " seed " << seed << " bound " << bound;
            EXPECT_TRUE(same_bits(all.virial, measured.virial)) << " seed " << seed;
          }
    });
}

INSTANTIATE_TEST_SUITE_P(InstructionSets, CellKernel, testing::ValuesIn(test::instruction_sets()),
                         [](const auto &set) { return std::string(hwy::TargetName(set.param)); });
} // namespace isostat
