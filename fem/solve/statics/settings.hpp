// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/solve/newton_settings.hpp"
#include "fem/solve/statics/inertia.hpp"
#include "fem/space/discretisation.hpp"

#include <functional>
#include <optional>
#include <string>

namespace isostat
{
/// Total traction (of soil and water together, tension positive) on a face, Pa. On a face that moves together only the
/// sum counts, and `place` is that of one of its nodes: traction times area is the force on a rigid plate.
struct FaceTraction
{
  Face face;
  std::function<std::array<double, 3>(double time, const Place &place)> traction;
};

/// Displacement since the start of a component of Supports::fixed or Supports::together, m. Of two that meet at a node
/// the later one holds.
struct FaceDisplacement
{
  FaceComponent of;
  std::function<double(double time, const Place &place)> displacement;
};

struct StaticsSettings
{
  bool pore_water = false; ///< consolidation; false: dry or fully drained, time is only what loads depend on
  std::vector<FaceTraction> tractions = {};
  std::vector<FaceDisplacement> displacements =
      {}; ///< components that are fixed and not named here stay where they are
  /// Force on the volume of a layer of the soil (SoilProfile::layers), N/m3; none: only loads on faces.
  std::function<std::array<double, 3>(double time, std::size_t layer)> body_force = {};
  /// What holds the stresses of the start goes off from t = 0 to 1: then they alone balance all loads, which are the
  /// whole ones and not changes.
  bool settles = false;
  std::optional<NodalInertia> inertia = {}; ///< none: equilibria, for which time is what loads and water depend on
  NewtonSettings newton = {};
  /// Of the time since water began to flow, the longest part that a sub-step takes; of the first step, that of its
  /// first one. Infinite: whole steps.
  double largest_part = 0.1;
  std::string petsc = {}; ///< options of PETSc for the linear system, each beginning with -statics_; empty: LU
  double min_force = 0;   ///< N, smallest force scale: for materials whose stress is noisy by tolerance times this
  /// Asked before each trial of the material and each factorisation; true: the step is given up, with all its
  /// sub-steps. Empty: never.
  std::function<bool()> gives_up = {};
};

/// The settings as they are.   @throws InputError  see Statics   tested: tests/fem/solve/statics_failure_test.cpp
StaticsSettings checked(StaticsSettings settings, const FiniteElementSpace &space, const Material &material);
} // namespace isostat
