// SPDX-License-Identifier: BSD-3-Clause
#include "fem/water/biot.hpp"

#include "fem/space/axes.hpp"
#include "fem/space/petsc_check.hpp"
#include "fem/water/biot_integrals.hpp"

#include <petscmat.h>

namespace isostat
{
namespace
{
void check(PetscErrorCode code) { petsc_check(code, "pore pressure system"); }

/// Entries (row, column, value) that add up.
struct Triplets
{
  std::vector<PetscInt> rows, columns;
  std::vector<double> values;

  void add(PetscInt row, PetscInt column, double value)
  {
    rows.push_back(row);
    columns.push_back(column);
    values.push_back(value);
  }
};

Mat assembled(MPI_Comm communicator, std::size_t n_rows, std::size_t n_columns, Triplets &entries)
{
  Mat matrix;
  check(MatCreate(communicator, &matrix));
  check(MatSetSizes(matrix, n_rows, n_columns, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetType(matrix, MATAIJ));
  check(MatSetPreallocationCOO(matrix, entries.rows.size(), entries.rows.data(), entries.columns.data()));
  check(MatSetValuesCOO(matrix, entries.values.data(), INSERT_VALUES));
  return matrix;
}

/// A PETSc vector that looks at the owned part of one of ours.
class View
{
public:
  View(MPI_Comm communicator, std::size_t n_owned)
  {
    check(VecCreateMPIWithArray(communicator, 1, n_owned, PETSC_DETERMINE, nullptr, &vec_));
  }
  ~View() { VecDestroy(&vec_); }
  View(const View &) = delete;
  View &operator=(const View &) = delete;
  Vec of(const Vector &ours) const
  {
    check(VecPlaceArray(vec_, const_cast<double *>(ours.begin())));
    return vec_;
  }
  Vec vec() const { return vec_; }
  void release() const { check(VecResetArray(vec_)); }

private:
  Vec vec_ = nullptr;
};
} // namespace

std::vector<PorousLayer> porous_layers(const SoilProfile &soil)
{
  std::vector<PorousLayer> layers;
  for (const Layer &layer : soil.layers)
    layers.push_back({layer.porosity / soil.water.bulk_modulus, soil.water.mobility(layer.permeability)});
  return layers;
}

template <int dim>
struct PressureSystem<dim>::Matrices
{
  Mat storage = nullptr;                 ///< S/(2 dt)
  Mat to_force = nullptr;                ///< G^T
  Mat ahead = nullptr, behind = nullptr; ///< G/2 + L/dt, G/2 - L/dt
  Mat factor = nullptr;                  ///< of the matrix of the pressure
  std::array<Vector, 3> base_flow;       ///< int kb rho_f grad N_i, along each axis
  std::vector<unsigned> held;            ///< owned unknowns with p = 0: drained, or removed by a tie
  mutable Vector right_hand_side, work;
  std::unique_ptr<View> of_u, of_p, of_pressure_residual;

  ~Matrices()
  {
    for (Mat *matrix : {&storage, &to_force, &ahead, &behind, &factor})
      MatDestroy(matrix);
  }
};

namespace
{
/// Element integrals of all cells as entries of the global matrices.
struct BiotEntries
{
  Triplets g, l, s, h;
};

template <int dim>
BiotEntries integrate(const Discretisation<dim> &space, const std::vector<PorousLayer> &layers, double fluid_density)
{
  BiotEntries e;
  const std::size_t n_u = 3 * space.nodes_per_cell(), n_i = space.pressure_nodes_per_cell();
  const auto u_part = space.displacement_vector().get_partitioner(), p_part = space.pressure_vector().get_partitioner();
  for (std::size_t cell = 0; cell < space.n_cells(); ++cell)
    {
      const BiotCell c = biot_cell(space, layers[space.cell_layer[cell]], fluid_density, cell);
      for (std::size_t i = 0; i < n_i; ++i)
        {
          const PetscInt row = p_part->local_to_global(space.cell_pressures[cell * n_i + i]);
          for (std::size_t j = 0; j < n_i; ++j)
            {
              const PetscInt column = p_part->local_to_global(space.cell_pressures[cell * n_i + j]);
              e.s.add(row, column, c.s(i, j));
              e.h.add(row, column, c.h(i, j));
            }
          for (std::size_t k = 0; k < n_u; ++k)
            if (c.g(i, k) != 0 || c.l(i, k) != 0)
              {
                const PetscInt column = u_part->local_to_global(space.cell_dofs[cell * n_u + k]);
                e.g.add(row, column, c.g(i, k));
                e.l.add(row, column, c.l(i, k));
              }
        }
    }
  return e;
}

/// a G + b L, or G^T with a = 1, b = 0 and `transposed`.
Mat combined(MPI_Comm communicator, std::size_t n_p, std::size_t n_u, const BiotEntries &e, double a, double b,
             bool transposed)
{
  Triplets sum = e.g;
  for (std::size_t k = 0; k < sum.values.size(); ++k)
    sum.values[k] = a * e.g.values[k] + b * e.l.values[k];
  if (transposed)
    std::swap(sum.rows, sum.columns);
  return transposed ? assembled(communicator, n_u, n_p, sum) : assembled(communicator, n_p, n_u, sum);
}

/// LU of a square matrix: PETSc's own on one rank, MUMPS on several.
Mat factorised(Mat matrix, MPI_Comm communicator, bool banded)
{
  int n_ranks = 1;
  MPI_Comm_size(communicator, &n_ranks);
  Mat factor;
  check(MatGetFactor(matrix, n_ranks > 1 ? MATSOLVERMUMPS : MATSOLVERPETSC, MAT_FACTOR_LU, &factor));
  IS rows = nullptr, columns = nullptr;
  if (n_ranks == 1)
    check(MatGetOrdering(matrix, banded ? MATORDERINGNATURAL : MATORDERINGND, &rows, &columns));
  MatFactorInfo info;
  check(MatFactorInfoInitialize(&info));
  check(MatLUFactorSymbolic(factor, matrix, rows, columns, &info));
  check(MatLUFactorNumeric(factor, matrix, &info));
  check(ISDestroy(&rows));
  check(ISDestroy(&columns));
  return factor;
}
} // namespace

template <int dim>
PressureSystem<dim>::PressureSystem(const Discretisation<dim> &space, double time_step, const Vector &update)
    : matrices_(std::make_unique<Matrices>())
{
  Matrices &m = *matrices_;
  const MPI_Comm communicator = space.communicator();
  const SoilProfile &soil = space.mesh().soil;
  m.right_hand_side = space.pressure_vector();
  m.work = space.pressure_vector();
  const std::size_t n_p = m.work.locally_owned_size(), n_u = update.locally_owned_size();
  m.of_u = std::make_unique<View>(communicator, n_u);
  m.of_p = std::make_unique<View>(communicator, n_p);
  m.of_pressure_residual = std::make_unique<View>(communicator, n_p);
  const std::vector<PorousLayer> layers = porous_layers(soil);
  BiotEntries e = integrate(space, layers, soil.water.density);
  make_base_flow(space, layers);

  const PetscInt first = m.work.get_partitioner()->local_range().first;
  for (std::size_t i = 0; i < n_p; ++i) // every diagonal entry is there, also of unknowns that no cell has
    e.s.add(first + i, first + i, 0);
  m.to_force = combined(communicator, n_p, n_u, e, 1, 0, true);
  m.ahead = combined(communicator, n_p, n_u, e, 0.5, 1 / time_step, false);
  m.behind = combined(communicator, n_p, n_u, e, 0.5, -1 / time_step, false);

  Mat step = combined(communicator, n_p, n_u, e, 0.5, 1 / time_step, false), product;
  check(MatDiagonalScale(step, nullptr, m.of_u->of(update)));
  m.of_u->release();
  check(MatMatMult(step, m.to_force, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &product));
  Triplets stored = e.s;
  for (double &value : stored.values)
    value /= 2 * time_step;
  m.storage = assembled(communicator, n_p, n_p, stored);
  Mat matrix, seepage = assembled(communicator, n_p, n_p, e.h);
  check(MatDuplicate(m.storage, MAT_COPY_VALUES, &matrix));
  check(MatScale(matrix, 3));
  check(MatAXPY(matrix, 1, seepage, DIFFERENT_NONZERO_PATTERN));
  check(MatAXPY(matrix, 1, product, DIFFERENT_NONZERO_PATTERN));
  hold(space, matrix);
  m.factor = factorised(matrix, communicator, dim == 1);
  for (Mat *unused : {&step, &product, &seepage, &matrix})
    check(MatDestroy(unused));
}

template <int dim>
PressureSystem<dim>::~PressureSystem() = default;

/// Rows of pressures that are 0 become identities. Soil without permeability does not feel that its surface is drained.
template <int dim>
void PressureSystem<dim>::hold(const Discretisation<dim> &space, void *matrix)
{
  Matrices &m = *matrices_;
  std::vector<bool> is_held(m.work.locally_owned_size(), true), can_flow(is_held.size(), false);
  const std::size_t n_i = space.pressure_nodes_per_cell();
  for (std::size_t k = 0; k < space.cell_pressures.size(); ++k)
    if (const unsigned p = space.cell_pressures[k]; p < is_held.size())
      {
        is_held[p] = false;
        can_flow[p] = can_flow[p] || space.mesh().soil.layers[space.cell_layer[k / n_i]].permeability > 0;
      }
  for (unsigned p : space.drained_pressures)
    if (p < is_held.size())
      is_held[p] = is_held[p] || can_flow[p];
  std::vector<PetscInt> rows;
  for (unsigned p = 0; p < is_held.size(); ++p)
    if (is_held[p])
      {
        m.held.push_back(p);
        rows.push_back(m.work.get_partitioner()->local_to_global(p));
      }
  check(MatZeroRows(static_cast<Mat>(matrix), rows.size(), rows.data(), 1, nullptr, nullptr));
}

template <int dim>
void PressureSystem<dim>::make_base_flow(const Discretisation<dim> &space, const std::vector<PorousLayer> &layers)
{
  Matrices &m = *matrices_;
  const std::size_t n_i = space.pressure_nodes_per_cell(), n_q = space.points_per_cell();
  for (Vector &flow : m.base_flow)
    flow = space.pressure_vector();
  for (std::size_t point = 0; point < space.n_points(); ++point)
    for (std::size_t i = 0; i < n_i; ++i)
      for (int d = 0; d < dim; ++d)
        m.base_flow[mesh_axes<dim>[d]].local_element(space.cell_pressures[point / n_q * n_i + i]) +=
            space.weight[point] * layers[space.cell_layer[point / n_q]].mobility * space.mesh().soil.water.density *
            space.pressure_gradient[(point * n_i + i) * dim + d];
  for (Vector &flow : m.base_flow)
    flow.compress(dealii::VectorOperation::add);
}

template <int dim>
void PressureSystem<dim>::solve(const Vector &v_star, const Vector &v_before, const Vector &p_before,
                                const Vector &p_before_that, const std::array<double, 3> &base_acceleration,
                                Vector &p) const
{
  const Matrices &m = *matrices_;
  const std::size_t n = m.work.locally_owned_size();
  double *rhs = m.right_hand_side.begin(), *work = m.work.begin();
  // right-hand side of docs/theory_column.md (8), term by term: S (4p' - p'')/(2 dt)
  for (std::size_t i = 0; i < n; ++i)
    work[i] = 4 * p_before.local_element(i) - p_before_that.local_element(i);
  check(MatMult(m.storage, m.of_p->of(m.work), m.of_pressure_residual->of(m.right_hand_side)));
  m.of_p->release();
  // - (G/2 + L/dt) v*
  check(MatMult(m.ahead, m.of_u->of(v_star), m.of_p->of(m.work)));
  m.of_u->release();
  for (std::size_t i = 0; i < n; ++i)
    rhs[i] -= work[i];
  // - (G/2 - L/dt) v-
  check(MatMult(m.behind, m.of_u->of(v_before), m.of_p->vec()));
  m.of_u->release();
  for (std::size_t i = 0; i < n; ++i)
    rhs[i] -= work[i];
  // - L a_base
  for (int axis = 0; axis < 3; ++axis)
    if (base_acceleration[axis] != 0)
      for (std::size_t i = 0; i < n; ++i)
        rhs[i] -= base_acceleration[axis] * m.base_flow[axis].local_element(i);
  for (unsigned held : m.held)
    rhs[held] = 0;
  m.of_p->release();
  check(MatSolve(m.factor, m.of_pressure_residual->vec(), m.of_p->of(p)));
  m.of_p->release();
  m.of_pressure_residual->release();
}

template <int dim>
void PressureSystem<dim>::force(const Vector &p, Vector &f) const
{
  const Matrices &m = *matrices_;
  check(MatMult(m.to_force, m.of_p->of(p), m.of_u->of(f)));
  m.of_p->release();
  m.of_u->release();
}

template class PressureSystem<1>;
template class PressureSystem<2>;
template class PressureSystem<3>;
} // namespace isostat
