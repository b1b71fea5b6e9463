// SPDX-License-Identifier: BSD-3-Clause
// What drivers remember from step to step, by concept. Stresses and strains here are in the soil-mechanics convention
// (compression positive) because q_amp and p' are.
//
// Every struct lists its fields once (base/fields.hpp): checkpoints (dem/io/checkpoint.cpp) and packed elements
// (dem/rve/rve_bytes.cpp) go by that list.
// tested: tests/dem/io/checkpoint_test.cpp (every field comes back bit for bit)
#pragma once
#include "base/fields.hpp"
#include "dem/domain/rigid_box.hpp"

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace isostat
{
/// Where in the programme.
struct ProgrammePlace
{
  std::uint64_t stage = 0; ///< its number in the programme
  std::uint64_t steps = 0; ///< of this stage so far
  std::uint64_t done = 0;  ///< stages that are over, each as often as it was repeated

  ISOSTAT_FIELDS(stage, steps, done)
};

/// How fast a packing is strained.
struct Pace
{
  double rate = 0;      ///< bound on the driven strain rate, 1/s
  double load_rate = 0; ///< bound on |d load/dt|, Pa/s; 0: none
  double time_step = 0; ///< s
  double indicator = 0; ///< quasi-static error indicator of the last control, see rate_control.hpp; of a static drive
                        ///< the imbalance that the last increment has left [-]

  ISOSTAT_FIELDS(rate, load_rate, time_step, indicator)
};

enum class LoadDirection
{
  compression, ///< in simple shear towards positive gamma_xy
  extension
};

constexpr LoadDirection last_of(LoadDirection) { return LoadDirection::extension; } ///< for reading checkpoints

/// +1 in compression, -1 in extension.
constexpr double sign(LoadDirection direction) { return direction == LoadDirection::compression ? 1 : -1; }
constexpr LoadDirection opposite(LoadDirection direction)
{
  return direction == LoadDirection::compression ? LoadDirection::extension : LoadDirection::compression;
}

/// The driven load of this stage: its strain rate ramps, and brakes before a reversal by the slope of the load.
struct Loading
{
  double strain = 0;      ///< driven in this stage: axial logarithmic compression, or gamma_xy [-]
  double signed_rate = 0; ///< 1/s, compression positive; ramps towards sign(direction) * Pace::rate
  LoadDirection direction = LoadDirection::compression;
  double slope = 0;                          ///< |d load/d strain|, Pa
  double window_load = 0, window_strain = 0; ///< where the window began that the slope is taken over, Pa and [-]
  std::uint64_t window_steps = 0;            ///< since then
  double begun_load = 0, begun_strain = 0;   ///< where this direction began, Pa and [-]
  double half_cycle = 0;                     ///< share of the way to the next turn that is done, 0..1; never falls

  ISOSTAT_FIELDS(strain, signed_rate, direction, slope, window_load, window_strain, window_steps, begun_load,
                 begun_strain, half_cycle)
};

/// The last increment of a static drive: from its answer the next one learns moduli, where stresses are kept.
struct LastIncrement
{
  Vec3 strain = Vec3::Zero(); ///< along x, y, z, tension positive [-]
  double gamma = 0;           ///< of a cell [-]
  double driven = 0;          ///< of the component that a stage drives, amount [-]
  // where stresses are kept (dem/drive/servo.hpp): sigma and tau before it, compression positive, and moduli, Pa
  Vec3 stress = Vec3::Zero();
  double tau = 0;
  Vec3 moduli_x = Vec3::Zero(), moduli_y = Vec3::Zero(), moduli_z = Vec3::Zero(); ///< rows d sigma_i / d eps_j
  Vec3 by_gamma = Vec3::Zero(), of_tau = Vec3::Zero(); ///< d sigma_i / d gamma, d tau / d eps_j
  double shear_modulus = 0;

  ISOSTAT_FIELDS(strain, gamma, driven, stress, tau, moduli_x, moduli_y, moduli_z, by_gamma, of_tau, shear_modulus)
};

/// The specimen when the first shear stage began: what strains and p'/p0 count from.
struct ShearStart
{
  Vec3 edges = Vec3::Zero(); ///< of the box, m
  double p0 = 0;             ///< mean effective stress, Pa

  ISOSTAT_FIELDS(edges, p0)
};

/// The effective stress from which the volume is kept: what excess pore pressure counts from.
struct UndrainedStart
{
  double stress = 0;     ///< p', or the vertical one, Pa
  bool vertical = false; ///< in simple shear

  ISOSTAT_FIELDS(stress, vertical)
};

/// The way that the specimen went.
struct PathState
{
  RigidBox reference;                      ///< box at the start of this stage
  Vec3 lateral_target = Vec3::Zero();      ///< stresses at the start of this shear stage: kept laterally if drained, Pa
  std::optional<ShearStart> start;         ///< none before the first shear stage
  Vec3 cell_strain = Vec3::Zero();         ///< of a cell: sum of L dt along x, y, z since then, tension positive [-]
  double gamma = 0;                        ///< of a cell: sum of L_xy dt since then [-]
  std::optional<UndrainedStart> undrained; ///< none while water drains

  double p0() const { return start ? start->p0 : 0.0; }
  /// p0', or before the specimen is sheared the mean stress with which the present stage began, Pa.
  double reference_pressure() const { return start ? start->p0 : lateral_target.mean(); }

  template <class Self, class F>
  static void for_each(Self &self, F &&f)
  {
    auto &[reference_, lateral_target_, start_, cell_strain_, gamma_, undrained_] = self;
    f("reference_lower", reference_.lower), f("reference_upper", reference_.upper);
    f("lateral_target", lateral_target_), f("start", start_), f("cell_strain", cell_strain_), f("gamma", gamma_);
    f("undrained", undrained_);
  }
};

/// How far the present stage has come, if it is a path (dem/drive/stages/path.hpp). Compression positive.
struct PathProgress
{
  Vec3 stress = Vec3::Zero();  ///< sigma_x, sigma_y, sigma_z when it began, Pa
  double tau = 0;              ///< sigma_xy then, Pa
  double volume = 0;           ///< then, m3
  std::uint64_t reversals = 0; ///< before it
  std::uint64_t table = 0;     ///< PathTable::hash() of its course
  double place = 0;            ///< on its course, s or [-]
  Vec3 strain = Vec3::Zero();  ///< so far, along x, y, z [-]
  double gamma = 0;            ///< so far [-]

  ISOSTAT_FIELDS(stress, tau, volume, reversals, table, place, strain, gamma)
};

/// What a stress servo continues from.
struct ServoState
{
  Vec3 step = Vec3::Zero();          ///< of the step before: wall displacement, m per wall, inward positive; of a cell
                                     ///< strain [-], tension positive
  Vec3 shear = Vec3::Zero();         ///< of a cell: strain yz, xz, xy of the step before [-]
  Vec3 modulus = Vec3::Zero();       ///< of a cell: affine modulus along x, y, z, Pa
  std::uint64_t balanced_checks = 0; ///< consecutive checks in which the stage's balance held

  ISOSTAT_FIELDS(step, shear, modulus, balanced_checks)
};

/// The moment at which p'/p0 first fell below the ratio of its stage.
struct Liquefaction
{
  std::uint64_t step = 0, reversals = 0;
  double strain = 0; ///< driven, since the start of shearing [-]

  ISOSTAT_FIELDS(step, reversals, strain)
};

/// Strain softening under a load that should continue rising (dem/drive/stages/cyclic_response.hpp).
struct Softening
{
  std::uint64_t step = 0, reversals = 0; ///< when it counted as flow
  double strain = 0;                     ///< driven, since the start of shearing, at the peak [-]
  double peak = 0, lowest = 0;           ///< load there, and the least amount of it while it softened, Pa
  double direction = 1;                  ///< of the load then, 1 or -1
  bool recovered = false; ///< the load reached the turning point of that direction all the same: limited flow

  ISOSTAT_FIELDS(step, reversals, strain, peak, lowest, direction, recovered)
};

/// The present half cycle of a cyclic stage, and what came of those before.
struct CyclicResponse
{
  double peak = 0, peak_strain = 0; ///< largest load along the direction, Pa, and driven strain of the stage then
  double lowest = 0;                ///< least load along the direction since then, Pa
  double least_load = 0, largest_load = 0;  ///< of the last cyclic stage, Pa
  double least_strain = 0, most_strain = 0; ///< since the start of shearing [-]
  std::optional<Softening> flow;            ///< of all cyclic stages: the last that has not recovered

  ISOSTAT_FIELDS(peak, peak_strain, lowest, least_load, largest_load, least_strain, most_strain, flow)
};

/// What happened at constant volume, over all stages.
struct UndrainedRecord
{
  std::uint64_t reversals = 0;
  double worst_overshoot = 0; ///< of the load over its limit at a reversal, Pa
  std::optional<Liquefaction> liquefaction;
  double max_strain_before = 0; ///< largest |driven strain| before it [-]
  CyclicResponse response;      ///< of cyclic stages

  /// 0 as long as there is none.
  std::uint64_t reversals_to_liquefaction() const { return liquefaction ? liquefaction->reversals : 0; }

  ISOSTAT_FIELDS(reversals, worst_overshoot, liquefaction, max_strain_before, response)
};

/// The last row of the history, and the last snapshot.
struct RecordedState
{
  double p = 0, load = 0, strain = 0; ///< Pa, Pa, [-]
  std::optional<std::uint64_t> step;
  double snapshot_strain = 0;
  Vec3 stress = Vec3::Zero(), strains = Vec3::Zero(); ///< along x, y, z, Pa and [-]
  double tau = 0, gamma = 0;                          ///< of a cell, Pa and [-]

  ISOSTAT_FIELDS(p, load, strain, step, snapshot_strain, stress, strains, tau, gamma)
};

/// What a stage had reached when it ended, as far as its conditions of ending use it.
struct StageFigures
{
  double driven = 0;                            ///< strain driven in the stage, amount [-]
  double strain = 0;                            ///< the driven one since the start of shearing, amount [-]
  double volumetric = 0;                        ///< of the stage if it is a path, amount [-]
  double p = 0, q = 0;                          ///< Pa
  double unbalanced = 0;                        ///< force ratio [-]
  double stress_error = 0;                      ///< of stresses that are brought to a target, relative [-]
  double place = 0;                             ///< share of a path's course [-]
  std::uint64_t reversals = 0;                  ///< of the test
  std::uint64_t own_reversals = 0;              ///< of the stage
  std::optional<std::uint64_t> since_liquefied; ///< reversals; none: it has not liquefied

  ISOSTAT_FIELDS(driven, strain, volumetric, p, q, unbalanced, stress_error, place, reversals, own_reversals,
                 since_liquefied)
};

/// What ends a stage.
enum class EndCondition
{
  max_steps,
  strain,
  volumetric_strain,
  q,
  p,
  stress_ratio,
  cycles,
  reversals_after_liquefaction,
  balance,
  course ///< of a path that drives nothing
};
constexpr EndCondition last_of(EndCondition) { return EndCondition::course; }

/// How a stage ended (dem/drive/stages/stage_end.hpp).
struct StageEnd
{
  std::uint64_t stage = 0, done = 0; ///< its number, and the stages that were over then, each as often as repeated
  std::uint64_t step = 0;            ///< of the run
  std::uint64_t times = 0;           ///< that it ended so in all, where it is repeated; the rest is of the first time
  bool at_once = false;              ///< in its first step
  EndCondition by = EndCondition::max_steps;
  StageFigures figures;

  ISOSTAT_FIELDS(stage, done, step, times, at_once, by, figures)
};

/// What a stage is to have under control (dem/drive/control.hpp).
enum class ControlledQuantity
{
  sigma_x,
  sigma_y,
  sigma_z,
  tau_xy,
  indicator
};
constexpr ControlledQuantity last_of(ControlledQuantity) { return ControlledQuantity::indicator; }
inline constexpr std::size_t n_controlled = static_cast<std::size_t>(last_of(ControlledQuantity{})) + 1;

/// How far a controlled quantity went from where it should be, in one stage.
struct Deviation
{
  double strain = 0;            ///< driven while it was outside of its tolerance, amount [-]
  double worst = 0;             ///< relative, or the indicator [-]
  double value = 0, target = 0; ///< then, Pa; of the indicator [-]
  double began = 0;             ///< driven strain of the stage when it was outside for the first time, amount [-]
  std::uint64_t step = 0;       ///< of the stage, then
  bool told = false;            ///< it counts as lost, and the log says so

  ISOSTAT_FIELDS(strain, worst, value, target, began, step, told)
};

/// Control that a stage lost.
struct ControlLoss
{
  std::uint64_t stage = 0, done = 0; ///< its number, and the stages that were over then, each as often as repeated
  ControlledQuantity quantity = ControlledQuantity::sigma_x;
  Deviation deviation;
  double share = 0; ///< of the stage's strain that was driven meanwhile [-]

  ISOSTAT_FIELDS(stage, done, quantity, deviation, share)
};

/// Control in the present stage, and what was lost in those before.
struct ControlState
{
  double strain = 0;      ///< driven so far, amounts added up [-]
  double last_strain = 0; ///< Loading::strain at the last check
  Deviation sigma_x, sigma_y, sigma_z, tau_xy, indicator;
  std::vector<ControlLoss> losses;

  Deviation &of(ControlledQuantity quantity)
  {
    Deviation *const all[n_controlled] = {&sigma_x, &sigma_y, &sigma_z, &tau_xy, &indicator};
    return *all[static_cast<std::size_t>(quantity)];
  }
  /// Of a new stage; the losses stay.
  void restart()
  {
    ControlState fresh;
    fresh.losses = std::move(losses);
    *this = std::move(fresh);
  }

  ISOSTAT_FIELDS(strain, last_strain, sigma_x, sigma_y, sigma_z, tau_xy, indicator, losses)
};

/// All of it: a resumed run continues from here to the same bits.
struct DriveState
{
  ProgrammePlace place;
  Pace pace;
  Loading loading;
  PathState path;
  PathProgress progress;
  ServoState servo;
  UndrainedRecord undrained;
  RecordedState recorded;
  ControlState control;
  std::vector<StageEnd> ends;
  LastIncrement increment;

  ISOSTAT_FIELDS(place, pace, loading, path, progress, servo, undrained, recorded, control, ends, increment)
};
} // namespace isostat
