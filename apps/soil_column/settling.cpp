// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/settling.hpp"

#include "base/error.hpp"
#include "fem/solve/statics.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr unsigned steps = 10;

StaticsSettings settings_of(const ColumnScene &scene, const SoilProfile &soil)
{
  StaticsSettings settings;
  settings.settles = true;
  settings.body_force = [&soil](double t, std::size_t layer) {
    return std::array<double, 3>{0, 0, -t * soil.water.gravity * (soil.layers[layer].density - soil.water.density)};
  };
  if (scene.load.surcharge > 0)
    settings.tractions = {{Face::surface, [&load = scene.load](double t, const Place &place) {
                             return std::array<double, 3>{0, 0, -t * load.surcharge_at(place[0])};
                           }}};
  settings.newton = scene.has_grains()
                        ? NewtonSettings{.tolerance = 5e-3, .max_iterations = 0, .relaxation_iterations = 300}
                        : NewtonSettings{.tolerance = 1e-6, .max_iterations = 15, .relaxation_iterations = 300};
  return settings;
}
} // namespace

double settle(const ColumnScene &scene, const FiniteElementSpace &space, Material &material)
{
  const SoilProfile soil = soil_profile(scene);
  Statics statics(space, material, settings_of(scene, soil));
  try
    {
      for (unsigned k = 1; k <= steps; ++k)
        statics.step(static_cast<double>(k) / steps - statics.time());
    }
  catch (const RunFailure &failure)
    {
      throw RunFailure(fmt::format("the soil of the box does not settle under its weight{}: {}",
                                   scene.load.surcharge > 0 ? " and the surcharge" : "", failure.what()));
    }
  double largest = 0;
  for (std::size_t i = 0; i < statics.displacement().locally_owned_size(); ++i)
    largest = std::max(largest, std::abs(statics.displacement().local_element(i)));
  if (space.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, space.communicator());
  return largest;
}
} // namespace isostat
