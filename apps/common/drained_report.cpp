// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/drained_report.hpp"

#include "dem/drive/stages/cycles.hpp"
#include "dem/measure/strength.hpp"

#include <algorithm>
#include <cmath>

namespace isostat
{
namespace
{
struct DrainedStage
{
  std::size_t stage = 0; ///< of the scene
  std::string cycle;     ///< which time it is, where stages are repeated (dem/drive/stages/cycles.hpp)
  DrainedStrength strength;
};

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

/// Of one that is repeated the last time. Stages that unload have no strength.
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

} // namespace

void add_drained(const RunHistory &run, const Scene &scene, Summary &summary)
{
  const std::vector<DrainedStage> stages = drained_stages(run, scene);
  for (std::size_t k = 0; k < stages.size(); ++k)
    {
      const auto &[number, cycle, s] = stages[k];
      const auto value = [&](const char *name, double amount, double unit = 1) {
        return Value{fmt::format("drained.{}.{}", k, name), amount, unit};
      };
      const std::string which =
          stages.size() > 1 || !cycle.empty() ? fmt::format(" (stage {}{})", number, cycle) : std::string();
      const bool rises = std::abs(s.end_ratio) > 0.99 * std::abs(s.peak_ratio);
      summary[fmt::format("drained.{}", k)] = {{"stage", number}, {"dilatancy_deg", nullptr}};
      summary.row("peak friction", "{:.2f} deg (q/p' {:.3f}) at a strain of {:.3f} %{}{}",
                  value("friction_peak_deg", s.peak_friction), value("q_over_p_peak", s.peak_ratio),
                  value("strain_at_peak", s.peak_strain, percent), rises ? ", no peak yet: mobilised" : "", which);
      summary.row("end friction", "{:.2f} deg (q/p' {:.3f}){}", value("friction_end_deg", s.end_friction),
                  value("q_over_p_end", s.end_ratio), which);
      summary.row("largest dilatancy", "{}-d eps_v/d eps {:.3f} at a strain of {:.3f} %{}",
                  s.dilatancy ? summary.text("{:.2f} deg, ", value("dilatancy_deg", *s.dilatancy)) : "",
                  value("dilatancy_rate", s.dilatancy_rate), value("strain_at_dilatancy", s.dilatancy_strain, percent),
                  which);
      summary.row("volumetric strain", "{:.3f} % at the end, {:.3f} % at most, at a strain of {:.3f} %{}",
                  value("eps_v_end", s.end_volumetric, percent), value("eps_v_max", s.most_contracted, percent),
                  value("strain_at_eps_v_max", s.contracted_strain, percent), which);
    }
}
} // namespace isostat
