// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/in_situ/in_situ_start.hpp"

#include <utility>

namespace isostat
{
void InSituStart::add(std::size_t id, std::shared_ptr<const StartingSpecimen> start, const Mat3 &target)
{
  std::string recipe = in_situ_recipe(start->state, target, motion_, settings_);
  if (const auto [result, is_new] = results_.try_emplace(recipe, Result{id, {}, {}}); is_new)
    result->second.specimen = cache_.find(recipe);
  jobs_[id] = {std::move(start), target, std::move(recipe)};
}

void InSituStart::prepare(std::size_t id)
{
  const Job &job = jobs_.at(id);
  Result &result = results_.at(job.recipe);
  if (result.first != id || result.specimen)
    return;
  result.packed = bring_to_stress(job.start->state, job.target, motion_, settings_);
  result.specimen = specimen_of(result.packed);
}

std::vector<InSituState> InSituStart::prepared() const
{
  std::vector<InSituState> states;
  for (const auto &[id, job] : jobs_)
    if (const Result &result = results_.at(job.recipe); result.first == id && !result.packed.empty())
      states.push_back({job.recipe, job.start->source, result.packed});
  return states;
}

const Snapshot &InSituStart::specimen(std::size_t id) const { return *results_.at(jobs_.at(id).recipe).specimen; }
} // namespace isostat
