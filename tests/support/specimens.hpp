// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/prepare/compact.hpp"

#include <cmath>
#include <map>
#include <string_view>
#include <tuple>

namespace isostat::test
{
/// Watches nothing.
struct Unobserved : RunObserver
{
  void record(const Assembly &, const DriveState &, const Observation &, bool) override {}
};

inline LinearRolling paper_law()
{
  LinearRolling law;
  law.friction = std::tan(18 * M_PI / 180);
  return law;
}

/// Displacement gradient of simple shear: x moves with y.
inline Mat3 simple_shear(double gamma)
{
  Mat3 gradient = Mat3::Zero();
  gradient(0, 1) = gamma;
  return gradient;
}

/// The same grains at rest.
inline Snapshot stopped(Snapshot snapshot)
{
  for (std::size_t i = 0; i < snapshot.grains.n_grains(); ++i)
    {
      snapshot.grains.set_linear_velocity(i, Vec3::Zero());
      snapshot.grains.set_angular_velocity(i, Vec3::Zero());
    }
  return snapshot;
}

/// A stage of shear to a strain.
template <class Kind>
Kind sheared_to(double strain)
{
  Kind stage;
  stage.strain_end = strain;
  return stage;
}

inline GradingSpec small_grading(std::uint64_t grains)
{
  GradingSpec grading;
  grading.grains = grains;
  grading.cloud_edge = 10e-3 * std::cbrt(static_cast<double>(grains) / 10000.0);
  return grading;
}

/// A real specimen in seconds: cloud, compression to 200 kPa at a preparation friction, 18 deg, balance. Made once per
/// program and kept.
inline const Snapshot &specimen(std::uint64_t grains, double preparation_degrees, std::string_view domain = "rigid-box")
{
  static std::map<std::tuple<std::uint64_t, double, std::string>, Snapshot> made;
  const auto key = std::tuple(grains, preparation_degrees, std::string(domain));
  if (!made.contains(key))
    {
      Unobserved nobody;
      SpecimenSpec spec;
      spec.domain = domain;
      const isostat::Cloud cloud = make_cloud(small_grading(grains));
      const Snapshot compacted =
          compact(cloud, paper_law(), std::tan(preparation_degrees * M_PI / 180), {spec, nobody});
      made[key] = rebalance(compacted, paper_law(), {spec, nobody});
    }
  return made[key];
}

/// The same in a periodic cell.
inline const Snapshot &periodic_specimen(std::uint64_t grains, double preparation_degrees)
{
  return specimen(grains, preparation_degrees, "periodic-cell");
}

/// `n` periods of a periodic specimen in one long cell, contacts without their past.
inline Snapshot row_of_periods(const Snapshot &specimen, std::size_t n)
{
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (std::size_t period = 0; period < n; ++period)
    for (std::size_t i = 0; i < specimen.grains.n_grains(); ++i)
      {
        centres.push_back(specimen.grains.centre(i) + period * specimen.cell->edges.col(0));
        radii.push_back(specimen.grains.radius(i));
      }
  Snapshot row;
  row.grains = make_packing(centres, radii, specimen.grains.density);
  row.law = specimen.law;
  row.cell = specimen.cell;
  row.cell->edges.col(0) *= static_cast<double>(n);
  row.cell->reference_volume *= static_cast<double>(n);
  return row;
}

/// `n` copies of a specimen in a row along x in one long box, every other one mirrored: a larger packing without its
/// preparation. Where a wall was, a grain now leans on its mirror image.
inline Snapshot row_of_copies(const Snapshot &specimen, std::size_t n)
{
  const double edge = specimen.box.edges()[0];
  const std::size_t grains = specimen.grains.n_grains();
  std::vector<Vec3> centres;
  std::vector<double> radii;
  Snapshot row;
  for (std::size_t copy = 0; copy < n; ++copy)
    for (std::size_t i = 0; i < grains; ++i)
      {
        Vec3 x = specimen.grains.centre(i);
        if (copy % 2 == 1)
          x[0] = specimen.box.lower[0] + specimen.box.upper[0] - x[0];
        centres.push_back(x + Vec3(copy * edge, 0, 0));
        radii.push_back(specimen.grains.radius(i));
      }
  row.grains = make_packing(centres, radii, specimen.grains.density);
  row.box = specimen.box;
  row.box.upper[0] += (n - 1) * edge;
  row.law = specimen.law;
  return row;
}
} // namespace isostat::test
