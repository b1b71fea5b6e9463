// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/dem/io/packing_files_test.cpp
#pragma once
#include "dem/state/snapshot.hpp"

#include <filesystem>
#include <string_view>

namespace isostat
{
/// What is wrong with a sphere, as text; empty if nothing: a radius outside [1e-9, 1e6] m, a centre beyond 1e9 m or not
/// a number, a radius that is lost in the rounding of the centre (such grains would have no volume in their cell).
std::string sphere_fault(const Vec3 &centre, double radius);

/// Spheres as a file of another program lists them, one entry each in every vector that is not empty.
struct SphereTable
{
  std::vector<Vec3> centres;        ///< m
  std::vector<double> radii;        ///< m
  std::vector<std::uint32_t> ids;   ///< empty: counted from 0
  std::vector<Vec3> velocities;     ///< m/s; empty: at rest
  std::vector<Vec3> spins;          ///< rad/s; empty: at rest
  std::vector<double> densities;    ///< kg/m3; empty: the file does not say them
  std::vector<double> masses;       ///< kg; empty: likewise
  std::vector<std::size_t> line_of; ///< of the file, from 1; empty where it has no lines

  std::size_t line(std::size_t i) const { return line_of.empty() ? 0 : line_of[i]; }
  /// @throws InputError with file:line  no spheres, a sphere with a fault (sphere_fault), a motion that is not finite,
  ///         an id twice
  void check(const std::filesystem::path &path) const;
  /// @throws InputError with file:line  a centre outside the box
  void check_inside(const std::filesystem::path &path, const RigidBox &box) const;
  RigidBox bounding_box() const; ///< of the spheres   @pre not empty
  /// The one density of all spheres, kg/m3: that of the column density, else all mass over all volume, else the assumed
  /// one.
  /// @param scale  metres in the unit of length of the file
  /// @throws InputError with file:line  several densities, masses that differ by more than 1 % from those of one
  ///         density, a mass that is not positive, masses and densities that contradict each other
  /// @pre check()
  double density(const std::filesystem::path &path, double assumed, double scale = 1) const;
  Packing packing(double density) const;
};

/// Which words of a row are the numbers of a sphere, by the names of the columns in any case: x y z (or xu, pos_x,
/// position_x, Points:0 ...), r or radius or diameter, and, if they are there, id, vx vy vz, wx wy wz (or omegax omegay
/// omegaz), density, mass and clumpId, which must be -1. Others are ignored. A name may have quotes, and its unit in
/// brackets: "X (mm)".
class SphereColumns
{
public:
  /// @param first_id    number of the first grain in files of this kind: ids are counted from 0 here
  /// @param open_ended  rows may have more words than there are names
  explicit SphereColumns(const std::vector<std::string_view> &names, std::uint32_t first_id = 0,
                         bool open_ended = false);

  std::size_t n_columns() const { return n_columns_; }
  /// What is missing of x y z radius, as text; empty if nothing.
  std::string missing() const;
  /// A column whose unit is another than the one in which it is read, as text; empty if there is none.
  /// @param scale  metres in the unit of length of the file
  std::string wrong_unit(double scale) const;
  /// Adds the sphere of a row.   @throws InputError with file:line
  void read(const std::filesystem::path &path, std::size_t line, std::string_view text, SphereTable &table) const;

private:
  struct Unit
  {
    std::string column, unit, expected;
  };
  int id_ = -1, radius_ = -1, density_ = -1, mass_ = -1, clump_ = -1;
  int centre_[3] = {-1, -1, -1}, velocity_[3] = {-1, -1, -1}, spin_[3] = {-1, -1, -1};
  double radius_factor_ = 1; ///< of a diameter 0.5
  std::uint32_t first_id_;
  std::size_t n_columns_;
  bool open_ended_;
  std::vector<Unit> units_; ///< of the columns that are read and say theirs
};

/// The id of a grain; @throws InputError with file:line  not a whole number from first_id to 2^32 - 1
std::uint32_t grain_id(const std::filesystem::path &path, std::size_t line, double value, std::uint32_t first_id);
} // namespace isostat
