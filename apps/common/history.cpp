// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/history.hpp"

#include "dem/drive/rate_control.hpp"
#include "dem/measure/unbalanced.hpp"

#include <algorithm>

namespace isostat
{
std::vector<RecordColumn> history_columns(bool energy)
{
  std::vector<RecordColumn> columns = {{"step", "-"},      {"time", "s"},      {"stage", "-"},
                                       {"eps_x", "-"},     {"eps_y", "-"},     {"eps_z", "-"},
                                       {"rate", "1/s"},    {"reversals", "-"}, {"liquefied", "-"},
                                       {"time_step", "s"}, {"indicator", "-"}, {"inertial_number", "-"}};
  for (const auto &[name, unit] : Micromechanics::columns())
    columns.push_back({name, unit});
  if (energy)
    for (const char *name : {"W_boundary", "D_sliding", "D_rolling", "D_released", "D_damping", "created", "residual"})
      columns.push_back({name, "J"});
  return columns;
}

std::vector<double> history_row(const Assembly &assembly, const DriveState &state, const Observation &seen,
                                const Micromechanics &micromechanics, bool energy)
{
  Vec3 strain = Vec3::Zero(); // compression positive
  if (state.shear_started != 0)
    strain = (state.origin.edges().array() / assembly.box().edges().array()).log();
  const double inertia =
      inertial_number(state.signed_rate, assembly.d50(), assembly.packing().density, std::max(seen.p, 1.0));
  std::vector<double> row = {static_cast<double>(assembly.step()),
                             assembly.time(),
                             state.stage,
                             strain[0],
                             strain[1],
                             strain[2],
                             state.signed_rate,
                             state.reversals,
                             state.liquefied,
                             assembly.time_step,
                             state.indicator,
                             inertia};
  const std::vector<double> measured = micromechanics.row();
  row.insert(row.end(), measured.begin(), measured.end());
  if (energy)
    {
      const EnergyBalance e = assembly.energy();
      row.insert(row.end(), {e.boundary_work, e.sliding, e.rolling, e.released, e.damping, e.created, e.residual()});
    }
  return row;
}
} // namespace isostat
