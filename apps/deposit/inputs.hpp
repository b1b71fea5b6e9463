// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"

namespace isostat
{
/// Before any work: whether the libraries of the layers of grains have the seeds that the scene takes from them.
/// @param members  of an ensemble, each of which takes other seeds, after those before it, where none are drawn by lot
/// @throws InputError  a library that has fewer, or none of that density: key and value, how many, what it has
/// tested: tests/apps/column_ensemble_test.py
void check_libraries(const ColumnScene &scene, std::size_t members = 1);

/// What --validate looks at beyond the scene itself: check_libraries(), and the records of the motions are read.
/// @throws InputError   tested: tests/apps/column_ensemble_test.py
void check_inputs(const ColumnScene &scene);
} // namespace isostat
