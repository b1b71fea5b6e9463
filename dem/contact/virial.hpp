// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/types.hpp"

#include <cmath>

namespace isostat
{
/// Sum of F b over the contacts of a periodic cell (F the force on the second grain, b the branch vector), symmetric
/// part, from which Love-Weber stress follows as -sum/V, and whose bits depend neither on the number of lanes or
/// chunks nor on pairs in the list that do not touch.
///
/// Every partial sum starts from C = 1.5 2^k, which is larger than any sum can get: each term is thereby rounded to the
/// same grid of 2^(k-52), and sums of grid points are exact in any order. (A product that is rounded before it is added
/// can lie halfway between two grid points; the loop then rounds it by itself, see add_virial().) With 2^k >= E V the
/// grid is 2e-16 E V: with E = 10 GPa a contact adds its share of stress to 2e-6 Pa.
/// tested: tests/dem/contact/virial_test.cpp
class Virial
{
public:
  static constexpr std::size_t numbers = 48; ///< xx, yy, zz, yz + zy, xz + zx, xy + yx, 8 lanes each

  /// Starts the sums of all chunks.   @param bound  J, above any sum of F b: young times volume
  void start(std::size_t n_chunks, double bound)
  {
    start_ = 1.5 * std::exp2(std::ceil(std::log2(bound)));
    sums_.assign(numbers * n_chunks, start_);
  }
  /// Takes a sum as it is.
  void set(const Mat3 &sum)
  {
    start_ = 0;
    sums_.assign(numbers, 0.0);
    const double six[] = {sum(0, 0), sum(1, 1), sum(2, 2), sum(1, 2), sum(0, 2), sum(0, 1)};
    for (int c = 0; c < 6; ++c)
      sums_[8 * c] = c < 3 ? six[c] : 2 * six[c];
  }
  /// What sums start from: rounds a number to the grid when it is added and taken off again.
  double grid() const { return start_; }
  double *data(std::size_t chunk) { return sums_.data() + numbers * chunk; }

  /// Symmetric part of the sum of F b, J.
  Mat3 sum() const
  {
    double total[6] = {};
    for (std::size_t at = 0; at < sums_.size(); ++at)
      total[at / 8 % 6] += sums_[at] - start_;
    for (int c = 3; c < 6; ++c)
      total[c] *= 0.5;
    Mat3 m;
    m << total[0], total[5], total[4], total[5], total[1], total[3], total[4], total[3], total[2];
    return m;
  }

private:
  double start_ = 0;
  AlignedVector<double> sums_;
};
} // namespace isostat
