// SPDX-License-Identifier: BSD-3-Clause
// Columns and rows of history.csv.
#include "apps/common/run_output.hpp"

#include "dem/drive/rate_control.hpp"
#include "dem/measure/unbalanced.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isostat
{
namespace
{
/// Angle of the major principal compression from the vertical y in the plane of shear, degrees, positive as gamma_xy
/// drives it; 45 in pure shear.   @param stress  Pa, tension positive
double major_angle(const Mat3 &stress)
{
  return 0.5 * std::atan2(2 * stress(0, 1), stress(0, 0) - stress(1, 1)) * 180 / std::numbers::pi;
}

/// Excess pore pressure over the effective stress from which the volume is kept; 0 while water drains.
double pore_pressure_ratio(const PathState &path, const Observation &seen)
{
  if (!path.undrained || path.undrained->stress <= 0)
    return 0;
  return 1 - (path.undrained->vertical ? seen.stress[1] : seen.p) / path.undrained->stress;
}

/// It has a stage whose three normal stresses p and q do not tell.
bool has_path(const Scene &scene)
{
  return std::any_of(scene.stages.begin(), scene.stages.end(), [](const Stage &stage) { return as<Path>(stage); });
}
/// Its numbers of stages do not tell how often each was done.
bool has_repeat(const Scene &scene)
{
  return std::any_of(scene.stages.begin(), scene.stages.end(), [](const Stage &stage) { return as<Repeat>(stage); });
}
} // namespace

std::vector<RecordColumn> history_columns(const Scene &scene)
{
  std::vector<RecordColumn> columns = {{"step", "-"},      {"time", "s"},      {"stage", "-"},
                                       {"eps_x", "-"},     {"eps_y", "-"},     {"eps_z", "-"},
                                       {"rate", "1/s"},    {"reversals", "-"}, {"liquefied", "-"},
                                       {"time_step", "s"}, {"indicator", "-"}, {"inertial_number", "-"}};
  for (const auto &[name, unit] : Micromechanics::columns())
    columns.push_back({name, unit});
  if (scene.specimen.domain == "periodic-cell")
    columns.insert(columns.end(), {{"gamma_xy", "-"},
                                   {"tau_xy", "Pa"},
                                   {"sigma_x", "Pa"},
                                   {"sigma_y", "Pa"},
                                   {"sigma_z", "Pa"},
                                   {"sigma1_angle", "deg"}});
  else if (has_path(scene))
    columns.insert(columns.end(), {{"sigma_x", "Pa"}, {"sigma_y", "Pa"}, {"sigma_z", "Pa"}});
  if (has_repeat(scene))
    columns.push_back({"done", "-"});
  if (scene.output.energy)
    for (const char *name : {"W_boundary", "D_sliding", "D_rolling", "D_released", "D_damping", "D_contact_damping",
                             "D_free_grains", "created", "residual"})
      columns.push_back({name, "J"});
  columns.insert(columns.end(), {{"eps_v", "-"}, {"r_u", "-"}, {"cycles", "-"}});
  if (scene.drive.on)
    columns.push_back({"relaxed", "J"});
  return columns;
}

std::vector<double> history_row(const Scene &scene, const Assembly &assembly, const DriveState &state,
                                const Observation &seen, const Micromechanics &micromechanics)
{
  const Vec3 strain = -strain_since_start(assembly, state.path); // compression positive
  const double inertia =
      inertial_number(state.loading.signed_rate, assembly.d50(), assembly.packing().density, std::max(seen.p, 1.0));
  std::vector<double> row = {static_cast<double>(assembly.step()),
                             assembly.time(),
                             static_cast<double>(state.place.stage),
                             strain[0],
                             strain[1],
                             strain[2],
                             state.loading.signed_rate,
                             static_cast<double>(state.undrained.reversals),
                             state.undrained.liquefaction ? 1.0 : 0.0,
                             assembly.settings.time_step,
                             state.pace.indicator,
                             inertia};
  const std::vector<double> measured = micromechanics.row();
  row.insert(row.end(), measured.begin(), measured.end());
  if (scene.specimen.domain == "periodic-cell")
    {
      const Mat3 stress = assembly.stress();
      row.insert(row.end(), {seen.gamma, seen.tau, -stress(0, 0), -stress(1, 1), -stress(2, 2), major_angle(stress)});
    }
  else if (has_path(scene))
    row.insert(row.end(), seen.stress.begin(), seen.stress.end());
  if (has_repeat(scene))
    row.push_back(static_cast<double>(state.place.done));
  if (scene.output.energy)
    {
      const EnergyBalance e = assembly.energy();
      row.insert(row.end(), {e.boundary_work, e.sliding, e.rolling, e.released, e.damping, e.contact_damping,
                             e.free_grains, e.created, e.residual()});
    }
  row.insert(row.end(), {strain.sum(), pore_pressure_ratio(state.path, seen),
                         0.5 * (static_cast<double>(state.undrained.reversals) + state.loading.half_cycle)});
  if (scene.drive.on)
    row.push_back(seen.relaxed);
  return row;
}
} // namespace isostat
