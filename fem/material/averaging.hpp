// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace isostat
{
/// Weighted means over the points of a body: (W x)_q = sum_r W_qr x_r, docs/theory_column.md (18b).
///
///     W_qr = s_q k(|x_q - x_r|) s_r w_r         k(d) = exp(-d^2 / (2 l^2)), 0 beyond 4 l
///
/// w are the volumes of the points. The factors s are such that each row sums to 1 (symmetric balancing, Sinkhorn &
/// Knopp 1967), so that a uniform field stays what it is, also near boundaries, and w_q W_qr = w_r W_rq: the transpose
/// of W with respect to volumes is W itself, which likewise leaves uniform stress as it is and keeps sums of w x. Far
/// from boundaries l is the standard deviation of the weights along each axis.
/// tested: tests/fem/material/averaging_test.cpp
class Averaging
{
public:
  /// @param length  l, m; 0: every point is its own mean
  /// @param positions, volumes  of the points, m and m3 (any unit)
  /// @throws InputError  a length below 0, volumes that are not above 0, other numbers of positions than of volumes
  /// Cost: of the order of the pairs that are nearer than 4 l, 12 bytes each.
  Averaging(double length, std::span<const std::array<double, 3>> positions, std::span<const double> volumes);

  std::size_t n_points() const { return first_.size() - 1; }
  /// Means of `width` numbers at each point, which lie side by side. The sum is over differences, x_q + sum_r W_qr (x_r
  /// - x_q), so that uniform fields stay bit for bit.   @pre in and out do not overlap   Cost: in the loop.
  void apply(std::span<const double> in, std::span<double> out, std::size_t width) const;
  /// The same for arrays of numbers.
  template <std::size_t width>
  void apply(std::span<const std::array<double, width>> in, std::span<std::array<double, width>> out) const
  {
    if (!in.empty())
      apply({in[0].data(), width * in.size()}, {out[0].data(), width * out.size()}, width);
  }

private:
  void find_pairs(double reach, std::span<const std::array<double, 3>> positions, double length);
  void balance(std::span<const double> volumes);

  std::vector<std::size_t> first_; ///< of a point in the rows below; one more than points
  std::vector<unsigned> other_;    ///< r of each pair, rising
  std::vector<double> weight_;     ///< W_qr; of a point with itself it never counts
};
} // namespace isostat
