// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/instant.hpp"
#include "base/files/hdf5.hpp"
#include "fem/space/column_line.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace isostat
{
/// What a point shows in tables: compression positive but for the shear pairs, which keep the sign they have in the
/// soil (gamma_xz drives tau_xz).
inline constexpr std::array<std::pair<const char *, const char *>, 9> point_columns = {{{"gamma_xz", "-"},
                                                                                        {"gamma_yz", "-"},
                                                                                        {"eps_zz", "-"},
                                                                                        {"tau_xz", "Pa"},
                                                                                        {"tau_yz", "Pa"},
                                                                                        {"sigma_v", "Pa"},
                                                                                        {"p", "Pa"},
                                                                                        {"u", "Pa"},
                                                                                        {"ru", "-"}}};
using PointValues = std::array<double, point_columns.size()>;

/// The values of point q.   @param vertical_stress  sigma'_v0 of every point, Pa
PointValues point_values(const ColumnInstant &instant, std::size_t q, std::span<const double> vertical_stress);

/// Those of some points: all points of the first quantity, then of the second ...
std::vector<double> columns_at(const ColumnInstant &instant, std::span<const std::size_t> points,
                               std::span<const double> vertical_stress);

/// A column for ParaView: displacement and velocity at the nodes, means over each element of excess pore pressure,
/// r_u, shear strain and effective stress (compression positive; Pa, [-]). Lies along z in any dimension. No date in
/// it: the same state is the same bytes.
/// @param vertical_stress  sigma'_v0 of every point, Pa   @pre the mesh is not shared out
/// @throws RunFailure  the file cannot be written
/// tested: tests/apps/soil_column_test.py
template <int dim>
void write_column_vtu(const std::filesystem::path &path, const Discretisation<dim> &space, const ColumnInstant &instant,
                      std::span<const double> vertical_stress);

/// Profiles over the depth at instants, in profiles.h5: datasets `depth` (m), of the start `sigma_v0` (Pa) and
/// `shear_velocity` (m/s), series `time` (n) and, n x m each, gamma_xz, gamma_yz, eps_zz (-), tau_xz, tau_yz, sigma_v,
/// p, u (Pa), ru (-), as in the history, and `further` ones; at the end of the run what add() is given. Written aside
/// and renamed; rows wait in memory until flush() or until they outnumber a quarter of those written.
/// @throws RunFailure  cannot be written
/// tested: tests/apps/soil_column_test.py
class ProfileFile
{
public:
  /// A quantity that has so many values at each instant.
  struct Series
  {
    std::string name, unit;
    std::size_t width;
  };
  /// One that does not change.
  struct Constant
  {
    std::string name, unit;
    std::vector<double> values;
  };
  struct Further
  {
    std::vector<Series> series;
    std::vector<Constant> constants;
  };
  /// @param resume_rows  rows of an existing file that are kept; InputError if it has fewer, or other depths
  ProfileFile(std::filesystem::path path, std::vector<double> depths, std::span<const double> sigma_v0,
              std::span<const double> shear_velocity, std::size_t resume_rows = 0, const Further &further = {});

  /// @param values  all depths of the first quantity, then of the second ..., then further series
  void append(double time, std::span<const double> values);
  void flush();
  /// What has one value for each depth, once, at the end.
  void add(const char *name, std::span<const double> values, const char *unit);
  std::size_t n_rows() const { return n_rows_; }

private:
  void load(std::size_t rows);
  void append_waiting(hdf5::Group root) const;
  void forget_waiting();

  std::filesystem::path path_;
  std::vector<double> depths_;
  std::size_t n_rows_ = 0, n_written_ = 0;
  std::vector<Series> series_;
  std::vector<double> times_;
  std::vector<std::vector<double>> waiting_; ///< of each series
};

/// p' of an effective stress, compression positive, Pa.
inline double mean_effective(const Stress &stress) { return -(stress[0] + stress[1] + stress[2]) / 3; }
} // namespace isostat
