// SPDX-License-Identifier: BSD-3-Clause
// What of Dynamics follows the soil: cells (updated Lagrangian), and the permeability of its void ratio.
#include "fem/linear/with_ghosts.hpp"
#include "fem/ranks/failure.hpp"
#include "fem/solve/dynamics.hpp"
#include "fem/water/permeability.hpp"
#include "fem/water/pressure_system.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace isostat
{
namespace
{
/// Share of k by which the matrix of (8) may be late: errors and cost are in docs/theory_column.md at (3a).
constexpr double late_permeability = 1e-2;
/// Displacement gradient by which the cells may differ from those of the water's matrices and of the stable step: what
/// moves the water is wrong by that share at most.
constexpr double late_geometry = 2e-3;

/// The same on all ranks that the mesh is shared out over.
void deform(const FiniteElementSpace &space, const Vector &u, CellGeometry &at)
{
  const WithGhosts ghosts(u);
  fail_together(space.communicator(), failure_of([&] { space.deform(u, at); }));
}
} // namespace

void Dynamics::make_pressure_system()
{
  earlier_effort_ = linear_effort();
  const CellGeometry &at = deformed_ ? deformed_->found : static_cast<const CellGeometry &>(space_);
  pressure_system_ =
      std::make_unique<PressureSystem>(space_, at, time_step_, update_, permeable_strains_, settings_.petsc);
}

void Dynamics::follow_void_ratio()
{
  std::vector<double> strains;
  if (deformed_)
    std::ranges::transform(deformed_->now.weight, space_.weight, std::back_inserter(strains),
                           [](double now, double before) { return now / before - 1; });
  else
    strains = volume_strains(space_, u_);
  if (!permeability_differs(space_, permeable_strains_, strains, late_permeability))
    return;
  permeable_strains_.swap(strains);
  make_pressure_system();
}

/// All that depends on where cells are but the water, from u and the place where it was found last.
void Dynamics::find_deformation()
{
  deform(space_, deformed_->found_at, deformed_->found);
  deform(space_, u_, deformed_->now);
  frequencies_ = space_.frequencies(deformed_->found);
}

/// The cells have gone on with u.
void Dynamics::follow_deformation()
{
  Vector change = u_;
  change -= deformed_->found_at;
  std::vector<Gradient> gradients(space_.n_points());
  {
    const WithGhosts ghosts(change);
    space_.gradients(change, gradients);
  }
  const bool near = std::ranges::all_of(gradients, [](const Gradient &h) {
    return std::ranges::all_of(h, [](double entry) { return std::abs(entry) <= late_geometry; });
  });
  if (space_.on_every_rank(near))
    return deform(space_, u_, deformed_->now);
  deformed_->found_at = u_;
  find_deformation();
  if (pressure_system_)
    make_pressure_system();
}
} // namespace isostat
