// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"
#include "fem/solve/statics.hpp"

namespace isostat
{
class Summary;

/// What a plate met.
struct PlateResult
{
  double length = 0;                    ///< of the plate, m
  double start = 0;                     ///< force of the soil against it in situ, N/m
  double largest = 0, largest_at = 0;   ///< later; after what displacement, m
  double smallest = 0, smallest_at = 0; ///< likewise
  double last = 0;                      ///< at the end
  double residual = 0;                  ///< the largest of any step, of the force scale

  void follow(double displacement, double force, double step_residual);

  template <class Result, class Visit>
  static void for_each(Result &r, const Visit &visit)
  {
    visit("plate_start", r.start), visit("plate_last", r.last), visit("plate_residual", r.residual);
    visit("plate_largest", r.largest), visit("plate_largest_at", r.largest_at);
    visit("plate_smallest", r.smallest), visit("plate_smallest_at", r.smallest_at);
  }
};

void add_plate(const PlateResult &result, const ColumnScene &scene, Summary &summary);

/// Weight of a box of soil that is as high everywhere as where it is highest, N/m.
double largest_weight(const ColumnScene &scene);

/// Forces between a plate and the soil.
/// tested: tests/apps/plate_test.py
class PlateForces
{
public:
  /// @pre the plate is patch 0 of the mesh, which is not shared out
  /// @param stresses  at the start, effective, tension positive
  PlateForces(const ColumnScene &scene, const FiniteElementSpace &space, std::span<const Stress> stresses);

  double length() const { return length_; } ///< m
  /// Of the plate on the soil at the start, x, y, z, N/m: what a resumed run has to know.
  const std::array<double, 3> &start() const { return start_; }
  void set_start(const std::array<double, 3> &start) { start_ = start; }
  /// The force normal to the plate (compression positive), and that of the plate on the soil along it, towards +x or
  /// +z: those in situ and what has come since. Nodes at its ends carry a part of the soil next to it: of a trapdoor,
  /// that of an abutment; pressure() leaves it out. N/m
  std::array<double, 2> forces(const Statics &run) const;
  /// Mean stress normal to the plate at the row of points next to it, compression positive, Pa.
  double pressure(std::span<const Stress> stresses) const;

private:
  double distance(const Place &place) const; ///< to the side that the plate is on, m
  void find_points();
  void find_start(const ColumnScene &scene, std::span<const Stress> stresses);

  const Plate &plate_;
  const Patch patch_;
  const FiniteElementSpace &space_;
  Vector area_;
  std::vector<std::size_t> points_;
  std::vector<double> areas_; ///< of the plate that belong to them, up to a factor
  double length_ = 0;
  std::array<double, 3> start_ = {}; ///< of the plate on the soil in situ, N/m
};
} // namespace isostat
