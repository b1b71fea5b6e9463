// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/soil_material.hpp"

namespace isostat
{
/// mesh_spec() of a scene; in a consolidation with its cells cut where water drains (drainage_planes()), by the
/// stiffness that the material of each layer, a user's too, has at the stress in situ in its middle. A layer whose
/// material cannot be asked for one point alone is cut as if it was rigid, and coarse_drainage() warns where that is
/// not enough.
/// tested: tests/apps/column_water_test.py, tests/python/column_test.py
MeshSpec cut_mesh(const ColumnScene &scene, const UserMaterials &user);
} // namespace isostat
