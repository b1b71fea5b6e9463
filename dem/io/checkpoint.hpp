// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/drive_state.hpp"
#include "dem/state/snapshot.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace isostat
{
/// What a run has written so far.
struct WrittenSoFar
{
  std::uint64_t rows = 0, snapshots = 0; ///< of the history; stored
  double redundancy = 0;                 ///< of the last row, for the progress line

  ISOSTAT_FIELDS(rows, snapshots, redundancy)
};

/// All that a killed run needs to continue to the same bits: grains with the history of their contacts (after a move),
/// and what drivers, sums and recorders keep.
struct Checkpoint
{
  Snapshot state;
  DriveState drive;
  WrittenSoFar written;
  std::map<std::string, double> assembly; ///< sums of the energy balance, and what they continue from
  std::map<std::string, double> specimen; ///< its figures (Specimen::numbers), for the summary of a resumed run
  std::string scene;                      ///< the resolved scene; a resumed run must have the same
  std::string instruction_set = {};       ///< of the machine that wrote it, for other_instruction_set(); set by reading
};

/// Writes folder/last.h5 aside and renames it; what was last becomes folder/previous.h5, so that two are kept and one
/// is whole at any moment. Throws RunFailure (disk full, not writable): the older ones survive.
void write_checkpoint(const std::filesystem::path &folder, const Checkpoint &checkpoint);

/// The newest readable checkpoint of a folder. Instead of a damaged last.h5 it is previous.h5.
/// @throws InputError when there is none, naming what is wrong with each; a checkpoint of another schema is refused
/// tested: tests/dem/io/checkpoint_test.cpp
Checkpoint read_checkpoint(const std::filesystem::path &folder);
} // namespace isostat
