// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "coupling/batch/wave_moduli_cache.hpp"
#include "coupling/element/rve_element.hpp"
#include "coupling/in_situ/in_situ.hpp"
#include "coupling/placement/placement.hpp"

#include <string>

namespace isostat
{
/// How a material of grains is run. What users choose of it has its keys in coupling/scene/packings.hpp.
/// tested: tests/coupling/batch/rve_material_test.cpp
struct RveMaterialSettings
{
  std::string library; ///< specimens of the sand, made by isostat library; points may have others
  std::string sand;    ///< whose name all specimens must bear; empty: any
  std::string cache;   ///< in-situ states, kept for the next start; empty: none are kept
  InSituSettings in_situ;
  MotionSpec motion = controlled_motion();
  StaticDrive drive;            ///< if on, increments are taken to balance, and of `motion` only the time step counts
  bool undrained = true;        ///< volume strain is stripped (Rve::undrained); false: it is live
  std::size_t realisations = 1; ///< elements of a point; its stress is their mean
  std::uint64_t min_steps = 20; ///< time steps that an increment takes at least, see RveSettings
  unsigned halvings = 6;        ///< a rejected increment is taken in up to 2^halvings parts
  int threads = 1;              ///< that share the elements of a rank; 0: as many as the process may use
  BalanceRule balance;          ///< between ranks
  RefreshRule refresh;          ///< of wave moduli

  void check() const; ///< @throws InputError
  /// Of every element: the specimen's axes are those of column_frame().
  ElementSettings element() const;

  bool operator==(const RveMaterialSettings &) const = default;
};
} // namespace isostat
