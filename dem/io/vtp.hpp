// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/snapshot.hpp"

#include <filesystem>
#include <vector>

namespace isostat
{
/// Pressure in each grain, Pa, compression positive: the mean stress of the grain's own volume under its contact
/// forces,
///     p = sum fn (r - u/2) / (4 pi r^3)        (Weber's stress of one grain; tangential forces do not enter the trace)
/// Walls count like grains. A grain without contact has 0.   tested: tests/dem/io/vtp_test.cpp
std::vector<double> grain_pressure(const Snapshot &snapshot);

/// Writes the grains as points (ParaView: "Point Gaussian" or "Glyph", scaled by radius) with point data id, radius,
/// velocity, spin, coordination (contacts with grains and walls) and pressure, and with field data `box` (lower and
/// upper corner, m) or `cell` (edges a, b, c, m). VTK XML PolyData, base64, written aside and renamed. Throws
/// RunFailure.
/// tested: tests/dem/io/vtp_test.cpp
void write_grains_vtp(const std::filesystem::path &path, const Snapshot &snapshot);

/// Writes the force chains: one line between the centres of each touching pair, with point data normal_force and
/// shear_force (N, magnitudes), sliding and rolling (0 or 1), the same at both ends, so that the filter "Tube" can vary
/// its radius by them. A contact through a face of a periodic cell is drawn as two lines, from each of its grains to
/// the point of contact as that grain sees it. Contacts with walls are not drawn.
/// tested: tests/dem/io/vtp_test.cpp
void write_force_chains_vtp(const std::filesystem::path &path, const Snapshot &snapshot);
} // namespace isostat
