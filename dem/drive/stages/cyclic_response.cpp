// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/cyclic_response.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
void begin_half_cycle(double load, DriveState &state)
{
  CyclicResponse &response = state.undrained.response;
  response.peak = response.lowest = sign(state.loading.direction) * load;
  response.peak_strain = state.loading.strain;
}
} // namespace

void begin_response(double load, DriveState &state)
{
  CyclicResponse &response = state.undrained.response;
  response.least_load = response.largest_load = load;
  begin_half_cycle(load, state);
}

void turn_response(double load, DriveState &state, bool at_load)
{
  std::optional<Softening> &flow = state.undrained.response.flow;
  const double ended = -sign(state.loading.direction); // the half cycle that has
  if (flow && at_load && flow->direction == ended)
    flow->recovered = true;
  begin_half_cycle(load, state);
}

void follow_response(double load, double strain, double amplitude, const ShearMode &mode, std::uint64_t step,
                     DriveState &state, Verdict &verdict)
{
  CyclicResponse &response = state.undrained.response;
  const double direction = sign(state.loading.direction), along = direction * load;
  response.least_load = std::min(response.least_load, load);
  response.largest_load = std::max(response.largest_load, load);
  response.least_strain = std::min(response.least_strain, strain);
  response.most_strain = std::max(response.most_strain, strain);
  if (along >= response.peak)
    {
      response.peak = response.lowest = along;
      response.peak_strain = state.loading.strain;
      return;
    }
  response.lowest = std::min(response.lowest, along);
  const double since = std::abs(state.loading.strain - response.peak_strain);
  const bool softens =
      response.peak - response.lowest > softening_load * amplitude && since > softening_gamma / mode.gamma_factor;
  if (!softens)
    return;
  const std::uint64_t reversals = state.undrained.reversals;
  std::optional<Softening> &flow = response.flow;
  if (flow && flow->reversals == reversals && !flow->recovered)
    flow->lowest = std::min(flow->lowest, response.lowest);
  else if (!flow || flow->recovered)
    {
      flow = Softening{step,      reversals, strain - direction * since, direction * response.peak, response.lowest,
                       direction, false};
      verdict.notable = true;
      verdict.event = fmt::format("flow at step {}, after {} reversals: {} fell from {:.2f} to {:.2f} kPa, {} {:.4g} %",
                                  step, reversals, mode.load_name, flow->peak / 1e3, direction * response.lowest / 1e3,
                                  mode.strain_name, 100 * strain);
    }
}

bool reverses_stress(const CyclicResponse &response)
{
  const double overshoot = 0.01 * (response.largest_load - response.least_load); // each turn comes a little late
  return response.least_load < -overshoot && response.largest_load > overshoot;
}

const char *response_name(const UndrainedRecord &record, const ShearMode &mode)
{
  const CyclicResponse &response = record.response;
  if (response.flow)
    return response.flow->recovered ? "limited flow" : "flow";
  if (record.liquefaction)
    return "cyclic mobility";
  const double largest = std::max(response.most_strain, -response.least_strain);
  return largest >= accumulated_gamma / mode.gamma_factor ? "plastic strain accumulation" : "no failure";
}
} // namespace isostat
