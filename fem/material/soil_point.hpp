// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"

#include <limits>

namespace isostat
{
/// One Gauss point in an element test: simple shear along xz without lateral strain, at constant volume (undrained) or
/// at constant vertical stress (drained), and one-dimensional compression.
/// tested: tests/fem/material/soil_point_test.cpp
class SoilPoint
{
public:
  /// Of the path of a test: shear strain since the start, tau, sigma'_v, p' and eps_v, the last three compression
  /// positive. [-], Pa
  using Row = std::array<double, 5>;
  struct Cycles
  {
    double to_liquefaction = std::numeric_limits<double>::infinity();
    double largest_strain = 0; ///< |gamma|, also of the cycles after it
  };
  static constexpr double liquefied_ratio = 0.95, liquefied_strain = 0.03; ///< r_u, or |gamma|

  /// @param material  of one point   @param in_situ  its effective stress
  /// @throws InputError  a stress that the material cannot bear
  SoilPoint(std::unique_ptr<Material> material, const Stress &in_situ);

  const Stress &stress() const { return stress_; }                ///< tension positive, Pa
  const std::array<double, 6> &strain() const { return strain_; } ///< since the start, shear as gamma
  double shear_modulus() const;                                   ///< that of wave_moduli() now, Pa
  Row row() const;

  /// @throws RunFailure  no stress, also from all that follow
  void deform(const Gradient &increment);
  /// Shears by gamma in steps of equal duration, from end to end of a sine of 1 Hz, in half a second: what a material
  /// whose stress depends on time does in such cycles. All other tests are slow.
  /// @param path  gets a row for each step; null: not kept
  void shear(double gamma, unsigned steps, bool drained, std::vector<Row> *path = nullptr);
  /// Shears until tau, in steps of 2e-5, the last one shorter.
  /// @return false if |gamma| came to `limit` before
  bool shear_to(double tau, bool drained, double limit, std::vector<Row> *path = nullptr);
  /// One-dimensional compression or expansion to a vertical stress, compression positive, Pa.
  void compress_to(double vertical, std::vector<Row> *path = nullptr);
  /// Undrained cycles between +-tau until r_u = 1 - sigma'_v/sigma'_v0 or |gamma| counts as liquefaction, and `more`
  /// cycles after that; |gamma| = 0.2 ends them. A half cycle counts by the part of its stress, so the first quarter is
  /// 0.25.
  Cycles cyclic_shear(double tau, double max_cycles, double more = 0, std::vector<Row> *path = nullptr);

private:
  Stress tried(const Gradient &increment);
  void shear_once(double gamma, bool drained, double vertical);

  std::unique_ptr<Material> material_;
  Stress stress_;
  std::array<double, 6> strain_{};
};
} // namespace isostat
