// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/interrupt.hpp"

#include <csignal>

namespace isostat
{
namespace
{
volatile std::sig_atomic_t requested = 0;

void request(int signal)
{
  requested = 1;
  std::signal(signal, SIG_DFL);
}
} // namespace

void catch_signals()
{
  std::signal(SIGINT, request);
  std::signal(SIGTERM, request);
}

bool stop_requested() { return requested != 0; }
} // namespace isostat
