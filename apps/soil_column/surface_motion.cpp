// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/surface_motion.hpp"

#include "apps/deposit/ranks.hpp"
#include "base/files/replace_file.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
SurfaceMotion::SurfaceMotion(const ColumnScene &scene, const FiniteElementSpace &space,
                             const std::array<Motion, 3> &motions, double time_step)
    : space_(space), motions_(motions), rigid_(!scene.base.compliant()), damping_(scene.output.spectrum_damping),
      duration_(scene.analysis.duration)
{
  for (unsigned axis = 0; axis < 3; ++axis)
    {
      surface_[axis] = space.find_dof(space.mesh().on_line(0), axis);
      if (motions[axis].at_rest())
        continue;
      axes_.push_back(axis);
      spectra_.emplace_back(spectrum_periods(), damping_, time_step);
    }
  for (Bands &bands : bands_)
    bands.surface = bands.input = LowPass(scene.analysis.highest_frequency, time_step);
}

void SurfaceMotion::follow(const Dynamics &run)
{
  if (surface_[0] < 0) // its components are on one rank
    return;
  const double t = run.time() - run.time_step(); // what accelerations are of
  std::array<double, 3> input, a;
  for (std::size_t axis = 0; axis < 3; ++axis)
    {
      input[axis] = motions_[axis].acceleration(t);
      a[axis] = run.acceleration(static_cast<unsigned>(surface_[axis])) + (rigid_ ? input[axis] : 0);
    }
  for (std::size_t k = 0; k < axes_.size(); ++k)
    spectra_[k].follow(a[axes_[k]]);
  std::array<double, 2> low;
  for (std::size_t axis = 0; axis < 2; ++axis)
    {
      Bands &b = bands_[axis];
      low[axis] = b.surface(a[axis]);
      const double input_low = b.input(input[axis]);
      b.all += a[axis] * a[axis];
      b.low += low[axis] * low[axis];
      b.input_all += input[axis] * input[axis];
      b.input_low += input_low * input_low;
    }
  peak_below_ = std::max(peak_below_, std::hypot(low[0], low[1]));
}

std::vector<double> SurfaceMotion::sum_over_ranks(std::vector<double> values) const
{
  if (space_.shared_out() && surface_[0] < 0)
    std::ranges::fill(values, 0.0);
  space_.sum_over_ranks(values);
  return values;
}

MotionBands SurfaceMotion::bands() const
{
  const auto &[x, y] = bands_;
  const std::vector<double> sums =
      sum_over_ranks({x.all + y.all, x.low + y.low, x.input_all + y.input_all, x.input_low + y.input_low, peak_below_});
  const auto share = [](double all, double low) { return all > 0 ? std::max(0.0, 1 - low / all) : 0; };
  return {sums[4], share(sums[0], sums[1]), share(sums[2], sums[3])};
}

void SurfaceMotion::write_spectra(const std::filesystem::path &path) const
{
  if (axes_.empty())
    return;
  std::vector<std::vector<double>> columns = {spectrum_periods()};
  std::string text = "period (s)";
  for (std::size_t k = 0; k < axes_.size(); ++k)
    {
      const char name = "xyz"[axes_[k]];
      text +=
          fmt::format(",input_{0}_SA (m/s2),surface_{0}_SA (m/s2),input_{0}_PSA (m/s2),surface_{0}_PSA (m/s2)", name);
      const auto input = response_spectrum(motions_[axes_[k]], columns[0], damping_, duration_),
                 surface = spectra_[k].peaks();
      columns.insert(columns.end(),
                     {input.absolute, sum_over_ranks(surface.absolute), input.pseudo, sum_over_ranks(surface.pseudo)});
    }
  if (!ranks().first())
    return;
  text += '\n';
  for (std::size_t i = 0; i < columns[0].size(); ++i)
    for (std::size_t c = 0; c < columns.size(); ++c)
      text += fmt::format("{:.10g}{}", columns[c][i], c + 1 < columns.size() ? ',' : '\n');
  write_replacing(path, text);
}

template <class Self, class Visit>
void SurfaceMotion::for_each_number(Self &self, const Visit &visit)
{
  for (auto &b : self.bands_)
    {
      LowPass::for_each_field(b.surface, visit);
      LowPass::for_each_field(b.input, visit);
      visit(b.all), visit(b.low), visit(b.input_all), visit(b.input_low);
    }
  visit(self.peak_below_);
}

void SurfaceMotion::save(ColumnCheckpoint &checkpoint) const
{
  std::vector<double> numbers;
  for_each_number(*this, [&](double x) { numbers.push_back(x); });
  checkpoint.vectors["motion_bands"] = sum_over_ranks(numbers);
  for (std::size_t k = 0; k < axes_.size(); ++k)
    checkpoint.vectors[fmt::format("spectrum_{}", "xyz"[axes_[k]])] = sum_over_ranks(spectra_[k].save());
}

void SurfaceMotion::restore(const ColumnCheckpoint &checkpoint)
{
  std::size_t n = 0;
  for_each_number(*this, [&](double) { ++n; });
  auto next = checkpoint.vector("motion_bands", n).begin();
  for_each_number(*this, [&](double &x) { x = *next++; });
  for (std::size_t k = 0; k < axes_.size(); ++k)
    spectra_[k].restore(checkpoint.vector(fmt::format("spectrum_{}", "xyz"[axes_[k]])));
}
} // namespace isostat
