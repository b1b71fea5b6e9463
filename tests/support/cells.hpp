// SPDX-License-Identifier: BSD-3-Clause
// What tests of periodic packings share: how they are strained, and how two states are compared.
#pragma once
#include "dem/assembly/assembly.hpp"
#include "dem/motion/critical_step.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat::test
{
/// What the drivers do every 2,000 steps: a packing that stiffens needs a shorter step.
inline void review_time_step(Assembly &a)
{
  a.settings.time_step = 0.8 * critical_step_bound(a.law(), a.packing(), nullptr, a.contacts());
}

/// This many steps of the same displacement gradient, and the forces after them.
inline void strain(Assembly &a, const Mat3 &gradient, int steps)
{
  for (int step = 0; step < steps; ++step)
    {
      a.compute_forces();
      a.deform(gradient);
    }
  a.compute_forces();
}

/// How far contact forces of the same contacts are apart: forces over the mean force, moments over the mean moment.
struct ForceMisfit
{
  std::size_t contacts = 0;
  double force = 0, moment = 0;
};

/// @param q  turns the vectors of `a` before they are compared
/// @param magnitudes  compare these only
inline ForceMisfit misfit_of_forces(const Snapshot &a, const Snapshot &b, const Mat3 &q = Mat3::Identity(),
                                    bool magnitudes = false)
{
  ForceMisfit worst{a.contacts.size()};
  EXPECT_EQ(a.contacts.size(), b.contacts.size());
  if (a.contacts.size() != b.contacts.size())
    return worst;
  double force_sum = 0, moment_sum = 0;
  for (std::size_t c = 0; c < a.contacts.size(); ++c)
    {
      const Contact &one = a.contacts[c], &two = b.contacts[c];
      EXPECT_TRUE(one.first == two.first && one.second == two.second);
      auto force = [](const Contact &k) -> Vec3 { return k.normal_force * k.history.normal + k.history.shear_force; };
      auto moment = [](const Contact &k) -> Vec3 { return k.history.bending_moment + k.history.twisting_moment; };
      auto apart = [&](const Vec3 &x, const Vec3 &y) {
        return magnitudes ? std::abs(x.norm() - y.norm()) : (q * x - y).norm();
      };
      worst.force = std::max(worst.force, apart(force(one), force(two)));
      worst.moment = std::max(worst.moment, apart(moment(one), moment(two)));
      force_sum += force(two).norm();
      moment_sum += moment(two).norm();
    }
  worst.force *= static_cast<double>(worst.contacts) / force_sum;
  worst.moment *= static_cast<double>(worst.contacts) / moment_sum;
  return worst;
}

/// A dense packing of 500 grains, sheared to shortly before its cell is exchanged for a more upright one; after move().
/// Made once per program and kept.
inline const Snapshot &before_flip(double shear_step)
{
  static std::map<double, Snapshot> made;
  if (!made.contains(shear_step))
    {
      Assembly a(periodic_specimen(500, 10));
      const auto lean = [&] {
        const Mat3 &e = a.cell()->edges;
        return e.col(0).dot(e.col(1)) / std::min(e.col(0).squaredNorm(), e.col(1).squaredNorm());
      };
      while (lean() < 0.6 - 200 * shear_step)
        {
          review_time_step(a);
          strain(a, simple_shear(shear_step), 50);
        }
      a.deform(simple_shear(shear_step));
      EXPECT_EQ(a.cell()->flips, 0u);
      made[shear_step] = a.checkpoint();
    }
  return made[shear_step];
}
} // namespace isostat::test
