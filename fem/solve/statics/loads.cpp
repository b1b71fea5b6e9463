// SPDX-License-Identifier: BSD-3-Clause
#include "fem/solve/statics/loads.hpp"

#include "fem/water/biot_integrals.hpp"

#include <algorithm>

namespace isostat
{
namespace
{
void sort_out(const std::vector<bool> &is_held, std::vector<unsigned> &held, std::vector<unsigned> &free)
{
  for (unsigned i = 0; i < is_held.size(); ++i)
    (is_held[i] ? held : free).push_back(i);
}
} // namespace

void interpolate(const Loading &from, const Loading &to, double part, Loading &result)
{
  const auto between = [part](const Vector &a, const Vector &b, Vector &x) {
    for (std::size_t i = 0; i < x.locally_owned_size(); ++i)
      x.local_element(i) = (1 - part) * a.local_element(i) + part * b.local_element(i);
  };
  between(from.force, to.force, result.force);
  between(from.displacement, to.displacement, result.displacement);
}

std::vector<unsigned> unknowns_of(FaceComponent of, const FiniteElementSpace &space)
{
  const Vector area = space.face_area(of.face);
  std::vector<unsigned> unknowns;
  for (unsigned i = of.component; i < area.locally_owned_size(); i += 3)
    if (area.local_element(i) > 0)
      unknowns.push_back(i);
  return unknowns;
}

StaticsLoads::StaticsLoads(const FiniteElementSpace &space, const StaticsSettings &settings)
    : settings_(settings), places_(space.node_places())
{
  std::vector<bool> holds_u(space.displacement_vector().locally_owned_size());
  for (unsigned i : space.fixed_dofs)
    if (i < holds_u.size())
      holds_u[i] = true;
  for (const FaceDisplacement &given : settings.displacements)
    {
      given_.push_back(unknowns_of(given.of, space));
      for (unsigned i : given_.back())
        holds_u[i] = true;
    }
  sort_out(holds_u, held_without_flow_.u, held_without_flow_.free_u);
  held_in_flow_ = held_without_flow_;
  if (settings.pore_water)
    {
      std::vector<bool> holds_p(space.pressure_vector().locally_owned_size());
      sort_out(holds_p, held_without_flow_.p, held_without_flow_.free_p);
      for (unsigned i : held_pressures(space, holds_p.size()))
        holds_p[i] = true;
      sort_out(holds_p, held_in_flow_.p, held_in_flow_.free_p);
    }
  for (const FaceTraction &load : settings.tractions)
    traction_areas_.push_back(space.face_area(load.face));
  if (settings.body_force)
    layer_volumes_ = space.layer_volumes();
}

void StaticsLoads::find(double time, const Vector &reference_force, Loading &loading) const
{
  Vector &load = loading.force;
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
      load.local_element(i) -= std::clamp(time, 0.0, 1.0) * reference_force.local_element(i);
  if (settings_.inertia)
    settings_.inertia->add_load(time, load);
  for (std::size_t k = 0; k < given_.size(); ++k)
    for (unsigned i : given_[k])
      loading.displacement.local_element(i) = settings_.displacements[k].displacement(time, places_[i]);
}
} // namespace isostat
