// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/scene.hpp"
#include "base/scene/ranges.hpp"

namespace isostat
{
namespace
{
using namespace ranges;

constexpr unsigned of_waves = kind_bit(AnalysisKind::dynamic);
constexpr unsigned of_flow = kind_bit(AnalysisKind::consolidation);

// clang-format off
constexpr Key analysis_key[] = {
  {.path = "kind", .field = member<&ColumnAnalysis::kind>, .value = "dynamic", .choices = analysis_names,
   .text = "What is solved. A consolidation needs water.drainage \"coupled\", a load of kind \"step\", a rigid base "
           "and no motion; a plate a dry box without motion, load and `mesh.distributed`; a biaxial block dimension 2, "
           "without them, slope, base, water table, and what is written over the depth."},
  {.path = "duration", .field = member<&ColumnAnalysis::duration>, .unit = unit::s, .presence = Presence::required,
   .value = "20 s", .range = positive, .kinds = of_waves, .text = "End of the run. At most 1e15 time steps."},
  {.path = "time_step", .field = member<&ColumnAnalysis::time_step>, .unit = unit::ms, .presence = Presence::optional,
   .value = "1 ms", .range = positive, .kinds = of_waves,
   .text = "Time step, checked against the stable one; left out: `safety` times the stable one at the start."},
  {.path = "safety", .field = member<&ColumnAnalysis::safety>, .value = "0.8", .range = to_one,
   .reason = "because beyond the stable step the motion explodes", .kinds = of_waves,
   .text = "Fraction of the stable time step that is used. Of explicit steps."},
  {.path = "scheme", .field = member<&ColumnAnalysis::scheme>, .value = "explicit", .choices = scheme_names,
   .kinds = of_waves,
   .text = "Explicit: central differences, small steps that cost little. Implicit: generalised alpha, steps of any size, "
           "each with a Newton solution; for stiff or thin layers and long, slow motions. It needs a `time_step`, a "
           "twentieth of the shortest period of interest. Of dry or coupled soil of formulas with small strain, without "
           "free fields and viscosity. docs/column.md."},
  {.path = "spectral_radius", .field = member<&ColumnAnalysis::spectral_radius>, .value = "0.8",
   .range = {0, 1}, .reason = "because a larger one would feed vibrations", .kinds = of_waves,
   .text = "Of implicit steps: the part that one leaves of vibrations much faster than it. 1: all, and "
           "energy is conserved; 0: none. Lower ones damp more of what is slow, too."},
  {.path = "mass_damping", .field = member<&ColumnAnalysis::mass_damping>, .unit = unit::per_s, .value = "0 1/s",
   .range = not_negative, .kinds = of_waves,
   .text = "a_M: a force -a_M times mass and velocity; it damps frequency f by the fraction a_M / (4 pi f) of "
           "critical. The velocity is that against a rigid base, but absolute above a compliant one: there it also "
           "holds back the motion of soil and rock as a whole, and a_M should be far below 2 pi times the lowest "
           "frequency of interest."},
  {.path = "highest_frequency", .field = member<&ColumnAnalysis::highest_frequency>, .unit = unit::Hz,
   .value = "25 Hz", .range = positive, .kinds = of_waves,
   .text = "Highest frequency of interest. `viscosity` damps what vibrates faster. A warning names elements that are "
           "too long for its wave, or for that of the motion if it has no such frequencies. The summary gives the "
           "share of the surface's acceleration above it."},
  {.path = "viscosity", .field = member<&ColumnAnalysis::viscosity>, .unit = unit::ms, .presence = Presence::optional,
   .value = "0.1 ms", .range = not_negative, .reason = "because a negative one would feed vibrations", .kinds = of_waves,
   .text = "Viscosity beta of the skeleton over its modulus, which acts above `highest_frequency` f_c: it damps "
           "frequency f by the fraction pi f beta f^2 / (f^2 + f_c^2) of critical (of 0.1 ms, 0.08 % at 12.5 Hz, 1.5 % "
           "at 58 Hz). 0 ms of implicit steps. Left out: 0 ms where all layers are elastic, with or without `damping`, "
           "whose response is that of the closed form then; else 0.1 ms, without which layers and elements ring on "
           "(docs/results/column_dissipation.md). Lowers the stable time step dt to sqrt(beta^2 + dt^2) - beta: by 10 % "
           "where it is 1 ms, by 59 % where it is beta, to a sixteenth where it is beta/8, as in fine meshes."},
  {.path = "large_strain", .field = member<&ColumnAnalysis::large_strain>, .value = "false", .kinds = of_waves,
   .text = "Cells move with the soil: stresses are those of the deformed soil (updated Lagrangian), and water flows "
           "through it as it is. Left out, strains are small: at settlements or rotations of 10 % they are wrong by "
           "about as much. Stresses turn with the soil. Not in an undrained column, which keeps its length. docs/theory_column.md, section 2."},
  {.path = "petsc", .field = member<&ColumnAnalysis::petsc>, .presence = Presence::optional,
   .value = "-statics_ksp_type cg -statics_pc_type gamg",
   .text = "Options of PETSc for the linear systems; left out: direct solution, the same bits for any number of ranks. "
           "docs/column.md."},
  {.path = "first_time", .field = member<&ColumnAnalysis::first_time>, .unit = unit::s, .presence = Presence::required,
   .value = "10 s", .range = positive, .kinds = of_flow,
   .text = "End of the first time step after loading; later ones grow geometrically. Elements where water drains are "
           "refined to resolve it; where they cannot be, a warning states from when on results are right."},
  {.path = "last_time", .field = member<&ColumnAnalysis::last_time>, .unit = unit::s, .presence = Presence::required,
   .value = "6 h", .range = positive, .kinds = of_flow, .text = "End of the last time step. After `first_time`."},
  {.path = "steps", .field = member<&ColumnAnalysis::steps>, .value = "50", .range = {2, 1e6},
   .reason = "because first_time and last_time end a step each, and no run needs a million of them",
   .kinds = of_flow,
   .text = "Number of time steps, each with its row in the results; the solver divides them where accuracy requires "
           "it."},
};
// clang-format on
} // namespace

SceneFragment<ColumnAnalysis> analysis_keys() { return {analysis_key}; }
} // namespace isostat
