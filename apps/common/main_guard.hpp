// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/error.hpp"

#include <cstdio>
#include <functional>

namespace isostat
{
/// Runs a program and turns what it throws into one message on stderr and an exit code: 0 done, 1 failed, 2 bad input,
/// 130 interrupted.
inline int guarded(const std::function<void()> &program)
{
  try
    {
      program();
      return 0;
    }
  catch (const InputError &error)
    {
      std::fprintf(stderr, "error: %s\n", error.what());
      return 2;
    }
  catch (const Interrupted &stop)
    {
      std::fprintf(stderr, "%s\n", stop.what());
      return 130;
    }
  catch (const std::exception &error)
    {
      std::fprintf(stderr, "failed: %s\n", error.what());
      return 1;
    }
}
} // namespace isostat
