// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/checkpoint.hpp"
#include "apps/deposit/scene.hpp"
#include "fem/motion/low_pass.hpp"
#include "fem/motion/response_spectrum.hpp"
#include "fem/solve/dynamics.hpp"

#include <filesystem>

namespace isostat
{
/// How much of the horizontal motion is faster than the highest frequency of interest.
struct MotionBands
{
  double peak_below = 0;             ///< of the surface, below that frequency (LowPass), as a vector, m/s2
  double share = 0, input_share = 0; ///< of the squared acceleration of surface and input, above it [-]
};

/// What every step of a run shows of the surface's acceleration, which rows of the history, further apart and filtered,
/// do not: response spectra, and how much of it is too fast to be of interest.
/// tested: tests/apps/column_motion_test.py, tests/apps/soil_column_resume_test.py
class SurfaceMotion
{
public:
  /// Collective.
  SurfaceMotion(const ColumnScene &scene, const FiniteElementSpace &space, const std::array<Motion, 3> &motions,
                double time_step);

  /// After each step.   Cost: in the loop, 1 us for each axis that moves.
  void follow(const Dynamics &run);
  MotionBands bands() const; ///< collective

  /// A table of the period and of SA and PSA of input and surface along each axis that moves, spectra.csv. The input's
  /// come from its own samples. Nothing if nothing moves.   Collective, written on the first rank.
  void write_spectra(const std::filesystem::path &path) const;

  void save(ColumnCheckpoint &checkpoint) const; ///< collective
  void restore(const ColumnCheckpoint &checkpoint);

private:
  struct Bands
  {
    LowPass surface, input;
    double all = 0, low = 0, input_all = 0, input_low = 0; ///< sums of squares
  };
  template <class Self, class Visit>
  static void for_each_number(Self &self, const Visit &visit);
  std::vector<double> sum_over_ranks(std::vector<double> values) const;

  const FiniteElementSpace &space_;
  const std::array<Motion, 3> &motions_;
  bool rigid_;
  double damping_, duration_;
  std::array<long, 3> surface_;   ///< unknowns; -1 on ranks without
  std::vector<std::size_t> axes_; ///< that move
  std::vector<ResponseSpectrum> spectra_;
  std::array<Bands, 2> bands_; ///< x, y
  double peak_below_ = 0;
};
} // namespace isostat
