// SPDX-License-Identifier: BSD-3-Clause
// Stiffness and wave moduli of the elements.
#include "coupling/batch/rve_material.hpp"
#include "coupling/batch/wave_moduli.hpp"

#include <algorithm>
#include <chrono>

namespace isostat
{
namespace
{
constexpr std::size_t n_entries = 36;

double pressure(const Stress &s) { return -(s[0] + s[1] + s[2]) / 3; }

/// Strain without its volume.
Stiffness deviator()
{
  Stiffness d = Stiffness::Identity();
  d.topLeftCorner<3, 3>().array() -= 1.0 / 3;
  return d;
}

class Stopwatch
{
public:
  explicit Stopwatch(double &seconds) : seconds_(seconds) {}
  ~Stopwatch() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

private:
  double &seconds_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};
} // namespace

/// Of all elements, at the last trial.
void RveMaterial::find_stiffnesses() const
{
  check_ready();
  if (skeleton_known_)
    return;
  const Stopwatch watch(cost_.wave_seconds);
  std::vector<double> rows(n_entries * n_elements(), 0.0);
  exchange_.stop_together(for_mine([&](std::size_t id) {
    if (!has_trial_)
      elements_[id]->rollback();
    Eigen::Map<Stiffness> row(&rows[n_entries * id]);
    row = elements_[id]->rve().stiffness();
  }));
  exchange_.share(all_, owners_, n_entries, rows);
  for (std::size_t id = 0; id < n_elements(); ++id)
    skeleton_[id] = Eigen::Map<Stiffness>(&rows[n_entries * id]);
  skeleton_known_ = true;
  cost_.stiffnesses += n_elements();
}

void RveMaterial::skeleton_stiffness(std::span<Stiffness> stiffnesses) const
{
  find_stiffnesses();
  const std::size_t n = settings_.realisations;
  for (std::size_t point = 0; point < n_points_; ++point)
    {
      Stiffness sum = skeleton_[n * point];
      for (std::size_t k = 1; k < n; ++k)
        sum += skeleton_[n * point + k];
      stiffnesses[point] = sum / static_cast<double>(n);
    }
}

void RveMaterial::stiffness(std::span<Stiffness> tangents) const
{
  skeleton_stiffness(tangents);
  if (settings_.undrained)
    for (Stiffness &c : tangents)
      c = (c * deviator()).eval();
}

void RveMaterial::mark_due()
{
  for (std::size_t id = 0; id < n_elements(); ++id)
    {
      Wave &w = waves_[id];
      const double p = pressure(committed_[id]);
      const bool old = static_cast<double>(commits_) - w.commit >= static_cast<double>(settings_.refresh_interval);
      w.due |= p > (1 + settings_.refresh_rise) * w.pressure || (old && p >= w.pressure);
    }
}

void RveMaterial::wave_moduli(std::span<WaveModuli> moduli) const
{
  check_ready();
  std::vector<std::size_t> due;
  for (std::size_t id = 0; id < n_elements(); ++id)
    if (waves_[id].due)
      due.push_back(id);
  if (!due.empty())
    {
      const Stopwatch watch(cost_.wave_seconds);
      std::vector<double> found(2 * n_elements(), 0.0), rows;
      exchange_.stop_together(for_mine([&](std::size_t id) {
        if (!waves_[id].due)
          return;
        const WaveModuli m =
            max_wave_moduli(elements_[id]->at_committed([](const Rve &rve) { return Stiffness(rve.stiffness()); }));
        found[2 * id] = m.p, found[2 * id + 1] = m.s;
      }));
      for (std::size_t id : due)
        rows.insert(rows.end(), {found[2 * id], found[2 * id + 1]});
      exchange_.share(due, owners_, 2, rows);
      for (std::size_t k = 0; k < due.size(); ++k)
        {
          Wave &w = waves_[due[k]];
          const double p = std::max(pressure(committed_[due[k]]), 0.01 * w.pressure); // never zero: no endless refresh
          w = {rows[2 * k], rows[2 * k + 1], p, static_cast<double>(commits_), false};
        }
      cost_.stiffnesses += due.size();
    }
  const std::size_t n = settings_.realisations;
  for (std::size_t point = 0; point < n_points_; ++point)
    {
      WaveModuli sum;
      for (std::size_t k = 0; k < n; ++k)
        sum.p += waves_[n * point + k].p, sum.s += waves_[n * point + k].s;
      moduli[point] = {sum.p / static_cast<double>(n), sum.s / static_cast<double>(n)};
    }
}
} // namespace isostat
