// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/contact/loop.hpp"
#include "dem/measure/energy.hpp"
#include "dem/motion/leapfrog.hpp"

#include <array>
#include <string>

namespace isostat
{
/// What an energy balance continues from; part of a checkpoint.
struct EnergyMemory
{
  bool started = false;
  EnergyBalance tally;                       ///< since the start; of kinetic and elastic minus what was stored then
  std::array<double, 6> wall_force{};        ///< at the last evaluation, outward positive, N
  std::array<double, 6> wall_displacement{}; ///< since then, outward positive, m
  Mat3 virial = Mat3::Zero();                ///< of a cell: sum of F b at the last evaluation, J

  /// Calls f(name, field) for every number: the one list that checkpoints go by.
  template <typename Memory, typename F>
  static void for_each(Memory &memory, F &&f)
  {
    f("energy_started", memory.started);
    EnergyBalance::for_each(memory.tally,
                            [&](const char *name, auto &value) { f("energy_" + std::string(name), value); });
    for (int wall = 0; wall < 6; ++wall)
      {
        f("wall_force_" + std::to_string(wall), memory.wall_force[wall]);
        f("wall_displacement_" + std::to_string(wall), memory.wall_displacement[wall]);
      }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        f("virial_" + std::to_string(i) + std::to_string(j), memory.virial(i, j));
  }
};

/// Sums of an energy balance over the steps since its start:
///
///     work of the walls   dW = -1/2 (F + F') . du       F', F: forces on a wall before and after it has moved by du
///     work of a cell      dW = -1/2 (S + S') : E        S = sum of F b, E the strain of the step
///
/// and what each pair has dissipated, in the order of pairs, so that no sum depends on lists or threads.
/// Before the start all sums are zero.
/// tested: tests/verification/energy_balance_test.cpp; continued: tests/dem/assembly/assembly_test.cpp
class EnergyMeter
{
public:
  /// First evaluation of forces: nothing has been done yet.   @param virial  of a cell, J
  void start(const StoredEnergy &stored, const std::array<double, 6> &wall_force, const Mat3 &virial);
  /// Each later one; before the work is added.
  void add_dissipation(const DissipationPerPair &dissipation);
  void add_work_of_walls(const std::array<double, 6> &force);
  void add_work_of_cell(const Mat3 &virial, const Mat3 &strain_step);
  /// Motion after it.
  void add_motion(const MotionReport &report)
  {
    memory_.tally.damping += report.damping_loss;
    memory_.tally.free_grains += report.free_loss;
    memory_.tally.boundary_work += report.carried_work;
  }
  void walls_moved(const std::array<double, 6> &outward) { memory_.wall_displacement = outward; }

  bool started() const { return memory_.started; }
  EnergyBalance balance(const StoredEnergy &now) const;
  const EnergyMemory &memory() const { return memory_; }
  void set_memory(const EnergyMemory &memory) { memory_ = memory; }

private:
  EnergyMemory memory_;
};
} // namespace isostat
