// SPDX-License-Identifier: BSD-3-Clause
// Sides with a free field: level ground is a column, and what leaves is absorbed as dashpots absorb plane waves.
#include "fem/solve/free_field.hpp"

#include "base/error.hpp"
#include "fem/material/iwan.hpp"
#include "tests/fem/solve/secant_material.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/drawn_mesh.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <numbers>

namespace isostat
{
namespace
{
using testing::HasSubstr;

using MakeMaterial = std::function<std::unique_ptr<Material>(const FiniteElementSpace &)>;

std::shared_ptr<FreeField> beside(Face side, MeshSpec mesh, const Supports &supports, const MakeMaterial &material,
                                  const DynamicsSettings &settings)
{
  mesh.points_per_direction = mesh.gauss_points(2);
  auto column = std::make_unique<Discretisation<1>>(mesh, supports);
  std::unique_ptr<Material> soil = material(*column);
  return std::make_shared<FreeField>(side, std::move(column), std::move(soil), settings);
}

/// Sand that liquefies over stiffer ground, by the height of points.
std::unique_ptr<Material> sand(const FiniteElementSpace &space)
{
  auto iwan = std::make_unique<Iwan>(IwanParameters{}, space.n_points());
  std::vector<Stress> in_situ;
  for (const Place &at : space.position)
    {
      const double vertical = -9.5e3 * (6 - at[2]);
      in_situ.push_back({0.5 * vertical, 0.5 * vertical, vertical, 0, 0, 0});
    }
  iwan->set_initial_stress(in_situ);
  return iwan;
}

/// Part of the energy of a pulse g(x) sin(k_z z) that two sides reflect: the mean of R^2, R = (1 - cos a)/(1 + cos a),
/// over the wave numbers k of g, cos a = k/sqrt(k^2 + k_z^2).   @param deviation, carrier  of the Gauss bell g, and of
/// its cosine
double reflected(double deviation, double carrier, double k_z)
{
  double part = 0, all = 0;
  for (double k = carrier - 6 / deviation; k < carrier + 6 / deviation; k += 0.01 / deviation)
    {
      const double weight = std::exp(-std::pow((k - carrier) * deviation, 2)), cosine = k / std::hypot(k, k_z);
      part += weight * std::pow((1 - cosine) / (1 + cosine), 2);
      all += weight;
    }
  return part / all;
}

struct Pulse
{
  unsigned component; ///< of the displacement
  double k_z;         ///< its shape is sin(k_z z), 1/m; 0: uniform
  double carrier;     ///< 1/m
};

/// Part of the energy of such a pulse that is left when all of it has met a side once.
double left_of(const Pulse &pulse)
{
  constexpr double height = 10, width = 800, deviation = 75, velocity = 200;
  const MeshSpec mesh{.soil = one_layer(height, 2000, 2), .width = {width, 1}, .cells_across = {320, 1}};
  Supports supports;
  if (pulse.k_z > 0)
    supports.fixed = {{Face::base, 1}};
  const auto soil = [](const FiniteElementSpace &space) {
    return std::make_unique<Elastic>(ElasticParameters{2000 * velocity * velocity, 0}, space.n_points());
  };
  const Discretisation<2> space(mesh, supports);
  const auto material = soil(space);
  DynamicsSettings settings;
  for (Face side : {Face::x_low, Face::x_high})
    settings.free_fields.push_back(beside(side, mesh, supports, soil, {}));
  Dynamics run(space, *material, settings);
  SolverState start = run.save();
  Vector v = space.displacement_vector();
  const std::vector<Place> places = space.node_places();
  for (std::size_t i = pulse.component; i < places.size(); i += 3)
    v.local_element(i) = (pulse.k_z > 0 ? std::sin(pulse.k_z * places[i][2]) : 1) *
                         std::exp(-std::pow((places[i][0] - width / 2) / deviation, 2) / 2) *
                         std::cos(pulse.carrier * (places[i][0] - width / 2));
  start.vectors["velocity"] = MeshOrder(space).unknowns(v);
  run.restore(start);
  run.step();
  const double all = run.energy().kinetic;
  const double wave = pulse.component == 0 ? std::sqrt(2.0) * velocity : velocity; // nu = 0
  const double to_the_other_side = width / (wave * pulse.carrier / std::hypot(pulse.carrier, pulse.k_z));
  while (run.time() < to_the_other_side)
    run.step();
  return (run.energy().kinetic + run.energy().internal) / all;
}
} // namespace

TEST(FreeField, LevelGroundIsAColumnToRoundOff)
{
  for (const bool compliant : {false, true})
    {
      MeshSpec mesh{.soil = one_layer(4, 2000, 3), .width = {7, 1}, .cells_across = {3, 1}};
      mesh.soil.layers.push_back({.name = "below", .thickness = 2, .density = 2100, .cells = 2});
      for (Layer &layer : mesh.soil.layers)
        layer.permeability = compliant ? 0 : 1e-4;
      DynamicsSettings settings{.mass_damping = 0.5, .viscosity = 1e-4, .drainage = Drainage::coupled};
      settings.base.kind = compliant ? BaseKind::compliant : BaseKind::rigid;
      for (int axis = 0; axis < 3; ++axis)
        settings.motion[axis] = ricker_motion(3 - axis, 3 + axis, 0.5, 1e-3);
      const Supports supports = shaken_supports(compliant, Sides::free_field);
      const Discretisation<2> space(mesh, supports);
      for (Face side : {Face::x_low, Face::x_high})
        settings.free_fields.push_back(beside(side, mesh, supports, sand, settings));
      const auto material = sand(space);
      Dynamics run(space, *material, settings);
      while (run.time() < 1.5)
        run.step();
      DynamicsSettings alone = settings;
      alone.free_fields.clear();
      alone.time_step = run.time_step();
      mesh.points_per_direction = 3;
      const Discretisation<1> line(mesh, supports);
      const auto below = sand(line);
      Dynamics column(line, *below, alone);
      while (column.n_steps() < run.n_steps())
        column.step();
      const double largest = column.displacement().linfty_norm(), pressure = column.pressure().linfty_norm();
      EXPECT_GT(pressure, 1e4) << "the sand liquefies";
      const std::vector<Place> places = space.node_places();
      double worst = 0;
      for (std::size_t i = 0; i < places.size(); ++i)
        worst = std::max(worst, std::abs(run.displacement().local_element(i) -
                                         column.displacement().local_element(line.find_dof(places[i], i % 3))));
      EXPECT_BELOW_BECAUSE(worst / largest, 1e-9, "round-off, which sand that liquefies magnifies");
      const SolverState saved = run.save(); // with both columns
      run.step();
      const double next = run.displacement().l2_norm();
      run.restore(saved);
      run.step();
      EXPECT_EQ(run.displacement().l2_norm(), next);
    }
}

TEST(FreeField, WavesThatLeaveAreAbsorbedAsByDashpots)
{
  const double k_z = std::numbers::pi / 20; // a quarter of a wave over the height
  EXPECT_BELOW_BECAUSE(left_of({0, 0, k_z}), 1e-5, "a P wave along x: elements and steps");
  EXPECT_BELOW_BECAUSE(left_of({1, 0, k_z}), 1e-5, "an SH wave along x: elements and steps");
  for (const double degrees : {45., 60.})
    {
      const double carrier = k_z / std::tan(degrees * std::numbers::pi / 180), exact = reflected(75, carrier, k_z);
      EXPECT_NEAR_BECAUSE(left_of({1, k_z, carrier}) / exact, 1, 0.02, "tails of the pulse, elements") << degrees;
    }
}

TEST(FreeField, AFailureNamesTheSide)
{
  const auto weak = [](const FiniteElementSpace &space) {
    auto soil = std::make_unique<SecantMaterial>(
        8e7,
        [](double) {
          return SecantMaterial::Secant{3e7, 0};
        },
        space.n_points());
    soil->largest_strain = space.dimension == 1 ? 1e-6 : 1;
    return soil;
  };
  const MeshSpec mesh{.soil = one_layer(4, 2000, 2), .width = {4, 1}, .cells_across = {2, 1}};
  const Supports supports = shaken_supports(false, Sides::free_field);
  const Discretisation<2> space(mesh, supports);
  DynamicsSettings settings;
  settings.motion[0] = ricker_motion(3, 3, 0.5, 1e-3);
  settings.free_fields = {beside(Face::x_high, mesh, supports, weak, settings)};
  const auto material = weak(space);
  Dynamics run(space, *material, settings);
  const auto go = [&] {
    while (run.time() < 1)
      run.step();
  };
  EXPECT_THAT(message_of<RunFailure>(go), HasSubstr("the level ground next to the side of the highest x: point"));
}

TEST(FreeField, SidesThatHaveNoColumnAreRefused)
{
  const auto drawn = [](double shift) {
    return test::soil_of(test::read_gmsh_text(
        test::gmsh_text<2>({2, 2, 0},
                           [&](std::array<double, 3> at) {
                             return std::array<double, 3>{4 * at[0] + (at[0] == 1 ? shift * at[1] : 0), 2 * at[1], 0};
                           }),
        2));
  };
  const auto soil = [](const FiniteElementSpace &space) {
    return std::make_unique<Elastic>(ElasticParameters{8e7, 0.3}, space.n_points());
  };
  const auto run = [&](double shift, unsigned cells) {
    const MeshSpec mesh = drawn(shift);
    const Discretisation<2> space(mesh, {});
    const auto material = soil(space);
    DynamicsSettings settings;
    settings.free_fields = {
        beside(Face::x_high, {.soil = one_layer(2, 2000, cells), .degree = mesh.degree}, {}, soil, {})};
    Dynamics(space, *material, settings);
  };
  EXPECT_NO_THROW(run(0, 2));
  EXPECT_THAT(test::refusal([&] { run(0, 3); }), HasSubstr("one vertical line"));
  EXPECT_THAT(test::refusal([&] { run(-0.1, 2); }), HasSubstr("one vertical line"));
}
} // namespace isostat
