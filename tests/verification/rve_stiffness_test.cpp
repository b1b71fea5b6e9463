// SPDX-License-Identifier: BSD-3-Clause
// The condensed stiffness of a representative volume element against what the grains themselves answer to strains of
// 1e-7, and the moduli and wave speeds that follow from it.
//
// All specimens are prepared at a lower friction than they are probed with: no shear force is at its limit then, and
// the small strains of these tests find an elastic network. How many contacts yield is asserted, not assumed.
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/measure/redundancy.hpp"
#include "dem/motion/critical_step.hpp"
#include "dem/rve/rve.hpp"
#include "tests/support/near.hpp"
#include "tests/support/periodic.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
constexpr double probe = 1e-7;

/// Steps with the cell at rest until forces are in balance; strong local damping.
void relax(Assembly &assembly, double unbalanced)
{
  constexpr int interval = 200, most = 400'000;
  assembly.settings.damping = 0.5;
  assembly.compute_forces();
  for (int k = 1; k <= most; ++k)
    {
      assembly.deform(Mat3::Zero());
      assembly.compute_forces();
      if (k % interval == 0 && assembly.unbalanced_force_ratio() < unbalanced)
        return;
    }
  ADD_FAILURE() << "unbalanced still " << assembly.unbalanced_force_ratio();
}

/// 500 dense grains at 200 kPa, forces in balance to 1e-9: 2e-4 Pa, where the probes change stresses by 30 Pa. Rattlers
/// that preparation leaves fly on freely, damped or not, with 0.2 % of the elastic energy, and knock at the network.
Assembly relaxed(double degrees)
{
  Assembly assembly(test::stopped(test::periodic_specimen(500, degrees)));
  assembly.settings.time_step =
      0.8 * critical_step_bound(assembly.law(), assembly.packing(), nullptr, assembly.contacts());
  relax(assembly, 1e-9);
  return assembly;
}

/// Unit strain of column k of a stiffness, engineering shear, without rotation.
Mat3 unit_strain(int k)
{
  constexpr int shear[3][2] = {{1, 2}, {0, 2}, {0, 1}};
  Mat3 strain = Mat3::Zero();
  if (k < 3)
    strain(k, k) = 1;
  else
    strain(shear[k - 3][0], shear[k - 3][1]) = strain(shear[k - 3][1], shear[k - 3][0]) = 0.5;
  return strain;
}

Eigen::Matrix<double, 6, 1> components(const Mat3 &s)
{
  return Eigen::Matrix<double, 6, 1>{s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2), s(0, 1)};
}

/// Stress after a strain in small steps and new equilibrium, from `rest`.
Mat3 stress_after(Assembly &assembly, const AssemblyState &rest, const Mat3 &strain)
{
  constexpr int steps = 100;
  assembly.restore(rest);
  for (int k = 0; k < steps; ++k)
    {
      assembly.deform(strain / steps);
      assembly.compute_forces();
    }
  relax(assembly, 1e-8);
  return assembly.stress();
}

/// Column by column from central differences.
Mat6 probed_stiffness(Assembly &assembly)
{
  const AssemblyState rest = assembly.save();
  Mat6 probed;
  for (int k = 0; k < 6; ++k)
    {
      const Mat3 strain = probe * unit_strain(k);
      const Mat3 difference = stress_after(assembly, rest, strain) - stress_after(assembly, rest, -strain);
      probed.col(k) = components(difference) / (2 * probe);
    }
  assembly.restore(rest);
  return probed;
}

std::size_t yielding(const Snapshot &snapshot)
{
  const ContactClasses classes = contact_network(snapshot).classes;
  return classes.total() - classes.nsr;
}

TEST(RveStiffness, CondensedStiffnessIsWhatStrainProbesFind)
{
  for (const double degrees : {2.0, 6.0})
    {
      Assembly assembly = relaxed(degrees);
      const Snapshot rest = assembly.snapshot();
      EXPECT_LE(yielding(rest), rest.contacts.size() / 100) << "the state is not meant to yield in the probes";
      const Mat6 probed = probed_stiffness(assembly), condensed = Rve(rest, {}).stiffness(Sliding::elastic);
      const double scale = condensed.diagonal().maxCoeff(), worst = (probed - condensed).cwiseAbs().maxCoeff() / scale;
      EXPECT_BELOW_BECAUSE(worst, 0.01, "single contacts that yield in the probes, at most one in a hundred");
    }
}

TEST(RveStiffness, IsSymmetricAndPositiveDefinite)
{
  for (const double degrees : {2.0, 6.0, 18.0})
    {
      const Mat6 c = Rve(test::periodic_specimen(500, degrees), {}).stiffness();
      EXPECT_EQ(c, c.transpose());
      const Eigen::Matrix<double, 6, 1> modes = Eigen::SelfAdjointEigenSolver<Mat6>(c).eigenvalues();
      EXPECT_GT(modes[0], 0.02 * modes[5]) << "prepared at " << degrees << " deg";
    }
}

// In steps of statics: what balanced packings answer to the next increment of a loading, and to one back.
TEST(RveStiffness, PlasticStiffnessIsTheTangentOfContinuedLoading)
{
  RveSettings settings;
  settings.stepping = StaticStepping{};
  test::CellRecipe recipe{.grading = test::small_grading(200), .degrees = 6};
  recipe.law->young = 5e8; // of soil columns; of stiff grains each sliding contact changes the stress
  Rve rve(test::prepare_in_cell(recipe), settings);
  rve.relax();
  for (int k = 0; k < 10; ++k)
    ASSERT_EQ(rve.undrained(1e-3 * unit_strain(5)).outcome, RveOutcome::accepted);
  const RveState state = rve.save();
  const Mat3 before = rve.stress();
  const Mat6 plastic = rve.stiffness(Sliding::plastic), elastic = rve.stiffness();
  const auto misfit = [&](double strain, const Mat6 &tangent) {
    rve.restore(state);
    const Eigen::Matrix<double, 6, 1> answer =
        components(rve.undrained(strain * unit_strain(5)).stress - before) / strain;
    return (tangent.col(5) - answer).norm() / answer.norm();
  };
  EXPECT_BELOW_BECAUSE(misfit(5e-5, plastic), 0.4,
                       "contacts that begin to slide or turn back: 0.1 to 0.25 with packings like this");
  EXPECT_GT(misfit(5e-5, elastic), 1);
  EXPECT_BELOW_BECAUSE(misfit(-2e-5, elastic), 0.1, "few contacts slide after a reversal");
}

struct CycleWork
{
  double lost = 0, exchanged = 0; ///< J
};

/// gamma = 1e-7 sin^2 in one smooth undamped cycle.
CycleWork closed_cycle(Assembly &assembly, const Mat3 &unit, int steps)
{
  CycleWork work;
  const Mat3 origin = assembly.stress();
  Mat3 before = origin;
  double gamma = 0;
  for (int k = 1; k <= steps; ++k)
    {
      const double next = probe * std::pow(std::sin(M_PI * k / steps), 2);
      assembly.deform((next - gamma) * unit);
      assembly.compute_forces();
      const Mat3 after = assembly.stress();
      const double part = (0.5 * (before + after) - origin).cwiseProduct((next - gamma) * unit).sum();
      work.lost += part * assembly.volume();
      work.exchanged += std::abs(part) * assembly.volume();
      gamma = next;
      before = after;
    }
  return work;
}

// No damping, so that nothing but yielding contacts could take energy, and 20,000 steps a cycle, against the some 200
// of the slowest vibration of such a packing: grains follow in equilibrium and end at rest. Stress counts from its
// value before the cycle, as the work of a constant stress in a closed cycle is nothing but round-off. A contact of
// next to no force that slides, opens or closes on the way takes a little with it; where none can slide or roll, less.
TEST(RveStiffness, ClosedCyclesOfSmallShearLoseNoEnergy)
{
  Assembly assembly = relaxed(2);
  const AssemblyState rest = assembly.save();
  const Mat6 c = Rve(assembly.snapshot(), {}).stiffness();
  const Law law = assembly.law();
  auto without_limits = dynamic_cast<const LinearRolling &>(static_cast<const ContactLaw &>(law));
  without_limits.friction = without_limits.rolling_limit = 1e6;
  for (const bool limits : {true, false})
    for (int k = 3; k < 6; ++k)
      {
        assembly.restore(rest);
        assembly.set_law(limits ? law : Law(without_limits));
        assembly.settings.damping = 0;
        const CycleWork work = closed_cycle(assembly, unit_strain(k), 10'000);
        const double in_and_out = c(k, k) * probe * probe * assembly.volume(); // 1/2 G gamma^2 V, twice
        EXPECT_BELOW_BECAUSE(std::abs(work.lost), (limits ? 5e-3 : 1e-5) * work.exchanged,
                             "what a contact of next to no force takes along when it slides, opens or closes");
        EXPECT_NEAR_BECAUSE(work.exchanged / in_and_out, 1, 0.01,
                            "the condensed modulus is that of the start, and single contacts change on the way");
      }
}

/// Means over the three axes, Pa and m/s.
struct Moduli
{
  double pressure, coordination, shear, v_p, v_s;
};

Moduli moduli_of(const Rve &rve)
{
  const Mat6 c = rve.stiffness();
  const double shear = c.diagonal().tail<3>().mean(), oedometric = c.diagonal().head<3>().mean(),
               density = rve.dry_density();
  return {-rve.stress().trace() / 3, contact_network(rve.snapshot()).coordination_number(), shear,
          std::sqrt(oedometric / density), std::sqrt(shear / density)};
}

/// Slope of ln y over ln x.
double exponent(const std::vector<double> &x, const std::vector<double> &y)
{
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    {
      const double a = std::log(x[i]), b = std::log(y[i]);
      sx += a, sy += b, sxx += a * a, sxy += a * b;
    }
  const double n = static_cast<double>(x.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

// Laboratory sands have n = 0.4 to 0.5: a third of it is Hertz, whose contacts stiffen with their force, the rest are
// contacts that close. In this law kn does not know the force, so only the closing contacts are left and n is small:
// moduli here are a choice of E, and hold at one stress level.
TEST(RveStiffness, ShearModulusHardlyDependsOnPressure)
{
  Rve rve(test::prepare_in_cell({.grading = test::small_grading(500), .pressure = 50e3}), {});
  std::vector<double> pressures, moduli, coordination;
  for (const double wanted : {50e3, 100e3, 200e3, 400e3, 800e3})
    {
      MixedIncrement compression;
      compression.stress = -wanted * Mat3::Identity();
      compression.controlled.diagonal().setConstant(true);
      const RveResponse response = rve.advance(compression);
      ASSERT_EQ(response.outcome, RveOutcome::accepted) << response.reason;
      const Moduli m = moduli_of(rve);
      EXPECT_NEAR_BECAUSE(m.pressure / wanted, 1, 2e-3, "twice the tolerance of 1e-3 of a stress increment");
      pressures.push_back(m.pressure);
      moduli.push_back(m.shear);
      coordination.push_back(m.coordination);
    }
  const double n = exponent(pressures, moduli), nz = exponent(pressures, coordination);
  EXPECT_GT(n, 0);
  EXPECT_BELOW_BECAUSE(n, 0.2, "linear contacts: only their number grows with p'; Hertz alone would be 1/3");
  EXPECT_GT(nz, 0) << "contacts close under pressure";
}

TEST(RveStiffness, WaveSpeedsAtTheModulusOfThePaperAndAtASofterOne)
{
  const auto element = [](double young) {
    test::CellRecipe recipe;
    recipe.law->young = young;
    return Rve(test::prepare_in_cell(recipe), {});
  };
  const Moduli stiff = moduli_of(element(1e10)), soft = moduli_of(element(5e8));
  EXPECT_GT(stiff.v_s, 400);
  EXPECT_LT(stiff.v_s, 650);
  EXPECT_GT(soft.v_s, 100);
  EXPECT_LT(soft.v_s, 150);
  for (const Moduli &m : {stiff, soft})
    {
      EXPECT_GT(m.v_p / m.v_s, std::sqrt(4.0 / 3)) << "a positive bulk modulus";
      EXPECT_LT(m.v_p / m.v_s, 2);
    }
  EXPECT_GT(soft.v_s / stiff.v_s, std::sqrt(0.05)) << "more contacts in the softer packing";
}
} // namespace
} // namespace isostat
