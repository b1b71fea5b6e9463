// SPDX-License-Identifier: BSD-3-Clause
// How elements come to their stress in situ.
#include "base/error.hpp"
#include "base/files/bytes.hpp"
#include "coupling/batch/rve_material.hpp"
#include "coupling/in_situ/in_situ_cache.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double max_miss = 0.01; ///< of p'

Bytes to_bytes(const std::vector<InSituState> &states)
{
  ByteWriter out;
  out.count(states.size());
  for (const InSituState &state : states)
    {
      out.text(state.recipe), out.text(state.source);
      out.block(state.packed);
    }
  return out.take();
}

void append_states(std::vector<InSituState> &states, const Bytes &bytes)
{
  ByteReader in(bytes, "rve");
  for (std::uint64_t n = in.count(); n > 0; --n)
    {
      InSituState &state = states.emplace_back();
      state.recipe = in.text(), state.source = in.text();
      const auto block = in.block();
      state.packed.assign(block.begin(), block.end());
    }
}

void check_reached(const Mat3 &stress, const Mat3 &wanted, InSituPath path)
{
  const Mat3 miss = (stress - wanted) / (stress.trace() / 3);
  const double worst = path == InSituPath::all_stresses ? miss.cwiseAbs().maxCoeff() : std::abs(miss(2, 2));
  if (!(worst <= max_miss))
    throw RunFailure(fmt::format("the stress in situ is missed by {:.2g} of p', more than {:g}: the packing is not at "
                                 "rest. Lower the tolerance of its preparation.",
                                 worst, max_miss));
}
} // namespace

/// What this rank's elements need.
struct RveMaterial::Jobs
{
  struct Start
  {
    Snapshot specimen;
    std::string source;
  };
  std::map<std::string, Start> starts;          ///< by name of the library's entry, or number of the element
  std::map<std::size_t, std::string> start_of;  ///< id -> start
  std::map<std::size_t, std::string> recipe_of; ///< id -> recipe
  std::map<std::size_t, Mat3> wanted;           ///< id -> stress in the specimen's axes
  std::map<std::string, std::size_t> first_of;  ///< recipe -> the element that prepares it
  std::map<std::string, Snapshot> ready;        ///< recipe -> specimen at its stress
  std::map<std::size_t, Bytes> prepared;        ///< of the elements in first_of that were not ready
};

RveMaterial::Jobs RveMaterial::jobs_for(std::span<const Stress> effective) const
{
  Jobs jobs;
  const std::vector<LibraryEntry> entries =
      requests_.empty() ? std::vector<LibraryEntry>{} : list_library(settings_.library);
  const InSituCache cache(settings_.cache);
  for (std::size_t id : all_)
    {
      if (!is_mine(id))
        continue;
      const Mat3 wanted = column_frame().transpose() * to_matrix(effective[point_of(id)]) * column_frame();
      std::string start = std::to_string(id), source;
      if (!requests_.empty())
        {
          SpecimenRequest request = requests_[point_of(id)];
          request.realisation += id % settings_.realisations;
          start = source = nearest_entry(entries, request, -wanted(1, 1), -0.5 * (wanted(0, 0) + wanted(2, 2))).name;
        }
      if (!jobs.starts.contains(start))
        jobs.starts[start] = {requests_.empty() ? elements_[id]->rve().assembly().snapshot()
                                                : read_library_entry(settings_.library, start).state,
                              source};
      const std::string recipe =
          in_situ_recipe(jobs.starts[start].specimen, wanted, settings_.motion, settings_.in_situ);
      jobs.start_of[id] = start;
      jobs.recipe_of[id] = recipe;
      jobs.wanted[id] = wanted;
      if (!jobs.first_of.try_emplace(recipe, id).second)
        continue;
      if (auto found = cache.find(recipe))
        jobs.ready[recipe] = std::move(*found);
      else
        jobs.prepared[id];
    }
  return jobs;
}

void RveMaterial::keep(const Jobs &jobs) const
{
  if (settings_.cache.empty())
    return;
  std::vector<InSituState> mine;
  for (const auto &[id, packed] : jobs.prepared)
    mine.push_back({jobs.recipe_of.at(id), jobs.starts.at(jobs.start_of.at(id)).source, packed});
  std::vector<InSituState> all;
  for (const Bytes &bytes : exchange_.gather(to_bytes(mine)))
    append_states(all, bytes);
  InSituCache(settings_.cache).add(all); // on rank 0, nothing elsewhere
}

void RveMaterial::set_initial_stress(std::span<const Stress> effective)
{
  if (effective.size() != n_points_)
    throw RunFailure(fmt::format("rve: stresses of {} points, but it has {}", effective.size(), n_points_));
  Jobs jobs;
  const auto together = [&](const std::function<void()> &work) {
    std::optional<Exchange::Failure> failure;
    try
      {
        work();
      }
    catch (const InputError &error)
      {
        failure = {n_elements(), fmt::format("rve: {}", error.what()), true};
      }
    catch (const std::exception &error)
      {
        failure = {n_elements(), fmt::format("rve: {}", error.what()), false};
      }
    exchange_.stop_together(failure);
  };
  rollback();
  if (requests_.empty())
    exchange_.stop_together(for_mine([&](std::size_t id) { elements_[id]->rollback(); }));
  together([&] { jobs = jobs_for(effective); });
  exchange_.stop_together(for_mine([&](std::size_t id) {
    const auto job = jobs.prepared.find(id);
    if (job != jobs.prepared.end())
      job->second = bring_to_stress(jobs.starts.at(jobs.start_of.at(id)).specimen, jobs.wanted.at(id), settings_.motion,
                                    settings_.in_situ);
  }));
  together([&] {
    keep(jobs);
    for (const auto &[id, packed] : jobs.prepared)
      jobs.ready[jobs.recipe_of[id]] = specimen_of(packed);
  });
  exchange_.stop_together(for_mine([&](std::size_t id) {
    auto element = make_element(Rve(jobs.ready.at(jobs.recipe_of.at(id)), element_settings()));
    check_reached(element->rve().stress(), to_matrix(effective[point_of(id)]), settings_.in_situ.path);
    elements_[id] = std::move(element);
  }));
  start();
}
} // namespace isostat
