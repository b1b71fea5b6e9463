// SPDX-License-Identifier: BSD-3-Clause
// What the members of an ensemble give together.
#pragma once
#include "apps/soil_column/ensemble.hpp"

#include <map>
#include <span>

namespace isostat
{
/// r_u from which soil counts as liquefied here.
constexpr double liquefied_ru = 0.95;

/// Values from which there are bands: of two, 16 and 84 % would be the two drawn together.
constexpr std::size_t fewest_for_band = 3;

/// A number of a member, or the values of a curve.
struct Measured
{
  std::string name, unit;
  std::vector<double> values;
};

/// Curves over the same abscissa, the same for all members.
struct Curves
{
  Measured over;
  std::vector<Measured> curves;
};

/// What a member left.
struct MemberResults
{
  std::string name, record;
  std::size_t packings = 0;
  std::string same_as;                         ///< an earlier member with the same record and packings; empty: none
  std::vector<std::vector<std::size_t>> seeds; ///< of every point, rising; empty: they are not drawn by lot
  std::vector<Measured> numbers;               ///< one value each; nan: the member has none
  std::map<std::string, Curves> curves;        ///< points, nodes, grains, spectra, history
};

/// Of a sample without its nan. Percentiles lie on straight lines between the ordered values, the first of which is at
/// 0 % and the last at 100 %; those of 16 and 84 % are nan for less than `fewest_for_band` values. The standard error
/// is that of the mean, s / sqrt(n) with n - 1 in s, nan for one value.
struct Statistics
{
  std::size_t n = 0;
  double mean = 0, standard_error = 0, low = 0, median = 0, high = 0; ///< low and high: 16 and 84 %
  double minimum = 0, maximum = 0;

  explicit Statistics(std::vector<double> sample);
};

/// Thickness of the soil whose r_u exceeded `liquefied_ru`, m: each point stands for the soil that is nearer to it than
/// to any other.   @param depths  rising, m   @param height  of the column, m
double liquefied_thickness(std::span<const double> depths, std::span<const double> max_ru, double height);

/// Reads the files of a member that has finished.   @throws InputError  they are damaged
MemberResults read_member(const EnsembleMember &member, const std::filesystem::path &folder);

/// Finds members whose points have the same packings, in whatever order at a point, as those of an earlier member with
/// the same record: lots of few seeds at few points come twice. They are one sample.
/// tested: tests/apps/column_ensemble_test.py
void find_same_packings(std::vector<MemberResults> &members);

/// Leaves members.csv (a row for each member), bands_points.csv, bands_nodes.csv, bands_grains.csv, bands_spectra.csv,
/// bands_history.csv (mean and percentiles of each curve) and ensemble.json (statistics of each number) of
/// the members that differ from those before; read by apps/figures/column_ensemble.py.   @return the summary
/// tested: tests/apps/column_ensemble_test.py
std::string write_ensemble(const std::filesystem::path &folder, const ColumnScene &scene,
                           const std::vector<MemberResults> &members, std::size_t n_asked,
                           const std::map<std::string, std::string> &failures);
} // namespace isostat
