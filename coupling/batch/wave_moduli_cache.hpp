// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/files/bytes.hpp"
#include "fem/material/material.hpp"

namespace isostat
{
/// When wave moduli are computed again.
struct RefreshRule
{
  double rise = 0.25;              ///< p' has risen by this part since [-], or ...
  std::uint64_t interval = 10'000; ///< ... so many commits ago, unless p' is lower than it was
  void check() const;              ///< @throws InputError

  bool operator==(const RefreshRule &) const = default;
};

/// Wave moduli of elements, and the p' at which each was computed. They fall with p', so that an old value is rather
/// too large: good for the bound of a stable time step. Where p' rises by less than the rule's share an old value is
/// too small: hardly with linear contacts, by up to a tenth with those of Hertz.
/// tested: tests/coupling/batch/wave_moduli_cache_test.cpp
class WaveModuliCache
{
public:
  explicit WaveModuliCache(std::size_t n_elements, const RefreshRule &rule = {});

  /// Marks all as due, at commit 0.
  void clear();
  /// Counts a commit, and marks those that the rule says.     @param stresses  of each element
  void commit(std::span<const Stress> stresses);

  bool is_due(std::size_t id) const { return states_[id].due; }
  std::vector<std::size_t> due() const; ///< rising
  /// @param stress  committed, at which they were computed
  void set(std::size_t id, const WaveModuli &moduli, const Stress &stress);

  std::span<const WaveModuli> moduli() const { return moduli_; }
  std::uint64_t n_commits() const { return n_commits_; }

  /// The commits, and an element's moduli with what they were computed at, for pack() of a material.
  void set_commits(std::uint64_t n) { n_commits_ = n; }
  void write(std::size_t id, ByteWriter &out) const;
  void read(std::size_t id, ByteReader &in);

private:
  struct State
  {
    double pressure = 0, commit = 0; ///< at which they were computed
    bool due = true;
  };
  RefreshRule rule_;
  std::uint64_t n_commits_ = 0;
  std::vector<WaveModuli> moduli_;
  std::vector<State> states_;
};
} // namespace isostat
