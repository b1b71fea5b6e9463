// SPDX-License-Identifier: BSD-3-Clause
// What must hold for any packing: conservation of momentum, the redundancy index of a packing at rest, the trace of the
// fabric, and the equality of boundary and contact stress in equilibrium.
#include "dem/assembly/assembly.hpp"
#include "dem/io/text_tables.hpp"
#include "dem/measure/fabric.hpp"
#include "dem/measure/redundancy.hpp"
#include "dem/measure/stress.hpp"
#include "tests/support/near.hpp"
#include "tests/support/random.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
/// A lattice of grains around the centre of a box that is far away. They move inwards and at random, and spin: many
/// collisions, some sliding and some rolling.
Snapshot isolated_cluster(double drift)
{
  test::Random random(3);
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b)
      for (int c = 0; c < 4; ++c)
        {
          radii.push_back(1.5e-4 * (1 + 1e-3 * random()));
          centres.push_back(3e-4 * Vec3(a - 1.5, b - 1.5, c - 1.5) + 3e-7 * random.vector());
        }
  Snapshot s;
  s.law = test::paper_law();
  s.grains = make_packing(centres, radii, 2650);
  s.box = {Vec3::Constant(-0.1), Vec3::Constant(0.1)};
  for (std::size_t i = 0; i < centres.size(); ++i)
    {
      s.grains.set_linear_velocity(i, 0.1 * random.vector() - 400 * centres[i] + drift * Vec3(1, -2, 3));
      s.grains.set_angular_velocity(i, 1000 * random.vector());
    }
  return s;
}

/// Linear momentum, angular momentum about the origin, and the sums of the magnitudes of their terms.
struct Momentum
{
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double linear_size = 0, angular_size = 0;
};

Momentum momentum(const Packing &grains)
{
  Momentum sum;
  for (std::size_t i = 0; i < grains.n_grains(); ++i)
    {
      const Vec3 p = grains.mass(i) * grains.linear_velocity(i);
      const Vec3 orbit = grains.centre(i).cross(p), spin = grains.inertia(i) * grains.angular_velocity(i);
      sum.linear += p;
      sum.angular += orbit + spin;
      sum.linear_size += p.norm();
      sum.angular_size += orbit.norm() + spin.norm();
    }
  return sum;
}

Snapshot reference_packing(const std::string &name)
{
  return import_tables(ISOSTAT_SOURCE_DIR "/tests/reference/n1000/" + name, test::paper_law(), 2650);
}

/// The stored packing at rest with its forces.
Snapshot at_rest(const std::string &name)
{
  Assembly assembly(reference_packing(name));
  assembly.settings.time_step = 5e-8;
  assembly.compute_forces();
  return assembly.snapshot();
}
} // namespace

// F acts at the contact point on both grains and the moments are opposite, so forces and torques about any fixed point
// cancel pair by pair. With positions x_k and velocities v_k-1/2, w_k-1/2 the scheme keeps
//
//     P = sum m v_k-1/2        L = sum m x_k x v_k-1/2 + I w_k-1/2
//
// exactly: x_k x (m v_k+1/2) = x_k x (m v_k-1/2) + dt x_k x F_k, the last term and dt T_k cancel in the sum, and
// x_k+1 x v_k+1/2 = x_k x v_k+1/2 since the way is along v_k+1/2. What remains is round-off.
TEST(Momentum, OfAnIsolatedClusterIsKeptToRoundOff)
{
  for (const double drift : {0.0, 0.1})
    {
      Assembly assembly(isolated_cluster(drift));
      assembly.settings.time_step = 1e-8;
      assembly.settings.damping = 0;
      const Momentum start = momentum(assembly.packing());
      double linear = 0, angular = 0, linear_size = start.linear_size, angular_size = start.angular_size;
      std::size_t collisions = 0;
      for (int step = 0; step < 5000; ++step)
        {
          assembly.compute_forces();
          if (step % 50 == 0)
            collisions += assembly.snapshot().contacts.size();
          assembly.move(assembly.box());
          const Momentum now = momentum(assembly.packing());
          linear = std::max(linear, (now.linear - start.linear).norm());
          angular = std::max(angular, (now.angular - start.angular).norm());
          linear_size = std::max(linear_size, now.linear_size);
          angular_size = std::max(angular_size, now.angular_size);
        }
      EXPECT_GT(collisions, 100u);
      EXPECT_BELOW_BECAUSE(linear, 1e-13 * linear_size, "round-off of 5,000 steps, 1e-16 each, that adds up at random");
      EXPECT_BELOW_BECAUSE(angular, 1e-13 * angular_size,
                           "round-off of 5,000 steps, 1e-16 each, that adds up at random");
    }
}

TEST(Momentum, SpinsAndVelocitiesDoExchangeIt)
{
  // the conservation above is no triviality: spin alone is far from being kept
  Assembly assembly(isolated_cluster(0));
  assembly.settings.time_step = 1e-8;
  assembly.settings.damping = 0;
  auto spin = [&] {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < assembly.packing().n_grains(); ++i)
      sum += assembly.packing().inertia(i) * assembly.packing().angular_velocity(i);
    return sum;
  };
  const Vec3 before = spin();
  for (int step = 0; step < 2000; ++step)
    {
      assembly.compute_forces();
      assembly.move(assembly.box());
    }
  EXPECT_GT((spin() - before).norm(), 0.1 * before.norm());
}

class PackingAtRest : public testing::TestWithParam<const char *>
{};

TEST_P(PackingAtRest, RedundancyIsHalfTheCoordinationNumber)
{
  // compressed at 2 or 10 deg and then given 18 deg: nothing yields, except for one weak contact that YADE counts as
  // rolling
  Snapshot s = at_rest(GetParam());
  const std::size_t all = s.contacts.size();
  std::erase_if(s.contacts, [&](const Contact &c) {
    const YieldState yield = s.law->yield(s.closed(c), yield_round_off);
    return yield.sliding || yield.rolling;
  });
  EXPECT_LE(all - s.contacts.size(), 1u);
  const ContactNetwork network = contact_network(s);
  ASSERT_EQ(network.classes.nsr, network.classes.total());
  ASSERT_GT(network.classes.total(), 1000u);
  EXPECT_DOUBLE_EQ(network.redundancy_index(), 0.5 * network.coordination_number());
}

TEST_P(PackingAtRest, WallStressIsLoveWeberStress)
{
  const Snapshot s = at_rest(GetParam());
  const Mat3 contact = contact_stress(s);
  const Vec3 wall = wall_stress(s);
  const double p = invariants(wall).p;
  const double misfit = (contact.diagonal() - wall).cwiseAbs().maxCoeff() / p;
  EXPECT_NEAR_BECAUSE(p, 200e3, 0.1e3, "the servo stopped within 0.05 % of its pressure");
  EXPECT_BELOW_BECAUSE(misfit, 1e-4, "forces unbalanced by 1e-4 where the specimen was stored");
  // moments about each grain cancel, too: the tensor is symmetric
  EXPECT_BELOW_BECAUSE((contact - contact.transpose()).norm(), 1e-4 * p,
                       "moments unbalanced by 1e-4 where the specimen was stored");
}

TEST_P(PackingAtRest, TraceOfFabricAndBoundOfRedundancyHoldWhileItYields)
{
  Assembly assembly(reference_packing(GetParam()));
  assembly.settings.time_step = 5e-8;
  for (int step = 0; step < 500; ++step)
    {
      assembly.compute_forces();
      const Vec3 way = 0.5 * 5e-8 * 20 * Vec3(0.5, -1, 0.5).cwiseProduct(assembly.box().edges());
      assembly.move({assembly.box().lower - way, assembly.box().upper + way});
    }
  assembly.compute_forces();
  const Snapshot s = assembly.snapshot();
  const ContactNetwork network = contact_network(s);
  EXPECT_GT(network.classes.s, 100u);
  EXPECT_NEAR_BECAUSE(contact_fabric(s).trace(), 1, 1e-14, "round-off of a mean of thousands of unit vectors");
  EXPECT_GE(network.redundancy_index(), 1.0 / 6);
  EXPECT_BELOW_BECAUSE(network.redundancy_index(), 0.5 * network.coordination_number(),
                       "I_R = Z/2 where nothing yields, and each yielding contact counts less");
}
INSTANTIATE_TEST_SUITE_P(Packings, PackingAtRest, testing::Values("medium", "vloose"),
                         [](const auto &packing) { return std::string(packing.param); });
} // namespace isostat
