// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/elastic.hpp"
#include "fem/solve/statics.hpp"
#include "tests/support/drawn_mesh.hpp"

#include <map>
#include <numbers>

namespace isostat::test
{
/// A sphere of 1 m under a pressure on its drained surface (Cryer 1963, Q. J. Mech. Appl. Math. 16, 401): in its middle
///
///     p/p_0 = sum_j eta (sin x - x) / [eta x cos(x)/2 + (eta - 1) sin x] exp(-x^2 c t)
///     (1 - eta x^2/2) tan x = x                eta = (1 - nu)/(1 - 2 nu) (1 + K S)
///
/// (Verruijt 2013, Theory and Problems of Poroelasticity, section 3.3). An octant of 4 n^3 elements: a cube in the
/// middle and a block between it and the surface along each axis, 2 n along the radius.
struct CryersSphere
{
  /// Of a corner of a cell, in the cube [0, 2]^3 of which the three bars that leave [0, 1]^3 along the axes are meshed.
  static Place place(Place at)
  {
    const double out = std::max({at[0], at[1], at[2], 1.0}) - 1; // of the inner block, to the surface
    double far = 0;
    for (double &x : at)
      far = std::max(far, x = std::min(x, 1.0));
    Place outer = at;
    for (double &x : outer)
      x = std::tan(std::numbers::pi / 4 * x);
    const double r = std::hypot(at[0], at[1], at[2]), on_sphere = std::hypot(outer[0], outer[1], outer[2]);
    for (int d = 0; d < 3; ++d)
      {
        const double inner = r > 0 ? 0.25 * (1 + far / r) * at[d] : 0;
        at[d] = out > 0 ? (1 - out) * inner + out * outer[d] / on_sphere : inner;
      }
    return at;
  }
  static MeshSpec octant(unsigned n, const std::vector<Refinement> &refine)
  {
    auto mesh = std::make_shared<GivenMesh>();
    std::map<std::array<long, 3>, unsigned> numbers;
    const auto number = [&](const Place &at) {
      const auto [known, is_new] =
          numbers.try_emplace({std::lround(1e8 * at[0]), std::lround(1e8 * at[1]), std::lround(1e8 * at[2])},
                              static_cast<unsigned>(mesh->places.size()));
      if (is_new)
        mesh->places.push_back(at);
      return known->second;
    };
    mesh->dimension = 3;
    for (unsigned k = 0; k < 2 * n; ++k)
      for (unsigned j = 0; j < 2 * n; ++j)
        for (unsigned i = 0; i < 2 * n; ++i)
          {
            if ((i >= n) + (j >= n) + (k >= n) > 1)
              continue;
            GivenMesh::Cell cell = {};
            for (unsigned c = 0; c < 8; ++c)
              cell.corners[c] = number(place({1. * (i + c % 2) / n, 1. * (j + c / 2 % 2) / n, 1. * (k + c / 4) / n}));
            mesh->cells.push_back(cell);
            const bool ends[] = {i == 0, i + 1 == 2 * n, j == 0, j + 1 == 2 * n, k == 0, k + 1 == 2 * n};
            constexpr Face faces[] = {Face::x_low, Face::x_high, Face::y_low, Face::y_high, Face::base, Face::surface};
            for (unsigned f = 0; f < 6; ++f)
              if (ends[f])
                mesh->sides.push_back({mesh->side(cell, f), faces[f]});
          }
    mesh->sort();
    MeshSpec spec = soil_of(std::move(mesh));
    spec.soil.layers[0].porosity = 0.33;
    spec.soil.layers[0].permeability = permeability;
    spec.refine = refine;
    return spec;
  }
  static Supports supports()
  {
    return {.fixed = {{Face::base, 2}, {Face::x_low, 0}, {Face::y_low, 1}},
            .drained = {Face::surface, Face::x_high, Face::y_high}};
  }
  static StaticsSettings settings(const std::string &petsc, double largest_part)
  {
    StaticsSettings settings;
    settings.petsc = petsc;
    settings.largest_part = largest_part;
    settings.pore_water = true;
    settings.newton.tolerance = 1e-10;
    for (Face face : supports().drained)
      settings.tractions.push_back({face, [](double, const Place &at) {
                                      const double r = std::hypot(at[0], at[1], at[2]);
                                      return Place{-load * at[0] / r, -load * at[1] / r, -load * at[2] / r};
                                    }});
    return settings;
  }
  explicit CryersSphere(unsigned n, const std::string &petsc = {}, MPI_Comm communicator = MPI_COMM_SELF,
                        double largest_part = 0.1, const std::vector<Refinement> &refine = {})
      : space(octant(n, refine), supports(), communicator), soil(elastic, space.n_points()),
        statics(space, soil, settings(petsc, largest_part))
  {
    const double k = elastic.bulk_modulus(), g = elastic.shear_modulus;
    const Water &water = space.mesh().soil.water;
    const double storage = 0.33 / water.bulk_modulus, m = 1 / (k + 4 * g / 3);
    at_once = load / (1 + k * storage);
    eta = (1 + k * storage) / (2 * g * m);
    seconds = (m + storage) / water.mobility(permeability);
  }
  double exact(double t) const
  {
    const auto f = [this](double x) { return (1 - eta * x * x / 2) * std::sin(x) - x * std::cos(x); };
    double sum = 0;
    for (int j = 1; j < 60; ++j) // one root in each interval
      {
        double low = (j - 0.5) * std::numbers::pi, high = (j + 0.5) * std::numbers::pi;
        const bool rises = f(low) < 0;
        for (int k = 0; k < 80; ++k)
          ((f((low + high) / 2) < 0) == rises ? low : high) = (low + high) / 2;
        sum += eta * (std::sin(low) - low) / (eta * low * std::cos(low) / 2 + (eta - 1) * std::sin(low)) *
               std::exp(-low * low * t);
      }
    return sum;
  }
  double pressure() const ///< in the middle, over that at once
  {
    const long i = space.find_pressure({0, 0, 0});
    double p = i < 0 ? 0 : statics.pressure().local_element(i) / at_once;
    space.sum_over_ranks({&p, 1});
    return p;
  }
  /// Largest error of that from t = 0.1 to 0.4, and its peak.
  std::array<double, 2> error_and_peak()
  {
    statics.step_undrained();
    std::array<double, 2> found = {};
    for (int k = 1; k <= 20; ++k)
      {
        statics.step(0.02 * seconds);
        const double p = pressure();
        found[1] = std::max(found[1], p);
        if (k >= 5)
          found[0] = std::max(found[0], std::abs(p - exact(0.02 * k)));
      }
    return found;
  }

  static constexpr double load = 1e4, permeability = 1e-8;
  static constexpr ElasticParameters elastic{.shear_modulus = 5e6, .poisson_ratio = 0.1};
  Discretisation<3> space;
  Elastic soil;
  Statics statics;
  double at_once, eta, seconds;
};
} // namespace isostat::test
