// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/settling.hpp"

#include "apps/deposit/deposit_space.hpp"
#include "base/error.hpp"
#include "fem/solve/dynamics.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr unsigned steps = 10;

bool has_plate(const ColumnScene &scene, PlateSide side)
{
  return scene.analysis.kind == AnalysisKind::plate && scene.plate.on == side;
}

/// Faces of the surface that bear the surcharge; a plate, and a surcharge on a part, have one of their own.
std::vector<Face> surfaces(const ColumnScene &scene)
{
  if (!scene.load.bears_on_all())
    return {patch_face(0)};
  if (has_plate(scene, PlateSide::surface))
    return {Face::surface, patch_face(0)};
  return {Face::surface};
}

/// Smooth walls and a rough base, which a plate in them is a part of.
Supports box_supports(const ColumnScene &scene)
{
  Supports supports = shaken_supports(false, Sides::walls, scene.mesh.dimension);
  if (has_plate(scene, PlateSide::base))
    for (unsigned c = 0; c < 3; ++c)
      supports.fixed.push_back({patch_face(0), c});
  if (has_plate(scene, PlateSide::left) || has_plate(scene, PlateSide::right))
    supports.fixed.push_back({patch_face(0), 0});
  return supports;
}

StaticsSettings settings_of(const ColumnScene &scene, const SoilProfile &soil)
{
  StaticsSettings settings;
  settings.settles = true;
  settings.body_force = [&soil](double t, std::size_t layer) {
    return std::array<double, 3>{0, 0, -t * soil.water.gravity * (soil.layers[layer].density - soil.water.density)};
  };
  if (scene.load.surcharge > 0)
    for (Face face : surfaces(scene))
      settings.tractions.push_back({face, [pressure = scene.load.surcharge](double t, const Place &) {
                                      return std::array<double, 3>{0, 0, -t * pressure};
                                    }});
  settings.petsc = scene.analysis.petsc;
  settings.newton = {.tolerance = 1e-6, .max_iterations = 15, .relaxation_iterations = 300};
  if (scene.has_grains() && scene.grains.drive.on)
    settings.newton.tolerance = 1e-3;
  else if (scene.has_grains()) // noisy
    settings.newton = {.tolerance = 5e-3, .max_iterations = 0, .relaxation_iterations = 300};
  return settings;
}
} // namespace

Settled settle(const ColumnScene &scene, const MeshSpec &mesh, Material &material,
               const std::function<void(const std::string &)> &after_step)
{
  const SoilProfile soil = soil_profile(scene);
  MeshSpec cut = mesh;
  if (!scene.load.bears_on_all())
    cut.patches.push_back(
        {Face::surface, scene.load.surcharge_from.value_or(0), scene.load.surcharge_to.value_or(scene.mesh.width)});
  const std::unique_ptr<const FiniteElementSpace> its_space = discretised(scene, cut, box_supports(scene));
  const FiniteElementSpace &space = *its_space;
  Statics statics(space, material, interruptible(settings_of(scene, soil)));
  try
    {
      for (unsigned k = 1; k <= steps; ++k)
        {
          statics.step(static_cast<double>(k) / steps - statics.time());
          if (after_step)
            after_step(fmt::format("settles: step {:>2} of {}  {} trials, residuals {}{}", k, steps,
                                   statics.effort().trials, statics.effort().convergence(),
                                   statics.linear_effort().text()));
        }
    }
  catch (const StepGivenUp &)
    {
      throw Interrupted("interrupted while the soil settles, before the first step; start it again");
    }
  catch (const RunFailure &failure)
    {
      throw RunFailure(fmt::format("the soil of the box does not settle under its weight{}, of which it bears {:.3g} % "
                                   "(t below is that part): {}",
                                   scene.load.surcharge > 0 ? " and the surcharge" : "", 100 * statics.time(),
                                   failure.what()));
    }
  double largest = 0;
  for (std::size_t i = 0; i < statics.displacement().locally_owned_size(); ++i)
    largest = std::max(largest, std::abs(statics.displacement().local_element(i)));
  if (space.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, space.communicator());
  return {largest, statics.linear_effort()};
}
} // namespace isostat
