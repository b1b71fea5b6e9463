// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/types.hpp"

#include <random>

namespace isostat::test
{
/// Numbers at random between -1 and 1, the same ones for the same seed.
struct Random
{
  explicit Random(unsigned seed = 1) : engine(seed) {}
  double operator()() { return std::uniform_real_distribution<double>(-1, 1)(engine); }
  Vec3 vector()
  {
    const double x = (*this)(), y = (*this)();
    return {x, y, (*this)()};
  }
  std::mt19937_64 engine;
};
} // namespace isostat::test
