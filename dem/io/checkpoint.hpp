// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/snapshot.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace isostat
{
/// All that a killed run needs to go on to the same bits: grains with the history of their contacts (after a move), and
/// every number that drivers, sums and recorders keep.
struct Checkpoint
{
  Snapshot state;
  std::map<std::string, double> numbers;
  std::string scene; ///< the resolved scene; a resumed run must have the same
};

/// Writes folder/last.h5 aside and renames it; what was last becomes folder/previous.h5, so that two are kept and one
/// is whole at any moment. Throws RunFailure (disk full, not writable): the older ones survive.
void write_checkpoint(const std::filesystem::path &folder, const Checkpoint &checkpoint);

/// The newest readable checkpoint of a folder. A damaged last.h5 gives way to previous.h5.
/// @throws InputError when there is none, naming what is wrong with each
/// tested: tests/dem/io/checkpoint_test.cpp
Checkpoint read_checkpoint(const std::filesystem::path &folder);
} // namespace isostat
