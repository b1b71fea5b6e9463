// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cmath>

namespace isostat
{
/// Butterworth's low-pass filter of fourth order by the bilinear transformation, causal: gain 1/sqrt(1 + (f/f_c)^8),
/// exact at f_c. Two second-order sections with four numbers of state. A corner above a quarter of the samples in a
/// second passes all.   tested: tests/fem/motion/low_pass_test.cpp
class LowPass
{
public:
  LowPass() = default; ///< passes all
  /// @param corner  f_c, Hz   @param interval  between samples, s
  LowPass(double corner, double interval);

  double operator()(double x)
  {
    for (Section &s : sections_) // transposed direct form II
      {
        const double y = s.b0 * x + s.one;
        s.one = at_rest(s.b1 * x - s.a1 * y + s.two);
        s.two = at_rest(s.b2 * x - s.a2 * y);
        x = y;
      }
    return x;
  }

  /// Visits its state.
  template <class Self, class Visit>
  static void for_each_field(Self &self, const Visit &visit)
  {
    for (auto &s : self.sections_)
      visit(s.one), visit(s.two);
  }

private:
  struct Section
  {
    double b0 = 1, b1 = 0, b2 = 0, a1 = 0, a2 = 0; ///< y = (b0 + b1 z^-1 + b2 z^-2)/(1 + a1 z^-1 + a2 z^-2) x
    double one = 0, two = 0;
  };
  /// Numbers that underflow are slow.
  static double at_rest(double x) { return std::abs(x) < 1e-150 ? 0 : x; }

  std::array<Section, 2> sections_;
};
} // namespace isostat
