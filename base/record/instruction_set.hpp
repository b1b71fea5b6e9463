// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>

namespace isostat
{
/// Name of the instruction set that the contact loops use on this machine, e.g. "AVX3": the widest that it has.
std::string instruction_set();

/// Lets the contact loops use no wider one than this, as on a machine that has no wider one: to the same bits as there.
/// Programs and the Python package take it from the environment, ISOSTAT_INSTRUCTION_SET, if it is set there.
/// @pre no loop has run yet
/// @throws InputError  this machine does not have it, or no loop was compiled for it: the names that there are
/// tested: tests/apps/kill_resume_test.py
void use_instruction_set(const std::string &name);
void use_instruction_set_of_environment();

/// Message for a run that continues from a checkpoint of another instruction set; empty if it is the same, or unknown.
std::string other_instruction_set(const std::string &made_with);
} // namespace isostat
