// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/stage_report.hpp"

#include "dem/drive/stages/cycles.hpp"
#include "dem/drive/stages/cyclic_response.hpp"
#include "dem/drive/stages/stage_end.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace
{
std::string loss_text(const ControlLoss &loss, const Scene &scene)
{
  return to_text(loss, scene.control, cycle_text(scene.stages, loss.done));
}
} // namespace

std::string response_text(const std::string &name, const CyclicResponse &cycles)
{
  std::string text = fmt::format("\n  cyclic response          {} ({}, loads from {:.2f} to {:.2f} kPa)", name,
                                 reverses_stress(cycles) ? "with stress reversal" : "without stress reversal",
                                 cycles.least_load / 1e3, cycles.largest_load / 1e3);
  if (const std::optional<Softening> &flow = cycles.flow)
    text += fmt::format("\n  it softened              after {} reversals from {:.2f} kPa at a strain of {:.4f} %",
                        flow->reversals, flow->peak / 1e3, 100 * flow->strain);
  return text;
}

Json response_json(const std::string &name, const CyclicResponse &cycles)
{
  Json json{{"name", name},
            {"stress_reversal", reverses_stress(cycles)},
            {"load_min", cycles.least_load},
            {"load_max", cycles.largest_load},
            {"strain_min", cycles.least_strain},
            {"strain_max", cycles.most_strain},
            {"softening", nullptr}};
  if (cycles.flow)
    json["softening"] = {{"reversals", cycles.flow->reversals},
                         {"strain", cycles.flow->strain},
                         {"peak", cycles.flow->peak},
                         {"recovered", cycles.flow->recovered}};
  return json;
}

std::vector<ToldEnd> told_ends(const DriveState &state, const Scene &scene)
{
  std::vector<ToldEnd> ends;
  for (const StageEnd &end : state.ends)
    ends.push_back({end, is_early(end, scene.stages), to_text(end, scene.stages)});
  return ends;
}

std::string stages_text(const DriveState &state, const Scene &scene)
{
  std::string text;
  for (const std::string &repeat : repeats_text(scene.stages))
    text += "\n  repeated                 " + repeat;
  for (const ToldEnd &told : told_ends(state, scene))
    text += fmt::format("\n  {:<25}{}", told.early ? "ended early" : "ended", told.text);
  for (const ControlLoss &loss : state.control.losses)
    text += "\n  control lost             " + loss_text(loss, scene);
  return text;
}

std::vector<std::string> stage_warnings(const DriveState &state, const Scene &scene)
{
  std::vector<std::string> lines;
  for (const ToldEnd &told : told_ends(state, scene))
    if (told.early)
      lines.push_back(told.text);
  for (const ControlLoss &loss : state.control.losses)
    lines.push_back("control lost: " + loss_text(loss, scene));
  return lines;
}

Json control_json(const std::vector<ControlLoss> &losses)
{
  Json list = Json::array();
  for (const auto &[stage, done, quantity, deviation, share] : losses)
    list.push_back({{"stage", stage},
                    {"quantity", name_of(quantity)},
                    {"target", deviation.target},
                    {"worst", deviation.value},
                    {"strain", deviation.began},
                    {"step", deviation.step},
                    {"share", share}});
  return list;
}

Json ends_json(const std::vector<ToldEnd> &ends)
{
  Json list = Json::array();
  for (const auto &[end, early, text] : ends)
    list.push_back({{"stage", end.stage},
                    {"by", name_of(end.by)},
                    {"step", end.step},
                    {"times", end.times},
                    {"early", early},
                    {"text", text}});
  return list;
}

Json early_ends_json(const std::vector<ToldEnd> &ends)
{
  Json list = Json::array();
  for (const auto &[end, early, text] : ends)
    if (early)
      list.push_back(
          {{"stage", end.stage}, {"step", end.step}, {"times", end.times}, {"at_once", end.at_once}, {"text", text}});
  return list;
}
} // namespace isostat
