// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/behaviour.hpp"

namespace isostat
{
Key SteppedStage::max_steps_key()
{
  return {.path = "max_steps",
          .kind = Kind::integer,
          .value = "0",
          .text = "Ends the stage after so many time steps; 0: no limit.",
          .field = InStage<&SteppedStage::max_steps>{}};
}

RigidBox about_centre(const DriveState &state, const Vec3 &edges)
{
  const Vec3 centre = state.path.reference.centre();
  return {centre - 0.5 * edges, centre + 0.5 * edges};
}
} // namespace isostat
