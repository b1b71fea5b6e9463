// SPDX-License-Identifier: BSD-3-Clause
#include "fem/motion/low_pass.hpp"

#include <cmath>
#include <numbers>

namespace isostat
{
LowPass::LowPass(double corner, double interval)
{
  if (!(corner * interval < 0.25))
    return;
  const double k = std::tan(std::numbers::pi * corner * interval);
  for (std::size_t i = 0; i < sections_.size(); ++i)
    {
      const double angle = (2.0 * static_cast<double>(i) + 1) * std::numbers::pi / 8, damp = 2 * k * std::cos(angle),
                   norm = 1 / (1 + damp + k * k);
      sections_[i].b0 = sections_[i].b2 = k * k * norm;
      sections_[i].b1 = 2 * k * k * norm;
      sections_[i].a1 = 2 * (k * k - 1) * norm;
      sections_[i].a2 = (1 - damp + k * k) * norm;
    }
}
} // namespace isostat
