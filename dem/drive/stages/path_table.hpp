// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace isostat
{
/// What a path may prescribe: stresses (Pa), the mean effective stress, and strains since the start of the stage;
/// compression positive, shear as gamma_xy and tau = sigma_xy are.
enum class PathQuantity
{
  sigma_x,
  sigma_y,
  sigma_z,
  tau,
  p,
  strain_x,
  strain_y,
  strain_z,
  gamma
};
inline constexpr std::size_t n_path_quantities = 9;

constexpr bool is_strain(PathQuantity quantity) { return quantity >= PathQuantity::strain_x; }
/// A normal stress or their mean, which grains without cohesion bear in compression alone.
constexpr bool is_compression(PathQuantity quantity) { return !is_strain(quantity) && quantity != PathQuantity::tau; }
const char *name_of(PathQuantity quantity); ///< "stress_x", "mean_stress", "gamma": a column without its unit

/// A path through stress and strain: straight lines between knots. Knot 0 is where the specimen is when the stage
/// begins, at 0; the knots here follow it.
struct PathTable
{
  bool by_time = false;   ///< knots are at times (s) since the start of the stage; else their distance has no meaning
                          ///< beyond their order, and the rate control says how fast they are passed
  std::vector<double> at; ///< rising, above 0
  std::array<std::vector<double>, n_path_quantities> columns; ///< as many values as knots, or none: not prescribed

  bool prescribes(PathQuantity q) const { return !columns[static_cast<std::size_t>(q)].empty(); }
  /// Value at a place, between knot 0 with the value `start` and the last one; beyond it that of the last.
  double value(PathQuantity q, double place, double start) const;
  /// Of all knots and values: a resumed run must continue along the same path.
  std::uint64_t hash() const;

  bool operator==(const PathTable &) const = default;
};

/// From a CSV file: first `time (s)` or `step (-)`, then any of `stress_x (kPa)`, `stress_y`, `stress_z`, `tau`,
/// `mean_stress` (in Pa, kPa or MPa), `strain_x (-)`, `strain_y`, `strain_z`, `gamma` (- or %).
/// @throws InputError  with file:line: another column, a quantity twice, a place that does not rise, no rows
/// tested: tests/dem/drive/stages/path_table_test.cpp
PathTable read_path_table(const std::filesystem::path &file);
} // namespace isostat
