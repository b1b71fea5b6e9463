// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/contact/kernel.hpp"
#include "dem/contact/shares.hpp"
#include "dem/domain/rigid_box.hpp"
#include "dem/measure/energy.hpp"
#include "dem/measure/snapshot.hpp"
#include "dem/motion/leapfrog.hpp"
#include "dem/neighbours/verlet_list.hpp"

#include <array>

namespace isostat
{
/// Bytes in use.
struct MemoryUse
{
  std::size_t state;   ///< what the next step depends on: grains, and pair and history of closed contacts
  std::size_t working; ///< the rest: pairs that are only near, slots, forces, positions the lists were made from
};

/// The granular assembly in its rigid box, and one time step of it in two halves:
///
///     compute_forces()    x, v, history  ->  contact and wall forces, new history
///     move(next box)      forces         ->  v, x; walls go to `next box`
///
/// compute_forces() itself only needs to know what the walls feel. Contact forces are evaluated when somebody looks at
/// them, or else in move(), chunk by chunk with the motion of the chunk's grains while they are in the cache; the bits
/// are the same. Between the halves the state is consistent: a driver reads stresses there, a recorder takes snapshots.
/// After move() the state is what a checkpoint keeps. Nothing here decides where walls go: that is the drivers'
/// business (dem/drive).
class Assembly
{
public:
  /// Starts from a specimen or checkpoint: grains, box, law and the history of its contacts.
  explicit Assembly(const Snapshot &initial);

  void compute_forces();
  /// @param next_box  walls after this step
  /// @throws RunFailure naming step and grain when a grain is not a number or moves more than 1 % of the smallest
  ///         radius in one step
  void move(const RigidBox &next_box);

  /// Changes the law from the next force evaluation on; history of the parts that stay is kept.
  void set_law(const LawParams &law);

  const Packing &packing() const { return packing_; }
  const RigidBox &box() const { return box_; }
  const LawParams &law() const { return law_; }
  const ContactList &contacts() const
  {
    evaluate();
    return contacts_;
  }
  double solid_volume() const { return solid_volume_; }
  double d50() const { return d50_; }
  std::uint64_t step() const { return step_; }
  double time() const { return time_; }
  const VerletList &verlet_list() const { return verlet_; }

  /// Force of the grains on wall 0..5 (x-, x+, ...), outward positive, N.  @pre compute_forces()
  const std::array<double, 6> &wall_forces() const { return wall_force_; }
  /// Wall stress along x, y, z: mean of both opposite walls over their area, Pa, tension positive.
  Vec3 wall_stress() const;
  /// Love-Weber stress of grain and wall contacts, Pa, tension positive, diagonal only: sum F_k l_k / V. Cheaper than
  /// a snapshot (0.2 ms for 10,000 grains): what the rate control looks at.
  Vec3 contact_stress() const;
  /// Mean |resultant force| of grains in contact over mean |contact force| [-].  @pre compute_forces(), not yet moved
  double unbalanced_force_ratio() const;
  /// Sum of stiffnesses of the contacts with the two walls of an axis, N/m: what the servo divides by.
  double wall_stiffness_sum(int axis) const { return wall_stiffness_sum_[axis]; }

  MemoryUse memory() const;

  /// State with all contacts in force.  @pre compute_forces(), not yet moved
  Snapshot snapshot() const;
  /// State to go on from, after move(): positions ahead of the contact history by one step.
  Snapshot checkpoint() const;

  /// Balance since the first force evaluation with measure_energy; zero without it.  @pre compute_forces(), not yet
  /// moved
  EnergyBalance energy() const;

  double time_step = 0; ///< s; set before the first step
  int threads = 1;      ///< that share a step; changes no bit of any result
  /// What `threads` starts from in every new assembly: a number, or 0 for as many as the process may use and the
  /// packing can feed. Set once by a program that has a core to itself; otherwise one thread.
  inline static int default_threads = 1;
  double damping = 0.2;        ///< local damping [-]
  Vec3 gravity = Vec3::Zero(); ///< m/s2
  bool measure_energy = false;
  /// What energy() goes by, part of a checkpoint: sums of boundary work and dissipation since the start, and in kinetic
  /// and elastic minus what was stored then.
  EnergyBalance tally;

  /// Wall forces (N) and outward displacements (m) of the step before, and 1 once energy is being measured: what the
  /// boundary work goes on from; part of a checkpoint.
  static constexpr std::size_t wall_memory_size = 13;
  std::array<double, wall_memory_size> wall_memory() const;
  void set_wall_memory(const std::array<double, wall_memory_size> &memory);

private:
  /// Contact forces of this step, if they are still pending.
  void evaluate() const;
  void evaluate_chunk(std::size_t chunk) const;
  int n_threads() const;
  /// Calls work(chunk) for all chunks: in order on one thread, in shares on several.
  template <typename Work>
  void for_chunks(const Work &work) const;
  void add_wall_forces(std::size_t chunk);
  void sum_wall_forces();
  MotionReport move_grains(double speed_limit);
  void add_gravity();
  void sum_dissipation();
  void start_energy();
  Snapshot without_contacts() const;
  [[noreturn]] void report_explosion(double speed_limit) const;

  Packing packing_;
  RigidBox box_;
  LawParams law_;
  mutable ContactList contacts_; ///< mutable, as the three below: evaluate() fills in what is pending
  VerletList verlet_;
  mutable AlignedVector<double> action_; ///< [F 0 T 0] per slot
  mutable DissipationPerPair dissipation_;
  bool forces_known_ = false; ///< compute_forces() has been called in this step: again is for free
  enum class Pending
  {
    nothing,
    ghosts,  ///< contact forces are there, ghosts are not added yet
    contacts ///< contact forces are not evaluated yet
  };
  mutable Pending pending_ = Pending::nothing;
  mutable ThreadShares shares_;
  /// What the grains of one chunk do to the walls.
  struct WallSums
  {
    std::array<double, 6> force, stiffness;
  };
  std::vector<WallSums> wall_sums_;          ///< per chunk
  std::vector<MotionReport> motion_reports_; ///< per chunk
  std::array<double, 6> wall_force_{}, previous_wall_force_{}, wall_displacement_{};
  std::array<double, 3> wall_stiffness_sum_{};
  double solid_volume_ = 0, d50_ = 0, min_radius_ = 0, greatest_step_ = 0;
  std::uint64_t step_ = 0;
  double time_ = 0;
  bool energy_started_ = false;
};
} // namespace isostat
