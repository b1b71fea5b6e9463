// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/contact/loop.hpp"
#include "dem/contact/shares.hpp"
#include "dem/domain/rigid_box.hpp"
#include "dem/measure/energy.hpp"
#include "dem/motion/leapfrog.hpp"
#include "dem/neighbours/verlet_list.hpp"
#include "dem/state/snapshot.hpp"

#include <array>

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
struct AssemblyState
{
  std::vector<double> grains; ///< x (3), v (3), spin (3), force (3), torque (3) of each grain; SI
  std::vector<ContactList::Pair> pairs;
  std::vector<double> history; ///< n', fs, [mb], [mt] of each pair
  PeriodicCell cell;
  Mat3 virial = Mat3::Zero(); ///< sum of F b, J
  double time = 0, time_step = 0;
  std::uint64_t step = 0;

  std::size_t bytes() const;
};

/// The granular assembly in its rigid box or periodic cell, and one time step of it in two halves:
///
///     compute_forces()    x, v, history  ->  contact and wall forces, new history
///     move(next box)      forces         ->  v, x; walls go to `next box`
///     deform(L dt)        forces         ->  v, x; the cell and all grains in it are strained by L dt
///
/// In a cell velocities and spins are fluctuations about the homogeneous motion, in the cell's own frame.
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
  /// @throws RunFailure naming step and grain when a grain is not a number or moves more than 5 % of the smallest
  ///         radius in one step
  void move(const RigidBox &next_box);
  /// @param displacement_gradient  L dt of this step, laboratory frame; constant volume where its trace is 0
  /// @throws RunFailure as move(); also where |L dt| exceeds 1 %
  /// @pre a periodic cell
  void deform(const Mat3 &displacement_gradient);

  /// Changes the law from the next force evaluation on; history of the parts that stay is kept.
  void set_law(const Law &law);

  const Packing &packing() const { return packing_; }
  const RigidBox &box() const { return box_; }                           ///< without meaning in a cell
  const RigidBox *walls() const { return cell_ ? nullptr : &box_; }      ///< null in a cell
  const PeriodicCell *cell() const { return cell_ ? &*cell_ : nullptr; } ///< null in a box
  double volume() const { return cell_ ? cell_->volume() : box_.volume(); }
  const Law &law() const { return law_; }
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
  /// What the specimen as a whole carries, Pa, tension positive, laboratory frame: in a box the wall stress, on the
  /// diagonal; in a cell Love-Weber stress, symmetric (its skew part is of the order of the unbalanced moments).
  Mat3 stress() const;
  /// Love-Weber stress of grain and wall contacts, Pa, tension positive, diagonal only: sum F_k l_k / V. Cheaper than
  /// a snapshot (0.2 ms for 10,000 grains): what the rate control looks at. In a cell the diagonal of stress().
  Vec3 contact_stress() const;
  /// Mean |resultant force| of grains in contact over mean |contact force| [-].  @pre compute_forces(), not yet moved
  double unbalanced_force_ratio() const;
  /// Moduli along x, y, z if all grains followed the strain, (1/V) sum l^2 (kn n_k^4 + ks n_k^2 (1 - n_k^2)), Pa, own
  /// frame of a cell: what the servo of a cell divides by. One pass over the contacts.
  Vec3 affine_moduli() const;
  /// Sum of stiffnesses of the contacts with the two walls of an axis, N/m: what the servo of a box divides by.
  double wall_stiffness_sum(int axis) const { return wall_stiffness_sum_[axis]; }

  MemoryUse memory() const;

  /// State with all contacts in force; a cell is turned into the laboratory frame.  @pre compute_forces(), not yet
  /// moved
  Snapshot snapshot() const;
  /// State to go on from, after move(): positions ahead of the contact history by one step; a cell in its own frame.
  Snapshot checkpoint() const;

  /// State with contacts in force, forces included, in the fewest numbers, and back to the same bits. A list of pairs
  /// that still fits is kept.  @pre compute_forces(), not yet moved; restore: the same grains, a periodic cell
  AssemblyState save() const;
  void restore(const AssemblyState &state);

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

  /// What the boundary work goes on from, part of a checkpoint: wall forces (N) and outward displacements (m) of the
  /// step before; 1 once energy is being measured; of a cell the sum of F b of the step before (J).
  static constexpr std::size_t boundary_memory_size = 19;
  std::array<double, boundary_memory_size> boundary_memory() const;
  void set_boundary_memory(const std::array<double, boundary_memory_size> &memory);

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
  void sum_boundary_work();
  MotionReport move_grains(double speed_limit, const AffineStep *affine = nullptr);
  void turn_upright();
  void add_gravity();
  void sum_dissipation();
  void start_energy();
  Snapshot without_contacts() const;
  [[noreturn]] void report_explosion(double speed_limit) const;

  Packing packing_;
  RigidBox box_;
  std::optional<PeriodicCell> cell_;
  Law law_;
  mutable ContactList contacts_; ///< mutable, as the three below: evaluate() fills in what is pending
  VerletList verlet_;
  mutable AlignedVector<double> action_; ///< [F 0 T 0] per slot
  mutable DissipationPerPair dissipation_;
  mutable Virial virial_;          ///< of a cell
  Mat3 virial_sum_ = Mat3::Zero(); ///< of the step that save() and boundary work look at, J
  bool forces_known_ = false;      ///< compute_forces() has been called in this step: again is for free
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
  double solid_volume_ = 0, d50_ = 0, min_radius_ = 0, d_max_ = 0, max_step_ = 0;
  std::uint64_t step_ = 0;
  double time_ = 0;
  bool energy_started_ = false;
};
} // namespace isostat
