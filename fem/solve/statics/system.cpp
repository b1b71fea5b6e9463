// SPDX-License-Identifier: BSD-3-Clause
// Numbers in brackets are equations of docs/theory_column.md.
#include "fem/solve/statics/system.hpp"

#include "base/error.hpp"
#include "fem/linear/linear_solver.hpp"

#include <cmath>
#include <fmt/format.h>
#include <tuple>

namespace isostat
{
namespace
{
/// B of a point: strain (as strain() orders it, shear as gamma) per displacement of its cell's nodes, 6 rows, columns
/// [node][3], 1/m.
void strain_matrix(const CellTables &t, std::size_t point, Eigen::Matrix<double, 6, Eigen::Dynamic> &b)
{
  for (std::size_t a = 0; a < t.n_nodes; ++a)
    {
      std::array<double, 3> g = {0, 0, 0};
      for (unsigned d = 0; d < t.dimension; ++d)
        g[mesh_axes[t.dimension][d]] = t.gradient[(point * t.n_nodes + a) * t.dimension + d];
      b.middleCols<3>(3 * a) << g[0], 0, 0, 0, g[1], 0, 0, 0, g[2], 0, g[2], g[1], g[2], 0, g[0], g[1], g[0], 0;
    }
}

/// Ends the assembly of a matrix and removes held rows and columns from it.   @return these columns, as they were
PetscMatrix assembled(Mat matrix, const std::vector<PetscInt> &held, double diagonal)
{
  MPI_Comm communicator = PetscObjectComm(reinterpret_cast<PetscObject>(matrix));
  PetscInt first = 0, end = 0;
  petsc_check(MatGetOwnershipRange(matrix, &first, &end));
  for (PetscInt row = first; row < end; ++row) // of rows that no cell has, too
    petsc_check(MatSetValue(matrix, row, row, 0, ADD_VALUES));
  petsc_check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  petsc_check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  petsc_check(MatSetOption(matrix, MAT_KEEP_NONZERO_PATTERN, PETSC_TRUE));
  IS rows = nullptr, columns = nullptr;
  Mat removed = nullptr;
  petsc_check(ISCreateStride(communicator, end - first, first, 1, &rows));
  petsc_check(
      ISCreateGeneral(communicator, static_cast<PetscInt>(held.size()), held.data(), PETSC_USE_POINTER, &columns));
  petsc_check(MatCreateSubMatrix(matrix, rows, columns, MAT_INITIAL_MATRIX, &removed));
  petsc_check(ISDestroy(&rows));
  petsc_check(ISDestroy(&columns));
  petsc_check(MatZeroRowsColumns(matrix, static_cast<PetscInt>(held.size()), held.data(), diagonal, nullptr, nullptr));
  return PetscMatrix(removed);
}

/// Options of the blocks of a split where the user gives no others.
constexpr const char *split_blocks =
    "-statics_fieldsplit_u_ksp_type gmres -statics_fieldsplit_u_ksp_rtol 1e-2 -statics_fieldsplit_u_pc_type gamg "
    "-statics_fieldsplit_p_ksp_type preonly -statics_fieldsplit_p_pc_type hypre";
} // namespace

struct StaticsSystem::Matrices
{
  double pressure_scale = 1, cell_size = 1;
  std::size_t n_u = 0, n_p = 0;     ///< owned rows
  std::vector<PetscInt> of_u, of_p; ///< number in the system of owned and other unknowns
  // of the i-th owned row
  PetscInt row(std::size_t i) const { return i < n_u ? of_u[i] : of_p[i - n_u]; }
  double &entry(MixedVector &x, std::size_t i) const
  {
    return i < n_u ? x.u.local_element(i) : x.p.local_element(i - n_u);
  }
  std::vector<PetscInt> of_schur;     ///< number among pressures alone, likewise
  std::vector<unsigned> unused, held; ///< owned rows that no cell has; held ones
  const BiotOperator *water = nullptr;
  std::vector<Stiffness> known_tangents; ///< that the factor is of
  double known_theta = -1;
  Vector inertia;              ///< on the diagonal of K
  double velocity = 0;         ///< per displacement, 1/s; 0 without inertia
  PetscMatrix matrix, of_held; ///< held rows and columns removed; the columns that it had
  PetscMatrix schur;           ///< (16a), for a split; else none
  PetscVector in, out, held_in;
  PetscNullSpace motions;
  std::unique_ptr<LinearSolver> solver;
};

StaticsSystem::StaticsSystem(const FiniteElementSpace &space, const BiotOperator *water, double pressure_scale,
                             const std::string &options, bool moves)
    : space_(space), matrices_(std::make_unique<Matrices>())
{
  Matrices &m = *matrices_;
  m.water = water;
  m.pressure_scale = pressure_scale;
  double size[2] = {0, static_cast<double>(space.n_cells())};
  for (double w : space.weight)
    size[0] += w;
  space.sum_over_ranks(size);
  m.cell_size = std::pow(size[0] / size[1], 1.0 / space.dimension);
  number_unknowns();
  // MUMPS: no permutation by values, scaling found at each factorisation, per cent of spare room for pivots. Its
  // analysis does not look at values: a resumed run has the same pivots. With inertia (16) is quasi-definite and needs
  // no pivots (Vanderbei 1995, doi:10.1137/0805005), and of a column PETSc's LU takes a seventh of the time.
  const DirectSolver mumps{MATSOLVERMUMPS, nullptr, {{6, 0}, {8, 7}, {14, 60}}}, own{MATSOLVERPETSC, MATORDERINGND};
  m.solver = std::make_unique<LinearSolver>(
      space.communicator(), "statics_", options, moves && space.dimension == 1 ? own : mumps,
      [this](KSP ksp) { tell_structure(ksp); }, split_blocks);
  const bool tells_blocks = !options.empty() && !water;
  preallocate(tells_blocks ? 3 : 1);
  hold({}, {});
  if (tells_blocks && space.dimension > 1)
    petsc_check(MatSetNearNullSpace(m.matrix.get(), rigid_motions()));
}

StaticsSystem::~StaticsSystem() = default;

double StaticsSystem::force_per_volume() const { return matrices_->pressure_scale / matrices_->cell_size; }

/// Each rank's displacements come first, its pressures behind them.
void StaticsSystem::number_unknowns()
{
  Matrices &m = *matrices_;
  Vector u = space_.displacement_vector(), p = space_.pressure_vector();
  m.n_u = u.locally_owned_size();
  m.n_p = m.water ? p.locally_owned_size() : 0;
  PetscInt mine = m.n_u + m.n_p, first = 0;
  MPI_Exscan(&mine, &first, 1, MPIU_INT, MPI_SUM, space_.communicator());
  const auto number = [&](Vector &x, std::size_t n, PetscInt start, std::vector<PetscInt> &numbers) {
    for (std::size_t i = 0; i < n; ++i)
      x.local_element(i) = start + i; // exact: a PetscInt of 32 bits
    x.update_ghost_values();
    numbers.assign(x.begin(), x.begin() + x.n_local());
  };
  number(u, m.n_u, first, m.of_u);
  number(p, m.n_p, first + m.n_u, m.of_p);
  mine = m.n_p, first = 0;
  MPI_Exscan(&mine, &first, 1, MPIU_INT, MPI_SUM, space_.communicator());
  number(p, m.n_p, first, m.of_schur);
  const auto find_unused = [&](Vector uses, const std::vector<unsigned> &of_cells, std::size_t n, unsigned start) {
    for (unsigned i : of_cells)
      uses.local_element(i) = 1;
    uses.add_ghosts_to_owners();
    for (unsigned i = 0; i < n; ++i)
      if (uses.local_element(i) == 0)
        m.unused.push_back(start + i);
  };
  find_unused(space_.displacement_vector(), space_.cell_dofs, m.n_u, 0);
  std::vector<unsigned> wet; // above the water table there is no equation for the pressure
  const std::size_t n_i = space_.pressure_nodes_per_cell();
  for (std::size_t k = 0; k < space_.cell_pressures.size(); ++k)
    if (space_.cell_is_wet[k / n_i])
      wet.push_back(space_.cell_pressures[k]);
  find_unused(space_.pressure_vector(), wet, m.n_p, m.n_u);
}

/// Rows that a cell has, and those of its pressures in (16a).
void StaticsSystem::rows_of(std::size_t cell, std::vector<PetscInt> &rows, std::vector<PetscInt> &schur) const
{
  const Matrices &m = *matrices_;
  const std::size_t n_u = 3 * space_.n_nodes, n_i = m.water ? space_.pressure_nodes_per_cell() : 0;
  rows.resize(n_u + n_i);
  schur.resize(n_i);
  for (std::size_t k = 0; k < n_u; ++k)
    rows[k] = m.of_u[space_.cell_dofs[cell * n_u + k]];
  for (std::size_t k = 0; k < n_i; ++k)
    {
      rows[n_u + k] = m.of_p[space_.cell_pressures[cell * n_i + k]];
      schur[k] = m.of_schur[space_.cell_pressures[cell * n_i + k]];
    }
}

void StaticsSystem::preallocate(int block)
{
  Matrices &m = *matrices_;
  const bool splits = m.water && m.solver->splits();
  PetscPattern whole(space_.communicator(), m.n_u + m.n_p, block), schur(space_.communicator(), m.n_p);
  std::vector<PetscInt> rows, of_schur;
  for (std::size_t cell = 0; cell < space_.n_cells(); ++cell)
    {
      rows_of(cell, rows, of_schur);
      whole.add(rows);
      if (splits)
        schur.add(of_schur);
    }
  m.matrix = whole.matrix();
  if (splits)
    m.schur = schur.matrix();
  Vec in = nullptr, out = nullptr;
  petsc_check(MatCreateVecs(m.matrix.get(), &in, &out));
  m.in.reset(in);
  m.out.reset(out);
}

void StaticsSystem::hold(const std::vector<unsigned> &displacements, const std::vector<unsigned> &pressures)
{
  Matrices &m = *matrices_;
  std::vector<bool> is_held(m.n_u + m.n_p, false);
  for (unsigned i : m.unused)
    is_held[i] = true;
  for (unsigned i : displacements)
    is_held[i] = true;
  for (unsigned i : pressures)
    is_held[m.n_u + i] = true;
  std::vector<unsigned> held;
  for (unsigned i = 0; i < is_held.size(); ++i)
    if (is_held[i])
      held.push_back(i);
  if (held != m.held)
    m.known_tangents.clear();
  m.held = std::move(held);
}

void StaticsSystem::set_tangent(std::span<const Stiffness> tangents, double theta)
{
  Matrices &m = *matrices_;
  const bool same = m.known_theta == theta && std::ranges::equal(tangents, m.known_tangents);
  if (space_.on_every_rank(same))
    return;
  m.known_tangents.clear();
  assemble(tangents, theta);
  factorise();
  m.known_theta = theta;
  m.known_tangents.assign(tangents.begin(), tangents.end());
}

void StaticsSystem::forget_tangent() { matrices_->known_tangents.clear(); }

void StaticsSystem::set_inertia(const Vector &diagonal, double velocity)
{
  matrices_->inertia = diagonal;
  matrices_->velocity = velocity;
  forget_tangent();
}

void StaticsSystem::assemble(std::span<const Stiffness> tangents, double theta)
{
  Matrices &m = *matrices_;
  const std::size_t n_u = 3 * space_.n_nodes, n_q = space_.points_per_cell();
  const std::size_t n_i = m.water ? space_.pressure_nodes_per_cell() : 0, n = n_u + n_i;
  using RowByRow = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Matrix<double, 6, Eigen::Dynamic> b(6, n_u);
  RowByRow k(n, n), schur(n_i, n_i);
  std::vector<PetscInt> rows, of_schur;
  petsc_check(MatZeroEntries(m.matrix.get()));
  if (m.schur)
    petsc_check(MatZeroEntries(m.schur.get()));
  if (m.velocity > 0)
    for (std::size_t i = 0; i < m.n_u; ++i)
      petsc_check(MatSetValue(m.matrix.get(), m.of_u[i], m.of_u[i], m.inertia.local_element(i), ADD_VALUES));
  for (std::size_t cell = 0; cell < space_.n_cells(); ++cell)
    {
      k.setZero();
      schur.setZero();
      for (std::size_t q = cell * n_q; q < (cell + 1) * n_q; ++q)
        {
          strain_matrix(space_, q, b); // K of (16): int B^T C B
          k.topLeftCorner(n_u, n_u) += space_.weight[q] * b.transpose() * (tangents[q] * b);
          if (m.schur) // M_p of (16a)
            {
              const Eigen::Map<const Eigen::VectorXd> shape(space_.pressure_shapes(q), n_i);
              const double modulus = std::max(tangents[q].topLeftCorner<3, 3>().trace() / 3, 1e-3 * m.pressure_scale);
              schur += space_.weight[q] / modulus * shape * shape.transpose();
            }
        }
      if (m.water) // -G, -G^T, -(S + theta H), pressures in units of the scale
        {
          const BiotCell &water = m.water->cell(cell);
          const double scale = m.pressure_scale;
          k.bottomLeftCorner(n_i, n_u) = -scale * water.g;
          if (m.velocity > 0)
            k.bottomLeftCorner(n_i, n_u) -= scale * m.velocity * water.l;
          k.topRightCorner(n_u, n_i) = -scale * water.g.transpose();
          k.bottomRightCorner(n_i, n_i) = -scale * scale * (water.s + theta * water.h);
          schur = k.bottomRightCorner(n_i, n_i) - scale * scale * schur; // (16a)
        }
      rows_of(cell, rows, of_schur);
      petsc_check(MatSetValues(m.matrix.get(), n, rows.data(), n, rows.data(), k.data(), ADD_VALUES));
      if (m.schur)
        petsc_check(MatSetValues(m.schur.get(), n_i, of_schur.data(), n_i, of_schur.data(), schur.data(), ADD_VALUES));
    }
}

void StaticsSystem::factorise()
{
  Matrices &m = *matrices_;
  std::vector<PetscInt> rows, of_schur;
  for (unsigned i : m.held)
    {
      rows.push_back(m.row(i));
      if (i >= m.n_u)
        of_schur.push_back(m.of_schur[i - m.n_u]);
    }
  m.of_held = assembled(m.matrix.get(), rows, m.pressure_scale);
  Vec held_in = nullptr;
  petsc_check(MatCreateVecs(m.of_held.get(), &held_in, nullptr));
  m.held_in.reset(held_in);
  if (m.schur)
    assembled(m.schur.get(), of_schur, m.pressure_scale);
  try
    {
      m.solver->set_matrix(m.matrix.get());
    }
  catch (const RunFailure &failure)
    {
      throw RunFailure(
          fmt::format("the tangent is singular: a part moves freely, or a soil has no stiffness ({})", failure.what()));
    }
}

/// For -statics_pc_type fieldsplit: displacements and pressures by name, (16a), and what the user's options may
/// replace. The matrix of displacements gets from their name what it has without pressures.
void StaticsSystem::tell_structure(KSP ksp) const
{
  const Matrices &m = *matrices_;
  if (!m.schur)
    return;
  PC pc = nullptr;
  petsc_check(KSPGetPC(ksp, &pc));
  petsc_check(KSPSetType(ksp, KSPFGMRES));
  petsc_check(PCFieldSplitSetType(pc, PC_COMPOSITE_SCHUR));
  petsc_check(PCFieldSplitSetSchurFactType(pc, PC_FIELDSPLIT_SCHUR_FACT_UPPER));
  petsc_check(PCFieldSplitSetSchurPre(pc, PC_FIELDSPLIT_SCHUR_PRE_USER, m.schur.get()));
  for (const auto &[name, n, start] : {std::tuple{"u", m.n_u, m.of_u.front()}, {"p", m.n_p, m.of_p.front()}})
    {
      IS rows = nullptr;
      petsc_check(ISCreateStride(space_.communicator(), static_cast<PetscInt>(n), start, 1, &rows));
      if (start == m.of_u.front() && space_.dimension > 1)
        {
          petsc_check(ISSetBlockSize(rows, 3));
          petsc_check(PetscObjectCompose(reinterpret_cast<PetscObject>(rows), "nearnullspace",
                                         reinterpret_cast<PetscObject>(rigid_motions())));
        }
      petsc_check(PCFieldSplitSetIS(pc, name, rows));
      petsc_check(ISDestroy(&rows));
    }
}

/// Motions without strain, which algebraic multigrid needs on coarse levels.
MatNullSpace StaticsSystem::rigid_motions() const
{
  Matrices &m = *matrices_;
  Vec places = nullptr;
  petsc_check(VecCreateMPI(space_.communicator(), static_cast<PetscInt>(m.n_u), PETSC_DETERMINE, &places));
  const PetscVector owner(places);
  petsc_check(VecSetBlockSize(places, 3));
  double *values;
  petsc_check(VecGetArrayWrite(places, &values));
  const std::vector<Place> of_nodes = space_.node_places();
  for (std::size_t i = 0; i < m.n_u; ++i)
    values[i] = of_nodes[i][i % 3];
  petsc_check(VecRestoreArrayWrite(places, &values));
  MatNullSpace motions = nullptr;
  petsc_check(MatNullSpaceCreateRigidBody(places, &motions));
  m.motions.reset(motions);
  return motions;
}

LinearEffort StaticsSystem::effort() const { return matrices_->solver->effort(); }

void StaticsSystem::load(MixedVector &x, double p_factor) const
{
  const Matrices &m = *matrices_;
  double *in;
  petsc_check(VecGetArrayWrite(m.in.get(), &in));
  for (std::size_t i = 0; i < m.n_u + m.n_p; ++i)
    in[i] = (i < m.n_u ? 1 : p_factor) * m.entry(x, i);
  petsc_check(VecRestoreArrayWrite(m.in.get(), &in));
}

void StaticsSystem::unload(MixedVector &x, double p_factor) const
{
  const Matrices &m = *matrices_;
  const double *out;
  petsc_check(VecGetArrayRead(m.out.get(), &out));
  for (std::size_t i = 0; i < m.n_u + m.n_p; ++i)
    m.entry(x, i) = (i < m.n_u ? 1 : p_factor) * out[i];
  petsc_check(VecRestoreArrayRead(m.out.get(), &out));
}

/// (16) with held unknowns: A x = r - A x_held for the others, x = x_held for these.
void StaticsSystem::solve(const MixedVector &residual, MixedVector &step, MixedVector &moved) const
{
  const Matrices &m = *matrices_;
  const double scale = m.pressure_scale;
  MixedVector rhs = residual;
  double *held = nullptr;
  petsc_check(VecGetArrayWrite(m.held_in.get(), &held));
  for (unsigned i : m.held) // the residual loses what the held increments alone make: A x_held
    *held++ = m.entry(step, i) / (i < m.n_u ? 1 : scale);
  petsc_check(VecRestoreArrayWrite(m.held_in.get(), nullptr));
  petsc_check(MatMult(m.of_held.get(), m.held_in.get(), m.out.get()));
  unload(moved, 1 / scale);
  rhs.u -= moved.u;
  rhs.p -= moved.p;
  for (unsigned i : m.held) // their rows say: scale x = scale given
    m.entry(rhs, i) = m.entry(step, i) * (i < m.n_u ? scale : 1 / scale);
  load(rhs, scale);
  m.solver->solve(m.in.get(), m.out.get());
  unload(step, scale);
}
} // namespace isostat
