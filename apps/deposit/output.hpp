// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/instant.hpp"
#include "base/record/series_file.hpp"
#include "fem/space/column_line.hpp"

#include <array>
#include <filesystem>
#include <span>

namespace isostat
{
/// What a point shows in tables: compression positive except for the shear pairs, which keep the sign they have in the
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

/// A column for ParaView: displacement and velocity, and means over each element of what point_columns name. Lies
/// along z in any dimension.
/// @param vertical_stress  sigma'_v0 of every point, Pa   @pre the mesh is not shared out
/// @throws RunFailure  the file cannot be written
/// tested: tests/apps/soil_column_test.py
void write_column_vtu(const std::filesystem::path &path, const FiniteElementSpace &space, const ColumnInstant &instant,
                      std::span<const double> vertical_stress);

/// One coordinate of all places, m.
std::vector<double> along(int axis, const std::vector<Place> &places);

/// What profiles.h5 and maps.h5 hold of some points: of the start `depth` (m), `sigma_v0` (Pa) and `shear_velocity`
/// (m/s), and over time all of point_columns.
SeriesLayout profile_layout(std::vector<double> depths, std::vector<double> sigma_v0,
                            std::vector<double> shear_velocity);

/// p' of an effective stress, compression positive, Pa.
inline double mean_effective(const Stress &stress) { return -(stress[0] + stress[1] + stress[2]) / 3; }
} // namespace isostat
