// SPDX-License-Identifier: BSD-3-Clause
// What holds and what loads a block in statics, and the reactions.
#include "base/error.hpp"
#include "fem/solve/statics.hpp"
#include "fem/solve/statics_system.hpp"
#include "fem/water/biot_integrals.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
std::string name_of(FaceComponent of)
{
  constexpr const char *names[] = {"x_low", "x_high", "y_low", "y_high", "base", "surface"};
  if (is_patch(of.face))
    return fmt::format("u_{} of patch {}", "xyz"[of.component], static_cast<int>(of.face) - n_faces);
  return fmt::format("u_{} of face {}", "xyz"[of.component], names[static_cast<int>(of.face)]);
}

bool contains(const std::vector<FaceComponent> &list, FaceComponent of)
{
  return std::any_of(list.begin(), list.end(), [&](const FaceComponent &entry) {
    return entry.face == of.face && entry.component == of.component;
  });
}
} // namespace

void Statics::check_settings() const
{
  if (material_.n_points() != space_.n_points())
    throw InputError(fmt::format("the material has {} points, the mesh {}", material_.n_points(), space_.n_points()));
  if (settings_.pore_water && space_.mesh().degree != 2)
    throw InputError("pore water with degree 1; pressure of degree 1 needs displacements of degree 2, or it "
                     "oscillates. Set degree = 2.");
  for (const FaceDisplacement &given : settings_.displacements)
    {
      if (given.of.component > 2)
        throw InputError(fmt::format("displacement of component {}; must be 0, 1 or 2", given.of.component));
      if (!contains(space_.supports().fixed, given.of) && !contains(space_.supports().together, given.of))
        throw InputError(fmt::format("a displacement is given for {}, which is free; add it to the fixed ones, or to "
                                     "those that move together",
                                     name_of(given.of)));
    }
  if (!(settings_.newton.tolerance > 0) || settings_.newton.tolerance >= 1)
    throw InputError(fmt::format("tolerance = {}; must be in (0, 1), of the force scale", settings_.newton.tolerance));
  if (!(settings_.largest_part > 0))
    throw InputError(
        fmt::format("largest part = {}; must be > 0, of the time since water began to flow", settings_.largest_part));
  if (!(settings_.min_force >= 0))
    throw InputError(fmt::format("smallest force = {} N; must be >= 0", settings_.min_force));
  if (settings_.newton.max_iterations == 0 && settings_.newton.relaxation_iterations == 0)
    throw InputError("neither iterations of Newton's method nor of relaxation; one of both must be >= 1");
  if (settings_.newton.iterations_per_tangent == 0)
    throw InputError("iterations per tangent must be >= 1");
  if (settings_.newton.max_halvings > 40)
    throw InputError(fmt::format("max halvings = {}; must be <= 40", settings_.newton.max_halvings));
}

/// Owned unknowns of a component on a face. A rank need not have a cell at all.
std::vector<unsigned> Statics::unknowns_of(FaceComponent of) const
{
  const Vector area = space_.face_area(of.face);
  std::vector<unsigned> unknowns;
  for (unsigned i = of.component; i < area.locally_owned_size(); i += 3)
    if (area.local_element(i) > 0)
      unknowns.push_back(i);
  return unknowns;
}

void Statics::find_held()
{
  is_held_u_.assign(u_.locally_owned_size(), 0);
  is_held_p_.assign(p_.locally_owned_size(), 0);
  for (unsigned i : space_.fixed_dofs)
    if (i < is_held_u_.size())
      is_held_u_[i] = 1;
  for (const FaceDisplacement &given : settings_.displacements)
    {
      given_.push_back(unknowns_of(given.of));
      for (unsigned i : given_.back())
        is_held_u_[i] = 1;
    }
  for (unsigned i : held_pressures(space_, is_held_p_.size()))
    is_held_p_[i] = 1;
  for (unsigned i = 0; i < is_held_u_.size(); ++i)
    if (is_held_u_[i])
      held_u_.push_back(i);
  for (unsigned i = 0; i < is_held_p_.size(); ++i)
    if (is_held_p_[i])
      held_p_.push_back(i);
  for (const FaceTraction &load : settings_.tractions)
    traction_areas_.push_back(space_.face_area(load.face));
  if (settings_.body_force)
    layer_volumes_ = space_.layer_volumes();
  places_ = space_.node_places();
}

/// Forces on the nodes, and displacements of held unknowns (those without a given one stay).
void Statics::find_loads(double time, Vector &load, Vector &held) const
{
  load = 0;
  for (std::size_t k = 0; k < traction_areas_.size(); ++k)
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (const double area = traction_areas_[k].local_element(i); area > 0)
        load.local_element(i) += area * settings_.tractions[k].traction(time, places_[i])[i % 3];
  for (std::size_t layer = 0; layer < layer_volumes_.size(); ++layer)
    {
      const std::array<double, 3> force = settings_.body_force(time, layer);
      for (std::size_t i = 0; i < places_.size(); ++i)
        load.local_element(i) += force[i % 3] * layer_volumes_[layer].local_element(i);
    }
  if (settings_.settles)
    for (std::size_t i = 0; i < load.locally_owned_size(); ++i)
      load.local_element(i) -= std::clamp(time, 0.0, 1.0) * reference_force_.local_element(i);
  for (std::size_t k = 0; k < given_.size(); ++k)
    for (unsigned i : given_[k])
      held.local_element(i) = settings_.displacements[k].displacement(time, places_[i]);
}

double Statics::reaction(FaceComponent of) const
{
  Vector force = space_.displacement_vector(), pore = force;
  space_.add_internal_force(stresses_, force);
  if (water_)
    water_->add_pore_force(p_, pore);
  double sum = 0;
  for (unsigned i : unknowns_of(of))
    sum += force.local_element(i) - reference_force_.local_element(i) - pore.local_element(i) - load_.local_element(i);
  space_.sum_over_ranks({&sum, 1});
  return sum;
}
} // namespace isostat
