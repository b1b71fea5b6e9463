// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <vector>

namespace isostat
{
/// `isostat convert IN OUT`: a packing from one format into another, checked on the way.
/// @param words  "convert" and what follows on the command line
/// @return exit code; 2 for a packing that cannot be meant, and nothing is written then
/// tested: tests/apps/convert_test.py
int convert(const std::vector<std::string> &words);
} // namespace isostat
