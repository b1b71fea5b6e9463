// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/kill_resume_test.py
#pragma once

namespace isostat
{
/// From here on SIGINT and SIGTERM only raise a flag; the run stops after the step it is in and writes a checkpoint. A
/// second signal ends the program at once.
void catch_signals();
bool stop_requested();
} // namespace isostat
