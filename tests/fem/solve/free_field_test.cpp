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

constexpr double poisson = 0.25, v_s = 200, density = 2000;
const double v_p = v_s * std::sqrt(2 * (1 - poisson) / (1 - 2 * poisson));

/// A pulse g(x) cos(carrier x) of waves between smooth plates, uniform along z or with half a wave between them; g is a
/// Gauss bell of this deviation.
struct Pulse
{
  enum Kind
  {
    p,
    sv,
    sh
  } kind;
  double k_z, carrier; ///< 1/m
  static constexpr double deviation = 75;

  double velocity() const { return kind == p ? v_p : v_s; }
  /// grad(phi cos k_z z), curl(phi sin k_z z) or along y: nothing crosses the plates, which bear no shear.
  Place at(double x, double z) const
  {
    const double bell = std::exp(-x * x / (2 * deviation * deviation)), phi = bell * std::cos(carrier * x),
                 slope = -x / (deviation * deviation) * phi - carrier * bell * std::sin(carrier * x),
                 c = std::cos(k_z * z), s = std::sin(k_z * z);
    if (kind == sh)
      return {0, phi * c, 0};
    return kind == p ? Place{slope * c, 0, -k_z * phi * s} : Place{-k_z * phi * c, 0, slope * s};
  }
};

/// What a plane wave exerts on a side x = const beyond what its dashpots bear, over i omega: along x and z.
Eigen::Vector2cd beyond_dashpots(const Eigen::Vector2cd &direction, const Eigen::Vector2cd &motion, double velocity)
{
  const double mu = density * v_s * v_s, lambda = density * v_p * v_p - 2 * mu;
  return {(lambda * (direction[0] * motion[0] + direction[1] * motion[1]) + 2 * mu * direction[0] * motion[0]) /
                  velocity -
              density * v_p * motion[0],
          mu * (direction[0] * motion[1] + direction[1] * motion[0]) / velocity - density * v_s * motion[1]};
}

/// Part of the energy of a plane wave of the wave numbers k and k_z that dashpots return (Lysmer & Kuhlemeyer 1969): as
/// the same wave, and, P and SV, as the other one, to which Snell's law gives its direction: of SV beyond the critical
/// angle a P wave along the side, which carries nothing away.
double reflected(const Pulse &pulse, double k)
{
  const double cosine = k / std::hypot(k, pulse.k_z), sine = std::sqrt(1 - cosine * cosine);
  if (pulse.kind == Pulse::sh)
    return std::pow((1 - cosine) / (1 + cosine), 2);
  const bool is_p = pulse.kind == Pulse::p;
  const double v = pulse.velocity(), other = is_p ? v_s : v_p, sine_other = sine * other / v;
  using Complex = std::complex<double>;
  const Complex cosine_other = std::sqrt(Complex(1 - sine_other * sine_other));
  const auto wave = [](Complex c, double s, bool longitudinal) {
    return longitudinal ? beyond_dashpots({c, s}, {c, s}, v_p) : beyond_dashpots({c, s}, {-s, c}, v_s);
  };
  Eigen::Matrix2cd back;
  back << wave(-cosine, sine, is_p), wave(-cosine_other, sine_other, !is_p);
  const Eigen::Vector2cd amplitude = back.inverse() * wave(cosine, sine, is_p);
  return std::norm(amplitude[0]) + std::norm(amplitude[1]) * other * cosine_other.real() / (v * cosine);
}

/// The mean over the wave numbers of the pulse, by their energy.
double reflected(const Pulse &pulse)
{
  double part = 0, all = 0;
  for (double k = pulse.carrier - 6 / Pulse::deviation; k < pulse.carrier + 6 / Pulse::deviation;
       k += 0.01 / Pulse::deviation)
    {
      const double weight = std::exp(-std::pow((k - pulse.carrier) * Pulse::deviation, 2)) *
                            (pulse.kind == Pulse::sh ? 1 : k * k + pulse.k_z * pulse.k_z);
      part += weight * reflected(pulse, k);
      all += weight;
    }
  return part / all;
}

/// Part of the energy of such a pulse that is left when all of it has met a side once.
double left_of(const Pulse &pulse)
{
  constexpr double height = 20, width = 800;
  const MeshSpec mesh{.soil = one_layer(height, density, 4), .width = {width, 1}, .cells_across = {320, 1}};
  Supports supports;
  supports.fixed = {{Face::base, 2}, {Face::surface, 2}};
  const auto soil = [](const FiniteElementSpace &space) {
    return std::make_unique<Elastic>(ElasticParameters{density * v_s * v_s, poisson}, space.n_points());
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
  for (std::size_t i = 0; i < places.size(); ++i)
    v.local_element(i) = pulse.at(places[i][0] - width / 2, places[i][2])[i % 3];
  start.vectors["velocity"] = MeshOrder(space).unknowns(v);
  run.restore(start);
  run.step();
  const double all = run.energy().kinetic;
  const double to_the_other_side = // of the pulse's middle
      width / (pulse.velocity() * (pulse.k_z > 0 ? pulse.carrier / std::hypot(pulse.carrier, pulse.k_z) : 1));
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
  const double k_z = std::numbers::pi / 20;
  for (const Pulse::Kind kind : {Pulse::p, Pulse::sh})
    EXPECT_BELOW_BECAUSE(left_of({kind, 0, k_z / 3}), 1e-5, "along x: elements and steps") << kind;
  for (const auto &[kind, degrees] :
       {std::pair{Pulse::p, 45.}, {Pulse::p, 60.}, {Pulse::sv, 30.}, {Pulse::sv, 45.}, {Pulse::sh, 60.}})
    {
      const Pulse pulse{kind, k_z, k_z / std::tan(degrees * std::numbers::pi / 180)};
      EXPECT_NEAR_BECAUSE(left_of(pulse), reflected(pulse), 3e-4, "tails of the pulse, elements")
          << kind << " " << degrees;
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
