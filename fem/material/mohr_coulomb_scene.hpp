// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/fragment.hpp"
#include "fem/material/mohr_coulomb.hpp"

#include <string>

namespace isostat
{
class SceneDocument;

/// The keys of a Mohr-Coulomb soil that a scene has; its stiffness is that of its layer.
SceneFragment<MohrCoulombParameters> mohr_coulomb_keys();
/// Those and all other parameters: what bytes and checks are made of.
SceneFragment<MohrCoulombParameters> all_mohr_coulomb_keys();

/// What is wrong with parameters of which each is in its range.
struct MohrCoulombProblem
{
  const char *key = nullptr; ///< null: nothing is
  std::string text;          ///< what it must be, why, and a remedy
};
MohrCoulombProblem mohr_coulomb_problem(const MohrCoulombParameters &soil);

/// @param prefix  where the keys of the soil are, "layer.0"
/// @throws InputError  mohr_coulomb_problem()   tested: tests/apps/deposit/scene_error_test.cpp
void check_mohr_coulomb(const SceneDocument &document, const std::string &prefix, const MohrCoulombParameters &soil);
} // namespace isostat
