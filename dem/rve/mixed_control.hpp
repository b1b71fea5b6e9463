// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/rve/rve.hpp"

namespace isostat
{
constexpr double largest_increment = 0.1; ///< strain that one Rve::advance() may take at all

/// What the rate control counts as strain: the difference of the extreme principal strains, or the largest alone.
double strain_measure(const Mat3 &gradient);

/// Why stress control cannot begin: a number is missing, it is not symmetric, one component has strain and stress, the
/// target needs tension. Empty: it can.   @param scale  what the tolerance is relative to, Pa
/// tested: tests/dem/rve/rve_test.cpp
std::string refusal(const MixedIncrement &increment, double scale);
} // namespace isostat
