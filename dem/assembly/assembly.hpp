// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/contact_forces.hpp"
#include "dem/assembly/energy_meter.hpp"
#include "dem/assembly/wall_forces.hpp"
#include "dem/measure/balance.hpp"
#include "dem/motion/leapfrog.hpp"
#include "dem/state/snapshot.hpp"

namespace isostat
{
/// Bytes in use.
struct MemoryUse
{
  std::size_t state;   ///< what the next step depends on: grains, and pair and history of closed contacts
  std::size_t working; ///< the rest: pairs that are only near, slots, forces, positions the lists were made from
};

/// What the next step of a periodic assembly depends on, besides sizes, masses and law: 15 numbers a grain, 12 and a
/// pair of indices for each closed contact.
/// tested: tests/dem/rve/rve_test.cpp
struct AssemblyState
{
  std::vector<double> grains; ///< x (3), v (3), spin (3), force (3), torque (3) of each grain; SI
  std::vector<ContactList::Pair> pairs;
  std::vector<double> history; ///< n', fs, [mb], [mt] of each pair
  Mat3 virial = Mat3::Zero();  ///< sum of F b, J
  PeriodicCell cell;
  double time = 0, time_step = 0;
  std::uint64_t step = 0;

  ISOSTAT_FIELDS(grains, pairs, history, virial, cell, time, time_step, step)
  std::size_t bytes() const;
};

/// What a grain resists motion with, inverted: 1/kg and 1/(kg m2).
struct InverseInertia
{
  double mass, moment;
};

/// The granular assembly in its rigid box or periodic cell, and one time step of it in two halves:
///
///     compute_forces()    x, v, history  ->  contact and wall forces, new history
///     move(next box)      forces         ->  v, x; walls go to `next box`
///     deform(L dt)        forces         ->  v, x; the cell and all grains in it are strained by L dt
///
/// In a cell velocities and spins are fluctuations about the homogeneous motion, in the cell's own frame.
///
/// compute_forces() itself only needs to know what the walls feel; when contact forces are evaluated is the business of
/// ContactForces. Between the halves the state is consistent: a driver reads stresses there, a recorder takes
/// snapshots. After move() the state is what a checkpoint keeps. Where walls go is decided by the drivers (dem/drive).
/// Views are not for several threads at once: the first one may evaluate forces.
/// tested: tests/dem/assembly/assembly_test.cpp,
/// tests/verification/{threads,cell_bits,cell_strain,energy_balance}_test.cpp
class Assembly
{
public:
  /// Starts from a specimen or checkpoint: grains, box, law and the history of its contacts.
  explicit Assembly(const Snapshot &initial, const StepSettings &how = {});

  StepSettings settings; ///< of the steps to come

  void compute_forces();
  /// @param next_box  walls after this step
  /// @throws RunFailure naming step and grain when a grain is not a number or moves more than 5 % of the smallest
  ///         radius in one step
  /// @pre settings.time_step > 0, a box
  void move(const RigidBox &next_box);
  /// @param displacement_gradient  L dt of this step, laboratory frame; constant volume where its trace is 0
  /// @throws RunFailure as move(); also where |L dt| exceeds 1 %
  /// @pre settings.time_step > 0, a periodic cell
  void deform(const Mat3 &displacement_gradient);

  /// For relaxations (dem/static), between compute_forces() and the next move. Grains lose their motion.
  void stop_grains();
  /// Those that touch something go with a strain rate of a box about its centre, 1/s, tension positive.
  void set_homogeneous_motion(const Vec3 &rate);
  /// They move with other masses.   @pre one for each grain
  void set_inverse_inertia(const std::vector<InverseInertia> &inertia);
  std::vector<InverseInertia> inverse_inertia() const;
  double power() const;          ///< sum of F.v and T.w, W: positive while they gain speed
  double kinetic_energy() const; ///< under their masses at present, J
  /// A loss that counts as of damping, J.
  void add_loss(double energy) { meter_.add_motion({.damping_loss = energy}); }

  /// Changes the law from the next force evaluation on; history of the parts that stay is kept.
  void set_law(const Law &law);

  const Packing &packing() const { return packing_; }
  const RigidBox &box() const { return domain_.box; }                                  ///< without meaning in a cell
  const RigidBox *walls() const { return domain_.walls(); }                            ///< null in a cell
  const PeriodicCell *cell() const { return domain_.cell ? &*domain_.cell : nullptr; } ///< null in a box
  double volume() const { return domain_.volume(); }
  const Law &law() const { return law_; }
  const ContactList &contacts() const { return forces().list(); }
  double solid_volume() const { return solid_volume_; }
  double d50() const { return d50_; }
  std::uint64_t step() const { return step_; }
  double time() const { return time_; }
  const VerletList &verlet_list() const { return verlet_; }

  /// Force of the grains on wall 0..5 (x-, x+, ...), outward positive, N.  @pre compute_forces()
  const std::array<double, 6> &wall_forces() const { return walls_.forces(); }
  /// Sum of stiffnesses of the contacts with the two walls of an axis, N/m: what the servo of a box divides by.
  double wall_stiffness_sum(int axis) const { return walls_.stiffness_sum(axis); }
  /// Wall stress along x, y, z, Pa, tension positive.
  Vec3 wall_stress() const { return walls_.stress(domain_.box); }
  /// What the specimen as a whole carries, Pa, tension positive, laboratory frame: in a box the wall stress, on the
  /// diagonal; in a cell Love-Weber stress, symmetric (its skew part is of the order of the unbalanced moments).
  Mat3 stress() const;
  /// Love-Weber stress of grain and wall contacts along x, y, z, Pa, tension positive: what the rate control looks at.
  /// In a cell the diagonal of stress().
  Vec3 contact_stress() const;
  /// See unbalanced_force().  @pre compute_forces(), not yet moved
  double unbalanced_force_ratio() const;
  /// See dem/measure/balance.hpp: forces that a mean stress of 1e-3 of a reference makes count as none, and those of
  /// overlaps of 1e-11 d50.   @param reference  Pa   @pre compute_forces(), not yet moved
  Balance balance(double left_out, double reference) const;
  /// The closed contacts for further measures.  @pre compute_forces(), not yet moved
  LiveContacts live_contacts() const;

  MemoryUse memory() const;

  /// State with all contacts in force; a cell is turned into the laboratory frame.  @pre compute_forces(), not yet
  /// moved
  Snapshot snapshot() const;
  /// State to continue from, after move(): positions ahead of the contact history by one step; a cell in its own frame.
  Snapshot checkpoint() const;

  /// State with contacts in force, forces included, in the fewest numbers, and back to the same bits. A list of pairs
  /// that still fits is kept.  @pre compute_forces(), not yet moved; restore: the same grains, a periodic cell
  AssemblyState save() const;
  void restore(const AssemblyState &state);

  /// Balance since the first force evaluation with settings.measure_energy; zero without it.  @pre compute_forces(),
  /// not yet moved
  EnergyBalance energy() const;
  /// What it continues from after a checkpoint.
  const EnergyMemory &energy_memory() const { return meter_.memory(); }
  void set_energy_memory(const EnergyMemory &memory) { meter_.set_memory(memory); }

private:
  ContactForces::Input force_input() const { return {law_, packing_, domain_, settings}; }
  /// Contact forces of this step, evaluated now if they were not before.
  const ContactForces &forces() const;
  void update_list(double max_step);
  void add_gravity();
  void measure_energy();
  LeapfrogStep leapfrog_step() const; ///< as the settings say, in a box whose walls push
  double move_grains(const LeapfrogStep &how);
  void turn_upright();
  Snapshot without_contacts() const;

  Packing packing_;
  Domain domain_;
  Law law_;
  mutable ContactForces forces_; ///< mutable: forces() evaluates what is pending, and nothing else does
  VerletList verlet_;
  WallForces walls_;
  EnergyMeter meter_;
  std::vector<MotionReport> motion_reports_; ///< per chunk
  bool forces_known_ = false;                ///< compute_forces() has been called in this step: again is for free
  double solid_volume_ = 0, d50_ = 0, min_radius_ = 0, max_diameter_ = 0;
  double max_step_ = 0;           ///< bound on what a grain or wall has moved in the last step, m
  HomogeneousMotion wall_motion_; ///< that carried grains have shared in the last step
  std::uint64_t step_ = 0;
  double time_ = 0;
};
} // namespace isostat
