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
  std::vector<std::size_t> line_of; ///< of the file, from 1; empty where it has no lines

  std::size_t line(std::size_t i) const { return line_of.empty() ? 0 : line_of[i]; }
  /// @throws InputError with file:line  no spheres, a sphere with a fault (sphere_fault), a motion that is not finite,
  ///         an id twice
  void check(const std::filesystem::path &path) const;
  /// @throws InputError with file:line  a centre outside the box
  void check_inside(const std::filesystem::path &path, const RigidBox &box) const;
  RigidBox bounding_box() const; ///< of the spheres   @pre not empty
  Packing packing(double density) const;
};

/// Which words of a row are the numbers of a sphere, by the names of the columns: x y z (or xu yu zu), r or radius or
/// diameter, and, if they are there, id, vx vy vz, wx wy wz (or omegax omegay omegaz). Others are ignored.
class SphereColumns
{
public:
  /// @param first_id  number of the first grain in files of this kind: ids are counted from 0 here
  explicit SphereColumns(const std::vector<std::string_view> &names, std::uint32_t first_id = 0);

  /// What is missing of x y z radius, as text; empty if nothing.
  std::string missing() const;
  /// Adds the sphere of a row.   @throws InputError with file:line
  void read(const std::filesystem::path &path, std::size_t line, std::string_view text, SphereTable &table) const;

private:
  int id_ = -1, radius_ = -1, centre_[3] = {-1, -1, -1}, velocity_[3] = {-1, -1, -1}, spin_[3] = {-1, -1, -1};
  double radius_factor_ = 1; ///< of a diameter 0.5
  std::uint32_t first_id_;
  std::size_t n_columns_;
};

/// The id of a grain; @throws InputError with file:line  not a whole number from first_id to 2^32 - 1
std::uint32_t grain_id(const std::filesystem::path &path, std::size_t line, double value, std::uint32_t first_id);
} // namespace isostat
