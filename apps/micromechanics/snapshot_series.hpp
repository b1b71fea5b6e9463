// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/snapshot.hpp"

#include <filesystem>
#include <vector>

namespace isostat
{
/// The files to analyse: all snapshots/snapshot_*.h5 of a results folder, in the order of their numbers, or the one
/// file given (a snapshot or a specimen).
/// @throws InputError  nothing there, or a folder without snapshots
/// tested: tests/apps/micromechanics_test.py
std::vector<std::filesystem::path> snapshot_files(const std::filesystem::path &results);

/// Reads a stored snapshot, or the state of a specimen; the root attribute `format` tells them apart.
/// @throws InputError  missing, truncated or not HDF5; HDF5 of another program
Snapshot read_stored_snapshot(const std::filesystem::path &path);
} // namespace isostat
