// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/types.hpp"

namespace isostat
{
/// Whole numbers U, det U = +1, by which edges H (columns, m) become the most compact periods H U of the same lattice:
/// reduced in the sense of Minkowski, |a| <= |b| <= |c|, each as short as can be next to those before it. Hence
///
///     |a| is the shortest period of the lattice at all;
///     every width of the cell H U is at least |a| / sqrt(2), however much the cell H leans
///
/// (V >= |a| |b| |c| / sqrt(2) for such periods, and a width is V over the area of a face).
///
/// Found by greedy reduction (Semaev 2001, doi:10.1007/3-540-44670-2_13; Nguyen & Stehle 2009,
/// doi:10.1145/1597036.1597050): the two shorter periods are reduced as by Lagrange and Gauss, the third takes off the
/// whole combination of them that leaves it shortest, until nothing gets shorter. A function of H alone; what is
/// shorter by less than 1e-12 of itself counts as equally long. Edges that span no cell, or are not numbers, are left
/// as they are.
/// cost: some microseconds; a few more steps for each factor of ten that the cell leans
/// tested: tests/dem/domain/lattice_test.cpp
Eigen::Matrix3i compact_periods(const Mat3 &edges);

/// H U with the U above, m.
inline Mat3 compact_edges(const Mat3 &edges) { return edges * compact_periods(edges).cast<double>(); }

/// How far a place is from the cell at the origin, in edges: the largest of its three coordinates along them. Beyond
/// max_edges_away nothing is a state that a run can have come to.
inline constexpr double max_edges_away = 1e6;
inline double edges_away(const Mat3 &edges, const Vec3 &place)
{
  return (edges.inverse() * place).cwiseAbs().maxCoeff();
}

/// Distance of a grain from the nearest of its own images, whatever edges describe the lattice, m.
inline double shortest_period(const Mat3 &edges) { return compact_edges(edges).colwise().norm().minCoeff(); }
} // namespace isostat
