// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/files/json.hpp"
#include "coupling/element/strain_record.hpp"

#include <functional>
#include <optional>
#include <string>

namespace isostat
{
/// What is run otherwise than in the record.
struct ReplayChanges
{
  std::optional<double> tolerance, rate_floor, rate_ceiling, damping;
  std::optional<std::uint64_t> min_steps;
  bool any() const { return tolerance || rate_floor || rate_ceiling || damping || min_steps; }
  /// @throws InputError  a floor above the ceiling
  RveSettings applied_to(RveSettings settings) const;
};

/// How the stress of the packing alone compares with what the finite elements were given.
struct ReplayResult
{
  std::size_t increments = 0, equal = 0; ///< all of them; those after which all six stresses are equal to the bit
  std::uint64_t steps = 0;               ///< time steps of the packing
  double seconds = 0;
  double shear_error = 0, pressure_error = 0; ///< rms of the difference of tau_xz and p' over that of the record [-]
  double largest_error = 0;                   ///< |stress difference| / p0' [-] ...
  std::size_t largest_at = 0;                 ///< ... after this increment
  double largest_strain = 0, min_pressure = 0, min_redundancy = 1e300; ///< |gamma_xz|; Pa; I_R
};

/// Sends a packing the way of its record, alone: no mesh, no solver. Rows of history.csv and .h5 in `folder`: strain
/// and stress of the column and of the packing alone every increment, micromechanics every `every` increments (0
/// between).
/// @param tell  called after each increment with its number
/// @throws RunFailure  an increment is rejected
ReplayResult replay(const StrainRecord &record, const ReplayChanges &changes, const std::filesystem::path &folder,
                    std::size_t every, const std::function<void(std::size_t)> &tell);

std::string to_text(const ReplayResult &result, const StrainRecord &record, const ReplayChanges &changes);
Json to_json(const ReplayResult &result, const StrainRecord &record);
} // namespace isostat
