// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/vector.hpp"
#include "fem/material/material.hpp"
#include "fem/space/block.hpp"
#include "fem/space/tables.hpp"

#include <mpi.h>

namespace isostat
{
/// A block of soil in finite elements as solvers see it, of any dimension: its tables (CellTables), vectors of its
/// unknowns, and the integrals over it that a solver asks for. Displacement has three components in any dimension; the
/// pressure is continuous of degree 1.   tested: tests/fem/space/discretisation_test.cpp (patch tests)
class FiniteElementSpace : public CellTables
{
public:
  virtual ~FiniteElementSpace() = default;

  const MeshSpec &mesh() const { return mesh_; }
  const Supports &supports() const { return supports_; }
  MPI_Comm communicator() const { return communicator_; }
  bool shared_out() const { return shared_out_; } ///< over several ranks

  std::vector<unsigned> fixed_dofs; ///< local unknowns of Supports::fixed, owned or not, in rising order
  /// Local unknowns of Supports::drained and at and above a water table in the soil, owned or not, in rising order.
  std::vector<unsigned> drained_pressures;

  /// Each number becomes its sum over the ranks that the mesh is shared out over; where each has all of it, it stays.
  void sum_over_ranks(std::span<double> values) const;
  bool on_every_rank(bool here) const; ///< the same answer on all of these

  /// A zero vector of displacements / of pressures.
  Vector displacement_vector() const { return Vector(displacements_); }
  const VectorPartition &displacement_partition() const { return displacements_; }
  Vector pressure_vector() const { return Vector(pressures_); }

  /// Diagonal mass by Gauss-Lobatto at the nodes, kg; 0 at unknowns that a tie has removed.
  Vector lumped_mass() const;
  /// Volume of each layer (MeshSpec::soil) that belongs to each displacement unknown, likewise. m3
  std::vector<Vector> layer_volumes() const;
  /// Area of a face that belongs to each displacement unknown (axes that are not meshed count 1 m), m2: int N_A over
  /// the face by Gauss-Lobatto at the nodes.   @throws InputError  the face is of an axis that is not meshed
  virtual Vector face_area(Face face) const = 0;
  /// Where the node of each owned displacement unknown is, m; of a tie, the node that stays.
  virtual std::vector<Place> node_places() const = 0;
  /// The local displacement unknown of `component` at the node nearest to a place, or the pressure unknown, -1 if
  /// another rank owns it. Collective.
  virtual long find_dof(const Place &place, unsigned component) const = 0;
  virtual long find_pressure(const Place &place) const = 0;

  /// Displacement gradients h_cd = factor sum_A u_Ac dN_A/dx_d at all points, along the axes that are meshed; the other
  /// entries of `out` stay as they are (0).   @pre ghost entries of u are up to date   Cost: in the loop.
  void gradients(const Vector &u, std::span<Gradient> out, double factor = 1) const
  {
    gradients(*this, u, out, factor);
  }
  /// The same in cells that have moved: deform().
  void gradients(const CellGeometry &at, const Vector &u, std::span<Gradient> out, double factor = 1) const;
  /// f_Ac += int sigma_cd dN_A/dx_d, the internal force of effective stresses (N); what belongs to other ranks is
  /// brought home.   Cost: in the loop.
  void add_internal_force(std::span<const Stress> stresses, Vector &f) const { add_internal_force(*this, stresses, f); }
  void add_internal_force(const CellGeometry &at, std::span<const Stress> stresses, Vector &f) const;
  /// The cells where displacements u have brought them: with F = I + du/dX along the axes that are meshed,
  /// dN/dx = dN/dX F^-1 and dv = det F dV; exactly those of the start for u = 0.
  /// @pre ghost entries of u are up to date   @throws RunFailure  a cell is turned inside out   Cost: in the loop.
  void deform(const Vector &u, CellGeometry &at) const;
  /// Pressure at all points, Pa, 0 above the water table, whatever the ghosts of p hold.
  std::vector<double> point_pressures(const Vector &p) const;
  /// Bound of the largest omega^2 of the mesh, (rad/s)^2: the largest of any cell (Irons & Treharne 1971), for an
  /// isotropic skeleton with these moduli; `shear_only`: vertical motion is held in wet cells.
  /// @param frequencies  frequencies()   Cost: in the loop.
  double max_frequency_squared(std::span<const double> frequencies, std::span<const WaveModuli> moduli,
                               bool shear_only) const;
  /// omega^2 of each cell per Pa of wave modulus: cell_frequencies() over the density of its layer.
  std::vector<double> frequencies(const CellGeometry &at) const;

protected:
  FiniteElementSpace(const MeshSpec &mesh, const Supports &supports, int dim, MPI_Comm communicator);

  /// Finds bound_share. @throws InputError  a mass is not positive
  void share_out_masses();

  MeshSpec mesh_;
  Supports supports_;
  bool shared_out_;
  MPI_Comm communicator_;
  VectorPartition displacements_, pressures_;
};

template <int dim>
class Unknowns;

/// The same, made by deal.II. `communicator` MPI_COMM_SELF: the whole problem is on this rank; else the cells are
/// shared out (dim > 1).
///
///     block.hpp          what is requested: layers, widths, supports
///     mesh.hpp           cells                                                    (deal.II)
///     hanging_nodes.hpp  nodes on coarser neighbours                              (deal.II)
///     unknowns.hpp       nodes, ties, numbers of unknowns                         (deal.II)
///     discretisation.cpp where unknowns are                                       (deal.II)
///     tables.hpp         the cells as flat tables                                 (made by deal.II, then free of it)
///     integrals.cpp      strains and forces from the tables, in the time loop; cell_frequency.cpp its stable step
///
/// This header, and with it all that solves and writes, is free of deal.II's.
template <int dim>
class Discretisation : public FiniteElementSpace
{
public:
  /// @throws InputError  a mesh that cannot be; a support on a face of an axis that is not meshed
  Discretisation(const MeshSpec &mesh, const Supports &supports, MPI_Comm communicator = MPI_COMM_SELF);
  ~Discretisation() override;

  const Unknowns<dim> &unknowns() const { return *unknowns_; }

  Vector face_area(Face face) const override;
  std::vector<Place> node_places() const override;
  long find_dof(const Place &place, unsigned component) const override;
  long find_pressure(const Place &place) const override;

private:
  std::unique_ptr<Unknowns<dim>> unknowns_;
};
} // namespace isostat
