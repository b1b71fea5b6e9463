// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/system_limits_test.py
#pragma once
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace isostat
{
/// Messages for the observer, on stderr. A run does not end because they cannot be written: the disk of a log may be
/// full, a pipe or a terminal closed.
inline void tell(const std::string &text) { std::fputs(text.c_str(), stderr); }

/// Takes the warnings of its thread while it lives, for a program that has its own way to warn, as Python does.
/// tested: tests/python/warnings_test.py
class WarningsTaken
{
public:
  WarningsTaken() : before_(std::exchange(taker_, this)) {}
  ~WarningsTaken() { taker_ = before_; }
  WarningsTaken(const WarningsTaken &) = delete;
  WarningsTaken &operator=(const WarningsTaken &) = delete;

  std::vector<std::string> lines;

private:
  friend void warn(const std::string &text);
  static inline thread_local WarningsTaken *taker_ = nullptr;
  WarningsTaken *before_;
};

/// "warning: " and the text on stderr, or to what takes warnings.
inline void warn(const std::string &text)
{
  if (WarningsTaken *taker = WarningsTaken::taker_)
    taker->lines.push_back(text);
  else
    tell("warning: " + text + "\n");
}
} // namespace isostat
