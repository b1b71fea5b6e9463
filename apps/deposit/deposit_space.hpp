// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/soil_material.hpp"
#include "fem/solve/free_field.hpp"

namespace isostat
{
/// The mesh of a scene with its supports: those of a shaken block; a plate holds what it moves, and the soil along it
/// if it is rough; a biaxial block lies between smooth plates, held by one node in the middle of its base, without
/// displacement along y. In a consolidation cells are cut where water drains (drainage_planes()), by the stiffness that
/// the material of each layer, a user's too, has at the stress in situ in its middle. A layer whose material cannot be
/// asked for one point alone is cut as if it was rigid, and coarse_drainage() warns where that is not enough.
/// tested: tests/apps/column_water_test.py, tests/python/column_test.py, tests/apps/biaxial_test.py
std::unique_ptr<const FiniteElementSpace> deposit_space(const ColumnScene &scene, const UserMaterials &user);

/// Those of both sides, if the scene has them; their soil is that of the scene at the sides.   Collective.
/// @param settings  of the block   tested: tests/apps/box_test.py, tests/apps/grain_box_test.py
std::vector<std::shared_ptr<FreeField>> free_fields(const ColumnScene &scene, const DynamicsSettings &settings,
                                                    int threads, const UserMaterials &user);
} // namespace isostat
