// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/assembly.hpp"
#include "dem/measure/balance.hpp"

#include <functional>

namespace isostat
{
/// When a packing counts as balanced.
struct BalanceSpec
{
  double tolerance = 0.01; ///< on the imbalance of single grains, dem/measure/balance.hpp [-], > 0
  double left_out = 0.01;  ///< share of the loaded grains, the worst, for which it need not hold [-], [0, 1)

  bool operator==(const BalanceSpec &) const = default;
  /// @throws InputError  naming what is out of range
  void check() const;
};

/// Increments of strain that are each taken to balance, in place of time steps at a rate.
struct StaticStepping
{
  double increment = 5e-5; ///< largest strain of one of them, as the rate control counts it [-], (0, 1e-3]
  BalanceSpec balance = {};

  bool operator==(const StaticStepping &) const = default;
  /// @throws InputError  naming what is out of range
  void check() const;
};

/// How a relaxation is watched.
struct RelaxationLimits
{
  double reference = 0; ///< mean stress by which one is small: forces of a thousandth of it count as none, Pa
  std::uint64_t max_steps = 200'000;
  std::function<bool()> go_on = {}; ///< asked at every look at the balance, if given
};

struct Relaxed
{
  Balance balance;
  std::uint64_t steps = 0; ///< force evaluations
  double lost = 0;         ///< kinetic energy of the grains where they were stopped, J
  bool balanced = false;
};

/// Strains packings from balance to balance without inertia:
///
///     n times { cell or walls by a part of the strain;  one iteration };  v <- 0
///     repeat one iteration until balanced;                      iteration: forces;  v <- v + dt F/M;  x <- x + v dt
///
/// Dynamic relaxation with kinetic damping (Cundall 1976; Barnes 1999, Int. J. Space Struct. 14, 89,
/// doi:10.1260/0266351991494722): grains move under fictitious masses in proportion to the stiffness they feel,
/// M_i = dt^2 sum (kn + ks), J_i = dt^2 sum (ks R^2 + kr + kt) over their contacts, so that all are as quick; where
/// the kinetic energy passes a peak, F.v <= 0, all of them are stopped. Dashpots in the contacts, 5 % of critical, take
/// the motion of grains that rattle between others. Grains that touch nothing stay with the cell.
/// A strain of `increment` is spread over n = 100 iterations, others in proportion (at least one). In a cell grains are
/// strained with it; in a box those that touch something begin with the velocity of its homogeneous strain. All at once
/// it would load contacts as if grains moved affinely, many would slide, and their way back loses stress
/// (docs/theory.md, section 17).
/// The history of contacts goes along with every iteration: with history frozen at the start of an increment
/// relaxation ends in limit cycles, because Coulomb friction is not associated. What is lost where a network breaks
/// is part of this definition, which is fully dissipative.
///
/// As long as it lives grains have these masses and dashpots; afterwards they have their own masses. Depends on nothing
/// but the state it begins with: same bits for any number of threads.
/// @pre no gravity
/// tested: tests/dem/static/relaxation_test.cpp, tests/verification/static_drive_test.cpp
class Relaxation
{
public:
  /// @param increment  strain that is spread over 100 iterations [-], > 0
  Relaxation(Assembly &assembly, double increment);
  ~Relaxation();
  Relaxation(const Relaxation &) = delete;
  Relaxation &operator=(const Relaxation &) = delete;

  /// Strains a cell, or moves the walls of a box and the grains with them. The last of the n >= 1 moves is pending
  /// afterwards, without strain too: compute_forces() and run() follow.
  /// @return n   @pre compute_forces(), settings.time_step > 0
  std::uint64_t deform(const Mat3 &gradient);
  std::uint64_t move(const RigidBox &next);

  /// From where they are to balance, at rest.
  /// @pre compute_forces(), settings.time_step > 0
  /// @throws RunFailure  not balanced within limits.max_steps, naming the worst grain; interrupted; exploded
  Relaxed run(const BalanceSpec &spec, const RelaxationLimits &limits = {});

private:
  template <typename Move>
  std::uint64_t spread(double strain, const Vec3 &box_strain, const Move &move);
  void follow_stiffness();         ///< M and J of the contacts as they are
  void hold();                     ///< one iteration
  double stop();                   ///< of all motion; its energy, which is lost, J
  double half_work() const;        ///< of the forces since velocities were made, J
  double energy_of_motion() const; ///< kinetic energy, of velocities that are half a step older than forces, J
  void look(Relaxed &found, const BalanceSpec &spec, const RelaxationLimits &limits) const;

  Assembly &assembly_;
  double increment_;
  StepSettings settings_;
  std::vector<InverseInertia> own_;
};
} // namespace isostat
