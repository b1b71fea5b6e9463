// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/batch/wave_moduli_cache.hpp"

#include <algorithm>

namespace isostat
{
namespace
{
double pressure(const Stress &s) { return -(s[0] + s[1] + s[2]) / 3; }
} // namespace

void RefreshRule::check() const
{
  if (!(rise > 0) || interval == 0)
    throw InputError("rve: rise and interval of the refresh of wave moduli must be positive");
}

WaveModuliCache::WaveModuliCache(std::size_t n_elements, const RefreshRule &rule)
    : rule_(rule), moduli_(n_elements), states_(n_elements)
{}

void WaveModuliCache::clear()
{
  n_commits_ = 0;
  std::ranges::fill(moduli_, WaveModuli{});
  std::ranges::fill(states_, State{});
}

void WaveModuliCache::commit(std::span<const Stress> stresses)
{
  ++n_commits_;
  for (std::size_t id = 0; id < states_.size(); ++id)
    {
      State &state = states_[id];
      const double p = pressure(stresses[id]);
      const bool old = static_cast<double>(n_commits_) - state.commit >= static_cast<double>(rule_.interval);
      state.due |= p > (1 + rule_.rise) * state.pressure || (old && p >= state.pressure);
    }
}

std::vector<std::size_t> WaveModuliCache::due() const
{
  std::vector<std::size_t> ids;
  for (std::size_t id = 0; id < states_.size(); ++id)
    if (is_due(id))
      ids.push_back(id);
  return ids;
}

void WaveModuliCache::set(std::size_t id, const WaveModuli &moduli, const Stress &stress)
{
  moduli_[id] = moduli;
  const double p = std::max(pressure(stress), 0.01 * states_[id].pressure); // never zero: no endless refresh
  states_[id] = {p, static_cast<double>(n_commits_), false};
}

void WaveModuliCache::write(std::size_t id, ByteWriter &out) const
{
  const State &state = states_[id];
  out.numbers(std::array{moduli_[id].p, moduli_[id].s, state.pressure, state.commit, state.due ? 1.0 : 0.0});
}

void WaveModuliCache::read(std::size_t id, ByteReader &in)
{
  std::array<double, 5> x{};
  in.numbers(x, "numbers of waves");
  moduli_[id] = {x[0], x[1]};
  states_[id] = {x[2], x[3], x[4] != 0};
}
} // namespace isostat
