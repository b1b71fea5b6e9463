// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/constant_p.hpp"

#include <algorithm>

namespace isostat
{
Vec3 ConstantP::lateral_stresses(const StageContext &c) const
{
  const double minus_axial = c.assembly.stress()(1, 1), p = c.state.path.lateral_target.mean();
  return Vec3::Constant(std::max(0.0, 0.5 * (3 * p + minus_axial)));
}
} // namespace isostat
