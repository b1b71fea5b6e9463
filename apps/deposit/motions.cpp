// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/scene.hpp"

namespace isostat
{
namespace
{
Motion motion_of(const ColumnMotion &motion)
{
  switch (motion.kind)
    {
    case MotionKind::record:
      {
        const Motion record = corrected(read_motion(motion.file, motion.unit), motion.baseline);
        return motion.peak ? scaled_to_peak(record, *motion.peak) : scaled(record, motion.factor);
      }
    case MotionKind::harmonic:
      return harmonic_motion(motion.amplitude, motion.frequency, motion.duration, motion.ramp,
                             motion.sample_interval());
    case MotionKind::ricker:
      return ricker_motion(motion.amplitude, motion.frequency, motion.peak_time(), motion.sample_interval());
    }
  return {};
}
} // namespace

std::array<Motion, 3> column_motions(const ColumnScene &scene)
{
  std::array<Motion, 3> motions;
  for (const ColumnMotion &motion : scene.motions)
    {
      const Motion once = motion_of(motion);
      motions[static_cast<std::size_t>(motion.axis)] = motion.again ? repeated(once, *motion.again) : once;
    }
  return motions;
}
} // namespace isostat
