// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/biaxial/scene.hpp"
#include "apps/common/scene_program.hpp"
#include "apps/common/summary.hpp"

#include <optional>

namespace isostat
{
using BiaxialRequest = RunRequest<BiaxialScene>;

/// Results of a run.
struct BiaxialSummary
{
  std::size_t steps = 0, points = 0;
  bool complete = false;
  std::string failure;                     ///< why it stopped before its end
  double axial_strain = 0;                 ///< reached
  double peak_stress = 0, peak_strain = 0; ///< largest axial stress, compression positive, Pa; where
  double last_stress = 0;                  ///< Pa
  double volumetric_strain = 0;            ///< at the end, compression positive
  double pore_pressure = 0;                ///< excess, at the end, mean of the block, Pa
  double localisation = 0;                 ///< 90 % quantile of the points' shear strain over its median; uniform: 1
  double max_strain = 0;   ///< largest amount of a principal strain of a point so far: the mesh takes it as small
  double max_rotation = 0; ///< largest rotation of a point in the plane so far, (u_x,z - u_z,x)/2, alike, rad
  std::optional<double> large_from; ///< axial strain at which one of the two was first beyond a tenth
  std::size_t iterations = 0, trials = 0, substeps = 0, rejected = 0;
  double wall_seconds = 0, material_seconds = 0, tangent_seconds = 0, rve_steps = 0; ///< of all calls

  /// What a checkpoint keeps of it.
  template <class Summary, class Visit>
  static void for_each(Summary &s, const Visit &visit)
  {
    visit("axial_strain", s.axial_strain), visit("peak_stress", s.peak_stress), visit("peak_strain", s.peak_strain);
    visit("last_stress", s.last_stress), visit("volumetric_strain", s.volumetric_strain);
    visit("pore_pressure", s.pore_pressure);
    visit("localisation", s.localisation), visit("max_strain", s.max_strain), visit("max_rotation", s.max_rotation);
    visit("wall_seconds", s.wall_seconds), visit("material_seconds", s.material_seconds);
    visit("tangent_seconds", s.tangent_seconds), visit("rve_steps", s.rve_steps);
    visit("iterations", s.iterations), visit("trials", s.trials), visit("substeps", s.substeps);
    visit("rejected", s.rejected), visit("steps", s.steps);
  }
};

/// Runs a scene and leaves all files but the summary, or continues from its newest checkpoint to the same bits. A step
/// without equilibrium ends the run early: what it found so far stays.
/// @throws InputError  before anything existing is changed
/// @throws Interrupted  after a signal, with a checkpoint
/// tested: tests/apps/biaxial_test.py, tests/apps/biaxial_resume_test.py
BiaxialSummary run_biaxial(const BiaxialRequest &request);

Summary report_of(const BiaxialSummary &summary, const BiaxialScene &scene);
} // namespace isostat
