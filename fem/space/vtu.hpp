// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/discretisation.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace isostat
{
/// A vector at the nodes, by the unknowns of a displacement that this rank owns.
struct NodeField
{
  std::string name;
  std::span<const double> values;
};
/// A number at each Gauss point, shown as its mean over the element.
struct PointField
{
  std::string name;
  std::vector<double> values;
};
struct VtuTime
{
  double time = 0; ///< s, or what else rows are sorted by
  std::uint64_t step = 0;
};

/// A mesh for ParaView, by deal.II's writer; elements lie in space whatever the dimension of the mesh. No date in it:
/// the same state is the same bytes.   @pre the mesh is not shared out
/// @throws RunFailure  the file cannot be written
/// tested: tests/apps/soil_column_test.py, tests/apps/biaxial_test.py
void write_vtu(const std::filesystem::path &path, const FiniteElementSpace &space, VtuTime when,
               const std::vector<NodeField> &vectors, const std::vector<PointField> &means);
} // namespace isostat
