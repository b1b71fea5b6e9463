// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/ground.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
double GroundLine::at(double x) const
{
  const auto right = std::ranges::find_if(points, [x](const auto &point) { return point[0] > x; });
  if (right == points.begin() || right == points.end())
    return (right == points.begin() ? points.front() : points.back())[1];
  const auto &[x0, z0] = *(right - 1);
  const auto &[x1, z1] = *right;
  return z0 + (z1 - z0) * (x - x0) / (x1 - x0);
}

double GroundLine::highest() const
{
  double z = points.front()[1];
  for (const auto &point : points)
    z = std::max(z, point[1]);
  return z;
}

void GroundLine::check() const
{
  if (points.size() < 2)
    throw InputError(fmt::format("ground: {} point; must be at least two. Give x and z of each.", points.size()));
  for (std::size_t k = 0; k < points.size(); ++k)
    {
      if (!(points[k][1] > 0))
        throw InputError(
            fmt::format("ground: point {} is {} m above the base; must be > 0, or there is no soil", k, points[k][1]));
      if (k > 0 && !(points[k][0] > points[k - 1][0]))
        throw InputError(
            fmt::format("ground: x = {} m after {} m; must rise from point to point", points[k][0], points[k - 1][0]));
    }
}
} // namespace isostat
