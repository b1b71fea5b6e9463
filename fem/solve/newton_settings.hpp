// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isostat
{
/// How a load step is solved, see Statics.   tested: tests/fem/solve/statics_test.cpp, statics_failure_test.cpp
struct NewtonSettings
{
  double tolerance = 1e-8;             ///< of the residual, in units of the force scale
  unsigned max_iterations = 25;        ///< per sub-step; 0: relaxation alone
  unsigned iterations_per_tangent = 1; ///< 1: Newton. More: the tangent is kept (modified Newton), within a sub-step
  unsigned relaxation_iterations = 0;  ///< of the relaxation that a sub-step gets which Newton does not solve; 0: none
  unsigned max_halvings = 12;          ///< the smallest sub-step is the step times 2^-max_halvings

  bool operator==(const NewtonSettings &) const = default;
};
} // namespace isostat
