// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/domain/periodic_cell.hpp"
#include "dem/state/contact_list.hpp"

namespace isostat
{
/// Bytes in use.
struct MemoryUse
{
  std::size_t state;   ///< what the next step depends on: grains, and pair and history of closed contacts
  std::size_t working; ///< the rest: pairs that are only near, slots, forces, positions the lists were made from
};

/// What the next step of a periodic assembly depends on, besides sizes, masses and law: 15 numbers a grain, 12 and a
/// pair of indices for each closed contact.
/// tested: tests/dem/rve/rve_test.cpp
struct AssemblyState
{
  std::vector<double> grains; ///< x (3), v (3), spin (3), force (3), torque (3) of each grain; SI
  std::vector<ContactList::Pair> pairs;
  std::vector<double> history; ///< n', fs, [mb], [mt] of each pair
  PeriodicCell cell;
  Mat3 virial = Mat3::Zero(); ///< sum of F b, J
  double time = 0, time_step = 0;
  std::uint64_t step = 0;

  std::size_t bytes() const;
};
} // namespace isostat
