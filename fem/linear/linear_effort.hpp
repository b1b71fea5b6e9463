// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/fem/solve/statics_ranks_test.cpp
#pragma once
#include <cstdint>
#include <fmt/format.h>
#include <string>

namespace isostat
{
/// What the iterative solution of a linear system has cost since its start; no solves: it is a direct one.
struct LinearEffort
{
  std::string method; ///< PETSc's names: "cg, hypre"
  std::uint64_t solves = 0, iterations = 0, most = 0;

  /// With what another system before it has cost.
  LinearEffort after(const LinearEffort &other) const
  {
    return {method.empty() ? other.method : method, solves + other.solves, iterations + other.iterations,
            most > other.most ? most : other.most};
  }
  /// At the end of a line of progress; empty: a direct solution.
  std::string text() const
  {
    return solves == 0 ? ""
                       : fmt::format("  {}: {:.1f} iterations", method,
                                     static_cast<double>(iterations) / static_cast<double>(solves));
  }
};
} // namespace isostat
