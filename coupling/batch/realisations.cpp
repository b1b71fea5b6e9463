// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/batch/realisations.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
void add(Stress &sum, const Stress &x)
{
  for (std::size_t c = 0; c < sum.size(); ++c)
    sum[c] += x[c];
}
void divide(Stress &sum, double n)
{
  for (double &x : sum)
    x /= n;
}

void add(Stiffness &sum, const Stiffness &x) { sum += x; }
void divide(Stiffness &sum, double n) { sum /= n; }

void add(WaveModuli &sum, const WaveModuli &x) { sum.p += x.p, sum.s += x.s; }
void divide(WaveModuli &sum, double n) { sum.p /= n, sum.s /= n; }

template <typename T>
void mean_of(const Realisations &points, std::span<const T> of_elements, std::span<T> of_points)
{
  for (std::size_t point = 0; point < points.n_points; ++point)
    {
      T &sum = of_points[point] = of_elements[points.id_of(point, 0)];
      for (std::size_t k = 1; k < points.per_point; ++k)
        add(sum, of_elements[points.id_of(point, k)]);
      divide(sum, static_cast<double>(points.per_point));
    }
}
} // namespace

std::string Realisations::label(std::size_t id) const
{
  const std::size_t point = point_of(id);
  const std::string name = names.empty() ? fmt::format("point {}", point) : names[point];
  return "rve: " + name + (per_point == 1 ? "" : fmt::format(", realisation {}", id % per_point));
}

void Realisations::mean(std::span<const Stress> of_elements, std::span<Stress> of_points) const
{
  mean_of(*this, of_elements, of_points);
}

void Realisations::mean(std::span<const Stiffness> of_elements, std::span<Stiffness> of_points) const
{
  mean_of(*this, of_elements, of_points);
}

void Realisations::mean(std::span<const WaveModuli> of_elements, std::span<WaveModuli> of_points) const
{
  mean_of(*this, of_elements, of_points);
}

void Realisations::deviation(std::span<const Stress> of_elements, std::span<Stress> of_points) const
{
  std::vector<Stress> means(n_points);
  mean(of_elements, means);
  for (std::size_t point = 0; point < n_points; ++point)
    for (std::size_t c = 0; c < means[point].size(); ++c)
      {
        double sum = 0;
        for (std::size_t k = 0; k < per_point; ++k)
          sum += std::pow(of_elements[id_of(point, k)][c] - means[point][c], 2);
        of_points[point][c] = per_point > 1 ? std::sqrt(sum / static_cast<double>(per_point - 1)) : 0;
      }
}
} // namespace isostat
