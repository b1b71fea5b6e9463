// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/balance.hpp"

#include <algorithm>
#include <cmath>

namespace isostat
{
namespace
{
constexpr double least_load = 1e-3; ///< of the mean contact force

/// Largest contact force on each grain, 0: it touches nothing.   @param mean  of all contacts
std::vector<double> largest_forces(const LiveContacts &contacts, double &mean)
{
  std::vector<double> largest(contacts.packing.n_grains(), 0.0);
  double sum = 0;
  std::size_t n = 0;
  contacts.for_pairs([&](std::uint32_t i, std::uint32_t j, const Vec3 &, const Vec3 &force) {
    const double f = force.norm();
    largest[i] = std::max(largest[i], f);
    largest[j] = std::max(largest[j], f);
    sum += f;
    ++n;
  });
  contacts.for_walls([&](std::uint32_t i, int, double, double fn) {
    largest[i] = std::max(largest[i], fn);
    sum += fn;
    ++n;
  });
  mean = n > 0 ? sum / static_cast<double>(n) : 0;
  return largest;
}
} // namespace

Balance balance(const LiveContacts &contacts, const double *action, double left_out, double no_force)
{
  double mean = 0;
  const std::vector<double> largest = largest_forces(contacts, mean);
  Balance found;
  std::vector<double> imbalance;
  for (std::size_t i = 0; i < largest.size(); ++i)
    if (largest[i] > 0)
      {
        const double residual =
            std::max(Vec3(action + 8 * i).norm(), Vec3(action + 8 * i + 4).norm() / contacts.packing.radius(i));
        imbalance.push_back(residual / std::max({largest[i], least_load * mean, no_force}));
        if (imbalance.back() > found.worst)
          found.worst = imbalance.back(), found.grain = contacts.packing.id[i];
      }
  found.loaded = imbalance.size();
  if (imbalance.empty())
    return found;
  const auto nth = imbalance.end() - 1 - static_cast<std::ptrdiff_t>(left_out * static_cast<double>(imbalance.size()));
  std::nth_element(imbalance.begin(), nth, imbalance.end());
  found.within = *nth;
  return found;
}
} // namespace isostat
