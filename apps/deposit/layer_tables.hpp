// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>

namespace isostat
{
class SceneDocument;

/// Puts a layer for each row of a table (`layer.table`, a CSV file) in the place of the [[layer]] that names it. The
/// rows run from the surface down and give thickness (m), shear_velocity (m/s) and density (kg/m3); all other keys are
/// those of that [[layer]]. What follows reads, checks and stores the layers as if the scene listed them.
/// @param scene_path  the table is looked for as found_file() does
/// @throws InputError  with file:line of the scene or of the table
/// tested: tests/apps/deposit/layer_tables_test.cpp
void expand_layer_tables(SceneDocument &document, const std::string &scene_path);
} // namespace isostat
