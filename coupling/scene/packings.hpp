// SPDX-License-Identifier: BSD-3-Clause
// The one table of how packings run, for every kind of scene that has them.
#pragma once
#include "base/scene/fragment.hpp"
#include "coupling/batch/rve_material_settings.hpp"
#include "coupling/in_situ/specimen_request.hpp"

namespace isostat
{
class SceneDocument;

/// What users choose of how packings run: library, cache, in_situ, realisations, min_steps, contact_damping, damping,
/// free_grain_damping, inertial_number, drive, increment, balance, left_out. Drainage and threads are set by the
/// program.
SceneFragment<RveMaterialSettings> packing_keys();
/// Which specimens a soil is made of: relative_density, realisation.
SceneFragment<SpecimenRequest> specimen_keys();
/// Points that draw their specimens: `mixed_realisations`, `lot`, `lot_length`.
SceneFragment<SpecimenRequest> lot_keys();

/// What the table of keys cannot say: soil of grains needs a library, increments a static drive.
/// @param section  where they are, "grains"   @throws InputError  no library, a floor above the ceiling
/// tested: tests/apps/deposit/scene_error_test.cpp, tests/apps/grain_column_test.py
void check_packings(const SceneDocument &document, const std::string &section, const RveMaterialSettings &packings);
/// @param section  of the request, "layer.0"   @param per_point  packings of a point, by the key `realisations`
/// @throws InputError  fewer mixed seeds than a point has packings, a draw number without any
/// tested: tests/apps/deposit/scene_error_test.cpp
void check_lot(const SceneDocument &document, const std::string &section, const SpecimenRequest &request,
               std::size_t per_point, const std::string &realisations);
} // namespace isostat
