// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/peaks.hpp"

#include <cmath>
#include <limits>

namespace isostat
{
namespace
{
/// Raises the largest size so far to that of (x, y). hypot() is slow: not of what is smaller beyond round-off.
bool raise(double &largest, double x, double y)
{
  constexpr double below = 1 - 1e-14;
  if (x * x + y * y < below * largest * largest)
    return false;
  const double size = std::hypot(x, y);
  if (!(size > largest))
    return false;
  largest = size;
  return true;
}

bool raise_shear(double &largest, const Gradient &h) { return raise(largest, h[2] + h[6], h[5] + h[7]); }

/// With a horizontal vector whose components along x and y are unknowns.
void raise_horizontal(double &largest, const Vector &values, long x, long y, double add_x, double add_y)
{
  raise(largest, values.local_element(static_cast<unsigned>(x)) + add_x,
        values.local_element(static_cast<unsigned>(y)) + add_y);
}
} // namespace

void take_max(double &value, std::initializer_list<double *> with, MPI_Comm communicator)
{
  const double here = value;
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, communicator);
  for (double *other : with)
    {
      double x = here == value ? *other : std::numeric_limits<double>::max();
      MPI_Allreduce(&x, other, 1, MPI_DOUBLE, MPI_MIN, communicator);
    }
}

void ColumnPeaks::save(ColumnCheckpoint &checkpoint) const
{
  checkpoint.put(*this);
  for_each_line(*this, [&](const char *name, const auto &values) { checkpoint.vectors[name] = values; });
}

void ColumnPeaks::restore(const ColumnCheckpoint &checkpoint)
{
  checkpoint.get(*this);
  for_each_line(*this, [&](const char *name, auto &values) { values = checkpoint.vector(name, values.size()); });
}

PeakFollower::PeakFollower(const FiniteElementSpace &space, const ColumnLine *line,
                           const std::vector<double> &vertical_stress, std::span<const Stress> in_situ)
    : space_(space), line_(line), vertical_stress_(vertical_stress)
{
  for (unsigned c = 0; c < 2; ++c)
    surface_[c] = space.find_dof(space.mesh().on_line(0), c);
  if (line)
    {
      for (std::vector<double> *of_points :
           {&peaks.line_gamma, &peaks.line_ru, &peaks.line_tau, &peaks.line_secant, &peaks.line_demand})
        of_points->assign(line->points.size(), 0.0);
      for (std::size_t q : line->points)
        shear_in_situ_.push_back({in_situ[q][4], in_situ[q][3]});
      for (std::vector<double> *of_nodes : {&peaks.line_acceleration, &peaks.line_velocity, &peaks.line_displacement})
        of_nodes->assign(line->nodes.size(), 0.0);
    }
}

void PeakFollower::follow(const Vector &displacement, const std::vector<double> &pressure, double time,
                          std::span<const Stress> stresses)
{
  gradients_of(space_, displacement, gradients_);
  const auto depth = [&](std::size_t q) { return space_.mesh().depth(space_.position[q]); };
  for (std::size_t q = 0; q < gradients_.size(); ++q)
    {
      if (raise_shear(peaks.gamma, gradients_[q]))
        peaks.gamma_depth = depth(q);
      if (const double ru = pressure[q] / vertical_stress_[q]; ru > peaks.ru)
        {
          peaks.ru = ru;
          peaks.ru_depth = depth(q);
          peaks.ru_time = time;
        }
    }
  if (line_)
    for (std::size_t k = 0; k < line_->points.size(); ++k)
      {
        const std::size_t q = line_->points[k];
        if (raise_shear(peaks.line_gamma[k], gradients_[q]))
          {
            const auto &[xz, yz] = shear_in_situ_[k];
            peaks.line_secant[k] = std::hypot(stresses[q][4] - xz, stresses[q][3] - yz) / peaks.line_gamma[k];
          }
        peaks.line_ru[k] = std::max(peaks.line_ru[k], pressure[q] / vertical_stress_[q]);
      }
}

void PeakFollower::follow(const Dynamics &run)
{
  const bool coupled = run.settings().drainage == Drainage::coupled;
  const double now = run.time() - run.time_step(); // what accelerations are of
  follow(run.displacement(), run.point_pressure(), coupled ? now : run.time(), run.stresses());
  const auto &motion = run.settings().motion;
  const double ax = motion[0].acceleration(now), ay = motion[1].acceleration(now);
  const bool absolute = run.settings().base.compliant();
  const double frame_x = absolute ? 0 : ax, frame_y = absolute ? 0 : ay;
  peaks.input = std::max(peaks.input, std::hypot(ax, ay));
  if (surface_[0] >= 0 && surface_[1] >= 0)
    raise_horizontal(peaks.surface, run.acceleration(), surface_[0], surface_[1], frame_x, frame_y);
  if (!line_)
    return;
  follow_nodes(run.acceleration(), frame_x, frame_y, peaks.line_acceleration);
  follow_nodes(run.velocity(), 0, 0, peaks.line_velocity);
  follow_nodes(run.displacement(), 0, 0, peaks.line_displacement);
  const std::span<const Stress> stresses = run.stresses();
  for (std::size_t k = 0; k < line_->points.size(); ++k)
    {
      const Stress &stress = stresses[line_->points[k]];
      raise(peaks.line_tau[k], stress[4], stress[3]);
      if (peaks.line_ru[k] < ColumnPeaks::demand_ru)
        peaks.line_demand[k] = peaks.line_tau[k];
    }
}

void PeakFollower::follow_nodes(const Vector &values, double x, double y, std::vector<double> &largest) const
{
  for (std::size_t k = 0; k < line_->nodes.size(); ++k)
    raise_horizontal(largest[k], values, line_->nodes[k], line_->nodes[k] + 1, x, y);
}

void PeakFollower::gather()
{
  if (!space_.shared_out())
    return;
  const MPI_Comm all = space_.communicator();
  take_max(peaks.surface, {}, all);
  take_max(peaks.gamma, {&peaks.gamma_depth}, all);
  take_max(peaks.ru, {&peaks.ru_depth, &peaks.ru_time}, all);
}
} // namespace isostat
