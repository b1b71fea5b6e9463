// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/motion/motion_input.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace isostat
{
/// A line above the numbers of a record.
struct HeaderLine
{
  std::size_t number; ///< of the file, from 1
  std::string_view text;
  bool names_columns = false; ///< of a table of time and acceleration
};

struct RecordUnit
{
  double factor; ///< of its numbers, to m/s2
  bool assumed;  ///< g, as neither the file nor the scene states one
};

/// The unit of a record. A unit of acceleration in the header counts whatever
/// the words around it are (CM/SEC/SEC, cm s^-2, Gal, UNITS OF G); one behind a number (PGA 0.3 g) is that of a value.
/// Without one the unit is the scene's, or, of layouts that are in g by custom, g.
/// @throws InputError with file:line  a header of velocities, displacements or another quantity, two units, or a unit
///         that contradicts the scene's
/// tested: tests/fem/motion/motion_header_test.cpp
RecordUnit record_unit(const std::filesystem::path &path, const std::vector<HeaderLine> &header, AccelerationUnit unit);

/// Refuses numbers that are too large for g where nothing says that they are.
/// @throws InputError   tested: tests/fem/motion/motion_file_test.cpp
void check_assumed(const std::filesystem::path &path, const Motion &motion, const RecordUnit &unit);

/// What the times of a table are multiplied with to get seconds: "time (ms)", "t [min]"; 1 where none is named.
double time_factor(std::string_view names_of_columns);

/// In capitals.
std::string upper_case(std::string_view text);
} // namespace isostat
