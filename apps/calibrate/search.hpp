// SPDX-License-Identifier: BSD-3-Clause
// Where to look for better parameters.   tested: tests/apps/calibrate/search_test.cpp
#pragma once
#include "apps/calibrate/plan.hpp"

#include <functional>
#include <string>
#include <vector>

namespace isostat
{
/// The points of a design: a Sobol sequence in the unit cube (Sobol 1967), by Boost.
std::vector<std::vector<double>> sobol_design(std::size_t dimensions, std::size_t n);

/// A function over the unit cube. It may throw what ends the search.
using Objective = std::function<double(const std::vector<double> &shares)>;

/// Thrown by an objective whose budget is used up.
struct BudgetUsed
{
  std::string what;
};

/// Looks for a smaller value from `start` on, by NLopt: BOBYQA (Powell 2009), Sbplx (Rowan 1990) or CRS2 with local
/// mutation (Kaelo and Ali 2006). It always asks for the same points in the same order, so that it can be repeated from
/// known values. Nothing is returned: the objective knows what it has been asked.
/// @param start  in the unit cube
/// @return why it ended    @throws what the objective throws, but for BudgetUsed
std::string search(const SearchSettings &settings, const std::vector<double> &start, const Objective &objective);
} // namespace isostat
