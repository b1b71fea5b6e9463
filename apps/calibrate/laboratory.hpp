// SPDX-License-Identifier: BSD-3-Clause
// Curves of the laboratory, and what their files may have wrong.   tested: tests/apps/calibrate/laboratory_test.cpp
#pragma once
#include "apps/calibrate/curve.hpp"

namespace isostat
{
/// Reads a laboratory file. A column is found by its name without the unit; the unit is that of the file's header.
///
/// What is checked beside the numbers is what a test of this kind cannot do, so that swapped columns, wrong signs and
/// wrong units do not become parameters: it begins at the pressure and nearly isotropic, q has the sign of the
/// direction, the ratio of principal stresses stays possible and leaves 1, a drained test keeps its lateral stress and
/// contracts at first in compression (expands in extension), and its volume changes by more than nothing.
/// @param pressure  effective, before the test, Pa
/// @throws InputError with file:line, value, what is possible, and remedy
Curve read_laboratory(const PlanCurve &plan, double pressure);
} // namespace isostat
