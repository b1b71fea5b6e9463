// SPDX-License-Identifier: BSD-3-Clause
#include "fem/water/pressure_system.hpp"

#include "fem/linear/linear_solver.hpp"
#include "fem/water/air_pressure.hpp"
#include "fem/water/biot_integrals.hpp"

#include <utility>

namespace isostat
{
struct PressureSystem::Matrices
{
  PetscMatrix storage;              ///< S/(2 dt); not with Boyle's law
  PetscMatrix to_force;             ///< G^T
  PetscMatrix ahead, behind;        ///< G/2 + L/dt, G/2 - L/dt
  mutable LinearSolver solver;      ///< of the matrix of the pressure; Boyle's law has it
  std::unique_ptr<AirPressure> air; ///< Boyle's law
  std::array<Vector, 3> base_flow;  ///< L times a unit acceleration along each axis: int kb rho_f grad N_i
  std::vector<unsigned> held;       ///< owned unknowns with p = 0: drained, or removed by a tie
  mutable Vector right_hand_side, work;
  PetscView of_u, of_p, of_residual;
};

namespace
{
/// G, L, S and H of docs/theory_column.md (7), of all cells of this rank, as entries of sparse matrices over all ranks:
/// rows are pressures; columns displacements (G, L, the same entries) or pressures (S, H; every diagonal one,
/// of S also for unknowns that no cell has).
struct BiotEntries
{
  PetscEntries g, l, s, h;
  std::size_t n_pressures = 0, n_displacements = 0; ///< owned by this rank
  MPI_Comm communicator = MPI_COMM_SELF;

  BiotEntries(const FiniteElementSpace &space, const CellGeometry &at, const PorousPoints &points);

  PetscMatrix coupling(double a, double b) const; ///< a G + b L
  PetscMatrix to_force() const;                   ///< G^T
  PetscMatrix storage(double divisor) const;      ///< S / divisor
  PetscMatrix seepage() const;                    ///< H
};

BiotEntries::BiotEntries(const FiniteElementSpace &space, const CellGeometry &at, const PorousPoints &points)
    : communicator(space.communicator())
{
  const Vector u = space.displacement_vector(), p = space.pressure_vector();
  n_displacements = u.locally_owned_size();
  n_pressures = p.locally_owned_size();
  const std::size_t n_u = 3 * space.n_nodes, n_i = space.pressure_nodes_per_cell();
  for (std::size_t cell = 0; cell < space.n_cells(); ++cell)
    {
      const BiotCell c = biot_cell(space, at, points, cell);
      for (std::size_t i = 0; i < n_i; ++i)
        {
          const PetscInt row = p.global_index(space.cell_pressures[cell * n_i + i]);
          for (std::size_t j = 0; j < n_i; ++j)
            {
              const PetscInt column = p.global_index(space.cell_pressures[cell * n_i + j]);
              s.add(row, column, c.s(i, j));
              h.add(row, column, c.h(i, j));
            }
          for (std::size_t k = 0; k < n_u; ++k)
            if (c.g(i, k) != 0 || c.l(i, k) != 0)
              {
                const PetscInt column = u.global_index(space.cell_dofs[cell * n_u + k]);
                g.add(row, column, c.g(i, k));
                l.add(row, column, c.l(i, k));
              }
        }
    }
  for (std::size_t i = 0; i < n_pressures; ++i)
    s.add(p.first_owned() + i, p.first_owned() + i, 0);
}

PetscMatrix BiotEntries::coupling(double a, double b) const
{
  PetscEntries sum = g;
  for (std::size_t k = 0; k < sum.values.size(); ++k)
    sum.values[k] = a * g.values[k] + b * l.values[k];
  return petsc_matrix(communicator, n_pressures, n_displacements, sum);
}

PetscMatrix BiotEntries::to_force() const
{
  PetscEntries transposed = g;
  std::swap(transposed.rows, transposed.columns);
  return petsc_matrix(communicator, n_displacements, n_pressures, transposed);
}

PetscMatrix BiotEntries::storage(double divisor) const
{
  PetscEntries scaled = s;
  for (double &value : scaled.values)
    value /= divisor;
  return petsc_matrix(communicator, n_pressures, n_pressures, scaled);
}

PetscMatrix BiotEntries::seepage() const
{
  PetscEntries entries = h;
  return petsc_matrix(communicator, n_pressures, n_pressures, entries);
}

std::array<Vector, 3> base_flows(const FiniteElementSpace &space, const CellGeometry &at, const PorousPoints &points)
{
  const std::size_t n_i = space.pressure_nodes_per_cell(), n_q = space.points_per_cell();
  std::array<Vector, 3> flows;
  for (Vector &flow : flows)
    flow = space.pressure_vector();
  for (std::size_t point = 0; point < space.n_points(); ++point)
    {
      if (!space.cell_is_wet[point / n_q])
        continue;
      for (std::size_t i = 0; i < n_i; ++i)
        for (unsigned d = 0; d < space.dimension; ++d)
          flows[mesh_axes[space.dimension][d]].local_element(space.cell_pressures[point / n_q * n_i + i]) +=
              at.weight[point] * points.mobility[point] * points.fluid_density *
              at.pressure_gradient[(point * n_i + i) * space.dimension + d];
    }
  for (Vector &flow : flows)
    flow.add_ghosts_to_owners();
  return flows;
}

/// factor S/(2 dt) + H + (G/2 + L/dt) D G^T, equation (8); rows of held pressures are those of the identity. The
/// pattern has room for S whatever the factor.
PetscMatrix pressure_matrix(const BiotEntries &entries, Mat storage, double factor, Mat to_force, double time_step,
                            Vec update, const std::vector<PetscInt> &held)
{
  const PetscMatrix ahead = entries.coupling(0.5, 1 / time_step), seepage = entries.seepage();
  petsc_check(MatDiagonalScale(ahead.get(), nullptr, update));
  Mat product = nullptr, matrix = nullptr;
  petsc_check(MatMatMult(ahead.get(), to_force, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &product));
  const PetscMatrix product_owner(product);
  petsc_check(MatDuplicate(storage, MAT_COPY_VALUES, &matrix));
  PetscMatrix owner(matrix);
  petsc_check(MatScale(matrix, factor));
  petsc_check(MatAXPY(matrix, 1, seepage.get(), DIFFERENT_NONZERO_PATTERN));
  petsc_check(MatAXPY(matrix, 1, product, DIFFERENT_NONZERO_PATTERN));
  petsc_check(MatSetOption(matrix, MAT_KEEP_NONZERO_PATTERN, factor == 0 ? PETSC_TRUE : PETSC_FALSE));
  petsc_check(MatZeroRows(matrix, held.size(), held.data(), 1, nullptr, nullptr));
  return owner;
}
/// LU of PETSc on one rank, in natural order if the matrix is banded, else by nested dissection; MUMPS on several.
LinearSolver pressure_solver(const FiniteElementSpace &space, const std::string &options)
{
  const DirectSolver alone{MATSOLVERPETSC, space.dimension == 1 ? MATORDERINGNATURAL : MATORDERINGND, {}};
  return {space.communicator(), "water_", options, space.shared_out() ? DirectSolver{MATSOLVERMUMPS} : alone};
}
} // namespace

PressureSystem::PressureSystem(const FiniteElementSpace &space, const CellGeometry &at, double time_step,
                               const Vector &update, std::span<const double> volume_strains, const std::string &options)
{
  const MPI_Comm communicator = space.communicator();
  const PorousPoints points = porous_points(space, volume_strains);
  const BiotEntries entries(space, at, points);
  const std::size_t n_p = entries.n_pressures;
  const Vector zero = space.pressure_vector();
  matrices_.reset(new Matrices{.storage = entries.storage(2 * time_step),
                               .to_force = entries.to_force(),
                               .ahead = entries.coupling(0.5, 1 / time_step),
                               .behind = entries.coupling(0.5, -1 / time_step),
                               .solver = pressure_solver(space, options),
                               .air = {},
                               .base_flow = base_flows(space, at, points),
                               .held = held_pressures(space, n_p),
                               .right_hand_side = zero,
                               .work = zero,
                               .of_u = PetscView(communicator, entries.n_displacements),
                               .of_p = PetscView(communicator, n_p),
                               .of_residual = PetscView(communicator, n_p)});
  Matrices &m = *matrices_;
  std::vector<PetscInt> held;
  for (unsigned p : m.held)
    held.push_back(zero.global_index(p));
  const bool boyle = has_boyle_air(space.mesh().soil);
  PetscMatrix matrix =
      pressure_matrix(entries, m.storage.get(), boyle ? 0 : 3, m.to_force.get(), time_step, m.of_u.of(update), held);
  m.of_u.release();
  if (boyle)
    m.air = std::make_unique<AirPressure>(space, at.weight, time_step, std::move(matrix), m.solver, m.held);
  else
    m.solver.set_matrix(matrix.get());
}

PressureSystem::~PressureSystem() = default;

void PressureSystem::solve(const Vector &v_star, const Vector &v_before, const Vector &p_before,
                           const Vector &p_before_that, const std::array<double, 3> &base_acceleration,
                           const Vector *inflow, Vector &p) const
{
  const Matrices &m = *matrices_;
  const std::size_t n = m.work.locally_owned_size();
  double *rhs = m.right_hand_side.begin(), *work = m.work.begin();
  // right-hand side of (8), term by term: S (4p' - p'')/(2 dt), which AirPressure has itself
  if (m.air)
    m.right_hand_side = 0;
  else
    {
      for (std::size_t i = 0; i < n; ++i)
        work[i] = 4 * p_before.local_element(i) - p_before_that.local_element(i);
      petsc_check(MatMult(m.storage.get(), m.of_p.of(m.work), m.of_residual.of(m.right_hand_side)));
      m.of_p.release();
      m.of_residual.release();
    }
  // - (G/2 + L/dt) v*
  petsc_check(MatMult(m.ahead.get(), m.of_u.of(v_star), m.of_p.of(m.work)));
  m.of_u.release();
  for (std::size_t i = 0; i < n; ++i)
    rhs[i] -= work[i];
  // - (G/2 - L/dt) v-
  petsc_check(MatMult(m.behind.get(), m.of_u.of(v_before), m.of_p.vec()));
  m.of_u.release();
  for (std::size_t i = 0; i < n; ++i)
    rhs[i] -= work[i];
  // - L a_base
  for (int axis = 0; axis < 3; ++axis)
    if (base_acceleration[axis] != 0)
      for (std::size_t i = 0; i < n; ++i)
        rhs[i] -= base_acceleration[axis] * m.base_flow[axis].local_element(i);
  for (std::size_t i = 0; inflow && i < n; ++i)
    rhs[i] += inflow->local_element(i);
  for (unsigned held : m.held)
    rhs[held] = 0;
  m.of_p.release();
  if (m.air)
    return m.air->solve(m.right_hand_side, p_before, p_before_that, p);
  m.solver.solve(m.of_residual.of(m.right_hand_side), m.of_p.of(p));
  m.of_p.release();
  m.of_residual.release();
}

LinearEffort PressureSystem::effort() const { return matrices_->solver.effort(); }

void PressureSystem::force(const Vector &p, Vector &f) const
{
  const Matrices &m = *matrices_;
  petsc_check(MatMult(m.to_force.get(), m.of_p.of(p), m.of_u.of(f)));
  m.of_p.release();
  m.of_u.release();
}
} // namespace isostat
