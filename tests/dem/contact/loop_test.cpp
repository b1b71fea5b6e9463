// SPDX-License-Identifier: BSD-3-Clause
// The SIMD contact loop against its scalar twin, in a box and in a periodic cell, for every variant of the laws and
// every instruction set of this machine: images of grains, homogeneous strain, virial.
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

/// A random cloud, in a cell one whose grains stand in other images: no pair is where it seems to be.
struct CloudInDomain
{
  Cloud cloud;
  std::vector<ImageCode> images; ///< of each pair; none in a box
  Mat3 edges = Mat3::Zero(), strain_step = Mat3::Zero();

  bool in_cell() const { return !images.empty(); }
  Vec3 offset(std::size_t p) const
  {
    return in_cell() ? Vec3(edges * image_shift(images[p]).cast<double>()) : Vec3(0, 0, 0);
  }
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
  void add_pair(const Pair &pair, const CloudInDomain &from, std::size_t p)
  {
    cloud.pairs.push_back(pair);
    cloud.histories.push_back(from.cloud.histories[p]);
    if (from.in_cell())
      images.push_back(from.images[p]);
  }
};

CloudInDomain in_box(unsigned seed) { return {random_cloud(seed), {}}; }

/// @param far  whole edges that grains are shifted by
CloudInDomain in_cell(unsigned seed, int far = 1)
{
  CloudInDomain c = in_box(seed);
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
CloudInDomain touching_pairs(const CloudInDomain &all)
{
  CloudInDomain c{{all.cloud.packing, {}, {}}, {}, all.edges, all.strain_step};
  for (std::size_t p = 0; p < all.cloud.pairs.size(); ++p)
    if (const auto &[i, j] = all.cloud.pairs[p];
        all.branch(p).norm() < all.cloud.packing.radius(i) + all.cloud.packing.radius(j))
      c.add_pair({i, j}, all, p);
  return c;
}

struct DomainOutcome : Outcome
{
  Mat3 virial = Mat3::Zero();
};

ContactList list_of(const CloudInDomain &c, const HistoryLayout &layout)
{
  ContactList list(layout);
  const auto n = static_cast<std::uint32_t>(c.cloud.packing.n_grains());
  list.replace_pairs(c.cloud.pairs, n, 1, c.images);
  if (c.in_cell())
    list.set_cell(c.edges);
  std::size_t p = 0;
  for (std::size_t lane = 0; lane < list.n_lanes(); ++lane)
    if (list.first()[lane] != n)
      list.set_history(lane, c.cloud.histories[p++]);
  return list;
}

/// @param bound  of the sum of F b, J
DomainOutcome simd_outcome(const ContactLaw &law, const CloudInDomain &c, bool with_energy, double bound,
                           double beta = 0)
{
  DomainOutcome out;
  ContactList list = list_of(c, law.history());
  Virial virial;
  virial.start(list.partition().n_chunks, bound);
  const CellMotion motion{c.strain_step, &virial};
  out.action.assign(8 * list.n_slots(), 0.0);
  add_contact_forces(law, c.cloud.packing, dt, list, out.action.data(), with_energy ? &out.loss : nullptr,
                     c.in_cell() ? &motion : nullptr, beta);
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
std::pair<Mat3, double> scalar_virial(const RollingResistance &law, const CloudInDomain &c, double beta)
{
  Mat3 sum = Mat3::Zero();
  double size = 0;
  for (std::size_t p = 0; p < c.cloud.pairs.size(); ++p)
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
CloudInDomain many_clouds(const CloudInDomain &one)
{
  const Packing &g = one.cloud.packing;
  const auto n = static_cast<std::uint32_t>(g.n_grains());
  const std::uint32_t copies = 3000 / n + 1, total = copies * n;
  CloudInDomain all{{}, {}, one.edges, one.strain_step};
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (std::uint32_t at = 0; at < total; ++at)
    {
      const std::uint32_t i = at % n, copy = at - i;
      centres.push_back(g.centre(i));
      radii.push_back(g.radius(i));
      for (const std::uint32_t to : {copy, copy + n}) // to its own copy, and to the next one
        for (std::size_t p = 0; p < one.cloud.pairs.size(); ++p)
          if (one.cloud.pairs[p].first == i && to < total && (to == copy || p % 7 == 0))
            all.add_pair({at, to + one.cloud.pairs[p].second}, one, p);
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
double energy_of(const CloudInDomain &c) { return c.in_cell() ? 1e10 * c.edges.determinant() : 1; }

template <typename Law>
Tolerance tolerance_of(const Law &law)
{
  return law.stiffness_varies() ? small_overlap : tolerance;
}

/// Forces, histories and losses, and in a cell the virial in units of sum |F| |b|, with energy sums and dashpots and
/// without.
template <typename Law>
void expect_scalar_sums(const Law &law, const CloudInDomain &c)
{
  for (const auto &[with_energy, beta] : {std::pair(false, 0.0), {true, 0.0}, {false, 0.3}, {true, 0.3}})
    {
      SCOPED_TRACE(testing::Message() << (with_energy ? "with energy" : "") << " beta " << beta);
      const DomainOutcome out = simd_outcome(law, c, with_energy, energy_of(c), beta);
      const auto seen = [&](std::size_t p) { return c.seen(p); };
      EXPECT_BELOW_BECAUSE(misfit(out, scalar_outcome(law, c.cloud, seen, beta), with_energy), tolerance_of(law));
      if (!c.in_cell())
        continue;
      const auto [virial, size] = scalar_virial(law, c, beta);
      EXPECT_BELOW_BECAUSE((out.virial - virial).norm() / size, 1e-12,
                           "a sum of thousands of terms on a grid of 2^-52 of their bound");
    }
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

TEST_P(ContactKernel, EqualsTheScalarLawAtTheImage)
{
  for (const Variant &v : variants)
    for_each_law(v, [&](const auto &law) {
      for (unsigned seed = 1; seed <= 10; ++seed)
        for (const CloudInDomain &c : {in_box(seed), in_cell(seed)})
          expect_scalar_sums(law, c);
    });
}

TEST_P(ContactKernel, ChunksAndGhostsAddUpToTheScalarSums)
{
  for (const CloudInDomain &c : {many_clouds(in_box(15)), many_clouds(in_cell(15))})
    {
      const std::size_t n = c.cloud.packing.n_grains();
      ASSERT_GT(list_of(c, {}).partition().n_chunks, 3u);
      ASSERT_GT(list_of(c, {}).n_slots(), n + Packing::n_padding);
      for (const Variant &v : variants)
        for_each_law(v, [&](const auto &law) {
          expect_scalar_sums(law, c);
          const DomainOutcome out = simd_outcome(law, c, false, energy_of(c));
          for (std::size_t slot = n; slot < out.action.size() / 8; ++slot)
            EXPECT_EQ(Vec3(&out.action[8 * slot]), Vec3::Zero()) << "ghosts are left empty";
        });
    }
}

TEST_P(ContactKernel, WithoutStrainAndImagesACellChangesNoBit)
{
  for (const Variant &v : variants)
    for_each_law(v, [](const auto &law) {
      CloudInDomain c = in_cell(16, 0);
      c.strain_step.setZero();
      const DomainOutcome box = simd_outcome(law, in_box(16), false, 1),
                          cell = simd_outcome(law, c, false, energy_of(c));
      EXPECT_EQ(std::memcmp(box.action.data(), cell.action.data(), 8 * box.action.size()), 0);
    });
}

TEST_P(ContactKernel, PairsThatDoNotTouchAndEnergySumsChangeNoBit)
{
  // a low bound of the virial makes its grid coarse: rounding that went by what is already in a lane would show
  for (const Variant &v : variants)
    for_each_law(v, [](const auto &law) {
      for (unsigned seed = 20; seed < 40; ++seed)
        for (const double bound : {4.0, 1e6})
          for (const CloudInDomain &c : {in_box(seed), in_cell(seed)})
            {
              SCOPED_TRACE(testing::Message() << " seed " << seed << " bound " << bound);
              const DomainOutcome all = simd_outcome(law, c, false, bound),
                                  few = simd_outcome(law, touching_pairs(c), false, bound),
                                  measured = simd_outcome(law, c, true, bound);
              ASSERT_GT(all.histories.size(), few.histories.size() + 8);
              EXPECT_EQ(std::memcmp(all.action.data(), few.action.data(), 8 * all.action.size()), 0);
              EXPECT_EQ(std::memcmp(all.action.data(), measured.action.data(), 8 * all.action.size()), 0);
              EXPECT_EQ(misfit(all, measured, false), 0);
              EXPECT_EQ(all.virial, few.virial);
              EXPECT_EQ(all.virial, measured.virial);
            }
    });
}

TEST_P(ContactKernel, ForcesAndMomentsBalance)
{
  for (const Variant &v : variants)
    for_each_law(v, [&](const auto &law) {
      const CloudInDomain c = in_box(11);
      const Cloud &cloud = c.cloud;
      const Outcome out = simd_outcome(law, c, false, 1);
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

TEST_P(ContactKernel, DissipationIsNotNegativeAndNotNaN)
{
  for_each_law(variants[4], [](const auto &law) {
    const Outcome out = simd_outcome(law, in_box(14), true, 1);
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

INSTANTIATE_TEST_SUITE_P(InstructionSets, ContactKernel, testing::ValuesIn(test::instruction_sets()),
                         [](const auto &set) { return std::string(hwy::TargetName(set.param)); });
} // namespace isostat
