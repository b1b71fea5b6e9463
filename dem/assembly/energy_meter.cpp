// SPDX-License-Identifier: BSD-3-Clause
#include "dem/assembly/energy_meter.hpp"

#include <utility>

namespace isostat
{
void EnergyMeter::start(const StoredEnergy &stored, const std::array<double, 6> &wall_force, const Mat3 &virial)
{
  memory_ = {};
  memory_.started = true;
  memory_.tally.kinetic = -stored.kinetic();
  memory_.tally.elastic = -stored.elastic();
  memory_.wall_force = wall_force;
  memory_.virial = virial;
}

void EnergyMeter::add_dissipation(const DissipationPerPair &dissipation)
{
  EnergyBalance &tally = memory_.tally;
  for (std::size_t p = 0; p < dissipation.sliding.size(); ++p)
    {
      tally.sliding += dissipation.sliding[p];
      tally.rolling += dissipation.rolling[p];
      tally.released += dissipation.released[p];
      tally.created += dissipation.created[p];
      tally.contact_damping += dissipation.viscous[p];
    }
}

void EnergyMeter::add_work_of_walls(const std::array<double, 6> &force)
{
  const std::array<double, 6> before = std::exchange(memory_.wall_force, force);
  for (int wall = 0; wall < 6; ++wall)
    memory_.tally.boundary_work -= 0.5 * (before[wall] + force[wall]) * memory_.wall_displacement[wall];
}

void EnergyMeter::add_work_of_cell(const Mat3 &virial, const Mat3 &strain_step)
{
  const Mat3 before = std::exchange(memory_.virial, virial);
  memory_.tally.boundary_work -= (0.5 * (before + virial)).cwiseProduct(strain_step).sum();
}

EnergyBalance EnergyMeter::balance(const StoredEnergy &now) const
{
  EnergyBalance balance = memory_.tally;
  balance.kinetic += now.kinetic();
  balance.elastic += now.elastic();
  return balance;
}
} // namespace isostat
