// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "tests/fuzz/choices.hpp"

#include <string>

namespace isostat::fuzz
{
/// The bytes of an HDF5 file with some of its members replaced by others of another value, shape or type, removed,
/// renamed, linked to each other, or new: what HDF5 itself takes as a whole file.
std::string damaged_hdf5(const std::string &whole, Choices &choices);
} // namespace isostat::fuzz
