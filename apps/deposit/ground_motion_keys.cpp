// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/scene.hpp"
#include "base/scene/ranges.hpp"

namespace isostat
{
namespace
{
using namespace ranges;

constexpr const char *motion_axes[] = {"x", "y", "z"};
constexpr const char *motion_choices[] = {"record", "harmonic", "ricker"};
constexpr const char *unit_choices[] = {"file", "m/s2", "cm/s2", "g"};
constexpr const char *baseline_choices[] = {"none", "mean", "quadratic"};

constexpr unsigned record = kind_bit(MotionKind::record);
constexpr unsigned harmonic = kind_bit(MotionKind::harmonic);
constexpr unsigned ricker = kind_bit(MotionKind::ricker);

// clang-format off
constexpr Key keys[] = {
  {.path = "axis", .field = member<&ColumnMotion::axis>, .value = "x", .choices = motion_axes,
   .text = "Direction of the motion. An undrained column, whose volume is constant, follows its base along z as a "
           "rigid body: no P waves; use coupled for them. A motion along z needs a rigid base there."},
  {.path = "kind", .field = member<&ColumnMotion::kind>, .presence = Presence::required, .value = "ricker",
   .choices = motion_choices, .text = "A recorded acceleration, a sine, or a Ricker wavelet."},
  {.path = "file", .field = member<&ColumnMotion::file>, .presence = Presence::required, .value = "motions/record.txt",
   .kinds = record,
   .text = "The record: two columns of time (s) and acceleration, DEEPSOIL, PEER .AT2, K-NET ASCII or ESM ASCII; "
           "counts from the folder of the scene file or else from the working directory. Records whose files have "
           "times keep the time between them: the earliest first sample is at 0 s, and motions without times start at "
           "0 s of that clock. Samples are 1e-5 s to 10 s apart and within 1e6 m/s2."},
  {.path = "unit", .field = member<&ColumnMotion::unit>, .value = "file", .choices = unit_choices, .kinds = record,
   .text = "Unit of the accelerations; file: the one that the header of the record states. A unit that contradicts the "
           "header is refused, and so are two columns without any unless `peak` is given; AT2 and DEEPSOIL without one are in g."},
  {.path = "baseline", .field = member<&ColumnMotion::baseline>, .value = "none", .choices = baseline_choices,
   .kinds = record,
   .text = "What is subtracted from the accelerations: nothing, their mean, or the quadratic in time that minimises "
           "the drift of the displacement."},
  {.path = "factor", .field = member<&ColumnMotion::factor>, .value = "1", .kinds = record, .group = "scale",
   .text = "Accelerations of the record are multiplied by this; excludes `peak`."},
  {.path = "peak", .field = member<&ColumnMotion::peak>, .unit = unit::m_s2, .presence = Presence::optional,
   .value = "0.2 g", .range = positive, .kinds = record, .group = "scale",
   .text = "Largest acceleration to which the record is scaled; excludes `factor`."},
  {.path = "amplitude", .field = member<&ColumnMotion::amplitude>, .unit = unit::m_s2, .presence = Presence::required,
   .value = "0.1 g", .kinds = harmonic | ricker, .text = "Amplitude of the acceleration."},
  {.path = "frequency", .field = member<&ColumnMotion::frequency>, .unit = unit::Hz, .presence = Presence::required,
   .value = "2 Hz", .range = {1e-3, 1e3}, .reason = "because ground does not shake as slowly or as fast",
   .kinds = harmonic | ricker, .text = "Frequency of the sine; of a wavelet the one where its spectrum is largest."},
  {.path = "duration", .field = member<&ColumnMotion::duration>, .unit = unit::s, .presence = Presence::required,
   .value = "10 s", .range = {0, 1e5, true}, .reason = "because no motion lasts for more than a day", .kinds = harmonic,
   .text = "Duration of the sine."},
  {.path = "ramp", .field = member<&ColumnMotion::ramp>, .unit = unit::s, .value = "0 s", .range = not_negative,
   .kinds = harmonic,
   .text = "Time in which the sine rises smoothly, and falls again at its end. At most half of `duration`."},
  {.path = "centre", .field = member<&ColumnMotion::centre>, .unit = unit::s, .presence = Presence::optional,
   .value = "0.75 s", .range = positive, .kinds = ricker,
   .text = "Time of the wavelet's peak, half of its duration; left out: 1.5 / frequency."},
  {.path = "interval", .field = member<&ColumnMotion::interval>, .unit = unit::s, .presence = Presence::optional,
   .value = "1 ms", .range = {Motion::shortest_interval, Motion::longest_interval},
   .reason = "because ground does not shake as fast or as slowly", .kinds = harmonic | ricker,
   .text = "Time between samples, linear in between; left out: 1 / (500 frequency), and 1e-5 s at least."},
  {.path = "again", .field = member<&ColumnMotion::again>, .unit = unit::s, .presence = Presence::optional,
   .value = "20 s", .range = positive,
   .text = "Time from the start of the motion to its start for the second time; left out: it comes once."},
};
// clang-format on
} // namespace

SceneFragment<ColumnMotion> ground_motion_keys() { return {keys}; }
} // namespace isostat
