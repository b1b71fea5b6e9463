// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isostat
{
struct HertzMindlin;
struct LoopView;

/// The loop over contacts of an exponent other than 3/2.
/// tested: tests/dem/contact/loop_test.cpp
void add_asperity_forces(const HertzMindlin &law, const LoopView &view);
} // namespace isostat
