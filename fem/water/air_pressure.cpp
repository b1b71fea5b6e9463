// SPDX-License-Identifier: BSD-3-Clause
#include "fem/water/air_pressure.hpp"

#include "base/error.hpp"
#include "fem/water/biot_integrals.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr unsigned most_iterations = 50;
/// Newton's error is squared by each iteration: after a change by this part of the atmospheric pressure, 1e-12 of it.
constexpr double small_change = 1e-6;

double largest(const Vector &v, const FiniteElementSpace &space)
{
  double size = 0;
  for (std::size_t i = 0; i < v.locally_owned_size(); ++i) // not-a-number is larger than all
    size = std::abs(v.local_element(i)) <= size ? size : std::abs(v.local_element(i));
  if (space.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, &size, 1, MPI_DOUBLE, MPI_MAX, space.communicator());
  return size;
}
} // namespace

AirPressure::AirPressure(const FiniteElementSpace &space, std::vector<double> volumes, double time_step,
                         PetscMatrix linear, LinearSolver &solver, const std::vector<unsigned> &held)
    : space_(space), volumes_(std::move(volumes)), two_steps_(2 * time_step), fluids_(pore_fluids(space)),
      linear_(std::move(linear)), solver_(solver), held_(space.pressure_vector()), residual_(held_), change_(held_),
      of_p_(space.communicator(), held_.locally_owned_size()),
      of_residual_(space.communicator(), held_.locally_owned_size())
{
  for (unsigned p : held)
    held_.local_element(p) = 1;
  held_.update_ghost_values();
  Mat copy = nullptr;
  petsc_check(MatDuplicate(linear_.get(), MAT_COPY_VALUES, &copy));
  tangent_.reset(copy);
}

/// linear p + int N_i (3 Theta(p) - 4 Theta(p') + Theta(p''))/(2 dt) - b; 0 at held pressures.
void AirPressure::find_residual(const Vector &b, const Vector &p)
{
  petsc_check(MatMult(linear_.get(), of_p_.of(p), of_residual_.of(change_)));
  of_p_.release();
  of_residual_.release();
  residual_ = 0;
  const std::vector<double> pressure = space_.point_pressures(p);
  const std::size_t n_i = space_.pressure_nodes_per_cell(), n_q = space_.points_per_cell();
  for (std::size_t q = 0; q < pressure.size(); ++q)
    {
      const double rate = volumes_[q] * (3 * fluids_[q].volume(pressure[q]) - before_[q]) / two_steps_;
      for (std::size_t i = 0; i < n_i; ++i)
        residual_.local_element(space_.cell_pressures[q / n_q * n_i + i]) += space_.pressure_shapes(q)[i] * rate;
    }
  residual_.add_ghosts_to_owners();
  for (std::size_t i = 0; i < residual_.locally_owned_size(); ++i)
    residual_.local_element(i) =
        held_.local_element(i) > 0 ? 0 : residual_.local_element(i) + change_.local_element(i) - b.local_element(i);
}

/// linear + 3/(2 dt) int N_i c(p) N_j, and its factors.
void AirPressure::find_tangent(const Vector &p)
{
  petsc_check(MatCopy(linear_.get(), tangent_.get(), SAME_NONZERO_PATTERN));
  const std::vector<double> pressure = space_.point_pressures(p);
  const std::size_t n_i = space_.pressure_nodes_per_cell(), n_q = space_.points_per_cell();
  for (std::size_t cell = 0; cell < space_.n_cells(); ++cell)
    {
      const unsigned *unknowns = &space_.cell_pressures[cell * n_i];
      for (std::size_t i = 0; i < n_i; ++i)
        for (std::size_t j = 0; j < n_i && held_.local_element(unknowns[i]) == 0; ++j)
          {
            double sum = 0;
            for (std::size_t q = 0; q < n_q; ++q)
              sum += volumes_[cell * n_q + q] * fluids_[cell * n_q + q].storage(pressure[cell * n_q + q]) *
                     space_.pressure_shapes(cell * n_q + q)[i] * space_.pressure_shapes(cell * n_q + q)[j];
            petsc_check(MatSetValue(tangent_.get(), p.global_index(unknowns[i]), p.global_index(unknowns[j]),
                                    3 * sum / two_steps_, ADD_VALUES));
          }
    }
  petsc_check(MatAssemblyBegin(tangent_.get(), MAT_FINAL_ASSEMBLY));
  petsc_check(MatAssemblyEnd(tangent_.get(), MAT_FINAL_ASSEMBLY));
  solver_.set_matrix(tangent_.get());
}

void AirPressure::solve(const Vector &b, const Vector &before, const Vector &before_that, Vector &p)
{
  before_ = space_.point_pressures(before);
  const std::vector<double> earlier = space_.point_pressures(before_that);
  for (std::size_t q = 0; q < before_.size(); ++q)
    before_[q] = 4 * fluids_[q].volume(before_[q]) - fluids_[q].volume(earlier[q]);
  for (std::size_t i = 0; i < p.locally_owned_size(); ++i)
    p.local_element(i) = 2 * before.local_element(i) - before_that.local_element(i);
  const double enough = small_change * space_.mesh().soil.water.atmospheric_pressure;
  for (unsigned k = 0; k < most_iterations; ++k)
    {
      find_residual(b, p);
      find_tangent(p);
      solver_.solve(of_residual_.of(residual_), of_p_.of(change_));
      of_residual_.release();
      of_p_.release();
      for (std::size_t i = 0; i < p.locally_owned_size(); ++i)
        p.local_element(i) -= change_.local_element(i);
      if (largest(change_, space_) <= enough)
        return;
    }
  throw RunFailure(fmt::format("the pressure of the air in the pores is not found in {} iterations; use a smaller time "
                               "step, or water.air = \"constant\"",
                               most_iterations));
}
} // namespace isostat
