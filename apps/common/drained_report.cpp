// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/drained_report.hpp"

#include "dem/drive/stages/cycles.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace
{
bool is_drained(const Stage &stage)
{
  const auto *path = as<Path>(stage);
  return as<ServoedShear>(stage) || (path && path->is_drained_triaxial());
}

/// It ends at a lower stress ratio than it began with, of the same sign, and never had a higher one.
bool unloads(const DrainedPath &path)
{
  if (path.stress_ratio.size() < 2)
    return true;
  const auto amount = [](double ratio) { return std::abs(ratio); };
  return path.stress_ratio.back() * path.stress_ratio.front() > 0 &&
         amount(path.stress_ratio.back()) < amount(path.stress_ratio.front()) &&
         std::ranges::max(path.stress_ratio, {}, amount) == path.stress_ratio.front();
}
} // namespace

std::vector<DrainedStage> drained_stages(const RunHistory &run, const Scene &scene)
{
  if (std::none_of(scene.stages.begin(), scene.stages.end(), is_drained))
    return {};
  enum
  {
    at_stage,
    x,
    y,
    z,
    p,
    q,
    done
  };
  std::vector<std::string> names = {"stage", "eps_x", "eps_y", "eps_z", "p", "q"};
  const bool repeated = !repeats_text(scene.stages).empty();
  if (repeated)
    names.push_back("done");
  const HistoryRows history = run.of(names);
  const auto stage_of = [&](std::size_t row) { return static_cast<std::size_t>(history(row, at_stage)); };
  std::vector<DrainedStage> stages;
  for (std::size_t k = 0; k < scene.stages.size(); ++k)
    if (is_drained(scene.stages[k]))
      {
        DrainedPath path;
        double last = -1; // time that it is done
        for (std::size_t row = 0; row < history.n_rows(); ++row)
          {
            if (stage_of(row) != k)
              continue;
            if (repeated && history(row, done) != last)
              path = {}, last = history(row, done);
            path.axial.push_back(history(row, y));
            path.volumetric.push_back(history(row, x) + history(row, y) + history(row, z));
            path.stress_ratio.push_back(history(row, p) > 0 ? history(row, q) / history(row, p) : 0);
          }
        if (!unloads(path))
          stages.push_back({k, repeated ? cycle_text(scene.stages, static_cast<std::uint64_t>(last)) : std::string(),
                            drained_strength(path)});
      }
  return stages;
}

std::string to_text(const std::vector<DrainedStage> &stages)
{
  std::string text;
  for (const auto &[number, cycle, s] : stages)
    {
      const std::string which =
          stages.size() > 1 || !cycle.empty() ? fmt::format(" (stage {}{})", number, cycle) : std::string();
      const auto line = [&](const char *name, const std::string &value) {
        text += fmt::format("\n  {:<25}{}{}", name, value, which);
      };
      const bool rises = std::abs(s.end_ratio) > 0.99 * std::abs(s.peak_ratio);
      line("peak friction", fmt::format("{:.2f} deg (q/p' {:.3f}) at a strain of {:.3f} %{}", s.peak_friction,
                                        s.peak_ratio, 100 * s.peak_strain, rises ? ", no peak yet: mobilised" : ""));
      line("end friction", fmt::format("{:.2f} deg (q/p' {:.3f})", s.end_friction, s.end_ratio));
      line("largest dilatancy", fmt::format("{}-d eps_v/d eps {:.3f} at a strain of {:.3f} %",
                                            s.dilatancy ? fmt::format("{:.2f} deg, ", *s.dilatancy) : "",
                                            s.dilatancy_rate, 100 * s.dilatancy_strain));
      line("volumetric strain",
           fmt::format("{:.3f} % at the end, {:.3f} % at most, at a strain of {:.3f} %", 100 * s.end_volumetric,
                       100 * s.most_contracted, 100 * s.contracted_strain));
    }
  return text;
}

Json to_json(const std::vector<DrainedStage> &stages)
{
  Json list = Json::array();
  for (const auto &[number, cycle, s] : stages)
    list.push_back({{"stage", number},
                    {"q_over_p_peak", s.peak_ratio},
                    {"q_over_p_end", s.end_ratio},
                    {"friction_peak_deg", s.peak_friction},
                    {"friction_end_deg", s.end_friction},
                    {"strain_at_peak", s.peak_strain},
                    {"dilatancy_deg", s.dilatancy ? Json(*s.dilatancy) : Json()},
                    {"dilatancy_rate", s.dilatancy_rate},
                    {"strain_at_dilatancy", s.dilatancy_strain},
                    {"eps_v_end", s.end_volumetric},
                    {"eps_v_max", s.most_contracted},
                    {"strain_at_eps_v_max", s.contracted_strain}});
  return list;
}
} // namespace isostat
