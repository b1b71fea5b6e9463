// SPDX-License-Identifier: BSD-3-Clause
// The batch: trial, commit, rollback, and who computes what. Elements, initial stress, stiffness and bytes are in
// files of their own.
#include "coupling/batch/rve_material.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <omp.h>
#include <utility>

namespace isostat
{
namespace
{
constexpr std::size_t row_width = 9; ///< stress (6), seconds, steps, failed
constexpr double forget = 0.1;       ///< weight of the last trial in the running mean of costs

double seconds_since(std::chrono::steady_clock::time_point begin)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}
} // namespace

void RveMaterialSettings::check() const
{
  if (realisations == 0)
    throw InputError("rve: realisations = 0; a point needs at least one element");
  if (halvings > 20)
    throw InputError(fmt::format("rve: halvings = {}; at most 20 (a million parts)", halvings));
  if (threads < 0)
    throw InputError(fmt::format("rve: threads = {}; must be >= 0", threads));
  if (!(balance.threshold >= 1 && balance.min_gain >= 0) || balance_interval == 0)
    throw InputError("rve: the threshold of balance must be >= 1, the smallest gain >= 0, the interval > 0");
  if (!(refresh_rise > 0) || refresh_interval == 0)
    throw InputError("rve: refresh_rise and refresh_interval must be positive");
}

RveMaterial::RveMaterial(std::size_t n_points, const RveMaterialSettings &settings, MPI_Comm comm)
    : settings_(settings), n_points_(n_points), exchange_(comm)
{
  settings_.check();
  if (settings_.threads == 0)
    settings_.threads = omp_get_max_threads();
  const std::size_t n = n_points * settings_.realisations;
  costs_.assign(n, 1.0);
  owners_ = longest_first(costs_, exchange_.size());
  order_ = costliest_first(costs_, owners_, exchange_.rank());
  all_.resize(n);
  std::iota(all_.begin(), all_.end(), std::size_t{0});
  elements_.resize(n);
  increments_.assign(n_points, Gradient{});
  committed_.assign(n, Stress{});
  trial_.assign(n, Stress{});
  rows_.assign(row_width * n, 0.0);
  waves_.resize(n);
  skeleton_.resize(n);
}

RveMaterial::RveMaterial(std::vector<SpecimenRequest> points, const RveMaterialSettings &settings, MPI_Comm comm)
    : RveMaterial(points.size(), settings, comm)
{
  requests_ = std::move(points);
}

RveMaterial::RveMaterial(const std::vector<Snapshot> &specimens, const RveMaterialSettings &settings, MPI_Comm comm)
    : RveMaterial(specimens.size() / std::max<std::size_t>(1, settings.realisations), settings, comm)
{
  if (specimens.size() != n_elements())
    throw InputError(fmt::format("rve: {} specimens cannot be shared out as {} for each point", specimens.size(),
                                 settings.realisations));
  exchange_.stop_together(
      for_mine([&](std::size_t id) { elements_[id] = make_element(Rve(specimens[id], element_settings())); }));
  start();
}

std::string RveMaterial::label(std::size_t id) const
{
  if (settings_.realisations == 1)
    return fmt::format("rve: point {}", point_of(id));
  return fmt::format("rve: point {}, realisation {}", point_of(id), id % settings_.realisations);
}

std::optional<Exchange::Failure> RveMaterial::for_mine(const std::function<void(std::size_t)> &work) const
{
  std::optional<Exchange::Failure> first;
  const auto failed = [&](std::size_t id, const char *what, bool bad_input) {
#pragma omp critical(isostat_rve_material_failure)
    if (!first || id < first->element)
      first = Exchange::Failure{id, label(id) + ": " + what, bad_input};
  };
#pragma omp parallel for schedule(dynamic, 1) num_threads(settings_.threads) if (settings_.threads > 1)
  for (std::size_t k = 0; k < order_.size(); ++k)
    try
      {
        work(order_[k]);
      }
    catch (const InputError &error)
      {
        failed(order_[k], error.what(), true);
      }
    catch (const std::exception &error)
      {
        failed(order_[k], error.what(), false);
      }
  return first;
}

/// Elements have their stress: what is known of them on all ranks starts here.
void RveMaterial::start()
{
  constexpr std::size_t width = 6;
  std::vector<double> rows(width * n_elements(), 0.0);
  for (std::size_t id : order_)
    std::ranges::copy(to_stress(elements_[id]->rve().stress()), &rows[width * id]);
  exchange_.share(all_, owners_, width, rows);
  for (std::size_t id = 0; id < n_elements(); ++id)
    std::copy_n(&rows[width * id], 6, committed_[id].begin());
  std::ranges::fill(waves_, Wave{});
  skeleton_known_ = has_trial_ = false;
  commits_ = 0;
  ready_ = true;
}

void RveMaterial::check_ready() const
{
  if (!ready_)
    throw RunFailure("rve: the elements have no stress yet; call set_initial_stress() first");
}

void RveMaterial::run_element(std::size_t id, const Gradient &increment)
{
  const auto begin = std::chrono::steady_clock::now();
  double *row = &rows_[row_width * id];
  std::string reason;
  row[7] = row[8] = 0;
  try
    {
      const ElementTrial result = elements_[id]->trial(to_matrix(increment));
      std::ranges::copy(to_stress(result.stress), row);
      row[7] = static_cast<double>(result.steps);
      row[8] = result.accepted ? 0 : 1;
      if (!result.accepted)
        reason = fmt::format("an increment of displacement gradient of {:.3g} cannot be taken, in {} parts neither: {}",
                             to_matrix(increment).norm(), 1u << settings_.halvings, result.reason);
    }
  catch (const std::exception &error)
    {
      row[8] = 1;
      reason = error.what();
    }
  row[6] = seconds_since(begin);
  if (row[8] != 0)
    {
#pragma omp critical(isostat_rve_material_failure)
      reasons_[id] = reason;
    }
}

void RveMaterial::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  check_ready();
  if (increments.size() != n_points_ || stresses.size() != n_points_)
    throw RunFailure(fmt::format("rve: increments of {} points and stresses of {}, but it has {}", increments.size(),
                                 stresses.size(), n_points_));
  const auto begin = std::chrono::steady_clock::now();
  has_trial_ = skeleton_known_ = false;
  std::ranges::copy(increments, increments_.begin());
  (void)for_mine([&](std::size_t id) { run_element(id, increments[point_of(id)]); });
  exchange_.share(all_, owners_, row_width, rows_);
  stop_if_failed();
  for (std::size_t id = 0; id < n_elements(); ++id)
    std::copy_n(&rows_[row_width * id], 6, trial_[id].begin());
  for (std::size_t point = 0; point < n_points_; ++point)
    stresses[point] = mean(trial_, point);
  has_trial_ = true;
  count_costs();
  cost_.batch_seconds += seconds_since(begin);
}

/// Every rank has seen the same rows: all come here to stop, or none.
void RveMaterial::stop_if_failed()
{
  bool failed = false;
  for (std::size_t id = 0; id < n_elements(); ++id)
    failed |= rows_[row_width * id + 8] != 0;
  if (!failed)
    return;
  std::optional<Exchange::Failure> mine;
  if (!reasons_.empty())
    mine = {reasons_.begin()->first, label(reasons_.begin()->first) + ": " + reasons_.begin()->second, false};
  reasons_.clear();
  (void)for_mine([&](std::size_t id) { elements_[id]->rollback(); });
  exchange_.stop_together(mine);
}

Stress RveMaterial::mean(const std::vector<Stress> &stresses, std::size_t point) const
{
  const std::size_t n = settings_.realisations;
  if (n == 1)
    return stresses[point];
  Stress sum{};
  for (std::size_t k = 0; k < n; ++k)
    for (int c = 0; c < 6; ++c)
      sum[c] += stresses[n * point + k][c];
  for (double &x : sum)
    x /= static_cast<double>(n);
  return sum;
}

void RveMaterial::scatter(std::span<Stress> deviations) const
{
  const std::size_t n = settings_.realisations;
  for (std::size_t point = 0; point < n_points_; ++point)
    {
      const Stress middle = mean(committed_, point);
      for (int c = 0; c < 6; ++c)
        {
          double sum = 0;
          for (std::size_t k = 0; k < n; ++k)
            sum += std::pow(committed_[n * point + k][c] - middle[c], 2);
          deviations[point][c] = n > 1 ? std::sqrt(sum / static_cast<double>(n - 1)) : 0;
        }
    }
}

double RveMaterial::steps_of(std::size_t point, std::size_t realisation) const
{
  return rows_[row_width * (point * settings_.realisations + realisation) + 7];
}

void RveMaterial::count_costs()
{
  std::vector<double> loads(exchange_.size(), 0.0);
  double steps = 0;
  for (std::size_t id = 0; id < n_elements(); ++id)
    {
      const double seconds = rows_[row_width * id + 6];
      costs_[id] = cost_.trials == 0 ? seconds : (1 - forget) * costs_[id] + forget * seconds;
      loads[owners_[id]] += seconds;
      cost_.rve_seconds += seconds;
      steps += rows_[row_width * id + 7];
    }
  cost_.busiest_seconds += *std::ranges::max_element(loads);
  cost_.steps += static_cast<std::uint64_t>(steps);
  ++cost_.trials;
}

void RveMaterial::commit()
{
  if (!has_trial_)
    return;
  has_trial_ = false;
  const std::optional<Exchange::Failure> failure = for_mine([&](std::size_t id) { elements_[id]->commit(); });
  if (failure)
    throw RunFailure(failure->message);
  std::swap(committed_, trial_);
  ++commits_;
  mark_due();
  if (commits_ % settings_.balance_interval == 0)
    balance();
}

void RveMaterial::rollback()
{
  if (has_trial_)
    skeleton_known_ = false;
  has_trial_ = false; // elements go back when they are asked for something
}

void RveMaterial::balance()
{
  if (exchange_.size() > 1)
    place(rebalanced(costs_, owners_, exchange_.size(), settings_.balance));
  else if (settings_.threads > 1)
    order_ = costliest_first(costs_, owners_, exchange_.rank());
}
} // namespace isostat
