// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"
#include "fem/material/soil.hpp"

#include <deal.II/base/partitioner.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <map>
#include <memory>

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
  bool tied_sides = false;                  ///< opposite side faces move as one (laterally periodic)
  std::vector<FaceComponent> fixed = {};    ///< given displacement, 0 unless the solver says otherwise
  std::vector<FaceComponent> together = {}; ///< all nodes of the face have the same displacement
  std::vector<Face> drained = {};           ///< excess pore pressure 0
};

/// A mesh with its displacement space (three components in any dimension) and its pressure space (continuous, degree
/// 1), laid out as flat tables for the time loop. deal.II is used to make the tables and to write ParaView files; no
/// call of it is left in the loop.
///
/// Every cell has the same number of nodes and points. Points are numbered cell by cell from the base up (in 2D and 3D
/// in the order of the mesh). `communicator` MPI_COMM_SELF: the whole problem on this rank; else the cells are shared
/// out (dim > 1).  tested: tests/fem/space/discretisation_test.cpp
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
  std::vector<unsigned> cell_pressures;        ///< [cell][corner], local pressure unknown, ties resolved
  std::vector<double> shape;                   ///< [point of a cell][node], the same in every cell
  std::vector<double> gradient;                ///< [point][node][dim], 1/m
  std::vector<double> pressure_shape;          ///< [point of a cell][corner]
  std::vector<double> pressure_gradient;       ///< [point][corner][dim], 1/m
  std::vector<double> weight;                  ///< volume of a point; axes that are not meshed count 1 m. m3
  std::vector<double> nodal_share;             ///< [cell][node] Gauss-Lobatto volume of a node, m3
  std::vector<std::array<double, 3>> position; ///< of a point, m
  std::vector<std::size_t> point_id;           ///< number of a point in the whole mesh, for any partition
  std::vector<unsigned> cell_layer;            ///< number of a cell's layer in mesh().soil, from the surface down
  std::vector<unsigned> fixed_dofs;            ///< local unknowns of Supports::fixed, owned or not
  std::vector<unsigned> drained_pressures;     ///< local unknowns of Supports::drained, owned or not

  /// A zero vector of displacements / of pressures.
  Vector displacement_vector() const { return Vector(displacement_partition_); }
  Vector pressure_vector() const { return Vector(pressure_partition_); }

  /// Diagonal mass by Gauss-Lobatto at the nodes, kg; 0 at unknowns that a tie has removed.
  Vector lumped_mass() const;
  /// Area of a face that belongs to each displacement unknown (axes that are not meshed count 1 m), m2.
  Vector face_area(Face face) const;
  /// Where the node of each owned displacement unknown is, m; of a tie, the node that stays.
  std::vector<std::array<double, 3>> node_places() const;
  /// The local displacement unknown of `component` at the node nearest to a place, -1 if another rank owns it.
  long find_dof(const std::array<double, 3> &place, unsigned component) const;
  /// The local pressure unknown nearest to a place, -1 if another rank owns it.
  long find_pressure(const std::array<double, 3> &place) const;

  /// Displacement gradients of factor u at all points, along the axes that are meshed; the other entries of `out` stay
  /// as they are (0).   @pre ghost entries of u are up to date   Cost: in the loop.
  void gradients(const Vector &u, std::span<Gradient> out, double factor = 1) const;
  /// f += int B^T sigma; what belongs to other ranks is brought home.   Cost: in the loop.
  void add_internal_force(std::span<const Stress> stresses, Vector &f) const;
  /// Bound of the largest omega^2 of the mesh, (rad/s)^2: the largest of any cell (Irons & Treharne 1971), for an
  /// isotropic skeleton with these moduli; `shear_only`: vertical motion is held.   Cost: in the loop.
  double max_frequency_squared(std::span<const WaveModuli> moduli, bool shear_only) const;

  const MeshSpec &mesh() const { return mesh_; }
  const Supports &supports() const { return supports_; }
  MPI_Comm communicator() const { return communicator_; }
  bool shared_out() const { return shared_out_; }                 ///< over several ranks
  const dealii::DoFHandler<dim> &nodes() const { return nodes_; } ///< one unknown per displacement node
  const dealii::DoFHandler<dim> &pressure_nodes() const { return pressures_; }
  /// Local displacement unknown of a node of nodes(), ties resolved.   @pre one of this rank's cells has the node
  unsigned dof_of_node(dealii::types::global_dof_index node, unsigned component) const;
  unsigned pressure_of_node(dealii::types::global_dof_index node) const;

private:
  using Partition = std::shared_ptr<const dealii::Utilities::MPI::Partitioner>;
  using Index = dealii::types::global_dof_index;

  void make_mesh();
  void make_unknowns();
  void make_tables();
  void make_supports();
  void make_frequencies();
  void tie_faces();

  MeshSpec mesh_;
  Supports supports_;
  MPI_Comm communicator_;
  bool shared_out_; ///< over several ranks
  std::unique_ptr<dealii::Triangulation<dim>> triangulation_;
  dealii::FE_Q<dim> displacement_element_, pressure_element_;
  dealii::DoFHandler<dim> nodes_, pressures_;
  std::size_t nodes_per_cell_ = 0, points_per_cell_ = 0;
  std::array<std::map<Index, Index>, 3> masters_; ///< of displacement nodes that a tie removes, for each component
  std::map<Index, Index> pressure_masters_;
  Partition displacement_partition_, pressure_partition_;
  std::vector<double> cell_frequency_; ///< omega^2 per Pa of wave modulus, without the layer's density
};
} // namespace isostat
