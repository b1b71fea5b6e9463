// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/compact.hpp"

#include "base/error.hpp"
#include "dem/measure/stress.hpp"
#include "dem/prepare/random.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double compressed_balance = 2e-3, rebalanced = 2e-4, at_rest = 5e-5;
constexpr int rest_attempts = 5; // a packing on the verge can collapse while its walls are held
constexpr double shaking = 0.1;  // largest velocity of opened packings over sqrt(p/rho)
constexpr double k0_start = 0.1; // of the vertical stress: isotropic pressure from which K0 consolidation begins

/// Runs a stage on a state and returns what it ends with. Rattlers are not damped: a cloud consists of them.
Snapshot run_stage(const Snapshot &initial, const Stage &stage, double damping, const Preparation &how)
{
  const Programme programme{
      .motion = {.contact_damping = 0, .damping = damping, .free_grain_damping = 0, .carry_grains = false},
      .servo = how.specimen,
      .record = {.snapshots = "none"},
      .stages = {stage}};
  Assembly assembly(initial, {.threads = how.threads});
  DriveState state;
  if (run_programme(programme, assembly, state, how.observer) == RunOutcome::interrupted)
    throw Interrupted("interrupted while the specimen was prepared; nothing is kept of it");
  assembly.compute_forces();
  Snapshot end = assembly.snapshot();
  end.step = 0;
  end.time = 0;
  return end;
}

/// Rattlers fly on forever, because local damping only acts on forces: they would disturb an element that should rest.
void stop_grains(Packing &grains)
{
  for (std::size_t i = 0; i < grains.n_grains(); ++i)
    {
      grains.set_linear_velocity(i, Vec3::Zero());
      grains.set_angular_velocity(i, Vec3::Zero());
    }
}

/// @param pressure  Pa   @param balance  unbalanced-force ratio at the end
template <class Kind>
Stage servo_stage(double pressure, double balance)
{
  Kind stage;
  stage.pressure = pressure;
  stage.balance = balance;
  return stage;
}
} // namespace

Snapshot opened(Snapshot packing, const SpecimenSpec &specimen, std::uint64_t seed)
{
  const double stretch = 1 + specimen.expansion;
  packing.contacts.clear();
  packing.wall_contacts.clear();
  packing.box = {stretch * packing.box.lower, stretch * packing.box.upper};
  if (packing.cell)
    {
      packing.cell->edges *= stretch;
      packing.cell->deformation *= stretch;
      packing.cell->volume_strain += 3 * std::log(stretch);
    }
  Packing &grains = packing.grains;
  const double fastest = shaking * std::sqrt(specimen.pressure / grains.density);
  Vec3 momentum = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < grains.n_grains(); ++i)
    {
      const auto u = uniform(seed, RandomStream::shaking, grains.id[i]);
      grains.set_centre(i, stretch * grains.centre(i));
      grains.set_linear_velocity(i, fastest * (2 * Vec3(u[0], u[1], u[2]) - Vec3::Ones()));
      momentum += grains.mass(i) * grains.linear_velocity(i);
      mass += grains.mass(i);
    }
  for (std::size_t i = 0; i < grains.n_grains(); ++i)
    grains.set_linear_velocity(i, grains.linear_velocity(i) - momentum / mass);
  return packing;
}

Snapshot compact(const Cloud &cloud, Law law, double friction, const Preparation &how)
{
  const SpecimenSpec &specimen = how.specimen;
  const Law of_test = law;
  if (law->friction > 0)
    law->friction = friction;
  Snapshot start;
  start.grains = cloud.packing;
  start.box = cloud.box;
  if (specimen.domain == "periodic-cell")
    start.cell = PeriodicCell::with_edges(cloud.box.edges());
  start.law = law;
  const double pressure = specimen.consolidation == "k0" ? k0_start * specimen.pressure : specimen.pressure;
  Compress stage;
  stage.of_cloud = true;
  stage.pressure = pressure;
  stage.balance = compressed_balance;
  start = run_stage(start, stage, specimen.damping, how);
  if (specimen.expansion == 0)
    return start;
  start.law = of_test;
  return run_stage(opened(start, specimen, cloud.seed), stage, specimen.damping, how);
}

Snapshot rebalance(const Snapshot &compacted, const Law &law, const Preparation &how)
{
  const SpecimenSpec &specimen = how.specimen;
  Snapshot start = compacted;
  start.law = law;
  const Stage consolidate = specimen.consolidation == "k0" ? servo_stage<K0Compress>(specimen.pressure, rebalanced)
                                                           : servo_stage<Rebalance>(specimen.pressure, rebalanced);
  Hold hold;
  hold.balance = at_rest;
  Snapshot rest;
  for (int attempt = 0; attempt < rest_attempts; ++attempt)
    {
      const Snapshot balanced = run_stage(start, consolidate, specimen.damping, how);
      rest = run_stage(balanced, hold, 0.5, how);
      if (-contact_stress(rest)(1, 1) > 0.95 * specimen.pressure)
        break;
      if (attempt + 1 == rest_attempts)
        throw RunFailure(fmt::format("the specimen lost its pressure each of the {} times it was brought to rest: so "
                                     "loose a packing is not stable. Lower the preparation friction.",
                                     rest_attempts));
      start = rest;
    }
  if (rest.cell)
    stop_grains(rest.grains);
  return rest;
}
} // namespace isostat
