// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/io/specimen_library.hpp"
#include "dem/rve/rve.hpp"
#include "fem/material/material.hpp"

#include <optional>

namespace isostat
{
/// The specimen's axes in a column: its x is the column's x, its vertical y the column's z, its z the column's -y. So
/// simple shear of the element tests (u_x grows with y) is the column's shear xz, number by number.
Mat3 column_frame();

/// Stress and displacement gradient as the solver and as grains have them.
Mat3 to_matrix(const Gradient &gradient);
Mat3 to_matrix(const Stress &stress);
Stress to_stress(const Mat3 &stress);

/// Which specimens of a library a point is made of.
struct SpecimenRequest
{
  /// D_r of the soil [-]; left out: the library holds one density only. The library's nearest one is taken.
  std::optional<double> relative_density;
  std::size_t realisation = 0; ///< counts the seeds that the library has of this density, rising

  bool operator==(const SpecimenRequest &) const = default;
};

/// The library entry of that density and seed with the nearest stress: smallest |ln(sigma_v/wanted)| +
/// |ln(sigma_h/wanted)|, the first by name of equals.
/// @param vertical, horizontal  wanted effective stress, compression positive, Pa
/// @throws InputError  no density within 0.05, fewer seeds, entries that do not say seed or stress: shows the library
/// tested: tests/coupling/in_situ/in_situ_test.cpp
const LibraryEntry &nearest_entry(const std::vector<LibraryEntry> &entries, const SpecimenRequest &request,
                                  double vertical, double horizontal);

/// How a specimen comes to its stress in situ.
enum class InSituPath
{
  all_stresses,     ///< all six components as wanted (K0 or isotropic)
  no_lateral_strain ///< vertical stress as wanted, sides fixed: the horizontal stress is what this packing gives
};

struct InSituSettings
{
  InSituPath path = InSituPath::all_stresses;
  double tolerance = 1e-3;           ///< |stress - wanted| / p' at the end, of all that is controlled [-]
  double min_pressure = 500;         ///< p' below which no packing is asked to go, Pa
  std::uint64_t max_steps = 500'000; ///< of one of the steps in which the stress is changed (factor 2 at most)

  bool operator==(const InSituSettings &) const = default;
};

/// A specimen at a stress in situ, in its own axes. Goes there by the element's mixed control in steps of stress of a
/// factor 2 at most, geometric in normal stresses, until no stress moves by more than twice the tolerance in 2,000
/// time steps without strain: a packing at a few kPa has soft modes that need so many.
/// @param wanted  Cauchy effective stress in the specimen's axes (y vertical), Pa, tension positive
/// @param motion  of the grains on their way
/// @throws InputError  not compressive, p' < min_pressure    @throws RunFailure  not reached: says how near it came
/// @return the packed element (Rve::pack)     cost of the order of 10,000 time steps; deterministic
/// tested: tests/coupling/in_situ/in_situ_test.cpp
std::vector<std::byte> bring_to_stress(const Snapshot &specimen, const Mat3 &wanted, const MotionSpec &motion,
                                       const InSituSettings &settings);

/// The specimen in a packed element, in its own axes.
Snapshot specimen_of(std::span<const std::byte> packed);

/// All that the result depends on, as text: hash of the specimen (law, cell, grains, contacts to the bit), stress,
/// settings.
std::string in_situ_recipe(const Snapshot &specimen, const Mat3 &wanted, const MotionSpec &motion,
                           const InSituSettings &settings);
} // namespace isostat
