// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/liquefaction_resistance_test.py
#pragma once
#include "apps/common/drained_report.hpp"
#include "apps/common/stage_report.hpp"
#include "dem/drive/drive_state.hpp"
#include "dem/scene/scene.hpp"

#include <map>
#include <optional>
#include <string>

namespace isostat
{
/// Of the simple shear stages of a test; gamma counts from the start of the first shear stage.
struct ShearExtremes
{
  double gamma = 0, tau = 0;  ///< largest |gamma_xy| [-], largest |tau_xy| in Pa
  double sigma_v0 = 0;        ///< vertical effective stress at the start of the first such stage, Pa
  double max_ratio = 0;       ///< tau over sigma_v0; in a cyclic test the CSR and its overshoot [-]
  double requested_ratio = 0; ///< CSR of the scene; 0 if no stage is cyclic [-]
};

/// What is reported of a finished test, from its history and the driver's state.
struct TestSummary
{
  std::string title, law; ///< as the scene names them
  std::size_t grains = 0;
  double void_ratio = 0, preparation_friction = -1;     ///< degrees; negative: unknown
  std::optional<double> relative_density, e_min, e_max; ///< and the limits that define it, as the specimen has them
  double p0 = 0;                                        ///< Pa
  double steps = 0;
  double last_steps = 0, seconds = 0; ///< since the run was begun or resumed for the last time
  double reversals = 0, worst_overshoot = 0;
  bool cyclic = false, liquefied = false;
  double cycles_to_liquefaction = 0; ///< reversals / 2
  double strain_before = 0;          ///< largest |axial strain|, in simple shear |gamma|, before liquefaction
  double redundancy_initial = 0, redundancy_at_onset = 0, redundancy_min = 0;
  double redundancy_recovered = 0; ///< mean over half cycles of I_R where p'/p0 comes back above the ratio for good
  double n_recoveries = 0;
  double max_strain = 0, max_q = 0, min_p = 0;
  double energy_residual = -1; ///< |residual| / sum of |boundary work|; negative: not measured
  double max_indicator = 0;
  std::size_t first_row = 0, onset_row = 0;
  bool axial = false;                 ///< has a triaxial shear stage
  std::optional<ShearExtremes> shear; ///< has a simple shear stage
  std::string response;               ///< of the last cyclic stage (dem/drive/stages/cyclic_response.hpp); none: empty
  CyclicResponse cycles;              ///< its figures
  std::vector<DrainedStage> drained;  ///< stages that a servo drains
  std::vector<ControlLoss> losses;    ///< of control, in all stages (dem/drive/control.hpp)
  std::vector<ToldEnd> ends;          ///< of stages (apps/common/stage_report.hpp)
  std::string stages;                 ///< lines about single stages
};

/// @param specimen  its figures (Specimen::numbers)
TestSummary summarise(const RunHistory &run, const Scene &scene, const std::map<std::string, double> &specimen,
                      const DriveState &state, double seconds);

/// For the terminal.
std::string to_text(const TestSummary &summary, const Scene &scene);
/// summary.json, read by apps/figures/element_test.py.
Json to_json(const TestSummary &summary);
} // namespace isostat
