// SPDX-License-Identifier: BSD-3-Clause
// Equilibrium past the peak: a column with a weak layer, sheared by its surface, against the closed form of a series of
// springs.
#include "fem/material/composite.hpp"
#include "fem/solve/statics.hpp"
#include "tests/fem/solve/secant_material.hpp"
#include "tests/support/near.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double weakness = 0.95;
const Softening strong, weak = strong.times(weakness);

/// Stress of a column of four layers, the lowest of them weak and softening, the others on their way back.
double stress_past_peak(double displacement)
{
  double below = weak.residual, above = weak.peak;
  for (int k = 0; k < 100; ++k)
    {
      const double tau = (below + above) / 2;
      double low = weak.at_peak(), high = 1;
      for (int i = 0; i < 100; ++i)
        (weak.stress((low + high) / 2) > tau ? low : high) = (low + high) / 2;
      (0.25 * low + 0.75 * tau / strong.modulus > displacement ? below : above) = tau; // more strain: less stress
    }
  return below;
}

struct SofteningColumn
{
  explicit SofteningColumn(NewtonSettings newton) : space(mesh(), supports())
  {
    std::vector<CompositeMaterial::Part> parts(2);
    for (std::size_t q = 0; q < space.n_points(); ++q)
      parts[space.position[q][2] < 0.25 ? 1 : 0].places.push_back(q);
    parts[0].material = std::make_unique<SecantMaterial>(1e8, strong.law(), parts[0].places.size());
    parts[1].material = std::make_unique<SecantMaterial>(1e8, weak.law(), parts[1].places.size());
    soil = std::make_unique<CompositeMaterial>(std::move(parts));
    StaticsSettings settings;
    settings.newton = newton;
    settings.displacements = {{{Face::surface, 0}, [](double t, const Place &) { return t; }}};
    statics.emplace(space, *soil, settings);
  }
  double stress() const { return statics->reaction({Face::surface, 0}); }

  Discretisation<1> space;
  std::unique_ptr<CompositeMaterial> soil;
  std::optional<Statics> statics;

private:
  static MeshSpec mesh()
  {
    MeshSpec spec = sheared_column_mesh();
    spec.degree = 1; // a layer softens as a whole
    return spec;
  }
  static Supports supports()
  {
    Supports s = fixed_base();
    s.fixed.push_back({Face::surface, 0});
    s.drained.clear();
    return s;
  }
};

constexpr NewtonSettings relaxed = {.tolerance = 1e-7, .max_iterations = 0, .relaxation_iterations = 2000};
} // namespace

TEST(StaticsRelaxation, PassesThePeakInAnyStep)
{
  for (const int steps : {1, 4, 40})
    {
      SofteningColumn column(relaxed);
      unsigned iterations = 0;
      for (int k = 1; k <= steps; ++k)
        {
          column.statics->step(0.01 / steps);
          iterations += column.statics->effort().iterations;
          EXPECT_EQ(column.statics->effort().rejected, 0u);
        }
      EXPECT_CLOSE_BECAUSE(column.stress(), stress_past_peak(0.01), 1e-5,
                           "tolerance of 1e-7 over a column that is some tens of times as soft as its parts");
    }
}

/// All layers on the way down together are in equilibrium too, but one that gives a little more takes all of the
/// motion.
TEST(StaticsRelaxation, LeavesAnEquilibriumThatNoSoilKeeps)
{
  SofteningColumn newton({.tolerance = 1e-7}), relaxation(relaxed);
  newton.statics->step(0.01);
  relaxation.statics->step(0.01);
  EXPECT_GT(newton.stress(), 0.9 * strong.stress(0.01)) << "as steep as it is, the residual leads there";
  EXPECT_CLOSE_BECAUSE(relaxation.stress(), stress_past_peak(0.01), 1e-5, "tolerance of 1e-7");
}

TEST(StaticsRelaxation, TakesOverWhereNewtonGivesUp)
{
  SofteningColumn column({.tolerance = 1e-7, .max_iterations = 1, .relaxation_iterations = 2000, .max_halvings = 0});
  column.statics->step(0.01);
  EXPECT_GT(column.statics->effort().iterations, 2u);
  EXPECT_CLOSE_BECAUSE(column.stress(), stress_past_peak(0.01), 1e-5, "tolerance of 1e-7");
}

/// A soil that says less of its waves than they are.
struct Understated : SecantMaterial
{
  Understated(double part, std::size_t n_points)
      : SecantMaterial(
            1e8,
            [](double) {
              return Secant{strong.modulus, 0};
            },
            n_points),
        part_(part)
  {}
  void wave_moduli(std::span<WaveModuli> moduli) const override
  {
    std::fill(moduli.begin(), moduli.end(), WaveModuli{part_ * (1e8 + 4 * strong.modulus / 3), part_ * strong.modulus});
  }

private:
  double part_;
};

TEST(StaticsRelaxation, StiffensAMassThatIsTooSoft)
{
  const Discretisation<1> space(sheared_column_mesh(), fixed_base());
  for (const double part : {1.0, 0.7, 0.4, 0.15})
    {
      Understated soil(part, space.n_points());
      StaticsSettings settings;
      settings.newton = relaxed;
      settings.newton.max_halvings = 0;
      settings.tractions = {{Face::surface, [](double t, const Place &) { return Place{1e5 * t, 0, 0}; }}};
      Statics statics(space, soil, settings);
      statics.step(1);
      EXPECT_CLOSE_BECAUSE(statics.stresses()[0][4], 1e5, 1e-5, "tolerance of 1e-7");
    }
}

TEST(StaticsRelaxation, FailsAsNewtonsMethodDoesWhereThereIsNoStiffness)
{
  const Discretisation<1> space(sheared_column_mesh(), fixed_base());
  Understated soil(0, space.n_points());
  StaticsSettings settings;
  settings.newton = relaxed;
  settings.tractions = {{Face::surface, [](double t, const Place &) { return Place{1e5 * t, 0, 0}; }}};
  Statics statics(space, soil, settings);
  EXPECT_THAT([&] { statics.step(1); },
              ThrowsMessage<RunFailure>(AllOf(HasSubstr("no equilibrium in step 1"), HasSubstr("singular"))));
  EXPECT_EQ(statics.reaction({Face::base, 0}), 0);
}

TEST(StaticsRelaxation, WithPoreWaterIsNewtonsConsolidation)
{
  double settlement[2];
  for (int k = 0; k < 2; ++k)
    {
      const Discretisation<1> space(sheared_column_mesh(), fixed_base());
      SecantMaterial soil(1e8, hyperbola(5e7, 1e5), space.n_points());
      StaticsSettings settings;
      settings.pore_water = true;
      settings.newton = k ? relaxed : NewtonSettings{.tolerance = 1e-8};
      settings.tractions = {{Face::surface, [](double, const Place &) { return Place{2e4, 0, -1e5}; }}};
      Statics statics(space, soil, settings);
      statics.step_undrained();
      for (int step = 0; step < 5; ++step)
        statics.step(1e-4);
      settlement[k] = statics.displacement().local_element(space.find_dof({0, 0, 1}, 2));
      EXPECT_EQ(statics.effort().rejected, 0u);
    }
  EXPECT_LT(settlement[0], 0);
  EXPECT_CLOSE_BECAUSE(settlement[1], settlement[0], 1e-5, "tolerance of 1e-7");
}

TEST(StaticsRelaxation, SaysWhenItDoesNotComeToRest)
{
  NewtonSettings few = relaxed;
  few.relaxation_iterations = 3, few.max_halvings = 0;
  SofteningColumn column(few);
  EXPECT_THAT([&] { column.statics->step(0.01); },
              ThrowsMessage<RunFailure>(HasSubstr("relaxation has not come to rest in 3 iterations")));
  EXPECT_EQ(column.statics->time(), 0);
}
} // namespace isostat
