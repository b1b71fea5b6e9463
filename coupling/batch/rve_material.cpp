// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/batch/rve_material.hpp"

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "coupling/element/axes.hpp"
#include "fem/material/wave_moduli.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace isostat
{
namespace
{
constexpr std::uint64_t version = 2; ///< of the bytes

/// 1 - m m^T/3: strain without its volume.
Stiffness deviator()
{
  Stiffness d = Stiffness::Identity();
  d.topLeftCorner<3, 3>().array() -= 1.0 / 3;
  return d;
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
  balance.check();
  refresh.check();
}

ElementSettings RveMaterialSettings::element() const
{
  ElementSettings settings;
  settings.rve.motion = motion;
  settings.rve.frame = column_frame();
  settings.rve.min_steps = min_steps;
  if (drive.on)
    settings.rve.stepping = drive;
  settings.undrained = undrained;
  settings.halvings = halvings;
  return settings;
}

RveMaterial::RveMaterial(std::size_t n_points, const RveMaterialSettings &settings, MPI_Comm comm)
    : settings_((settings.check(), settings)),
      batch_({n_points, settings.realisations}, settings.element(), settings.threads, comm), increments_(n_points),
      meter_(batch_.size()), waves_(batch_.size(), settings.refresh)
{}

RveMaterial::RveMaterial(std::vector<SpecimenRequest> points, const RveMaterialSettings &settings, MPI_Comm comm)
    : RveMaterial(points.size(), settings, comm)
{
  requests_ = std::move(points);
}

RveMaterial::RveMaterial(const std::vector<Snapshot> &specimens, const RveMaterialSettings &settings, MPI_Comm comm)
    : RveMaterial(specimens.size() / std::max<std::size_t>(1, settings.realisations), settings, comm)
{
  if (specimens.size() != batch_.size())
    throw InputError(fmt::format("rve: {} specimens cannot be shared out as {} for each point", specimens.size(),
                                 settings.realisations));
  make([&](std::size_t id) { return Rve(specimens[id], element_settings().rve); });
}

void RveMaterial::make(const std::function<Rve(std::size_t)> &maker)
{
  batch_.make(maker);
  waves_.clear();
  tangents_.clear();
}

InSituStart RveMaterial::in_situ_start(const InSituCache &cache, std::span<const Stress> effective) const
{
  InSituStart start(settings_.motion, settings_.in_situ, cache);
  std::map<std::string, NearestSpecimens> libraries; // by file
  for (std::size_t id = 0; id < batch_.size(); ++id)
    {
      if (!batch_.is_mine(id))
        continue;
      const std::size_t point = points().point_of(id);
      const Mat3 target = column_frame().transpose() * to_matrix(effective[point]) * column_frame();
      std::shared_ptr<const StartingSpecimen> specimen;
      if (!requests_.empty())
        {
          SpecimenRequest request = requests_[point];
          request.realisation = request.seed_of(id % settings_.realisations);
          const std::string &file = request.library.empty() ? settings_.library : request.library;
          NearestSpecimens &library = libraries.try_emplace(file, file).first->second;
          specimen = library.find(request, -target(1, 1), -0.5 * (target(0, 0) + target(2, 2)));
        }
      else
        specimen =
            std::make_shared<StartingSpecimen>(StartingSpecimen{batch_.element(id)->rve().assembly().snapshot(), {}});
      start.add(id, specimen, target);
    }
  return start;
}

/// Of each density of each library the first point with the largest shear on horizontal planes over p'; none without
/// shear, and none of elements that were given as they are.
std::vector<bool> RveMaterial::most_sheared(std::span<const Stress> effective) const
{
  std::map<std::pair<std::string, std::optional<double>>, std::pair<double, std::size_t>> largest;
  for (std::size_t point = 0; point < requests_.size(); ++point)
    {
      const Mat3 stress = to_matrix(effective[point]);
      const double ratio = std::hypot(stress(2, 0), stress(2, 1)) / -stress.trace();
      auto &[most, where] = largest[{requests_[point].library, requests_[point].relative_density}];
      if (ratio > most)
        most = ratio, where = point;
    }
  std::vector<bool> points(n_points(), false);
  for (const auto &[sand, most] : largest)
    if (most.first > 0)
      points[most.second] = true;
  return points;
}

void RveMaterial::set_initial_stress(std::span<const Stress> effective)
{
  if (effective.size() != n_points())
    throw RunFailure(fmt::format("rve: stresses of {} points, but it has {}", effective.size(), n_points()));
  rollback();
  std::optional<InSituCache> cache;
  std::optional<InSituStart> start;
  batch_.together([&] {
    cache.emplace(settings_.cache);
    start.emplace(in_situ_start(*cache, effective));
  });
  if (const std::vector<bool> first = most_sheared(effective); std::ranges::find(first, true) != first.end())
    batch_.for_each([&](std::size_t id) {
      if (first[points().point_of(id)])
        start->prepare(id);
    });
  batch_.for_each([&](std::size_t id) { start->prepare(id); });
  batch_.together([&] {
    if (settings_.cache.empty())
      return;
    std::vector<InSituState> all;
    for (const Bytes &bytes : batch_.exchange().gather(to_bytes(start->prepared())))
      append_states(all, bytes);
    cache->add(all); // on rank 0, nothing elsewhere
  });
  make([&](std::size_t id) {
    Rve rve(start->specimen(id), element_settings().rve);
    check_reached(rve.stress(), to_matrix(effective[points().point_of(id)]), settings_.in_situ.path);
    return rve;
  });
}

void RveMaterial::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  if (increments.size() != n_points() || stresses.size() != n_points())
    throw RunFailure(fmt::format("rve: increments of {} points and stresses of {}, but it has {}", increments.size(),
                                 stresses.size(), n_points()));
  const Stopwatch watch;
  std::ranges::copy(increments, increments_.begin());
  tangents_.clear();
  batch_.trial(increments);
  points().mean(batch_.trial_stress(), stresses);
  count_trial();
  cost_.batch_seconds += watch.seconds();
}

void RveMaterial::count_trial()
{
  std::vector<double> costs;
  for (const ElementRow &row : batch_.rows())
    {
      costs.push_back(row.seconds);
      cost_.rve_seconds += row.seconds;
      cost_.steps += row.steps;
    }
  meter_.add_trial(costs);
  ++cost_.trials;
}

void RveMaterial::commit()
{
  if (!batch_.commit())
    return;
  waves_.commit(batch_.committed_stress());
  if (waves_.n_commits() % settings_.balance.interval == 0)
    place(rebalanced(meter_.means(), owners(), batch_.exchange().size(), settings_.balance));
}

void RveMaterial::rollback()
{
  if (batch_.has_trial())
    tangents_.clear();
  batch_.rollback();
}

const Rve *RveMaterial::element(std::size_t point, std::size_t realisation) const
{
  const RveElement *element = batch_.element(points().id_of(point, realisation));
  return element ? &element->rve() : nullptr;
}

const std::vector<Stiffness> &RveMaterial::element_tangents() const
{
  batch_.check_made();
  if (!tangents_.empty())
    return tangents_;
  const TimedScope timed(cost_.wave_seconds);
  std::vector<std::array<double, 36>> rows(batch_.size());
  batch_.for_each([&](std::size_t id) {
    Eigen::Map<Stiffness> row(rows[id].data());
    row = batch_.element(id)->rve().stiffness(Sliding::plastic);
  });
  batch_.share(std::span(rows));
  for (const auto &row : rows)
    tangents_.emplace_back(Eigen::Map<const Stiffness>(row.data()));
  cost_.stiffnesses += rows.size();
  return tangents_;
}

void RveMaterial::stiffness(std::span<Stiffness> tangents) const
{
  points().mean(std::span(element_tangents()), tangents);
  if (settings_.undrained)
    for (Stiffness &c : tangents)
      c = (c * deviator()).eval();
}

void RveMaterial::refresh_waves() const
{
  const std::vector<std::size_t> due = waves_.due();
  if (due.empty())
    return;
  const TimedScope timed(cost_.wave_seconds);
  std::vector<WaveModuli> found(batch_.size());
  batch_.for_each([&](std::size_t id) {
    if (waves_.is_due(id))
      found[id] = max_wave_moduli(batch_.element(id)->at_committed([](const Rve &rve) { return rve.stiffness(); }));
  });
  batch_.share(due, std::span(found));
  for (std::size_t id : due)
    waves_.set(id, found[id], batch_.committed_stress()[id]);
  cost_.stiffnesses += due.size();
}

void RveMaterial::wave_moduli(std::span<WaveModuli> moduli) const
{
  batch_.check_made();
  refresh_waves();
  points().mean(waves_.moduli(), moduli);
}

MaterialState RveMaterial::pack() const
{
  batch_.check_made();
  ByteWriter out;
  out.text(name());
  out.count(version), out.count(settings_.realisations), out.count(settings_.undrained), out.count(waves_.n_commits());
  MaterialState state{out.take(), std::vector<Bytes>(n_points())};
  ByteWriter point; // elements come point by point
  batch_.pack([&](std::size_t id, const Bytes &packed) {
    waves_.write(id, point);
    point.block(packed);
    if ((id + 1) % settings_.realisations == 0)
      state.points[points().point_of(id)] = std::exchange(point, {}).take();
  });
  return state;
}

void RveMaterial::unpack(const MaterialState &state)
{
  ByteReader in(state.common, name());
  in.expect(in.text(), name());
  in.expect(in.count(), version, "as their version");
  in.expect(in.count(), settings_.realisations, "realisations");
  in.expect(in.count(), settings_.undrained, "as their drainage (1 is undrained)");
  WaveModuliCache waves(batch_.size(), settings_.refresh);
  waves.set_commits(in.count());
  in.expect_end();
  in.expect(state.points.size(), n_points(), "points");
  std::vector<std::span<const std::byte>> blocks(batch_.size());
  for (std::size_t p = 0; p < n_points(); ++p)
    {
      ByteReader point(state.points[p], name());
      for (std::size_t id = p * settings_.realisations; id < (p + 1) * settings_.realisations; ++id)
        {
          waves.read(id, point);
          blocks[id] = point.block();
        }
      point.expect_end();
    }
  make([&](std::size_t id) { return Rve::unpack(blocks[id], element_settings().rve); });
  waves_ = std::move(waves);
}
} // namespace isostat
