// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/system_limits_test.py
#pragma once
#include <cstdio>
#include <string>

namespace isostat
{
/// Words for who watches, on stderr. A run does not end because nobody can read them: the disk of a log may be full, a
/// pipe or a terminal closed.
inline void tell(const std::string &text) { std::fputs(text.c_str(), stderr); }
} // namespace isostat
