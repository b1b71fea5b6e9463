// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace isostat
{
/// A motion in one direction as equally spaced accelerations, m/s2. Between samples the acceleration is linear, so
/// velocity and displacement are exact polynomials; before the first sample and after the last the acceleration is 0.
/// tested: tests/fem/motion_input_test.cpp
class Motion
{
public:
  Motion() = default; ///< rest
  /// @param interval  s
  Motion(std::vector<double> accelerations, double interval);

  double acceleration(double t) const;
  double velocity(double t) const;
  double displacement(double t) const;

  bool at_rest() const { return accelerations_.empty(); }
  double duration() const;
  double interval() const { return interval_; }
  double peak() const; ///< largest |acceleration|
  const std::vector<double> &accelerations() const { return accelerations_; }

private:
  std::vector<double> accelerations_, velocities_, displacements_;
  double interval_ = 0;
};

/// Unit of the accelerations in a file.
enum class AccelerationUnit
{
  m_s2,
  cm_s2,
  g
};

/// Reads a record. Formats, told apart by content:
///  - two columns, time (s) and acceleration, separated by blanks, tabs or commas, any comment lines starting with # or
///  %
///    and one header line of words; the time must rise by equal intervals (to 1e-3 of one)
///  - PEER NGA .AT2: four header lines, the fourth with NPTS and DT, then accelerations in g, several to a line
/// @param unit  of a two-column file; AT2 is always in g
/// @throws InputError with file:line: missing file, text among the numbers, gaps or steps back in time, not-a-number,
///         fewer values than NPTS, fewer than two samples      tested: tests/fem/motion_input_test.cpp
Motion read_motion(const std::filesystem::path &path, AccelerationUnit unit);

/// A sin(2 pi f t) with a smooth (cosine) rise and fall over `ramp` seconds.
Motion harmonic_motion(double amplitude, double frequency, double duration, double ramp, double interval);

/// Ricker wavelet A (1 - 2 b^2) exp(-b^2), b = pi f (t - t0), from 0 to 2 t0 (Ricker 1953).
Motion ricker_motion(double amplitude, double frequency, double t0, double interval);

/// How a record is made ready.
enum class Baseline
{
  none,
  mean,     ///< takes the mean acceleration off
  quadratic ///< takes off the polynomial a0 + a1 t + a2 t^2 whose twice integrated motion fits the displacement best in
            ///< the least-squares sense, velocity 0 at the end being approached (as SeismoSignal and OpenSees users do)
};
Motion corrected(const Motion &motion, Baseline baseline);
Motion scaled_to_peak(const Motion &motion, double peak); ///< @throws InputError if the record is all zero
Motion scaled(const Motion &motion, double factor);

/// |S_a|(T): peak absolute acceleration of damped oscillators under a motion, exact for piecewise linear acceleration
/// (Nigam & Jennings 1969). @param damping  fraction of critical   @return m/s2
std::vector<double> response_spectrum(const Motion &motion, const std::vector<double> &periods, double damping);
} // namespace isostat
