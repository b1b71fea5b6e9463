// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"
#include "fem/space/discretisation.hpp"

#include <cmath>

namespace isostat::test
{
/// u_i = sum_j h_ij x_j + 1 at every node that has an unknown.
inline Vector linear_field(const FiniteElementSpace &space, const Gradient &h)
{
  Vector u = space.displacement_vector();
  const std::vector<Place> places = space.node_places();
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < 3; ++j)
      u.local_element(i) += h[3 * (i % 3) + j] * places[i][j] + (j == 0 ? 1 : 0);
  return u;
}

/// Largest omega^2 of a mesh by power iteration on M^-1 K, from below.
inline double omega_squared(const FiniteElementSpace &space, Material &material, int iterations)
{
  const Vector mass = space.lumped_mass();
  Vector x = space.displacement_vector(), f = x;
  for (std::size_t i = 0; i < x.size(); ++i)
    x.local_element(i) = mass.local_element(i) > 0 ? std::sin(1.0 + 7.0 * static_cast<double>(i)) : 0;
  std::vector<Gradient> h(space.n_points());
  std::vector<Stress> stresses(space.n_points());
  double omega2 = 0;
  for (int k = 0; k < iterations; ++k)
    {
      for (unsigned i : space.fixed_dofs)
        x.local_element(i) = 0;
      x /= x.l2_norm();
      space.gradients(x, h);
      material.trial(h, stresses);
      f = 0;
      space.add_internal_force(stresses, f);
      omega2 = 0;
      for (std::size_t i = 0; i < x.size(); ++i)
        {
          const double m = mass.local_element(i);
          f.local_element(i) = m > 0 ? f.local_element(i) / m : 0;
          omega2 += x.local_element(i) * f.local_element(i);
        }
      x = f;
    }
  return omega2;
}
} // namespace isostat::test
