// SPDX-License-Identifier: BSD-3-Clause
#include "apps/liquefaction_resistance/progress.hpp"

#include <cstdio>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double interval = 30; // s

bool has_ended(const RunResult &result) { return result.status != RunStatus::missing; }

std::string outcome(const RunResult &r)
{
  switch (r.status)
    {
    case RunStatus::liquefied:
      return fmt::format("liquefied after {:g} cycles", *r.to_liquefaction);
    case RunStatus::censored:
      return fmt::format("not liquefied in {:g} cycles", r.cycles);
    case RunStatus::strain:
      return fmt::format("not liquefied, strain limit after {:g} cycles", r.cycles);
    case RunStatus::failed:
      return "FAILED, " + r.note;
    case RunStatus::missing:
      break;
    }
  return "interrupted";
}
} // namespace

CampaignProgress::CampaignProgress(const Campaign &campaign, int jobs, bool quiet)
    : campaign_(campaign), jobs_(jobs), quiet_(quiet)
{}

double CampaignProgress::seconds_left() const
{
  double spent = 0, n_timed = 0, left = 0;
  for (const Campaign::Run &run : campaign_.runs)
    if (run.result.wall_seconds)
      {
        spent += *run.result.wall_seconds;
        n_timed += 1;
      }
  if (n_timed == 0)
    return -1;
  for (const Campaign::Run &run : campaign_.runs)
    {
      if (has_ended(run.result))
        continue;
      double sum = 0, n = 0; // of the same ratio, if there is one
      for (const Campaign::Run &other : campaign_.runs)
        if (other.ratio == run.ratio && other.result.wall_seconds)
          {
            sum += *other.result.wall_seconds;
            n += 1;
          }
      left += n > 0 ? sum / n : spent / n_timed;
    }
  return left / jobs_;
}

std::string CampaignProgress::state() const
{
  std::size_t n = 0;
  for (const Campaign::Run &run : campaign_.runs)
    n += has_ended(run.result);
  const std::size_t all = campaign_.runs.size();
  std::string text =
      fmt::format("{:3.0f} %  {} of {} runs", 100.0 * static_cast<double>(n) / static_cast<double>(all), n, all);
  const double left = seconds_left();
  if (left >= 0 && n < all)
    text += ", ETA " + duration_text(left);
  return text;
}

void CampaignProgress::finished(const Campaign::Run &run, int code, double seconds)
{
  if (quiet_)
    return;
  const bool specimen = run.scene.stages.empty();
  const std::string what = !specimen ? outcome(run.result) : code == 0 ? "ready" : outcome(run.result);
  std::fprintf(stderr, "%s\n", fmt::format("{}  {}: {}, {:.0f} s", state(), run.name, what, seconds).c_str());
  since_line_.restart();
}

bool CampaignProgress::is_due() const { return !quiet_ && since_line_.seconds() >= interval; }

void CampaignProgress::tick(const std::vector<std::string> &lines)
{
  if (!is_due())
    return;
  std::fprintf(stderr, "%s\n", state().c_str());
  for (const std::string &line : lines)
    std::fprintf(stderr, "       %s\n", line.c_str());
  since_line_.restart();
}
} // namespace isostat
