// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"

namespace isostat
{
/// Before any work: whether the libraries of the layers of grains have the seeds that the scene takes from them.
/// Warns of a layer whose stress is outside of the range of its specimens' sand.
/// @throws InputError  a library that has fewer, or none of that density: key and value, how many, what it has;
///         specimens of another sand than `grains.sand`
/// tested: tests/apps/column_ensemble_test.py, tests/apps/sands_test.py
void check_libraries(const ColumnScene &scene);

/// What --validate checks beyond the scene itself: check_libraries(), and the records of the motions are read.
/// @throws InputError   tested: tests/apps/column_ensemble_test.py
void check_inputs(const ColumnScene &scene);
} // namespace isostat
