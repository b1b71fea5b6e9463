// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/plate_forces.hpp"

#include "apps/common/summary.hpp"

#include <algorithm>
#include <limits>

namespace isostat
{
void PlateResult::follow(double displacement, double force, double step_residual)
{
  if (displacement == 0)
    start = largest = smallest = force;
  if (force > largest)
    largest = force, largest_at = displacement;
  if (force < smallest)
    smallest = force, smallest_at = displacement;
  last = force;
  residual = std::max(residual, step_residual);
}

void add_plate(const PlateResult &p, const ColumnScene &scene, Summary &summary)
{
  const Plate &plate = scene.plate;
  summary.row("plate", "{:.4g} m long, {}, moved {:+.4g} m in {} steps", Value{"plate.length", p.length},
              plate.rough ? "rough" : "smooth", plate.displacement, scene.load_steps.number);
  summary.row("force against it",
              "{:.4g} kN/m in situ, largest {:.4g} kN/m at {:+.4g} m, smallest {:.4g} kN/m at {:+.4g} m, "
              "{:.4g} kN/m at the end",
              Value{"plate.force_in_situ", p.start, kN}, Value{"plate.largest_force", p.largest, kN},
              Value{"plate.largest_at", p.largest_at}, Value{"plate.smallest_force", p.smallest, kN},
              Value{"plate.smallest_at", p.smallest_at}, Value{"plate.force_at_the_end", p.last, kN});
  summary.row("equilibrium", "residual at most {:.1e} of the force scale", Value{"plate.largest_residual", p.residual});
}

double largest_weight(const ColumnScene &scene)
{
  double weight = 0;
  for (const ColumnLayer &layer : scene.layers)
    weight += scene.water.gravity * layer.density * layer.thickness * scene.mesh.width;
  return weight;
}

PlateForces::PlateForces(const ColumnScene &scene, const FiniteElementSpace &space, std::span<const Stress> stresses)
    : plate_(scene.plate), patch_(plate_patch(scene)), space_(space), area_(space.face_area(patch_face(0)))
{
  for (std::size_t i = 0; i < area_.locally_owned_size(); i += 3)
    length_ += area_.local_element(i);
  find_points();
  find_start(scene, stresses);
}

/// Internal forces less weight and surcharge of the soil next to it that act on nodes of the plate.
void PlateForces::find_start(const ColumnScene &scene, std::span<const Stress> stresses)
{
  Vector force = space_.displacement_vector();
  space_.add_internal_force(stresses, force);
  const std::vector<Vector> volumes = space_.layer_volumes();
  const Vector beside = space_.face_area(Face::surface);
  for (std::size_t i = 0; i < area_.locally_owned_size(); ++i)
    if (area_.local_element(i) > 0)
      {
        start_[i % 3] += force.local_element(i) + (i % 3 == 2 ? scene.load.surcharge * beside.local_element(i) : 0);
        for (std::size_t k = 0; i % 3 == 2 && k < volumes.size(); ++k)
          start_[2] += scene.water.gravity * scene.layers[k].density * volumes[k].local_element(i);
      }
}

std::array<double, 2> PlateForces::forces(const Statics &run) const
{
  const unsigned normal = plate_.axis(), along = 2 - normal;
  return {plate_.inwards() * (start_[normal] + run.reaction({patch_face(0), normal})),
          plate_.rough ? start_[along] + run.reaction({patch_face(0), along}) : 0.0};
}

double PlateForces::pressure(std::span<const Stress> stresses) const
{
  double sum = 0, weight = 0;
  for (std::size_t k = 0; k < points_.size(); ++k)
    {
      sum -= areas_[k] * stresses[points_[k]][plate_.axis()];
      weight += areas_[k];
    }
  return sum / weight;
}

double PlateForces::distance(const Place &place) const
{
  switch (plate_.on)
    {
    case PlateSide::surface:
      return space_.mesh().depth(place);
    case PlateSide::base:
      return place[2];
    case PlateSide::left:
      return place[0];
    default:
      return space_.mesh().width[0] - place[0];
    }
}

/// Of each element at the plate the row of points that is nearest to it.
void PlateForces::find_points()
{
  const auto beside = [&](std::size_t q) {
    const double along = space_.position[q][2 - plate_.axis()];
    return along > patch_.from && along < patch_.to;
  };
  const std::size_t n = space_.n_gauss, n_corners = space_.pressure_nodes_per_cell();
  for (std::size_t first = 0; first < space_.n_points(); first += n)
    {
      const Place *corners = &space_.corner[first / space_.n_gauss * n_corners];
      if (std::none_of(corners, corners + n_corners,
                       [this](const Place &at) { return distance(at) < 1e-9 * space_.mesh().width[0]; }))
        continue;
      double nearest = std::numeric_limits<double>::max();
      for (std::size_t q = first; q < first + n; ++q)
        if (beside(q))
          nearest = std::min(nearest, distance(space_.position[q]));
      for (std::size_t q = first; q < first + n; ++q)
        if (beside(q) && distance(space_.position[q]) < 1.5 * nearest)
          {
            points_.push_back(q);
            areas_.push_back(space_.weight[q] / nearest);
          }
    }
}
} // namespace isostat
