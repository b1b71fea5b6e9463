// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/files/bytes.hpp"

namespace isostat
{
/// The committed state of a material: what all points have in common (its name, its parameters), and the bytes of each
/// point, by number. Code that distributes points again, over other ranks or layers, takes those it needs; a material
/// whose points cannot be taken apart keeps everything in `common`, and its points are empty.
/// tested: tests/fem/material/material_test.cpp
struct MaterialState
{
  std::vector<std::byte> common;
  std::vector<std::vector<std::byte>> points;

  bool operator==(const MaterialState &) const = default;
  /// One row of bytes, for files and hashes; and back.   @throws InputError  bytes that are not of such a state
  std::vector<std::byte> bytes() const;
  static MaterialState from_bytes(std::span<const std::byte> bytes);
};

/// Points that are rows of numbers, `values` one after the other; and back.
/// @throws InputError, in the name of the material  another number of points, or of numbers in a point
std::vector<std::vector<std::byte>> packed_rows(std::span<const double> values, std::size_t n_points);
void unpack_rows(const MaterialState &state, const std::string &material, std::span<double> values,
                 std::size_t n_points);
} // namespace isostat
