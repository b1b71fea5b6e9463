// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <vector>

namespace isostat
{
/// A step was given up (StaticsSettings::gives_up); the state is that before it.
struct StepGivenUp
{};

/// What the last step took.
struct StaticsEffort
{
  unsigned substeps = 0, rejected = 0; ///< that were accepted, that no solver solved
  unsigned iterations = 0;             ///< linear systems solved
  unsigned trials = 0;                 ///< evaluations of the material
  /// After each iteration, in units of the force scale: of each sub-step, rejected or not, by each solver.
  std::vector<std::vector<double>> residuals = {};

  /// Residuals as in "2.0e-01 3.1e-04 4.6e-10 | 1.3e-01 6.0e-05"; of more than ten iterations the first and last five.
  std::string convergence() const;
};

/// What became of the last sub-step.   tested: tests/fem/solve/statics_failure_test.cpp
struct StaticsReport
{
  StaticsEffort effort;         ///< of the step so far
  double scale = 0;             ///< force scale of the last trial, N
  double residual = 0;          ///< of the last trial, in units of the force scale
  std::string reason;           ///< why it has not been solved
  bool material_failed = false; ///< else it was the solver, or a load that nothing bears

  /// Of an iteration that is done.
  void add_iteration(double its_residual)
  {
    residual = its_residual;
    effort.residuals.back().push_back(its_residual);
  }

  /// Notes the reason.   @return false
  bool fail(std::string why, bool of_material = false)
  {
    reason = std::move(why);
    material_failed = of_material;
    return false;
  }
};
} // namespace isostat
