// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/files/hdf5.hpp"

#include <cstddef>

namespace isostat::hdf5
{
/// Bytes as a dataset of whole words, the last one filled up with zeros; their number is its attribute `bytes`.
/// tested: tests/base/files/hdf5_test.cpp
void write_bytes(Group group, const std::string &name, std::span<const std::byte> bytes);

/// @throws InputError  missing, or cut short
std::vector<std::byte> read_bytes(const Group &group, const std::string &name);
} // namespace isostat::hdf5
