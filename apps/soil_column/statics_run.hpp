// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/soil_column/column_run.hpp"

namespace isostat
{
/// A run whose steps are equilibria, each of which is recorded.
class StaticsRun : public ColumnRun<Statics>
{
public:
  StaticsRun(const ColumnRequest &request, const StaticsSettings &settings)
      : ColumnRun<Statics>(request, {}, interruptible(settings))
  {}

protected:
  /// A row, a profile and a ParaView file of every step.
  void record()
  {
    const Vector &u = run_.displacement();
    instant_.step = run_.n_steps();
    instant_.time = run_.time();
    instant_.displacement.assign(u.begin(), u.begin() + u.locally_owned_size());
    instant_.velocity.assign(instant_.displacement.size(), 0.0);
    instant_.acceleration = instant_.velocity;
    gradients_of(space_, u, instant_.gradients);
    instant_.stresses.assign(run_.stresses().begin(), run_.stresses().end());
    instant_.pressure = run_.point_pressure();
    follower_.follow(u, instant_.pressure, run_.time(), instant_.stresses);
    write([&] {
      files_.record(instant_);
      files_.write_rows();
      files_.profile(instant_);
      files_.paraview(instant_);
    });
  }
};
} // namespace isostat
