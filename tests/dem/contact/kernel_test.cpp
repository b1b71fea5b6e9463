// SPDX-License-Identifier: BSD-3-Clause
// The SIMD contact loop against its scalar twin, for every variant of the law and every instruction set of this
// machine.
#include "dem/contact/kernel.hpp"
#include "tests/dem/contact/random_cloud.hpp"
#include "tests/support/instruction_sets.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <hwy/targets.h>

namespace isostat
{
namespace
{
constexpr double dt = 5e-8, tolerance = 1e-13;
using Pair = ContactList::Pair;
using test::Cloud;
using test::random_cloud;

ContactList make_list(const Cloud &cloud, const LawParams &law, bool touching_only = false)
{
  std::vector<Pair> pairs;
  std::vector<ContactHistory> histories;
  for (std::size_t p = 0; p < cloud.pairs.size(); ++p)
    if (!touching_only || cloud.gap(cloud.pairs[p]) < 0)
      {
        pairs.push_back(cloud.pairs[p]);
        histories.push_back(cloud.histories[p]);
      }
  ContactList list(law.active());
  list.replace_pairs(pairs, static_cast<std::uint32_t>(cloud.packing.n_grains()));
  for (std::size_t p = 0; p < pairs.size(); ++p)
    list.set_history(p, histories[p]);
  return list;
}

/// What one force evaluation leaves behind.
struct Outcome
{
  AlignedVector<double> action; ///< [F 0 T 0] per grain
  std::vector<ContactHistory> histories;
  DissipationPerPair loss;
};

Outcome simd_outcome(const LawParams &law, const Cloud &cloud, bool with_energy, bool touching_only = false)
{
  Outcome out;
  ContactList list = make_list(cloud, law, touching_only);
  out.action.assign(8 * (cloud.packing.n_grains() + Packing::n_padding), 0.0);
  add_contact_forces(law, cloud.packing, dt, list, out.action.data(), with_energy ? &out.loss : nullptr);
  for (std::size_t p = 0; p < list.n_pairs(); ++p)
    out.histories.push_back(list.history(p));
  return out;
}

/// History that the parts of the law which are off do not have.
ContactHistory masked(const ContactHistory &h, LawFeatures on)
{
  const Vec3 zero = Vec3::Zero();
  if (!on.friction)
    return {};
  return {h.normal, h.shear_force, on.rolling ? h.bending_moment : zero, on.twisting ? h.twisting_moment : zero};
}

double spring_energy(const Vec3 &force, double stiffness)
{
  return stiffness > 0 ? 0.5 * force.squaredNorm() / stiffness : 0;
}

/// Losses of a pair from the scalar law alone: without limits it gives the trial state, without stiffness the history
/// that has only turned.
void scalar_loss(const LawParams &law, const ContactPair &pair, const ContactHistory &past, const ContactHistory &now,
                 bool touching, std::size_t p, DissipationPerPair &loss)
{
  const ContactStiffness k = contact_stiffness(law, pair.r1, pair.r2);
  if (!touching)
    {
      loss.released[p] = spring_energy(past.shear_force, k.shear) + spring_energy(past.bending_moment, k.rolling) +
                         spring_energy(past.twisting_moment, k.twisting);
      return;
    }
  LawParams unlimited = law;
  unlimited.friction = unlimited.rolling_limit = 1e30;
  LawParams limp = unlimited;
  limp.stiffness_ratio = 0;
  ContactHistory trial = past, turned = past;
  contact_force(unlimited, pair, dt, trial);
  contact_force(limp, pair, dt, turned);
  const Vec3 mid_force = 0.5 * (turned.shear_force + now.shear_force);
  loss.sliding[p] = mid_force.dot(trial.shear_force - now.shear_force) / k.shear;
  // the law measures slip with arms R1, R2; its force acts at the contact point
  const Vec3 branch = pair.x2 - pair.x1, n = branch.normalized(), point = 0.5 * (branch + (pair.r1 - pair.r2) * n);
  const Vec3 true_slip = pair.v2 - pair.v1 + pair.w2.cross(point - branch) - pair.w1.cross(point);
  const Vec3 law_slip =
      (pair.r1 + pair.r2) / branch.norm() * (pair.v2 - pair.v1) - (pair.r2 * pair.w2 + pair.r1 * pair.w1).cross(n);
  loss.created[p] = dt * mid_force.dot(true_slip - law_slip);
  if (k.rolling > 0)
    loss.rolling[p] =
        0.5 * (turned.bending_moment + now.bending_moment).dot(trial.bending_moment - now.bending_moment) / k.rolling;
}

Outcome scalar_outcome(const LawParams &law, const Cloud &cloud)
{
  Outcome out;
  const Packing &g = cloud.packing;
  out.action.assign(8 * (g.n_grains() + Packing::n_padding), 0.0);
  out.loss.resize(cloud.pairs.size());
  for (std::size_t p = 0; p < cloud.pairs.size(); ++p)
    {
      const auto [i, j] = cloud.pairs[p];
      const ContactPair pair{g.centre(i),          g.linear_velocity(i),  g.angular_velocity(i), g.centre(j),
                             g.linear_velocity(j), g.angular_velocity(j), g.radius(i),           g.radius(j)};
      const ContactHistory past = masked(cloud.histories[p], law.active());
      ContactHistory now = past;
      const ContactForce f = contact_force(law, pair, dt, now);
      for (int k = 0; k < 3; ++k)
        {
          out.action[8 * i + k] -= f.force[k];
          out.action[8 * j + k] += f.force[k];
          out.action[8 * i + 4 + k] += f.torque1[k];
          out.action[8 * j + 4 + k] += f.torque2[k];
        }
      out.histories.push_back(masked(now, law.active()));
      if (law.active().friction)
        scalar_loss(law, pair, past, now, f.touching, p, out.loss);
    }
  return out;
}

/// Largest |a - b| over largest |b|; `pick` gives a vector of an element.
template <typename Container, typename Pick>
double misfit(const Container &a, const Container &b, std::size_t n, const Pick &pick)
{
  double error = 0, scale = 0;
  for (std::size_t i = 0; i < n; ++i)
    {
      error = std::max(error, (pick(a, i) - pick(b, i)).norm());
      scale = std::max(scale, pick(b, i).norm());
    }
  return scale > 0 ? error / scale : error;
}

/// Worst misfit of everything that a force evaluation leaves behind.
double misfit(const Outcome &a, const Outcome &b, bool with_energy)
{
  using Histories = std::vector<ContactHistory>;
  using Numbers = AlignedVector<double>;
  const std::size_t n = b.histories.size(), grains = b.action.size() / 8;
  auto record = [](std::size_t offset) {
    return [=](const Numbers &v, std::size_t i) { return Vec3(&v[8 * i + offset]); };
  };
  auto member = [](auto m) { return [=](const Histories &h, std::size_t i) { return h[i].*m; }; };
  auto number = [](const Numbers &v, std::size_t i) { return Vec3(v[i], 0, 0); };
  double worst = std::max(misfit(a.action, b.action, grains, record(0)), misfit(a.action, b.action, grains, record(4)));
  for (auto m : {&ContactHistory::normal, &ContactHistory::shear_force, &ContactHistory::bending_moment,
                 &ContactHistory::twisting_moment})
    worst = std::max(worst, misfit(a.histories, b.histories, n, member(m)));
  if (with_energy && !a.loss.sliding.empty())
    for (auto m : {&DissipationPerPair::sliding, &DissipationPerPair::rolling, &DissipationPerPair::released,
                   &DissipationPerPair::created})
      worst = std::max(worst, misfit(a.loss.*m, b.loss.*m, n, number));
  return worst;
}

struct Variant
{
  const char *name;
  bool friction, rolling, twisting;
};
constexpr Variant variants[] = {{"frictionless", false, false, false},
                                {"sliding", true, false, false},
                                {"rolling", true, true, false},
                                {"twisting", true, false, true},
                                {"full", true, true, true}};

LawParams law_of(const Variant &v)
{
  LawParams law;
  law.twisting_stiffness = 0.7; // other than alpha_r: a mix-up would show
  law.features = {v.friction, v.rolling, v.twisting};
  return law;
}
} // namespace

/// Runs once for each instruction set that both the machine and the compiler have.
class ContactKernel : public testing::TestWithParam<std::int64_t>
{
protected:
  void SetUp() override
  {
    hwy::SetSupportedTargetsForTest(GetParam());
    ASSERT_EQ(instruction_set(), hwy::TargetName(GetParam()));
  }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

TEST_P(ContactKernel, EqualsTheScalarLaw)
{
  for (const Variant &v : variants)
    for (const bool with_energy : {false, true})
      {
        double worst = 0;
        for (unsigned seed = 1; seed <= 10; ++seed)
          {
            const Cloud cloud = random_cloud(seed);
            worst = std::max(worst, misfit(simd_outcome(law_of(v), cloud, with_energy),
                                           scalar_outcome(law_of(v), cloud), with_energy));
          }
        EXPECT_LE(worst, tolerance) << v.name << (with_energy ? " with energy" : "");
        std::printf("%-9s %-12s %-6s %.1e\n", instruction_set().c_str(), v.name, with_energy ? "energy" : "", worst);
      }
}

TEST_P(ContactKernel, ForcesAndMomentsBalance)
{
  for (const Variant &v : variants)
    {
      const Cloud cloud = random_cloud(11);
      const Outcome out = simd_outcome(law_of(v), cloud, false);
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
      EXPECT_LE(force.norm(), 1e-14 * force_scale) << v.name;
      EXPECT_LE(moment.norm(), 1e-14 * force_scale * 1e-3) << v.name;
    }
}

TEST_P(ContactKernel, PairsThatDoNotTouchChangeNoBit)
{
  for (const Variant &v : variants)
    {
      const Cloud cloud = random_cloud(12);
      const Outcome all = simd_outcome(law_of(v), cloud, false), touching = simd_outcome(law_of(v), cloud, false, true);
      ASSERT_GT(all.histories.size(), touching.histories.size() + 8);
      EXPECT_EQ(std::memcmp(all.action.data(), touching.action.data(), 8 * all.action.size()), 0) << v.name;
    }
}

TEST_P(ContactKernel, EnergySumsChangeNoBit)
{
  for (const Variant &v : variants)
    {
      const Cloud cloud = random_cloud(13);
      const Outcome plain = simd_outcome(law_of(v), cloud, false), measured = simd_outcome(law_of(v), cloud, true);
      EXPECT_EQ(std::memcmp(plain.action.data(), measured.action.data(), 8 * plain.action.size()), 0) << v.name;
      EXPECT_EQ(misfit(plain, measured, false), 0) << v.name;
    }
}

TEST_P(ContactKernel, DissipationIsNotNegativeAndNotNaN)
{
  const Cloud cloud = random_cloud(14);
  const Outcome out = simd_outcome(law_of(variants[4]), cloud, true);
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
}

TEST_P(ContactKernel, ChunksAndGhostsAddUpToTheScalarSums)
{
  // random clouds side by side, as many as make several chunks; pairs that reach across from each cloud to the next
  const LawParams law = law_of(variants[4]);
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
  ContactList list(law.active());
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
