// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "coupling/batch/rve_material.hpp"
#include "dem/io/specimen_library.hpp"
#include "tests/support/periodic.hpp"

namespace isostat::test
{
/// Soft enough for few time steps.
inline CellRecipe soft_recipe(std::uint64_t seed, double pressure)
{
  CellRecipe recipe;
  recipe.grading = small_grading(200);
  recipe.grading.seed = seed;
  recipe.law->young = 5e8;
  recipe.pressure = pressure;
  return recipe;
}

inline const Snapshot &soft_specimen(std::uint64_t seed, double pressure = 100e3)
{
  return prepare_in_cell(soft_recipe(seed, pressure));
}

/// Four packings, at two seeds and two pressures.
inline void write_library(const std::filesystem::path &path)
{
  LibraryWriter writer = LibraryWriter::create(path);
  for (std::uint64_t seed : {4, 9})
    for (double pressure : {50e3, 100e3})
      {
        Specimen specimen;
        specimen.state = soft_specimen(seed, pressure);
        specimen.numbers = {{"seed", seed}, {"relative_density", 0.5}, {"vertical_stress_Pa", pressure}, {"K0", 1.0}};
        writer.add(writer.next_name(), specimen);
      }
  writer.commit();
}

/// Shear in two planes and vertical strain of a column, no two alike.
inline std::vector<Gradient> column_increments(std::size_t n_points, int step, double size = 2e-5)
{
  std::vector<Gradient> increments(n_points, Gradient{});
  for (std::size_t i = 0; i < n_points; ++i)
    {
      const double phase = 0.9 * step + 1.3 * static_cast<double>(i);
      increments[i][2] = size * std::sin(phase);
      increments[i][5] = size * std::sin(1.7 * phase + 1);
      increments[i][8] = 0.3 * size * std::sin(0.6 * phase + 2);
    }
  return increments;
}

/// Stress in situ, isotropic or not. Pa, compression positive
inline Stress in_situ(double vertical, double k0) { return {-k0 * vertical, -k0 * vertical, -vertical, 0, 0, 0}; }
} // namespace isostat::test
