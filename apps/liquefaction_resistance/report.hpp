// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/liquefaction_resistance/campaign.hpp"

namespace isostat
{
/// Writes resistance.csv (one row per run), resistance.json (the fit; read by apps/figures/liquefaction_resistance.py) and
/// summary.txt into the folder of the campaign.   @return the summary
std::string write_report(const Campaign &campaign, const CampaignPlan &plan);
} // namespace isostat
