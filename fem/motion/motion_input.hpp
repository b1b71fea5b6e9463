// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace isostat
{
/// A motion in one direction as equally spaced accelerations, m/s2, the first at t = 0 unless it is delayed.
/// Between samples the acceleration is linear, so velocity and displacement are exact polynomials:
///   a = a_i + s tau,  v = v_i + a_i tau + s tau^2/2,  d = d_i + v_i tau + a_i tau^2/2 + s tau^3/6,  tau = t - t_i
/// Before the first sample all is at rest. After the last the acceleration is 0: the velocity keeps its last value and
/// the displacement runs away unless that value is 0. Records seldom end at rest; see `corrected`. tested:
/// tests/fem/motion/motion_input_test.cpp
class Motion
{
public:
  static constexpr double most_samples = 1e8;                              ///< of a record or a formula
  static constexpr double shortest_interval = 1e-5, longest_interval = 10; ///< between samples, s
  static constexpr double strongest = 1e6;                                 ///< acceleration, m/s2

  Motion() = default; ///< rest
  /// @param accelerations  m/s2, two at least   @param interval  s
  /// @throws InputError for fewer than two samples, a value or an interval beyond the bounds above
  Motion(std::vector<double> accelerations, double interval);

  double acceleration(double t) const; ///< m/s2, t in s
  double velocity(double t) const;     ///< m/s
  double displacement(double t) const; ///< m

  bool at_rest() const { return accelerations_.empty(); }
  double delay() const { return delay_; }       ///< time of the first sample, s
  double duration() const;                      ///< time of the last sample, s; 0 at rest
  double interval() const { return interval_; } ///< s; 0 at rest
  double peak() const;                          ///< largest |acceleration|, m/s2; 0 at rest
  const std::vector<double> &accelerations() const { return accelerations_; }
  double origin() const { return origin_; } ///< time of the record's own clock at t = 0, s

  /// The same motion later.   @param delay  s, >= 0   @param origin  origin()
  Motion delayed(double delay, double origin = 0) const;

private:
  /// Where a time since the first sample lies: the sample before it and the time since that; @pre 0 <= t, not at rest
  struct Place
  {
    std::size_t sample;
    double since, slope;
  };
  Place place(double t) const;

  std::vector<double> accelerations_, velocities_, displacements_;
  double interval_ = 0, delay_ = 0, origin_ = 0;
};

/// Unit of the accelerations in a file.
enum class AccelerationUnit
{
  stated, ///< by the file; of AT2 and DEEPSOIL else g
  m_s2,
  cm_s2,
  g
};

/// Standard acceleration of gravity, m/s2: what "g" in a record means.
inline constexpr double standard_gravity = 9.80665;

struct Record
{
  Motion motion;               ///< its first sample at t = 0
  std::optional<double> start; ///< time of the first sample in the file, s; none: the file has no times
};

/// Reads a record. Formats, recognised by content:
///  - two columns, time (s) and acceleration, separated by blanks, tabs or commas; comment lines start with # or %, and
///    one header line of words may come first (as R and pandas write it, too, with a column of row names). The times
///    must rise by equal intervals (each to 1e-3 of the median); the interval is the mean one.
///  - DEEPSOIL: the same below a line with the number of rows and the step
///  - PEER .AT2: a line with NPTS and DT among the first ten ("NPTS= 4000, DT= .005 SEC" or "4000 .005 NPTS, DT"), then
///    NPTS accelerations, any number to a line
///  - K-NET ASCII ("Sampling Freq(Hz)", "Duration Time(s)", "Scale Factor") and ESM ASCII ("SAMPLING_INTERVAL_S: ",
///    "NDATA: ", "UNITS: ")
/// Any may be gzipped. The unit is that of the header (see record_unit() of fem/motion/motion_header.hpp).
/// @param unit  of a file that states none; must agree with one that does. AT2 and DEEPSOIL without either are in g
/// @param size_matters  false: it will be scaled to a peak, and two columns need no unit
/// @throws InputError with file:line: missing file, text among the numbers, gaps or steps back in time, not-a-number,
///         fewer or more values than announced, no unit or another one, a quantity other than acceleration
/// tested: tests/fem/motion/motion_file_test.cpp
Record read_record(const std::filesystem::path &path, AccelerationUnit unit, bool size_matters = true);

/// A w(t) sin(2 pi f t), 0 <= t <= duration. w rises as (1 - cos(pi t/ramp))/2 over the first `ramp` seconds and falls
/// the same way over the last. Samples after `duration`, if it is no multiple of the interval, are 0. Without a ramp
/// the velocity is A/(2 pi f) (1 - cos(2 pi f t)): a sine that starts at once drifts; a ramp of a few periods ends the
/// drift.
/// @param amplitude  m/s2   @param frequency  Hz   @param duration, ramp, interval  s
/// @throws InputError unless f > 0, duration > 0, 0 <= 2 ramp <= duration, 0 < interval <= 0.1/f
/// tested: tests/fem/motion/motion_input_test.cpp
Motion harmonic_motion(double amplitude, double frequency, double duration, double ramp, double interval);

/// Ricker wavelet a = A (1 - 2 b^2) exp(-b^2), b = pi f (t - t0), from 0 to 2 t0 (Ricker 1953,
/// doi:10.1190/1.1437843); f is the peak of its spectrum. v = A (t - t0) exp(-b^2), d = -A/(2 pi^2 f^2) exp(-b^2), each
/// except for what is cut off before t = 0.
/// @param amplitude  m/s2   @param frequency  Hz   @param t0, interval  s
/// @throws InputError unless f > 0, f t0 >= 1 (less than 1e-3 A is cut off), 0 < interval <= 0.1/f
/// tested: tests/fem/motion/motion_input_test.cpp
Motion ricker_motion(double amplitude, double frequency, double t0, double interval);

/// How a record is made ready. What follows takes motions that are not delayed.
enum class Baseline
{
  none,
  mean,     ///< takes the mean over time of the acceleration off
  quadratic ///< takes a parabola c0 + c1 t + c2 t^2 off the acceleration
};

/// The motion without its drift. Both corrections end with velocity 0 (to round-off), so nothing moves after the
/// record; neither makes the last displacement 0. The parabola is the one that makes the sum of the squared velocities
/// at the samples smallest among those that end with velocity 0:
///   min sum_i v_c(t_i)^2,  v_c(T) = 0,  v_c the exact velocity of a_c,i = a_i - c0 - c1 t_i - c2 t_i^2
/// Newmark (1973) minimises the mean square velocity with such a parabola (Abaqus Theory Guide, "Baseline correction of
/// accelerograms"); the condition at the end is added here. The acceleration may jump by c0 at t = 0. Applying a
/// correction twice changes nothing.
/// tested: tests/fem/motion/motion_input_test.cpp
Motion corrected(const Motion &motion, Baseline baseline);

/// All accelerations times peak/motion.peak().
/// @param peak  m/s2   @throws InputError unless peak > 0, and if the motion is all zero
Motion scaled_to_peak(const Motion &motion, double peak);
Motion scaled(const Motion &motion, double factor); ///< all accelerations times `factor`

/// The motion twice: the second time from the first sample on that is `start` or later; where both are going on, their
/// sum.     @param start  s; rounded up to whole intervals   @throws InputError unless start > 0
/// tested: tests/fem/motion/motion_input_test.cpp
Motion repeated(const Motion &motion, double start);
} // namespace isostat
