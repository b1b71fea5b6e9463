// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material.hpp"
#include "fem/soil.hpp"

#include <deal.II/base/index_set.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <mpi.h>

namespace isostat
{
/// Displacements and the like, three to a node, in the local order of the discretisation; owned entries come first,
/// those of other ranks behind. On MPI_COMM_SELF all are owned and nothing is ever exchanged.
using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

/// Faces of a block of soil.
enum class Face
{
  x_low,
  x_high,
  y_low,
  y_high,
  base,
  surface
};

/// A displacement component (0, 1, 2 = x, y, z) on a face.
struct FaceComponent
{
  Face face;
  unsigned component;
};

/// A block of soil of layers, `dim` of the axes x, y, z meshed: 1 z; 2 x, z; 3 x, y, z.
struct MeshSpec
{
  SoilProfile soil;                              ///< layers with their numbers of cells
  std::array<double, 2> width = {1, 1};          ///< along x and y, m; what is not meshed counts as 1
  std::array<unsigned, 2> cells_across = {1, 1}; ///< along x and y
  unsigned degree = 2;                           ///< of the displacement, 1 or 2
  unsigned points_per_direction = 0; ///< Gauss points of a cell along each axis; 0: degree in a column, else degree + 1
};

/// How the block is held.
struct Supports
{
  bool tied_sides = false;             ///< opposite side faces move as one (laterally periodic)
  std::vector<FaceComponent> fixed;    ///< given displacement, 0 unless the solver says otherwise
  std::vector<FaceComponent> together; ///< all nodes of the face have the same displacement
  std::vector<Face> drained;           ///< excess pore pressure 0
};

/// A mesh with its displacement space (three components in any dimension) and its pressure space (continuous, degree
/// 1), laid out as flat tables for the time loop. deal.II is used to make the tables and to write ParaView files; no
/// call of it is left in the loop.
///
/// Every cell has the same number of nodes and points. Points are numbered cell by cell from the base up (in 2D and 3D
/// in the order of the mesh). `communicator` MPI_COMM_SELF: the whole problem on this rank; else the cells are shared
/// out (dim > 1).  tested: tests/fem/discretisation_test.cpp
template <int dim>
class Discretisation
{
public:
  /// @throws InputError for a mesh that cannot be
  Discretisation(const MeshSpec &mesh, const Supports &supports, MPI_Comm communicator = MPI_COMM_SELF);

  // sizes on this rank
  std::size_t n_cells() const { return cell_layer.size(); }
  std::size_t n_points() const { return weight.size(); }
  std::size_t nodes_per_cell() const { return nodes_per_cell_; }
  std::size_t points_per_cell() const { return points_per_cell_; }
  std::size_t pressure_nodes_per_cell() const { return 1u << dim; }

  // tables
  std::vector<unsigned> cell_dofs;             ///< [cell][node][3], local displacement unknown, ties resolved
  std::vector<unsigned> cell_pressures;        ///< [cell][corner], local pressure unknown
  std::vector<double> shape;                   ///< [point of a cell][node], the same in every cell
  std::vector<double> gradient;                ///< [point][node][dim], 1/m
  std::vector<double> pressure_shape;          ///< [point of a cell][corner]
  std::vector<double> pressure_gradient;       ///< [point][corner][dim], 1/m
  std::vector<double> weight;                  ///< volume of a point, m^dim (times 1 m along axes not meshed)
  std::vector<std::array<double, 3>> position; ///< of a point, m
  std::vector<std::size_t> point_id;           ///< the point's number in the whole mesh
  std::vector<unsigned> cell_layer;            ///< layer of a cell
  std::vector<double> lumping;      ///< [point-free][node] share of a cell's volume by Gauss-Lobatto, [cell][node]
  std::vector<unsigned> fixed_dofs; ///< local, owned or not
  std::vector<unsigned> drained_pressures; ///< local

  /// A zero vector of displacements / of pressures.
  Vector displacement_vector() const;
  Vector pressure_vector() const;

  /// Diagonal mass, kg: Gauss-Lobatto at the nodes. @param density  of each layer
  Vector lumped_mass() const;
  /// Area of a face that belongs to each displacement unknown (three times per node), m^(dim-1). Sums ties.
  Vector face_area(Face face) const;
  /// Lowest and highest node etc.: the local unknown of `component` at the node nearest to a place, if this rank owns
  /// it.
  /// @return local index, or -1
  long find_dof(const std::array<double, 3> &place, unsigned component) const;
  long find_pressure(const std::array<double, 3> &place) const;

  /// Gradients at all points.   @pre ghost entries of u are up to date
  void gradients(const Vector &u, std::span<Gradient> out) const;
  /// f += int B^T sigma; entries of other ranks are brought home.
  void add_internal_force(std::span<const Stress> stresses, Vector &f) const;
  /// Largest omega^2 of any cell for given moduli, (rad/s)^2: bound of that of the mesh (Irons & Treharne 1971).
  double greatest_frequency_squared(std::span<const WaveModuli> moduli, bool shear_only) const;

  const MeshSpec &mesh() const { return mesh_; }
  const Supports &supports() const { return supports_; }
  MPI_Comm communicator() const { return communicator_; }
  const dealii::DoFHandler<dim> &nodes() const { return nodes_; } ///< one unknown per displacement node
  const dealii::DoFHandler<dim> &pressure_nodes() const { return pressures_; }

private:
  MeshSpec mesh_;
  Supports supports_;
  MPI_Comm communicator_;
  std::unique_ptr<dealii::Triangulation<dim>> triangulation_;
  dealii::FE_Q<dim> displacement_element_, pressure_element_;
  dealii::DoFHandler<dim> nodes_, pressures_;
  std::size_t nodes_per_cell_, points_per_cell_;
};
} // namespace isostat
