// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/stage_report.hpp"

#include "dem/drive/stages/cycles.hpp"
#include "dem/drive/stages/cyclic_response.hpp"
#include "dem/drive/stages/stage_end.hpp"

namespace isostat
{
namespace
{
std::string loss_text(const ControlLoss &loss, const Scene &scene)
{
  return to_text(loss, scene.control, cycle_text(scene.stages, loss.done));
}
} // namespace

void add_response(const DriveState &state, const Scene &scene, Summary &summary)
{
  const CyclicResponse &cycles = state.undrained.response;
  std::string name;
  for (const Stage &stage : scene.stages)
    if (const auto *shear = as<ShearStage>(stage); shear && shear->notes_response())
      name = response_name(state.undrained, shear->mode());
  if (name.empty() || (state.undrained.reversals == 0 && !cycles.flow))
    return;
  const bool reverses = reverses_stress(cycles);
  summary["cyclic_response"] = {{"name", name}, {"stress_reversal", reverses}};
  summary.row("cyclic response", "{} ({} stress reversal, loads from {:.2f} to {:.2f} kPa)", name,
              reverses ? "with" : "without", Value{"cyclic_response.load_min", cycles.least_load, kPa},
              Value{"cyclic_response.load_max", cycles.largest_load, kPa});
  summary["cyclic_response.strain_min"] = cycles.least_strain;
  summary["cyclic_response.strain_max"] = cycles.most_strain;
  summary["cyclic_response.softening"] = nullptr;
  if (const std::optional<Softening> &flow = cycles.flow)
    {
      summary.row("it softened", "after {} reversals from {:.2f} kPa at a strain of {:.4f} %",
                  Value{"cyclic_response.softening.reversals", flow->reversals},
                  Value{"cyclic_response.softening.peak", flow->peak, kPa},
                  Value{"cyclic_response.softening.strain", flow->strain, percent});
      summary["cyclic_response.softening.recovered"] = flow->recovered;
    }
}

void add_stages(const DriveState &state, const Scene &scene, Summary &summary)
{
  for (const char *list : {"control_lost", "ended", "ended_early"})
    summary[list] = Json::array();
  for (const std::string &repeat : repeats_text(scene.stages))
    summary.row("repeated", "{}", repeat);
  for (const StageEnd &end : state.ends)
    {
      const bool early = is_early(end, scene.stages);
      const std::string text = to_text(end, scene.stages);
      summary.row(early ? "ended early" : "ended", "{}", text);
      summary["ended"].push_back({{"stage", end.stage},
                                  {"by", name_of(end.by)},
                                  {"step", end.step},
                                  {"times", end.times},
                                  {"early", early},
                                  {"text", text}});
      if (early)
        summary["ended_early"].push_back(
            {{"stage", end.stage}, {"step", end.step}, {"times", end.times}, {"at_once", end.at_once}, {"text", text}});
    }
  for (const ControlLoss &loss : state.control.losses)
    {
      summary.row("control lost", "{}", loss_text(loss, scene));
      summary["control_lost"].push_back({{"stage", loss.stage},
                                         {"quantity", name_of(loss.quantity)},
                                         {"target", loss.deviation.target},
                                         {"worst", loss.deviation.value},
                                         {"strain", loss.deviation.began},
                                         {"step", loss.deviation.step},
                                         {"share", loss.share}});
    }
}

std::vector<std::string> stage_warnings(const DriveState &state, const Scene &scene)
{
  std::vector<std::string> lines;
  for (const StageEnd &end : state.ends)
    if (is_early(end, scene.stages))
      lines.push_back(to_text(end, scene.stages));
  for (const ControlLoss &loss : state.control.losses)
    lines.push_back("control lost: " + loss_text(loss, scene));
  return lines;
}
} // namespace isostat
