// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/path.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>

namespace isostat
{
namespace
{
constexpr double rows_between_turns = 50;

bool prescribes_shear(const PathTable &table)
{
  return table.prescribes(PathQuantity::tau) || table.prescribes(PathQuantity::gamma);
}
} // namespace

const ShearMode &Path::mode() const
{
  if (drive == DrivenComponent::x || drive == DrivenComponent::z)
    return lateral_mode;
  return drive == DrivenComponent::xy ? simple_shear_mode : triaxial_mode;
}

bool Path::needs_cell() const
{
  return drive == DrivenComponent::xy || components[shear_component] != PathComponent{} ||
         (read_.table && prescribes_shear(*read_.table));
}

double Path::load(const Observation &seen) const { return &mode() == &lateral_mode ? -seen.q : seen.*mode().load; }

double Path::strain(const Observation &seen) const
{
  return drive == DrivenComponent::x   ? seen.strain[0]
         : drive == DrivenComponent::z ? seen.strain[2]
                                       : seen.*mode().strain;
}

double Path::row_strain(double asked) const
{
  return turn.strain > 0 ? std::min(asked, 2 * turn.strain / rows_between_turns) : asked;
}

std::optional<LoadRange> Path::required_loads(double) const
{
  if (!turn.low && !turn.high)
    return std::nullopt;
  std::vector<std::string> text;
  if (turn.low)
    text.push_back(fmt::format("turn.low = {:.4g} kPa", *turn.low / 1e3));
  if (turn.high)
    text.push_back(fmt::format("turn.high = {:.4g} kPa", *turn.high / 1e3));
  constexpr double any = std::numeric_limits<double>::infinity();
  return LoadRange{turn.low.value_or(-any), turn.high.value_or(any), fmt::format("{}", fmt::join(text, " and "))};
}

double Path::turning_load(const DriveState &state) const
{
  const auto &limit = state.loading.direction == LoadDirection::compression ? turn.high : turn.low;
  return limit ? *limit : ShearStage::turning_load(state);
}

double Path::turning_strain(const DriveState &state) const
{
  return turn.strain > 0 ? sign(state.loading.direction) * turn.strain : ShearStage::turning_strain(state);
}

void Path::begin_shear(const StageContext &c, const Mat3 &stress) const
{
  ShearStage::begin_shear(c, stress);
  PathProgress &progress = c.state.progress;
  progress = {};
  progress.stress = -stress.diagonal();
  progress.tau = stress(0, 1);
  progress.volume = c.assembly.volume();
  progress.reversals = c.state.undrained.reversals;
  progress.table = table_hash();
}
} // namespace isostat
