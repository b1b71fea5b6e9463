// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/files/hdf5.hpp"

#include <functional>

namespace isostat
{
/// Writes folder/last.h5 aside and renames it; what was last becomes folder/previous.h5, so that two are kept and one
/// is whole at any moment.
/// @param fill  puts the content into the empty file
/// @throws RunFailure  disk full, not writable: the older ones survive
void write_newest(const std::filesystem::path &folder, const std::function<void(hdf5::Group root)> &fill);

/// Checkpoints of a folder, the newest first: fresh.h5, which exists where write_newest() was interrupted, last.h5,
/// previous.h5.
std::vector<std::filesystem::path> checkpoints_of(const std::filesystem::path &folder);

/// Reads the newest checkpoint of a folder that can be read: a damaged one gives way to the one before, with a
/// warning on stderr.
/// @param read  takes one file, throws InputError if it is damaged or not one of its own
/// @throws InputError when there is none, naming what is wrong with each
/// tested: tests/dem/io/checkpoint_test.cpp
void read_newest(const std::filesystem::path &folder, const std::function<void(const std::filesystem::path &)> &read);
} // namespace isostat
