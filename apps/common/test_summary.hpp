// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/summary_test.py, tests/apps/resistance_test.py
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
/// The redundancy index in a row of the history.
struct RedundancyOfRow
{
  double index = 0, eq2 = 0; ///< of the contact law in force, in which 1 is isostatic; Eq. (2) of the paper [-]
  int constraints = 6;       ///< of a contact of that law that has not yielded
};

/// Of the triaxial shear stages of a test.
struct AxialExtremes
{
  double strain = 0, q = 0; ///< largest |axial strain| since the first shear stage began [-], largest |q| in Pa
};

/// Of the simple shear stages of a test.
struct ShearExtremes
{
  double gamma = 0, tau = 0; ///< largest |gamma_xy| since the first shear stage began [-], largest |tau_xy| in Pa
  // What follows is of the stage with the largest ratio, among those with a CSR if there are any.
  double sigma_v0 = 0;        ///< vertical effective stress when it began, Pa
  double max_ratio = 0;       ///< |tau_xy| over sigma_v0; in a cyclic test the CSR and its overshoot [-]
  double requested_ratio = 0; ///< CSR of the scene; 0: it has none [-]
};

/// Of the rows of stages that shear.
struct ShearRecord
{
  std::size_t first_row = 0;
  double p0 = 0, min_p = 0; ///< Pa
  RedundancyOfRow at_start;
  std::optional<double> max_indicator; ///< before liquefaction [-]; none: no row of a driven stage has it
  std::optional<AxialExtremes> axial;
  std::optional<ShearExtremes> simple_shear;
};

struct LiquefactionRecord
{
  std::size_t row = 0;       ///< of the onset
  double ratio = 0;          ///< p'/p0' below which it counts as liquefied, of the stage it came in [-]
  double reversals = 0;      ///< until then
  bool simple_shear = false; ///< the stage it came in: what its strain is
  bool cyclic = false;       ///< likewise
  double strain_before = 0;  ///< largest |axial strain|, in simple shear |gamma| [-]
  RedundancyOfRow before;    ///< in the row before the onset: of a static test, about its last balanced state
  double ratio_before = 0;   ///< p'/p0' there [-]
  RedundancyOfRow at_onset;
  double least_redundancy = 0; ///< from the onset on
  double recovered = 0;        ///< mean over half cycles of I_R where p'/p0 comes back above the ratio for good
  double n_recoveries = 0;
};

struct LastRow
{
  double p = 0; ///< Pa
  RedundancyOfRow redundancy;
};

/// What is reported of a finished test, from its history and the driver's state. What a test does not have is not
/// there.
struct TestSummary
{
  std::string title, law; ///< as the scene names them
  std::size_t grains = 0;
  double void_ratio = 0, preparation_friction = -1;     ///< degrees; negative: unknown
  std::optional<double> relative_density, e_min, e_max; ///< and the limits that define it, as the specimen has them
  double steps = 0;
  double last_steps = 0, seconds = 0;  ///< since the run was begun or resumed for the last time
  std::vector<int> constraints;        ///< of a contact, as the laws in force followed each other
  std::optional<ShearRecord> shearing; ///< none: no stage shears
  bool may_liquefy = false;            ///< has a stage that keeps the volume
  std::optional<LiquefactionRecord> liquefaction;
  std::optional<LastRow> last; ///< none: no stage took a step
  bool cyclic = false;         ///< has a stage that turns
  double reversals = 0;
  std::optional<double> worst_overshoot; ///< of the load over its limit at a reversal, Pa; none: no load turned
  double energy_residual = -1;           ///< |residual| / sum of |boundary work|; negative: not measured
  std::string response;                  ///< of the last cyclic stage (dem/drive/stages/cyclic_response.hpp); or empty
  CyclicResponse cycles;                 ///< its figures
  std::vector<DrainedStage> drained;     ///< stages that a servo drains
  std::vector<ControlLoss> losses;       ///< of control, in all stages (dem/drive/control.hpp)
  std::vector<ToldEnd> ends;             ///< of stages (apps/common/stage_report.hpp)
  std::string stages;                    ///< lines about single stages
};

/// @param specimen  its figures (Specimen::numbers)
TestSummary summarise(const RunHistory &run, const Scene &scene, const std::map<std::string, double> &specimen,
                      const DriveState &state, double seconds);

/// For the terminal and summary.txt (test_summary_text.cpp).
std::string to_text(const TestSummary &summary, const Scene &scene);
/// summary.json, read by apps/figures/element_test.py.
Json to_json(const TestSummary &summary);
} // namespace isostat
