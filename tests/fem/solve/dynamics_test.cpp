// SPDX-License-Identifier: BSD-3-Clause
// What must hold for any run of the dynamics: rest, energy, the stable step, one column in any dimension, restart.
#include "base/error.hpp"
#include "fem/solve/dynamics.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/fields.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Elastic soil whose stiffness can be raised while it runs, and which need not own up to it.
class Stiffening : public Elastic
{
public:
  Stiffening(std::size_t n, bool honest) : Elastic(elastic_of(n, 2000, 200, 0.25)), honest_(honest) {}
  double factor = 1;

  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override
  {
    std::vector<Gradient> larger(increments.begin(), increments.end());
    for (Gradient &h : larger)
      for (double &entry : h)
        entry *= factor;
    Elastic::trial(larger, stresses);
  }
  void wave_moduli(std::span<WaveModuli> moduli) const override
  {
    Elastic::wave_moduli(moduli);
    for (WaveModuli &m : moduli)
      m = {m.p * (honest_ ? factor : 1), m.s * (honest_ ? factor : 1)};
  }

private:
  bool honest_;
};

DynamicsSettings shaken(double peak = 1)
{
  DynamicsSettings settings;
  settings.motion[0] = ricker_motion(peak, 3, 0.5, 1e-3);
  settings.motion[1] = ricker_motion(0.5 * peak, 5, 0.4, 1e-3);
  return settings;
}

template <int dim>
Discretisation<dim> block(unsigned cells = 10, unsigned across = 1, MPI_Comm communicator = MPI_COMM_SELF)
{
  MeshSpec mesh{.soil = one_layer(20, 2000, cells), .width = {2, 3}, .cells_across = {across, across}};
  mesh.soil.layers[0].permeability = 1e-3;
  mesh.points_per_direction = 2;
  return Discretisation<dim>(mesh, shaken_supports(false), communicator);
}

/// Surface displacement (x, z) after some steps of a shaken and loaded column of `dim`.
template <int dim>
std::array<double, 4> surface_after(Drainage drainage, unsigned across)
{
  const Discretisation<dim> space = block<dim>(10, across);
  Elastic material = elastic_of(space.n_points(), 2000, 200, 0.25);
  DynamicsSettings settings = shaken();
  settings.drainage = drainage;
  settings.viscosity = 1e-4;
  settings.time_step = 8e-4;
  settings.motion[2] = ricker_motion(0.3, 4, 0.5, 1e-3);
  settings.surface_traction = [](double t) { return std::array<double, 3>{0, 0, -1e3 * std::min(1.0, t / 0.2)}; };
  Dynamics run(space, material, settings);
  for (int k = 0; k < 1500; ++k)
    run.step();
  const std::array<double, 3> top = {0, 0, 20};
  const auto u = [&](unsigned c) { return run.displacement().local_element(space.find_dof(top, c)); };
  return {u(0), u(1), u(2), run.pressure().local_element(space.find_pressure({0, 0, 10}))};
}
} // namespace

TEST(Dynamics, ColumnAtRestStaysAtRestBitForBit)
{
  const Discretisation<1> space = block<1>();
  for (Drainage drainage : {Drainage::dry, Drainage::undrained, Drainage::coupled})
    {
      Elastic material = elastic_of(space.n_points(), 2000, 200, 0.25);
      std::vector<Stress> initial;
      for (const auto &at : space.position)
        initial.push_back({-5e3 * (20 - at[2]), -5e3 * (20 - at[2]), -1e4 * (20 - at[2]), 0, 0, 0});
      material.set_initial_stress(initial);
      Dynamics run(space, material, {.viscosity = 1e-4, .drainage = drainage});
      for (int k = 0; k < 10000; ++k)
        run.step();
      EXPECT_EQ(run.displacement().linfty_norm(), 0);
      EXPECT_EQ(run.pressure().linfty_norm(), 0);
      EXPECT_TRUE(std::equal(initial.begin(), initial.end(), run.stresses().begin()));
    }
}

TEST(Dynamics, EnergyBalanceOfAnUndampedRun)
{
  const Discretisation<1> space = block<1>(40);
  Elastic material = elastic_of(space.n_points(), 2000, 200, 0.25);
  const double shear = 2000 * 200 * 200, lame = shear; // nu = 0.25
  Dynamics run(space, material, shaken());
  double largest = 0, worst = 0, worst_stored = 0;
  for (int k = 0; k < 10000; ++k)
    {
      double stored = 0; // of the strains, not of the bookkeeping
      std::vector<Gradient> h(space.n_points());
      space.gradients(run.displacement(), h);
      for (std::size_t q = 0; q < h.size(); ++q)
        stored += space.weight[q] / 2 *
                  ((lame + 2 * shear) * h[q][8] * h[q][8] + shear * (h[q][2] * h[q][2] + h[q][5] * h[q][5]));
      run.step();
      const DynamicsEnergy e = run.energy();
      largest = std::max({largest, e.kinetic, e.internal});
      worst = std::max(worst, std::abs(e.residual()));
      worst_stored = std::max(worst_stored, std::abs(e.internal - stored));
    }
  EXPECT_BELOW_BECAUSE(worst, 1e-6 * largest, "round-off of 10,000 steps: energies are sums of the work of each");
  EXPECT_BELOW_BECAUSE(worst_stored, 1e-6 * largest,
                       "round-off of 10,000 steps: energies are sums of the work of each");
  EXPECT_GT(run.energy().kinetic + run.energy().internal, 0.1 * largest); // still moving: nothing was damped away
}

TEST(Dynamics, StepAboveTheStableOneIsRefused)
{
  const Discretisation<1> space = block<1>();
  Elastic material = elastic_of(space.n_points(), 2000, 200, 0.25);
  const double stable = Dynamics(space, material, {}).stable_step();
  EXPECT_NEAR_BECAUSE(stable, 2 / std::sqrt(24) * 2 / (200 * std::sqrt(3)), 1e-9,
                      "tolerance of the power iteration"); // degree 2: omega h/c = sqrt(24)
  EXPECT_THAT([&] { Dynamics(space, material, {.time_step = 1.01 * stable}); },
              ThrowsMessage<InputError>(HasSubstr("stable step")));
}

TEST(Dynamics, StableStepIsABoundAndClose)
{
  const Discretisation<2> space = block<2>(6, 2);
  Stiffening material(space.n_points(), false);
  Dynamics run(space, material, {});
  const double ratio = run.stable_step() / (2 / std::sqrt(test::omega_squared(space, material, 2000)));
  EXPECT_BELOW_BECAUSE(ratio, 1 + 1e-9, "the true one comes from a power iteration, which is below its limit");
  EXPECT_GT(ratio, 0.6);
}

TEST(Dynamics, StiffeningIsFoundBeforeItExplodes)
{
  const Discretisation<1> space = block<1>();
  for (const bool honest : {true, false})
    {
      Stiffening material(space.n_points(), honest);
      Dynamics run(space, material, shaken());
      for (int k = 0; k < 500; ++k)
        run.step();
      material.factor = 16; // shear waves, which alone are there, have sqrt(3) of room
      const auto go_on = [&] {
        for (int k = 0; k < 5000; ++k)
          run.step();
      };
      EXPECT_THAT(go_on,
                  ThrowsMessage<RunFailure>(AllOf(HasSubstr(honest ? "the soil has become stiffer" : "kinetic energy"),
                                                  HasSubstr("at step 5"))));
    }
}

TEST(Dynamics, ColumnEqualsTiedBlocks)
{
  for (const Drainage drainage : {Drainage::dry, Drainage::coupled})
    {
      const auto one = surface_after<1>(drainage, 1), two = surface_after<2>(drainage, 2),
                 three = surface_after<3>(drainage, 2);
      for (int k = 0; k < 4; ++k)
        {
          EXPECT_NEAR_BECAUSE(two[k], one[k], 1e-10 * std::abs(one[k]),
                              "round-off of sums in another order, over the steps")
              << k;
          EXPECT_NEAR_BECAUSE(three[k], one[k], 1e-10 * std::abs(one[k]),
                              "round-off of sums in another order, over the steps")
              << k;
        }
      EXPECT_GT(std::abs(one[0]), 1e-4);
      EXPECT_EQ(one[3] != 0, drainage == Drainage::coupled);
    }
}

TEST(Dynamics, RestoredRunContinuesToTheSameBits)
{
  for (const Drainage drainage : {Drainage::dry, Drainage::undrained, Drainage::coupled})
    {
      const Discretisation<1> space = block<1>();
      DynamicsSettings settings = shaken();
      settings.drainage = drainage;
      settings.lagged_compressibility = drainage == Drainage::undrained;
      settings.viscosity = drainage == Drainage::dry ? 0 : 1e-4;
      Elastic first = elastic_of(space.n_points(), 2000, 200, 0.25), second = first;
      Dynamics whole(space, first, settings), resumed(space, second, settings);
      for (int k = 0; k < 300; ++k)
        whole.step();
      const SolverState saved = whole.save();
      for (int k = 0; k < 1000; ++k)
        whole.step();
      resumed.restore(saved);
      for (int k = 0; k < 1000; ++k)
        resumed.step();
      const SolverState a = whole.save(), b = resumed.save();
      EXPECT_EQ(a.vectors, b.vectors);
      EXPECT_EQ(a.numbers, b.numbers);
      EXPECT_EQ(a.material, b.material);
      EXPECT_EQ(a.step, 1300u);
    }
}

TEST(Dynamics, StateOfAnotherMeshIsRefused)
{
  const Discretisation<1> space = block<1>(), other = block<1>(11);
  Elastic material = elastic_of(space.n_points(), 2000, 200, 0.25);
  Elastic of_other = elastic_of(other.n_points(), 2000, 200, 0.25);
  Dynamics run(space, material, {.time_step = 1e-4}), into(other, of_other, {.time_step = 1e-4}),
      viscous(space, material, {.time_step = 1e-4, .viscosity = 1e-4});
  EXPECT_THROW(into.restore(run.save()), InputError);
  EXPECT_THROW(viscous.restore(run.save()), InputError);
  EXPECT_THROW(run.restore(viscous.save()), InputError);
}

TEST(Dynamics, SettingsThatCannotBeAreRefused)
{
  const Discretisation<2> plane = block<2>(2);
  Elastic in_plane = elastic_of(plane.n_points(), 2000, 200, 0.25);
  EXPECT_THAT(test::refusal([&] { Dynamics(plane, in_plane, {.drainage = Drainage::undrained}); }),
              HasSubstr("columns only"));
  const Discretisation<1> linear({.soil = one_layer(20, 2000, 4), .degree = 1}, shaken_supports(false));
  Elastic few = elastic_of(linear.n_points(), 2000, 200, 0.25);
  EXPECT_THAT(test::refusal([&] { Dynamics(linear, few, {.drainage = Drainage::coupled}); }), HasSubstr("degree = 2"));
  EXPECT_THAT(test::refusal([&] { Discretisation<1>({.soil = one_layer(0, 2000, 4)}, {}); }), HasSubstr("thickness"));
  const Discretisation<1> column = block<1>();
  Elastic in_column = elastic_of(column.n_points(), 2000, 200, 0.25);
  EXPECT_THAT(test::refusal([&] { Dynamics(column, in_column, {.viscosity = -1e-4}); }),
              HasSubstr("viscosity = -0.0001 s"));
  SoilProfile soil = one_layer(5, 2000, 4);
  soil.layers[0].permeability = -1e-5;
  EXPECT_THAT(test::refusal([&] { Discretisation<1>({.soil = soil}, {}); }), HasSubstr("permeability"));
}
} // namespace isostat
