// SPDX-License-Identifier: BSD-3-Clause
// What the summary of a test says of its specimen and of how it is driven.   tested: tests/apps/report_test.py
#pragma once
#include "apps/common/summary.hpp"
#include "dem/scene/scene.hpp"

#include <map>

namespace isostat
{
/// Specimen and contact law.   @param numbers  Specimen::numbers
void add_specimen(const std::map<std::string, double> &numbers, const Scene &scene, Summary &summary);
/// Rates of the stages that shear.
void add_rate(const Scene &scene, Summary &summary);
} // namespace isostat
