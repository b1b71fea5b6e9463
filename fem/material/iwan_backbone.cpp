// SPDX-License-Identifier: BSD-3-Clause
// The backbone and the loops of a table: fem/material/iwan_curve.hpp.
#include "base/error.hpp"
#include "fem/material/iwan_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double last_strain = 0.01, strength_share = 0.9; // of followed_strain()

/// G/G_max that tends to 1 below the table.
double reduction_at(const SoilCurve &curve, double strain)
{
  const double first = curve.strains.front();
  return strain < first ? 1 - (1 - curve.reduction.front()) * strain / first : curve.reduction_at(strain);
}

struct Polygon
{
  std::vector<double> x, f; ///< gamma/gamma_r, tau/tau_max
};

/// The smallest concave curve above it, at the same places.
void make_concave(Polygon &p)
{
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < p.x.size(); ++k)
    {
      const auto is_below = [&] { // the last one kept, the line from the one before it to this one
        const std::size_t a = kept[kept.size() - 2], b = kept.back();
        return (p.f[b] - p.f[a]) * (p.x[k] - p.x[a]) <= (p.f[k] - p.f[a]) * (p.x[b] - p.x[a]);
      };
      while (kept.size() > 1 && is_below())
        kept.pop_back();
      kept.push_back(k);
    }
  for (std::size_t j = 0; j + 1 < kept.size(); ++j)
    for (std::size_t a = kept[j], b = kept[j + 1], k = a + 1; k < b; ++k)
      p.f[k] = std::lerp(p.f[a], p.f[b], (p.x[k] - p.x[a]) / (p.x[b] - p.x[a]));
}

/// A hundred points a decade, from a thousandth of the table's first strain to a strain of 1.
Polygon backbone_of(const SoilCurve &curve, double reference_strain)
{
  const double followed = followed_strain(curve, reference_strain), first = 1e-3 * curve.strains.front();
  const auto of_table = [&](double strain) { return strain / reference_strain * reduction_at(curve, strain); };
  const double y = of_table(followed), step = 1e-3 * followed,
               slope = std::max(0.0, (y - of_table(followed - step)) / step), left = 1 - y;
  Polygon p;
  const int n = static_cast<int>(std::ceil(-100 * std::log10(first)));
  for (int k = 0; k <= n; ++k)
    {
      const double strain = std::pow(first, 1 - static_cast<double>(k) / n), u = slope * (strain - followed) / left;
      p.x.push_back(strain / reference_strain);
      p.f.push_back(strain <= followed ? of_table(strain) : y + left * u / (1 + u));
    }
  p.f.back() = 1;
  make_concave(p);
  return p;
}

/// Nodes of straight pieces through (1 + error) f, between which f is at most (1 + error) above them: from where that
/// is x to where it is 1.
std::vector<std::size_t> nodes_of(const Polygon &p, double error)
{
  std::size_t a = 0, last = 1;
  while (a + 1 < p.x.size() && (1 + error) * p.f[a + 1] >= p.x[a + 1])
    ++a;
  while (last + 1 < p.x.size() && (1 + error) * p.f[last] < 1)
    ++last;
  const auto fits = [&](std::size_t b) {
    for (std::size_t k = a + 1; k < b; ++k)
      if (const double chord = std::lerp(p.f[a], p.f[b], (p.x[k] - p.x[a]) / (p.x[b] - p.x[a]));
          (1 + error) * chord < (1 - error) * p.f[k])
        return false;
    return true;
  };
  std::vector<std::size_t> nodes{a};
  while (a < last)
    {
      std::size_t b = a + 1;
      while (b < last && fits(b + 1))
        ++b;
      nodes.push_back(a = b);
    }
  return nodes;
}

/// p1 and p2 of the weighted least squares of (p1 - p2 s) m - d, by the normal equations; p2 = 0 where s is one number.
std::array<double, 2> weighted_fit(const std::vector<double> &m, const std::vector<double> &s,
                                   const std::vector<double> &d, const std::vector<double> &weights)
{
  double aa = 1e-30, ab = 0, bb = 0, ac = 0, bc = 0;
  for (std::size_t k = 0; k < m.size(); ++k)
    {
      const double a = m[k], b = -m[k] * s[k], w = weights[k];
      aa += w * a * a, ab += w * a * b, bb += w * b * b, ac += w * a * d[k], bc += w * b * d[k];
    }
  const double determinant = aa * bb - ab * ab;
  if (!(determinant > 1e-12 * aa * bb))
    return {ac / aa, 0};
  return {(ac * bb - bc * ab) / determinant, (bc * aa - ac * ab) / determinant};
}
} // namespace

double stress_ratio(const Backbone &b, double x)
{
  double sum = 0;
  for (std::size_t k = 0; k < b.weights.size(); ++k)
    sum += b.weights[k] * std::min(x, b.yield_strains[k]);
  return sum;
}

/// Each element's parallelogram is 4 w x_k (x - x_k); D is the sum over 2 pi x tau.
double masing_damping(const Backbone &b, double x)
{
  double area = 0;
  for (std::size_t k = 0; k < b.weights.size(); ++k)
    area += 4 * b.weights[k] * b.yield_strains[k] * std::max(0.0, x - b.yield_strains[k]);
  return area / (2 * std::numbers::pi * x * stress_ratio(b, x));
}

double followed_strain(const SoilCurve &curve, double reference_strain)
{
  const double first = curve.strains.front(), last = std::min(last_strain, curve.strains.back());
  double strain = first, stress = 0;
  for (double next = first; next < last * (1 + 1e-9); next *= 1.01)
    {
      const double higher = next * reduction_at(curve, next);
      if (higher <= stress || higher > strength_share * reference_strain)
        break;
      strain = next, stress = higher;
    }
  return strain;
}

Backbone fit_curve(const SoilCurve &curve, double reference_strain, unsigned elements)
{
  if (elements < 4 || elements > 128)
    throw InputError("iwan: elements = " + std::to_string(elements) + "; must be 4 to 128");
  const Polygon p = backbone_of(curve, reference_strain);
  double low = 0, high = 1; // error that needs too many elements, and one that does not
  for (int k = 0; k < 40; ++k)
    (nodes_of(p, (low + high) / 2).size() > elements ? low : high) = (low + high) / 2;
  const std::vector<std::size_t> nodes = nodes_of(p, high);
  Backbone b;
  const auto stress = [&](std::size_t j) {
    return j == 0 ? p.x[nodes[0]] : j + 1 == nodes.size() ? 1.0 : (1 + high) * p.f[nodes[j]];
  };
  const auto slope = [&](std::size_t j) { // of the piece that ends at a node
    return j == 0 ? 1.0 : j < nodes.size() ? (stress(j) - stress(j - 1)) / (p.x[nodes[j]] - p.x[nodes[j - 1]]) : 0.0;
  };
  for (std::size_t j = 0; j < nodes.size(); ++j)
    {
      b.weights.push_back(slope(j) - slope(j + 1));
      b.yield_strains.push_back(p.x[nodes[j]]);
    }
  return b;
}

double LoopReduction::factor(double secant_ratio) const
{
  return std::clamp(p1 - p2 * std::pow(std::max(0.0, 1 - secant_ratio), p3), 0.0, 1.0);
}

LoopReduction fit_loop_reduction(const SoilCurve &curve, const Backbone &backbone, double reference_strain)
{
  std::vector<double> masing, wanted, softening;
  const double last = std::min(last_strain, curve.strains.back());
  for (double strain = curve.strains.front(); strain < last * (1 + 1e-9); strain *= std::pow(10.0, 0.05))
    {
      const double x = strain / reference_strain;
      masing.push_back(masing_damping(backbone, x));
      wanted.push_back(std::max(0.0, curve.damping_at(strain) - curve.damping.front()));
      softening.push_back(std::max(0.0, 1 - stress_ratio(backbone, x) / x));
    }
  LoopReduction best;
  double least = std::numeric_limits<double>::infinity();
  for (double p3 = 0.1; p3 < 20; p3 *= 1.1)
    {
      std::vector<double> weights(masing.size(), 1.0), powers;
      for (double s : softening)
        powers.push_back(std::pow(s, p3));
      for (int pass = 0; pass < 30; ++pass)
        {
          const auto [p1, p2] = weighted_fit(masing, powers, wanted, weights);
          double largest = 0;
          for (std::size_t k = 0; k < masing.size(); ++k)
            {
              const double error = std::abs(std::clamp(p1 - p2 * powers[k], 0.0, 1.0) * masing[k] - wanted[k]);
              weights[k] *= error + 1e-6;
              largest = std::max(largest, error);
            }
          for (const double most = *std::ranges::max_element(weights); double &weight : weights)
            weight /= most;
          if (largest < least)
            least = largest, best = {p1, p2, p3};
        }
    }
  return best;
}
} // namespace isostat
