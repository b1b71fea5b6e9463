// SPDX-License-Identifier: BSD-3-Clause
// Cells of Dynamics that move with the soil: updated Lagrangian.
#include "fem/ranks/failure.hpp"
#include "fem/solve/dynamics.hpp"
#include "fem/water/pressure_system.hpp"

#include <algorithm>
#include <cmath>

namespace isostat
{
namespace
{
/// Displacement gradient by which the cells may differ from those for which the water's matrices and the stable step
/// were found: what moves the water is wrong by that share at most.
constexpr double tolerance = 2e-3;

/// Values of other ranks are there while f(u) runs.
template <typename F>
void with_ghosts(const FiniteElementSpace &space, const Vector &u, const F &f)
{
  if (space.shared_out())
    u.update_ghost_values();
  f(u);
  if (space.shared_out())
    u.zero_out_ghost_values();
}

/// The same on all ranks that the mesh is shared out over.
void deform(const FiniteElementSpace &space, const Vector &u, CellGeometry &at)
{
  with_ghosts(space, u, [&](const Vector &whole) {
    const std::optional<RankFailure> failure = failure_of([&] { space.deform(whole, at); });
    fail_together(space.communicator(), failure);
  });
}
} // namespace

void Dynamics::make_pressure_system(const CellGeometry &at)
{
  pressure_system_ = std::make_unique<PressureSystem>(space_, at, time_step_, update_);
}

/// All that depends on where cells are, from u and the place where it was found last.
void Dynamics::find_deformation()
{
  CellGeometry at;
  deform(space_, deformed_->found_at, at);
  deformed_->frequencies = space_.frequencies(at);
  if (pressure_system_)
    make_pressure_system(at);
  deform(space_, u_, deformed_->now);
}

/// The cells have gone on with u.
void Dynamics::follow_deformation()
{
  Vector change = u_;
  change -= deformed_->found_at;
  std::vector<Gradient> gradients(space_.n_points());
  with_ghosts(space_, change, [&](const Vector &whole) { space_.gradients(whole, gradients); });
  const bool near = std::ranges::all_of(gradients, [](const Gradient &h) {
    return std::ranges::all_of(h, [](double entry) { return std::abs(entry) <= tolerance; });
  });
  if (space_.on_every_rank(near))
    return deform(space_, u_, deformed_->now);
  deformed_->found_at = u_;
  find_deformation();
}
} // namespace isostat
