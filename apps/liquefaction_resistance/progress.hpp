// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/liquefaction_resistance/campaign.hpp"
#include "base/record/progress.hpp"

namespace isostat
{
/// Progress of a campaign on stderr: a line for each run that ends, and every half minute what is at work.
class CampaignProgress
{
public:
  CampaignProgress(const Campaign &campaign, int jobs, bool quiet);

  /// A run or the preparation of a specimen has ended; its result is in `run`.
  void finished(const Campaign::Run &run, int code, double seconds);
  bool is_due() const;
  /// @param lines  of what is at work, if is_due()
  void tick(const std::vector<std::string> &lines);

private:
  /// "27 %  4 of 15 runs, ETA 6 min"
  std::string state() const;
  double seconds_left() const;

  const Campaign &campaign_;
  int jobs_;
  bool quiet_;
  Stopwatch since_line_;
};
} // namespace isostat
