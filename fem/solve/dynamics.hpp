// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/linear_effort.hpp"
#include "fem/motion/base.hpp"
#include "fem/motion/motion_input.hpp"
#include "fem/solve/energy.hpp"
#include "fem/solve/newton_settings.hpp"
#include "fem/solve/skeleton_viscosity.hpp"
#include "fem/solve/solver_state.hpp"
#include "fem/space/discretisation.hpp"

#include <functional>
#include <optional>

namespace isostat
{
class FreeField;
class PressureSystem;
class Statics;
struct PoreFluid;

/// Load on the surface: traction (x, y, z) at a time, tension positive, Pa.
using SurfaceTraction = std::function<std::array<double, 3>(double time)>;

struct DynamicsSettings
{
  /// rho_inf of implicit steps, in [0, 1] (see Dynamics); none: explicit ones
  std::optional<double> spectral_radius = {};
  NewtonSettings newton{.tolerance = 1e-6, .max_halvings = 8}; ///< of implicit steps
  double time_step = 0;      ///< s; 0: safety times the stable step at the start, or less: see `multiple`
  double multiple = 0;       ///< s; a step that is not given divides this interval if the interval is longer
  double safety = 0.8;       ///< of the stable step that may be used
  double mass_damping = 0;   ///< a_M, 1/s: force -a_M M v, v as the unknown counts it (relative to a rigid base)
  double viscosity = 0;      ///< beta of SkeletonViscosity, s; 0: none
  double viscous_above = 25; ///< f_c, Hz
  bool large_strain = false; ///< updated Lagrangian: see Dynamics
  Drainage drainage = Drainage::dry;
  /// Options of PETSc for the pressure's system, each beginning with -water_, or -statics_ of implicit steps; empty: LU
  std::string petsc = {};
  bool lagged_compressibility = false; ///< undrained: volume strain -dp/Q of the step before, instead of none
  Base base = {};
  std::array<Motion, 3> motion = {};     ///< along x, y, z: of the base, or of the rock's outcrop if compliant
  SurfaceTraction surface_traction = {}; ///< none: free
  std::vector<std::shared_ptr<FreeField>> free_fields = {}; ///< of sides, in 2D; each of this run alone
};

/// Waves in a block of saturated soil: central differences in the displacement, effective stress explicit, pore
/// pressure implicit. One evaluation of the material per step. docs/theory_column.md (4), (5), (6):
///
///     M (v+ - v-)/dt + C (v+ + v-)/2 = f - F(sigma') + G^T p                      momentum of the mixture at t_n
///     G (v+ + v-)/2 + S (3p - 4p' + p'')/(2 dt) + H p + L ((v+ - v-)/dt + a_base) = 0        water, backward (BDF2)
///     u_next = u + dt v+
///
/// sigma' has the viscous stress of SkeletonViscosity in it, if there is one.
/// v-, v+ at n -+ 1/2; p, p', p'' at n, n-1, n-2. M and C are diagonal, so the only linear system is for the
/// pressure (PressureSystem), constant and factorised once; where the permeability follows the void ratio, again when
/// it has changed by 1 % anywhere. The skeleton alone limits dt; water of any stiffness and permeability does not
/// (roots of the amplification polynomial (9) on or inside the unit circle for omega dt <= 2).
///
/// With large_strain sigma' is Cauchy's stress in the cells as they are: F, G, H, L and S are integrals over the
/// deformed cells (FiniteElementSpace::deform()), the increments of displacement gradient that the material gets refer
/// to the cells at the start of the step. M stays, as mass does. Those of the water and the stable step are found again
/// when a displacement gradient since the last time exceeds 0.2 %. It is the material that turns its stress with the
/// soil: packings do, formulas do not. tested: tests/fem/solve/dynamics_geometry_test.cpp
///
/// With a spectral radius steps are implicit, of any size: Statics with inertia, (13a) to (13c), the same unknowns,
/// loads and instants of what is reported. Small strain, no viscosity, dry or coupled, without free fields.
/// tested: tests/verification/implicit_dynamics_test.cpp
///
/// Displacements count from a rigid base, or are absolute above a compliant one (Lysmer & Kuhlemeyer 1969,
/// doi:10.1061/JMCEA3.0001144). Undrained, soil below the water table keeps its volume (u_z = 0), soil above it is
/// dry and moves vertically, too. The state at the start is taken as in equilibrium: a frozen column stays still bit
/// for bit.   tested: tests/fem/solve/dynamics_test.cpp, tests/verification/shear_layer_test.cpp,
/// tests/fem/water/pressure_system_test.cpp
class Dynamics
{
public:
  /// @pre material.n_points() == space.n_points(), initial stress set
  /// @throws InputError  step above the stable one, undrained in more than one dimension, u-p with degree 1, lagged
  ///                     compressibility of a fluid that is softer than the skeleton
  Dynamics(const FiniteElementSpace &space, Material &material, DynamicsSettings settings);
  ~Dynamics();

  /// One time step.
  /// @throws RunFailure  the stiffness has risen so that the step is no longer stable, or the motion explodes
  void step();

  std::uint64_t n_steps() const { return step_; }
  double time() const { return static_cast<double>(step_) * time_step_; }
  double time_step() const { return time_step_; }
  double stable_step() const; ///< explicit, of the present stiffness, s

  const Vector &displacement() const { return u_; } ///< at time()
  const Vector &velocity() const { return v_; }     ///< at time() - dt/2
  Vector acceleration() const;                ///< at time() - dt, as the unknown counts it; made again at each call
  double acceleration(unsigned unknown) const ///< the same of one unknown that this rank owns
  {
    return (v_.local_element(unknown) - next_.local_element(unknown)) / time_step_;
  }
  double velocity(unsigned unknown) const ///< likewise: (v+ + v-)/2 of (4), at time() - dt
  {
    return (v_.local_element(unknown) + next_.local_element(unknown)) / 2;
  }
  const Vector &pressure() const { return p_; }                  ///< excess, at time() - dt; zero unless coupled
  std::span<const Stress> stresses() const { return stresses_; } ///< effective, at time(), tension positive
  std::span<const Stress> skeleton_stresses();                   ///< those of (4): with the viscous stress
  /// Excess pore pressure at the points, compression positive, Pa: of u-p at time() - dt, of an undrained column from
  /// vertical equilibrium at time(), 0 if dry, and above the water table.
  std::vector<double> point_pressure() const;
  /// Sum over all ranks.
  DynamicsEnergy energy() const;
  LinearEffort linear_effort() const; ///< of an iterative linear solver, since the start or restore()
  const DynamicsSettings &settings() const { return settings_; }

  /// Bit for bit; on another number of ranks that share out the mesh, to round-off of their sums. Collective.
  /// @throws InputError  restore() of another mesh, material or step; save() of a mesh that is shared out with a
  ///                     material that keeps its points as a whole
  SolverState save() const;
  void restore(const SolverState &state);

private:
  // dynamics.cpp
  void check_settings() const;
  void check_implicit() const;
  void choose_step();
  void prepare_steps();
  void begin_implicit();
  void restore_implicit(const SolverState &state);
  void make_coefficients();
  std::vector<bool> wet_unknowns() const;
  template <typename Self, typename Visit>
  static void for_each_field(Self &self, Visit &&visit);
  // dynamics_step.cpp
  void find_loads(double time);
  void find_forces();
  void step_implicitly();
  void start();
  void find_pressure();
  template <bool coupled>
  void move();
  void strain_points();
  void add_lagged_compression();
  void check_lagged_compression() const;
  void check_motion();
  // dynamics_geometry.cpp
  const CellGeometry &cells() const { return deformed_ ? deformed_->now : space_; }
  void make_pressure_system();
  void follow_void_ratio();
  void find_deformation();
  void follow_deformation();

  const FiniteElementSpace &space_;
  Material &material_;
  DynamicsSettings settings_;
  double time_step_ = 0;
  std::uint64_t step_ = 0;

  // state
  Vector u_, v_, next_;          ///< next_: v half a step before v_
  Vector p_, p_before_, p_next_; ///< p_next_ is scratch
  std::vector<Stress> stresses_;
  std::vector<double> lagged_pressure_;   ///< at the points, lagged compressibility only
  std::vector<double> permeable_strains_; ///< volume strains of pressure_system_; empty: its permeability is constant
  std::optional<SkeletonViscosity> viscosity_;
  DynamicsEnergy half_way_; ///< of this rank, at time() - dt/2
  DynamicsEnergy energy_;   ///< of this rank at time() - dt
  double exchanged_ = 0;    ///< sum of |external work|, what an explosion is measured by

  /// Large strain: where cells are, and what was found where they were `found_at`.
  struct Deformation
  {
    CellGeometry now, found;
    Vector found_at; ///< displacement of `found`, m
  };
  std::optional<Deformation> deformed_;
  std::vector<double> frequencies_; ///< of the cells, where they are `found`; pressure_system_ is of them, too

  // constant
  Vector mass_, update_, keep_, damping_; ///< M, D, D (M/dt - C/2), C
  Vector dashpot_, surface_;              ///< rho V A of the base, area of the surface
  double min_energy_ = 0;                 ///< J, that no explosion is judged below
  std::vector<unsigned> loaded_;          ///< unknowns that dashpots or surface load
  Vector minus_reference_;                ///< -F of the initial stress
  std::vector<Stress> initial_stresses_;
  std::vector<PoreFluid> lagged_fluids_; ///< of the points, lagged compressibility only
  std::unique_ptr<PressureSystem> pressure_system_;
  std::unique_ptr<Statics> implicit_; ///< null: explicit
  LinearEffort earlier_effort_;       ///< of pressure systems before this one

  // of one step
  std::array<double, 3> frame_ = {}; ///< minus the acceleration of a rigid base
  Vector load_, force_, pore_force_;
  std::vector<Stress> total_; ///< with the viscous stress; empty without
  std::vector<Gradient> increments_;
  mutable std::vector<WaveModuli> moduli_;
};

/// How a block that is shaken at its base is held: the base (fixed to its given motion unless compliant, and always
/// in an undrained column vertically below its water table), its sides, drained surface.
Supports shaken_supports(bool compliant_base, Sides sides = Sides::tied, unsigned dimension = 2);
} // namespace isostat
