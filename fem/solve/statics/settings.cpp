// SPDX-License-Identifier: BSD-3-Clause
#include "fem/solve/statics/settings.hpp"

#include "base/error.hpp"
#include "fem/water/pore_fluid.hpp"

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

StaticsSettings checked(StaticsSettings settings, const FiniteElementSpace &space, const Material &material)
{
  if (material.n_points() != space.n_points())
    throw InputError(fmt::format("the material has {} points, the mesh {}", material.n_points(), space.n_points()));
  if (settings.pore_water && space.mesh().degree != 2)
    throw InputError("pore water with degree 1; pressure of degree 1 needs displacements of degree 2, or it "
                     "oscillates. Set degree = 2.");
  if (settings.pore_water && has_boyle_air(space.mesh().soil))
    throw InputError("statics with air that follows Boyle's law; must have the constant stiffness that it has in situ. "
                     "Set water.air = \"constant\".");
  for (const FaceDisplacement &given : settings.displacements)
    {
      if (given.of.component > 2)
        throw InputError(fmt::format("displacement of component {}; must be 0, 1 or 2", given.of.component));
      if (!contains(space.supports().fixed, given.of) && !contains(space.supports().together, given.of))
        throw InputError(fmt::format("a displacement is given for {}, which is free; add it to the fixed ones, or to "
                                     "those that move together",
                                     name_of(given.of)));
    }
  const NewtonSettings &newton = settings.newton;
  if (!(newton.tolerance > 0) || newton.tolerance >= 1)
    throw InputError(fmt::format("tolerance = {}; must be in (0, 1), of the force scale", newton.tolerance));
  if (!(settings.largest_part > 0))
    throw InputError(
        fmt::format("largest part = {}; must be > 0, of the time since water began to flow", settings.largest_part));
  if (!(settings.min_force >= 0))
    throw InputError(fmt::format("smallest force = {} N; must be >= 0", settings.min_force));
  if (newton.max_iterations == 0 && newton.relaxation_iterations == 0)
    throw InputError("neither iterations of Newton's method nor of relaxation; one of both must be >= 1");
  if (newton.iterations_per_tangent == 0)
    throw InputError("iterations per tangent must be >= 1");
  if (newton.max_halvings > 40)
    throw InputError(fmt::format("max halvings = {}; must be <= 40", newton.max_halvings));
  return settings;
}
} // namespace isostat
