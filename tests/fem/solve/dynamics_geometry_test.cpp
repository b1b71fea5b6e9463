// SPDX-License-Identifier: BSD-3-Clause
// Large strains: cells that move with the soil, in every dimension, dry and with water that flows.
#include "base/error.hpp"
#include "fem/material/corotational.hpp"
#include "fem/solve/dynamics.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/near.hpp"

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using Eigen::Matrix3d;

template <int dim>
Discretisation<dim> soft_block(double height, unsigned cells, const Supports &supports)
{
  MeshSpec mesh{.soil = one_layer(height, 2000, cells), .width = {2, 3}, .cells_across = {2, 1}};
  mesh.points_per_direction = 2; // as a column has
  mesh.soil.layers[0].permeability = 1e-3;
  return Discretisation<dim>(mesh, supports);
}

/// Vectors of the nodes from their places at the start.
template <typename Space, typename F>
Vector field(const Space &space, const F &at)
{
  Vector u = space.displacement_vector();
  const std::vector<Place> places = space.node_places();
  for (std::size_t i = 0; i < places.size(); ++i)
    u.local_element(i) = at(Eigen::Vector3d(places[i].data()))[i % 3];
  return u;
}

/// A stretch of the meshed axes, sheared to 200 % and turned by more than a right angle where there are two of them.
template <int dim>
Matrix3d deformation()
{
  Matrix3d f = Matrix3d::Identity();
  f(2, 2) = 0.5;
  if (dim == 1)
    return f;
  f(0, 0) = 1.3;
  f(0, 2) = 2 * f(2, 2);
  const Eigen::Vector3d axis = dim == 2 ? Eigen::Vector3d(0, 1, 0) : Eigen::Vector3d(1, 2, 3).normalized();
  return Eigen::AngleAxisd(2, axis) * f;
}

constexpr test::Tolerance summed{1e-12, "round-off of sums over some tens of points, of numbers up to 10"};

template <int dim>
void deformed_patch_test()
{
  const Discretisation<dim> space = soft_block<dim>(4, 2, {});
  const Matrix3d f = deformation<dim>();
  Matrix3d l; // velocity gradient along the axes that are meshed
  l << 1, -2, 3, 4, 5, -6, 7, 8, 9;
  for (int axis = 0; axis < 3; ++axis)
    if (std::ranges::find(mesh_axes[dim], axis) == mesh_axes[dim].end())
      l.col(axis).setZero();
  const Vector u = field(space, [&](const Eigen::Vector3d &x) { return (f * x - x).eval(); });
  const Vector v = field(space, [&](const Eigen::Vector3d &x) { return (l * f * x).eval(); });
  CellGeometry now;
  space.deform(u, now);

  std::vector<Gradient> found(space.n_points());
  space.gradients(now, v, found);
  for (std::size_t q = 0; q < found.size(); ++q)
    {
      EXPECT_NEAR_BECAUSE(now.weight[q] / space.weight[q], f.determinant(), summed);
      for (int i = 0; i < 9; ++i)
        EXPECT_NEAR_BECAUSE(found[q][i], l(i / 3, i % 3), 10 * summed);
    }

  // The power of a constant stress is stress : velocity gradient times the volume of now.
  const Stress stress = {1, 2, 3, 4, 5, 6};
  Vector force = space.displacement_vector();
  space.add_internal_force(now, std::vector<Stress>(space.n_points(), stress), force);
  Matrix3d sigma;
  sigma << stress[0], stress[5], stress[4], stress[5], stress[1], stress[3], stress[4], stress[3], stress[2];
  double volume = 0;
  for (double w : now.weight)
    volume += w;
  EXPECT_NEAR_BECAUSE(force * v, (sigma * l).trace() * volume, 100 * volume * summed);
}

constexpr double modulus = 2e5, height = 2, load = 1e5, ramp = 5; // M, H, q: Pa, m, Pa; s

double load_at(double time) { return load * std::min(1.0, time / ramp); }
std::array<double, 3> suddenly(double) { return {0, 0, -load}; }
std::array<double, 3> on_surface(double time) { return {0, 0, -load_at(time)}; }

/// Elastic soil, as columns have it.
std::unique_ptr<Material> soft_soil(bool large_strain, std::size_t n_points)
{
  auto law = std::make_unique<Elastic>(ElasticParameters{modulus / 3, 0.25}, n_points); // M = 3 G
  if (large_strain)
    return std::make_unique<Corotational>(std::move(law));
  return law;
}

/// A soft column under a load on its surface.
struct Loaded
{
  Discretisation<1> space;
  std::unique_ptr<Material> material;
  Dynamics run;

  Loaded(bool large_strain, Drainage drainage, double mass_damping)
      : space(soft_block<1>(height, 10, shaken_supports(false))), material(soft_soil(large_strain, space.n_points())),
        run(space, *material,
            {.time_step = 1e-3,
             .mass_damping = mass_damping,
             .large_strain = large_strain,
             .drainage = drainage,
             .surface_traction = drainage == Drainage::coupled ? on_surface : suddenly})
  {}

  double settlement_after(double time)
  {
    while (run.time() < time)
      run.step();
    return -run.displacement().local_element(space.find_dof({0, 0, height}, 2));
  }
};

/// Settlement of that column by consolidation in finite strain, in finite differences over the height at the start:
/// stretch s, sigma' = -M ln(s) = q - p, ds/dt = d/dZ (kb/s dp/dZ); inertia and the water's compressibility left out.
double consolidated(double time)
{
  constexpr int n = 100;
  const Water water;
  const double mobility = water.mobility(1e-3), dz = height / n, dt = 1e-3;
  std::vector<double> s(n, 1.0), flow(n + 1, 0.0);
  for (double t = 0; t < time; t += dt)
    {
      const auto pressure = [t](double stretch) { return load_at(t) + modulus * std::log(stretch); };
      for (int k = 1; k < n; ++k)
        flow[k] = mobility / ((s[k - 1] + s[k]) / 2) * (pressure(s[k]) - pressure(s[k - 1])) / dz;
      flow[n] = mobility / s[n - 1] * (0 - pressure(s[n - 1])) / (dz / 2); // drained surface
      for (int k = 0; k < n; ++k)
        s[k] += dt * (flow[k + 1] - flow[k]) / dz;
    }
  double settlement = 0;
  for (double stretch : s)
    settlement += (1 - stretch) * dz;
  return settlement;
}

/// Surface displacement (x, z) and pressure of a shaken and loaded soft block of `dim`.
template <int dim>
std::array<double, 3> soft_surface_after()
{
  const Discretisation<dim> space = soft_block<dim>(height, 4, shaken_supports(false));
  const std::unique_ptr<Material> material = soft_soil(true, space.n_points());
  DynamicsSettings settings{.time_step = 2e-3, .large_strain = true, .drainage = Drainage::coupled};
  settings.motion[0] = ricker_motion(1, 3, 0.5, 1e-3);
  settings.surface_traction = on_surface;
  Dynamics run(space, *material, settings);
  for (int k = 0; k < 2500; ++k)
    run.step();
  const auto u = [&](unsigned c) { return run.displacement().local_element(space.find_dof({0, 0, height}, c)); };
  return {u(0), u(2), run.pressure().local_element(space.find_pressure({0, 0, 1}))};
}
} // namespace

TEST(LargeStrain, PatchTestStretchedShearedAndTurned)
{
  deformed_patch_test<1>();
  deformed_patch_test<2>();
  deformed_patch_test<3>();
}

TEST(LargeStrain, CellsTurnedInsideOutStopWithTheirPlace)
{
  const Discretisation<1> space = soft_block<1>(4, 2, {});
  CellGeometry now;
  const Vector u = field(space, [](const Eigen::Vector3d &x) { return (-2 * x).eval(); });
  EXPECT_THAT([&] { space.deform(u, now); }, testing::ThrowsMessage<RunFailure>(testing::HasSubstr("inside out")));
}

TEST(LargeStrain, ColumnAtRestStaysAtRestBitForBit)
{
  const Discretisation<2> space = soft_block<2>(height, 4, shaken_supports(false));
  Elastic material({modulus / 3, 0.25}, space.n_points());
  std::vector<Stress> initial;
  for (const Place &at : space.position)
    initial.push_back({-5e3 * (2 - at[2]), -5e3 * (2 - at[2]), -1e4 * (2 - at[2]), 0, 0, 0});
  material.set_initial_stress(initial);
  Dynamics run(space, material, {.large_strain = true, .drainage = Drainage::coupled});
  for (int k = 0; k < 1000; ++k)
    run.step();
  EXPECT_EQ(run.displacement().linfty_norm(), 0);
}

TEST(LargeStrain, CompressionUnderALoadIsLogarithmic)
{
  // sigma = M ln(stretch) where the increments of strain refer to the present height; small strain has q/M
  constexpr test::Tolerance near{1e-3,
                                 "what remains of the motion after 15 s, and O(h^2) of increments h of up to 2.5 %"};
  EXPECT_NEAR_BECAUSE(Loaded(true, Drainage::dry, 10).settlement_after(15), height * (1 - std::exp(-load / modulus)),
                      near);
  EXPECT_NEAR_BECAUSE(Loaded(false, Drainage::dry, 10).settlement_after(15), height * load / modulus, near);
}

TEST(LargeStrain, ConsolidationIsThatOfFiniteDifferences)
{
  Loaded column(true, Drainage::coupled, 0);
  for (double time : {10.0, 40.0, 120.0})
    EXPECT_CLOSE_BECAUSE(column.settlement_after(time), consolidated(time), 0.01,
                         "ten elements, inertia, and water's matrices that are 0.2 % old");
  EXPECT_BELOW_BECAUSE(1.05 * consolidated(120), Loaded(false, Drainage::coupled, 0).settlement_after(120),
                       "small strain settles by more");
}

TEST(LargeStrain, AColumnIsTheSameInAnyDimension)
{
  const std::array<double, 3> column = soft_surface_after<1>(), plane = soft_surface_after<2>(),
                              solid = soft_surface_after<3>();
  EXPECT_BELOW_BECAUSE(column[1], -0.1, "the ground has settled by 5 % of its height, not little");
  constexpr test::Tolerance alike{1e-6, "round-off of 2,500 steps, and in which of them the water is found again"};
  for (int k = 0; k < 3; ++k)
    {
      EXPECT_CLOSE_BECAUSE(plane[k], column[k], alike);
      EXPECT_CLOSE_BECAUSE(solid[k], column[k], alike);
    }
}

TEST(LargeStrain, ResumesBitForBit)
{
  Loaded whole(true, Drainage::coupled, 0), resumed(true, Drainage::coupled, 0);
  whole.settlement_after(5);
  const SolverState middle = whole.run.save();
  whole.settlement_after(10);
  resumed.run.restore(middle);
  resumed.settlement_after(10);
  ASSERT_EQ(whole.run.n_steps(), resumed.run.n_steps());
  for (std::size_t i = 0; i < whole.run.displacement().locally_owned_size(); ++i)
    EXPECT_EQ(whole.run.displacement().local_element(i), resumed.run.displacement().local_element(i));
}
} // namespace isostat
