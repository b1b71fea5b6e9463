// SPDX-License-Identifier: BSD-3-Clause
#include "dem/static/relaxation.hpp"

#include "base/error.hpp"
#include "dem/measure/stress.hpp"
#include "tests/support/near.hpp"
#include "tests/support/rve_paths.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
using test::expect_same_bits, test::increment, test::run, test::simple_shear;

const Snapshot &specimen() { return test::rve_specimen(); }

RveSettings in_balance(double strain, double tolerance = 1e-3, double left_out = 0)
{
  RveSettings settings;
  settings.stepping = StaticStepping{strain, {tolerance, left_out}};
  return settings;
}

/// Diagonal of the response to small strains of both signs, from the same state, Pa.
std::array<Vec3, 2> probed_moduli(Rve &rve, double strain)
{
  std::array<Vec3, 2> moduli;
  const RveState state = rve.save();
  const Mat3 before = rve.stress();
  for (int sign : {0, 1})
    for (int k = 0; k < 3; ++k)
      {
        Mat3 h = Mat3::Zero();
        h(k, k) = sign ? strain : -strain;
        EXPECT_EQ(rve.advance(h).reason, "");
        moduli[sign][k] = (rve.stress() - before)(k, k) / h(k, k);
        rve.restore(state);
      }
  return moduli;
}
} // namespace

TEST(Relaxation, TakesEveryGrainToBalance)
{
  Rve rve(specimen(), {});
  run(rve, 0, 20);
  for (double tolerance : {1e-2, 1e-3, 1e-5})
    {
      const RveResponse found = rve.relax({tolerance, 0});
      ASSERT_EQ(found.reason, "");
      EXPECT_GT(found.balance.loaded, 150u);
      EXPECT_LE(found.balance.worst, tolerance);
      EXPECT_EQ(found.balance.worst, found.balance.within);
      const Balance again = rve.assembly().balance(0, 200e3);
      EXPECT_EQ(again.worst, found.balance.worst);
    }
  const Mat3 sigma = contact_stress(rve.snapshot());
  EXPECT_BELOW_BECAUSE((sigma - sigma.transpose()).norm(), 1e-5 * sigma.norm(), "torques are in balance to 1e-5");
  EXPECT_EQ(rve.kinetic_stress().norm(), 0) << "grains are at rest";
}

TEST(Relaxation, ABalancedPackingStaysToTheTolerance)
{
  Rve rve(specimen(), {});
  run(rve, 0, 20);
  rve.relax({1e-6, 0});
  const Mat3 before = rve.stress();
  const RveResponse again = rve.relax({1e-6, 0});
  EXPECT_LE(again.steps, 11u) << "balance is checked every ten iterations";
  EXPECT_BELOW_BECAUSE((rve.stress() - before).norm(), 1e-6 * before.norm(), "balanced to 1e-6");
}

TEST(Relaxation, SmallProbesOfABalancedPackingAreItsStiffness)
{
  Rve rve(specimen(), in_balance(1e-5, 1e-6));
  run(rve, 0, 20);
  const Vec3 elastic = rve.stiffness().diagonal().head<3>();
  for (const Vec3 &probed : probed_moduli(rve, 1e-9))
    EXPECT_BELOW_BECAUSE(((probed - elastic).array() / elastic.array()).abs().maxCoeff(), 0.02,
                         "0.7 % was seen: hardly any contact yields in a packing that has come to rest");
}

TEST(Relaxation, PathsDependLittleOnIncrementAndTolerance)
{
  const auto mean_stress = [](double strain, double tolerance) {
    Rve rve(specimen(), in_balance(strain, tolerance));
    for (int k = 0; k < 20; ++k)
      EXPECT_EQ(rve.undrained(simple_shear(2e-5)).reason, "");
    return -rve.stress().trace() / 3;
  };
  const double p0 = 200e3, chosen = mean_stress(1e-5, 1e-3);
  EXPECT_BELOW_BECAUSE(std::abs(mean_stress(1e-5, 1e-4) - chosen), 3e-4 * p0, "1.2e-4 was seen: it is tight");
  EXPECT_BELOW_BECAUSE(std::abs(mean_stress(5e-6, 1e-3) - chosen), 5e-3 * p0, "0.2 % was seen");
}

TEST(Relaxation, HasTheSameBitsForAnyNumberOfThreadsAndAfterRestoring)
{
  const auto path = [](int threads, bool restored) {
    Snapshot many = test::periodic_specimen(1200, 8);
    Assembly assembly(many);
    assembly.settings.threads = threads;
    assembly.settings.fixed_threads = true;
    assembly.settings.time_step = 1e-8;
    assembly.compute_forces();
    for (int k = 0; k < 2; ++k)
      {
        Relaxation relaxation(assembly, 1e-5);
        relaxation.deform(increment(k));
        EXPECT_EQ(relaxation.deform(Mat3::Zero()), 1u)
            << "a move is always pending, so that a resumed run has its bits";
        assembly.compute_forces();
        relaxation.run({1e-2, 0.05});
        if (restored)
          assembly.restore(assembly.save());
      }
    return assembly.save().grains;
  };
  const std::vector<double> alone = path(1, false);
  EXPECT_EQ(path(2, false), alone);
  EXPECT_EQ(path(3, true), alone);
}

TEST(Relaxation, WithoutContactsItIsDoneAtOnce)
{
  Snapshot loose = specimen();
  PeriodicCell &cell = *loose.cell;
  cell.edges *= 1.2;
  for (std::size_t i = 0; i < loose.grains.n_grains(); ++i)
    loose.grains.set_centre(i, 1.2 * loose.grains.centre(i));
  loose.contacts.clear();
  Rve rve(loose, in_balance(1e-5));
  const RveResponse found = rve.undrained(simple_shear(1e-5));
  EXPECT_EQ(found.reason, "");
  EXPECT_EQ(found.steps, 1u);
  EXPECT_EQ(found.balance.loaded, 0u);
}

TEST(Relaxation, ThatDoesNotEndIsTakenBack)
{
  RveSettings settings = in_balance(1e-5, 1e-2);
  settings.max_steps = 2000;
  Rve rve(specimen(), settings);
  run(rve, 0, 2); // that are run again
  const RveState before = rve.save();
  const RveResponse found = rve.undrained(simple_shear(5e-3));
  EXPECT_EQ(found.outcome, RveOutcome::rejected);
  EXPECT_NE(found.reason.find("force evaluations"), std::string::npos) << found.reason;
  expect_same_bits(rve.save(), before);
}

TEST(Relaxation, RefusesSettingsOutOfRange)
{
  EXPECT_THROW(Rve(specimen(), in_balance(0)), InputError);
  EXPECT_THROW(Rve(specimen(), in_balance(1e-5, 0)), InputError);
  EXPECT_THROW(Rve(specimen(), in_balance(1e-5, 1e-3, 1)), InputError);
  Rve rve(specimen(), {});
  EXPECT_THROW(rve.relax({-1, 0}), InputError);
}
} // namespace isostat
