// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/assembly.hpp"
#include "dem/drive/drive_state.hpp"
#include "dem/drive/motion_spec.hpp"
#include "dem/measure/stiffness.hpp"
#include "dem/static/relaxation.hpp"

#include <functional>
#include <span>
#include <string>

namespace isostat
{
/// How a representative volume element is run.
struct RveSettings
{
  /// Damping, rate, time step; load_per_wave is not used. An inertial number of 5e-4 where none is named: for a path on
  /// which accuracy matters take less, as columns do (1e-4, docs/results/ensemble.md).
  MotionSpec motion = {};
  Mat3 frame = Mat3::Identity(); ///< axes of the specimen in the laboratory, a rotation: x_lab = frame x_specimen
  /// Least number of time steps of an increment. An element whose increments are small would otherwise take
  /// each in a step or two, without time for its grains to find their places.
  std::uint64_t min_steps = 1;
  std::optional<StaticStepping> stepping = {}; ///< if given, of `motion` only the time step counts
  double max_increment = 0.01;                 ///< |dH| that one advance() takes; larger ones are rejected
  std::uint64_t max_steps = 10'000'000;        ///< of one advance()
  std::function<bool()> go_on = {};            ///< asked every 50 steps, if given; false: the increment is rejected

  /// tested: tests/dem/rve/rve_test.cpp
  void check() const; ///< @throws InputError  motion out of range, frame is no rotation, a limit is not positive
};

/// Prescribed strain in some components, target stress in the others: one increment of a laboratory test.
struct MixedIncrement
{
  Mat3 gradient = Mat3::Zero(); ///< displacement gradient, laboratory; its symmetric part is 0 where `controlled`
  Mat3 stress = Mat3::Zero();   ///< target Cauchy effective stress, Pa, tension positive, symmetric where `controlled`
  Eigen::Matrix<bool, 3, 3> controlled = Eigen::Matrix<bool, 3, 3>::Constant(false); ///< symmetric
  double tolerance = 1e-3; ///< |stress - target| / max(p', 0.05 p0) at the end
};

enum class RveOutcome
{
  accepted,
  rejected ///< the state is that before the call
};

/// What an increment gave.
struct RveResponse
{
  RveOutcome outcome = RveOutcome::accepted;
  std::string reason;         ///< why it was rejected; empty otherwise
  Mat3 stress = Mat3::Zero(); ///< Cauchy effective stress after it, Pa, tension positive, laboratory, symmetric
  /// tr(stress)/3 minus what it was before, Pa, tension positive. An undrained element under constant total mean stress
  /// changes its pore pressure (compression positive) by just this much.
  double mean_stress_change = 0;
  std::uint64_t steps = 0; ///< time steps it took
  double indicator = 0;    ///< quasi-static error indicator of the last control, see rate_control.hpp
  Balance balance = {};    ///< that of the grains after it; of static stepping and relax()
};

/// What elements have cost since they were made, or unpacked.
struct RveCost
{
  std::uint64_t steps = 0, advances = 0;
  double seconds = 0; ///< wall clock in advance() and undrained()
};

/// What the rate control and the servo of an element remember.
struct RveDrive
{
  Pace pace;
  ServoState servo;
  double p0 = 0;           ///< mean effective stress it was made with, Pa
  std::uint64_t steps = 0; ///< time steps since then: what the intervals of control and servo count from

  ISOSTAT_FIELDS(pace, servo, p0, steps)
};

/// The complete state of an element. Of the size of 15 numbers a grain and 13 a contact.
struct RveState
{
  AssemblyState grains;
  RveDrive drive;
  std::uint64_t specimen = 0; ///< whose state it is: a hash of the law and of the sizes and masses of the grains

  std::size_t bytes() const { return grains.bytes() + sizeof(RveDrive); }
};

/// Representative volume element: a periodic packing as a material point, the only door through which others (finite
/// elements, any host code) use grains.
///
///     dH ---> [ n steps of dH/n, n from the rate control ] ---> sigma'
///
/// Nothing moves between calls: the stress that a call returns is that of the grains as they are.
/// Every step is that of the element tests: the same contact loop, damping, critical step (reviewed every 2,000 steps)
/// and rate control (every 50 steps). The strain of a call is applied in equal steps, at the strain rate of the rate
/// control, max(gamma_1 - gamma_3, |gamma|max) of principal stretchings: largest minus smallest, in simple shear
/// d gamma/dt; or the largest alone where all have one sign.
/// Results depend on nothing but the sequence of calls: not on the lists, on saving, restoring or moving the element.
/// @throws RunFailure  never from advance(): a failed run is a rejected increment
/// tested: tests/dem/rve/rve_test.cpp, tests/verification/rve_*_test.cpp, tests/hard/rve_hard_cases_test.cpp
class Rve
{
public:
  /// @param specimen  a periodic packing at rest
  /// @throws InputError  a packing in a box; settings out of range
  /// @throws RunFailure  a cell too narrow for its grains; a fixed time step that is unstable
  Rve(const Snapshot &specimen, const RveSettings &settings);

  /// Strains the element by the displacement gradient dH (laboratory, relative to its present shape): F <- (I + dH) F.
  /// A rotation in dH turns stress and grains with it and costs no step of its own.
  RveResponse advance(const Mat3 &displacement_gradient);
  /// The same without the volumetric part of ln(I + dH): an element whose pores are closed.
  RveResponse undrained(const Mat3 &displacement_gradient);
  /// Takes the grains to balance at the present strain: what stress(), stiffness() and small probes of it then mean
  /// does not depend on how fast the element was strained before.
  RveResponse relax(const BalanceSpec &spec = {});
  /// Prescribed strain and target stress: drained, K0, constant p' and other tests. Rejected at once: a target that
  /// needs tension, strain and stress for one component. Rejected on the way: the servo strains it by more than 0.1
  /// (with stepping amounts are added up).
  RveResponse advance(const MixedIncrement &increment);

  /// Cauchy effective stress, Pa, tension positive, laboratory.
  Mat3 stress() const;
  /// Stress carried by the fluctuating motion, Pa: small while the element is quasi-static.
  Mat3 kinetic_stress() const;
  /// Instantaneous elastic stiffness of the contact network in the laboratory, see measure/stiffness.hpp.
  Mat6 stiffness(Sliding sliding = Sliding::elastic) const;
  double void_ratio() const { return isostat::void_ratio(assembly_.volume(), assembly_.solid_volume()); }
  /// Density of the grain skeleton, and with water in the pores, kg/m3.
  double dry_density() const;
  double saturated_density(double water = 1000) const;
  Snapshot snapshot() const; ///< for micromechanics and figures, laboratory frame
  const RveCost &cost() const { return cost_; }

  RveState save() const;
  /// @throws InputError  the state of an element with other grains or another law; nothing is changed
  void restore(const RveState &state);

  /// The element as bytes for another process on the same type of machine, and back to the same bits.
  std::vector<std::byte> pack() const;
  /// @throws InputError  bytes of another version, cut short or damaged
  static Rve unpack(std::span<const std::byte> packed, const RveSettings &settings);

  const Assembly &assembly() const { return assembly_; }

private:
  void keep_safe();
  void roll_back();
  template <typename Run>
  RveResponse guarded(double size, const Run &run);
  RveResponse strain(const Mat3 &displacement_gradient, bool constant_volume);
  void run_strain(const Mat3 &own_gradient);
  void run_balanced(const Mat3 &own_gradient, const StaticStepping &stepping);
  void run_mixed(const MixedIncrement &own);
  void run_mixed_balanced(const MixedIncrement &own, const StaticStepping &stepping);
  void step(const Mat3 &own_gradient);
  void review();
  double mean_stress() const;  ///< compression positive, Pa
  double stress_scale() const; ///< what a tolerance of stress is relative to, Pa
  Mat3 to_own(const Mat3 &laboratory) const;

  RveSettings settings_;
  Assembly assembly_;
  std::uint64_t specimen_; ///< as in RveState
  RveDrive drive_;
  RveCost cost_;
  /// State before a failed increment: a copy made every 500 steps, and the strains since, which are run again.
  RveState safe_;
  std::vector<Mat3> since_safe_;
  Balance balance_;           ///< of the last increment
  bool rolling_back_ = false; ///< no callback is asked whether to continue
};
} // namespace isostat
