// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/types.hpp"

namespace isostat
{
/// How a time step of an assembly is made. All of it may be changed between two steps.
/// tested: tests/dem/assembly/assembly_test.cpp, tests/verification/threads_test.cpp, energy_balance_test.cpp
struct StepSettings
{
  double time_step = 0;        ///< s; must be positive when grains are moved
  double damping = 0.2;        ///< local damping [-], [0, 1)
  Vec3 gravity = Vec3::Zero(); ///< m/s2
  bool measure_energy = false; ///< from the next force evaluation on, keep the sums of Assembly::energy()
  /// Threads that share a step, or 0 for as many as the process may use and the packing can feed. Changes no bit of any
  /// result. Give 1 where assemblies run side by side.
  int threads = 1;
};
} // namespace isostat
