// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/behaviour.hpp"

namespace isostat
{
/// Does the stages before it again.
/// tested: tests/dem/drive/stages/repeat_test.cpp
class Repeat : public StageBehaviour
{
public:
  std::uint64_t stages = 1; ///< this many entries of the programme before this one
  std::uint64_t times = 2;  ///< in all, the first time included

  bool operator==(const Repeat &) const = default;
  const char *kind() const override { return "repeat"; }
  bool takes_steps() const override { return false; }
  bool keeps_volume() const override { return true; }
  Verdict judge(const StageContext &, const Observation &) const override { return {}; }
};
} // namespace isostat
