// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/fragment.hpp"
#include "fem/solve/newton_settings.hpp"
#include "fem/space/block.hpp"

#include <optional>

namespace isostat
{
class SceneDocument;
struct ColumnScene;

/// Where a plate is.
enum class PlateSide
{
  surface,
  base,
  left,
  right
};

/// A rigid plate on a part of the boundary of a box, which moves along one axis without turning: footing, trapdoor,
/// wall.
struct Plate
{
  PlateSide on = PlateSide::surface;
  std::optional<double> from, to; ///< x on surface and base, z on a wall, m; left out: to the end
  double displacement = 0;        ///< at the end, m: into the soil if positive
  bool rough = true;              ///< the soil does not slide along it

  Face face() const
  {
    constexpr Face faces[] = {Face::surface, Face::base, Face::x_low, Face::x_high};
    return faces[static_cast<std::size_t>(on)];
  }
  unsigned axis() const { return on == PlateSide::left || on == PlateSide::right ? 0 : 2; } ///< along which it moves
  /// Into the soil, along the axis.
  double inwards() const { return on == PlateSide::surface || on == PlateSide::right ? -1 : 1; }

  bool operator==(const Plate &) const = default;
};

/// Of an analysis that moves a boundary slowly: that of a plate, or of a biaxial block.
struct LoadSteps
{
  unsigned number = 100;
  NewtonSettings newton{.tolerance = 1e-6, .max_halvings = 8};

  bool operator==(const LoadSteps &) const = default;
};

/// The keys of [analysis].
SceneFragment<Plate> plate_keys();
SceneFragment<LoadSteps> load_step_keys();

/// The part of the boundary that a plate has.
Patch plate_patch(const ColumnScene &scene);

/// Rules of a plate, and of what has no effect with one.
/// @throws InputError  no box; loads and motions; a plate out of its side   tested: tests/apps/deposit/box_test.cpp
void check_plate(const SceneDocument &document, const ColumnScene &scene);
} // namespace isostat
