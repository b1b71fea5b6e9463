// SPDX-License-Identifier: BSD-3-Clause
#include "dem/state/packing.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

namespace isostat
{
namespace
{
double cube(double r) { return r * r * r; }
} // namespace

std::vector<double> Packing::radii() const
{
  std::vector<double> radii(n_grains());
  for (std::size_t i = 0; i < n_grains(); ++i)
    radii[i] = radius(i);
  return radii;
}

double Packing::solid_volume() const
{
  double sum = 0;
  for (const double r : radii())
    sum += cube(r);
  return 4.0 / 3.0 * std::numbers::pi * sum;
}

double Packing::min_radius() const { return std::ranges::min(radii()); }

double Packing::max_radius() const { return std::ranges::max(radii()); }

double median_by_volume(std::vector<double> sizes)
{
  double total = 0, finer = 0;
  for (const double size : sizes)
    total += cube(size);
  std::sort(sizes.begin(), sizes.end());
  for (const double size : sizes)
    if ((finer += cube(size)) >= 0.5 * total)
      return size;
  return sizes.back();
}

double Packing::d50() const { return 2 * median_by_volume(radii()); }

Packing make_packing(const std::vector<Vec3> &centres, const std::vector<double> &radii, double density)
{
  const std::size_t n = centres.size();
  Packing packing;
  packing.density = density;
  for (auto *records : {&packing.position, &packing.velocity, &packing.spin})
    records->assign(4 * (n + Packing::n_padding), 0.0);
  packing.id.resize(n);
  std::iota(packing.id.begin(), packing.id.end(), 0u);
  for (std::size_t i = 0; i < n; ++i)
    {
      const double r = radii[i];
      const double mass = 4.0 / 3.0 * std::numbers::pi * cube(r) * density;
      packing.set_centre(i, centres[i]);
      packing.position[4 * i + 3] = r;
      packing.velocity[4 * i + 3] = 1.0 / mass;
      packing.spin[4 * i + 3] = 1.0 / (0.4 * mass * r * r);
    }
  packing.position[4 * n] = 1e6; // padding: apart from everything, and from each other
  packing.position[4 * (n + 1)] = 2e6;
  return packing;
}
} // namespace isostat
