// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/record/recorder.hpp"
#include "coupling/element/rve_element.hpp"
#include "fem/material/material.hpp"

#include <filesystem>

namespace isostat
{
/// Strain history of one element at its Gauss point, and what is needed to repeat it with the element alone.
/// In a folder: packing.h5 (its initial state, and how it is run), and history.csv and .h5 (a row for each increment).
/// tested: tests/coupling/element/strain_record_test.cpp, tests/apps/grain_column_test.py
struct StrainRecord
{
  double depth = 0;               ///< of the point below the surface, m
  std::vector<std::byte> packing; ///< Rve::pack() before the first increment
  ElementSettings settings;       ///< how it was run

  std::vector<double> time;         ///< at the end of each increment, s
  std::vector<Gradient> increments; ///< of the displacement gradient, row by row
  std::vector<Stress> stresses;     ///< effective stress after it, Pa, tension positive: xx yy zz yz xz xy
};

/// Columns of history.csv: step, time, H_xx ... H_zz, sigma_xx, sigma_yy, sigma_zz, sigma_yz, sigma_xz, sigma_xy, and
/// the time steps that the packing took.
std::vector<RecordColumn> strain_record_columns();
std::vector<double> strain_record_row(std::uint64_t step, double time, const Gradient &h, const Stress &stress,
                                      double steps_of_packing);

/// Writes packing.h5.     @throws RunFailure  not writable
void write_strain_record_start(const std::filesystem::path &folder, const StrainRecord &record);

/// @throws InputError  a file is missing, damaged or of another version
StrainRecord read_strain_record(const std::filesystem::path &folder);
} // namespace isostat
