// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/checkpoint.hpp"
#include "apps/deposit/instant.hpp"
#include "fem/space/column_line.hpp"

namespace isostat
{
/// The largest value of all ranks, and what belongs to it: the smallest, if several ranks have it.   Collective.
void take_max(double &value, std::initializer_list<double *> with, MPI_Comm communicator);

/// Largest values of a run, evaluated in every step, not only in those that are recorded.
struct ColumnPeaks
{
  /// Stress beyond it is what liquefying soil answers, in spikes as it dilates, rather than what is asked of it [-].
  static constexpr double demand_ru = 0.5;

  double input = 0, surface = 0;            ///< horizontal acceleration by size, m/s2
  double gamma = 0, gamma_depth = 0;        ///< sqrt(gamma_xz^2 + gamma_yz^2) [-]; m
  double ru = 0, ru_depth = 0, ru_time = 0; ///< [-], m, s
  std::vector<double> line_gamma, line_ru;  ///< at the points of a ColumnLine; empty if the mesh is shared out
  std::vector<double> line_secant; ///< likewise: change of shear stress over strain where that is largest, Pa; 0: none
  std::vector<double> line_tau;    ///< likewise sqrt(tau_xz^2 + tau_yz^2), Pa; 0 unless it is shaken
  std::vector<double> line_demand; ///< likewise line_tau until r_u of the point reaches `demand_ru`
  // Likewise at its nodes, horizontal by size: m/s2; m/s and m as the unknowns count (from a rigid base).
  std::vector<double> line_acceleration, line_velocity, line_displacement;

  template <class Peaks, class Visit>
  static void for_each(Peaks &p, const Visit &visit)
  {
    visit("peak_input", p.input), visit("peak_surface", p.surface);
    visit("peak_gamma", p.gamma), visit("peak_gamma_depth", p.gamma_depth);
    visit("peak_ru", p.ru), visit("peak_ru_depth", p.ru_depth), visit("peak_ru_time", p.ru_time);
  }
  template <class Peaks, class Visit>
  static void for_each_line(Peaks &p, const Visit &visit)
  {
    visit("peak_gamma", p.line_gamma), visit("peak_line_ru", p.line_ru), visit("peak_tau", p.line_tau);
    visit("peak_secant", p.line_secant), visit("peak_demand", p.line_demand);
    visit("peak_acceleration", p.line_acceleration), visit("peak_velocity", p.line_velocity);
    visit("peak_displacement", p.line_displacement);
  }
  void save(ColumnCheckpoint &checkpoint) const;
  void restore(const ColumnCheckpoint &checkpoint);
};

/// Follows them.
class PeakFollower
{
public:
  /// @param line  null: the mesh is shared out   @param vertical_stress  sigma'_v0 of every point, Pa
  /// @param in_situ  stress of every point at the start, Pa
  PeakFollower(const FiniteElementSpace &space, const ColumnLine *line, const std::vector<double> &vertical_stress,
               std::span<const Stress> in_situ);
  /// After each step.
  void follow(const Dynamics &run);
  /// Strain and r_u of any solution.
  void follow(const Vector &displacement, const std::vector<double> &pressure, double time,
              std::span<const Stress> stresses);
  /// Largest over all ranks.   Collective.
  void gather();

  ColumnPeaks peaks;

private:
  /// Of `values`, with x and y added to those of the unknowns, at the nodes of the line.
  void follow_nodes(const Vector &values, double x, double y, std::vector<double> &largest) const;

  const FiniteElementSpace &space_;
  const ColumnLine *line_;
  const std::vector<double> &vertical_stress_;
  std::vector<std::array<double, 2>> shear_in_situ_; ///< sigma_xz, sigma_yz at the points of the line
  std::array<long, 2> surface_;
  std::vector<Gradient> gradients_;
};
} // namespace isostat
