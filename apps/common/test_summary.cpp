// SPDX-License-Identifier: BSD-3-Clause
// From the history of a test and the driver's state to what is reported of it.
#include "apps/common/test_summary.hpp"

#include "apps/common/drained_report.hpp"
#include "apps/common/setup_report.hpp"
#include "apps/common/stage_report.hpp"
#include "dem/drive/programme.hpp"
#include "dem/measure/redundancy.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/ranges.h>

namespace isostat
{
namespace
{
enum Column
{
  stage,
  eps,
  liquefied,
  p,
  q,
  ir,
  ir_eq2,
  constraints,
  indicator,
  reversals,
  work,
  residual
};

HistoryRows rows_of(const RunHistory &run, bool energy)
{
  std::vector<std::string> names = {"stage", "eps_y",  "liquefied",      "p",         "q",
                                    "IR",    "IR_eq2", "IR_constraints", "indicator", "reversals"};
  if (energy)
    names.insert(names.end(), {"W_boundary", "residual"});
  return run.of(names);
}

bool is_simple_shear(const Stage &stage)
{
  const auto *shear = as<ShearStage>(stage);
  return shear && &shear->mode() == &simple_shear_mode;
}

bool is_cyclic(const Stage &stage)
{
  const auto *shear = as<ShearStage>(stage);
  return shear && shear->turns();
}

bool turns_at_a_load(const Stage &stage)
{
  const auto *path = as<Path>(stage);
  return as<CyclicConstantVolume>(stage) || (path && (path->turn.low || path->turn.high));
}

bool is_driven(const Stage &stage)
{
  const auto *path = as<Path>(stage);
  return as<ShearStage>(stage) && !(path && path->drive == DrivenComponent::none);
}

/// It looks for liquefaction.
bool may_liquefy(const Stage &stage)
{
  return as<LiquefiableShear>(stage) && behaviour(stage).shears() && behaviour(stage).keeps_volume();
}

std::string index_names(const std::vector<int> &constraints)
{
  std::vector<std::string> names;
  std::ranges::transform(constraints, std::back_inserter(names), index_name);
  return fmt::format("{}", fmt::join(names, "; then "));
}

/// Of the simple shear stages of a test.
struct ShearExtremes
{
  double gamma = 0, tau = 0; ///< largest |gamma_xy| since the first shear stage began [-], largest |tau_xy| in Pa
  // What follows is of the stage with the largest ratio, among those with a CSR if there are any.
  double sigma_v0 = 0;        ///< vertical effective stress when it began, Pa
  double max_ratio = 0;       ///< |tau_xy| over sigma_v0; in a cyclic test the CSR and its overshoot [-]
  double requested_ratio = 0; ///< CSR of the scene; 0: it has none [-]
};

/// Of two stages the one with a CSR, or with the larger ratio.
bool comes_first(const ShearExtremes &a, const ShearExtremes &b)
{
  const bool has = a.requested_ratio > 0, other_has = b.requested_ratio > 0;
  return has != other_has ? has : a.max_ratio > b.max_ratio;
}

std::optional<ShearExtremes> shear_extremes(const RunHistory &run, const Scene &scene)
{
  if (std::none_of(scene.stages.begin(), scene.stages.end(), is_simple_shear))
    return std::nullopt;
  enum
  {
    at_stage,
    gamma,
    tau,
    sigma_y,
    done
  };
  std::vector<std::string> names = {"stage", "gamma_xy", "tau_xy", "sigma_y"};
  const bool repeated =
      std::any_of(scene.stages.begin(), scene.stages.end(), [](const Stage &s) { return as<Repeat>(s); });
  if (repeated)
    names.push_back("done");
  const HistoryRows history = run.of(names);
  const std::size_t which = repeated ? done : at_stage; // what changes from one stage to the next
  ShearExtremes all, now;
  for (std::size_t row = 0; row < history.n_rows(); ++row)
    {
      const Stage &s = scene.stages[static_cast<std::size_t>(history(row, at_stage))];
      if (!is_simple_shear(s) || !behaviour(s).shears())
        continue;
      if (now.sigma_v0 == 0 || history(row, which) != history(row - 1, which))
        {
          const auto *cyclic = as<UndrainedCyclicSimpleShear>(s);
          now = {0, 0, history(row, sigma_y), 0, cyclic ? cyclic->stress_ratio : 0};
        }
      all.gamma = std::max(all.gamma, std::abs(history(row, gamma)));
      all.tau = std::max(all.tau, std::abs(history(row, tau)));
      now.max_ratio = std::max(now.max_ratio, std::abs(history(row, tau)) / now.sigma_v0);
      if (all.sigma_v0 == 0 || comes_first(now, all))
        all = {all.gamma, all.tau, now.sigma_v0, now.max_ratio, now.requested_ratio};
    }
  return all;
}

/// Of a static drive, until it liquefies: increments that did not lead to a neighbouring state of balance. Relaxation
/// took more than 1 % of the stored elastic energy there, and more than three times what it took in the increment
/// before: an increment has its loss at any stress, which is a large share of the little that is stored near p' = 0.
void add_jumps(const RunHistory &run, double p0, Summary &summary)
{
  constexpr double jump = 0.01, more = 3;
  enum
  {
    stress,
    elastic,
    relaxed,
    flows
  };
  const HistoryRows rows = run.of({"p", "E_el", "relaxed", "liquefied"});
  int n = 0;
  double largest = 0, from = 0;
  for (std::size_t row = 1; row < rows.n_rows() && rows(row - 1, flows) == 0; ++row)
    {
      const double stored = rows(row - 1, elastic), lost = rows(row, relaxed);
      if (!(stored > 0 && lost > jump * stored && lost > more * rows(row - 1, relaxed)))
        continue;
      ++n;
      if (lost / stored > largest)
        largest = lost / stored, from = rows(row - 1, stress) / p0;
    }
  summary["jumps.number"] = n;
  if (n > 0)
    summary.row("jumps", "{}, at most {:.2g} % of the elastic energy lost in an increment, from p'/p0' = {:.3f}", n,
                Value{"jumps.largest", largest, percent}, Value{"jumps.p_ratio_before", from});
  else
    summary.row("jumps", "none");
}

/// Reports what the rows of a history hold.
class HistoryReport
{
public:
  HistoryReport(const RunHistory &run, const Scene &scene, const DriveState &state, Summary &summary)
      : run_(run), scene_(scene), state_(state), history_(rows_of(run, scene.output.energy)), summary_(summary)
  {
    find_shearing();
  }

  void add_start(const TestEffort &effort)
  {
    std::vector<int> constraints; // of a contact, as the laws in force followed each other
    for (std::size_t row = 0; row < history_.n_rows(); ++row)
      if (const int n = constraints_at(row); constraints.empty() || n != constraints.back())
        constraints.push_back(n);
    summary_["IR_constraints"] = constraints;
    if (history_.n_rows() > 0)
      summary_.row("redundancy index I_R", "{}", index_names(constraints));
    if (first_)
      summary_.row("p0'", "{:.2f} kPa", Value{"p0", state_.path.p0(), kPa});
    add_effort(effort);
    if (max_indicator_)
      summary_.row("largest indicator", "{:.4f} (recorded{})", Value{"max_indicator", *max_indicator_},
                   any(may_liquefy) ? " before liquefaction" : "");
    if (!first_)
      return;
    summary_["shear_stage_first_row"] = *first_;
    summary_.row("I_R at the start", "{}", index_text("IR_at_start", *first_));
  }

  /// The onset and what follows.
  void add_liquefaction()
  {
    std::size_t row = 0;
    while (row < history_.n_rows() && history_(row, liquefied) == 0)
      ++row;
    if (row < history_.n_rows())
      add_onset(row);
    else if (any(may_liquefy))
      summary_.row("liquefaction", "none");
  }

  void add_reversals()
  {
    const Value reversals{"reversals", state_.undrained.reversals};
    const std::string overshoot = reversals.value > 0 && any(turns_at_a_load)
                                      ? summary_.text(", worst overshoot {:.4f} kPa",
                                                      Value{"worst_overshoot", state_.undrained.worst_overshoot, kPa})
                                      : "";
    if (any(is_cyclic))
      summary_.row("reversals", "{}{}", reversals, overshoot);
    else
      summary_["reversals"] = reversals.value;
  }

  /// The largest stresses and strains, and the end.
  void add_extremes()
  {
    if (max_strain_)
      {
        summary_.row("largest |axial strain|", "{:.4f} %", *max_strain_ / percent);
        summary_.row("largest |q|", "{:.2f} kPa", max_q_ / kPa);
      }
    if (first_)
      add_shear_extremes();
    if (const std::size_t n = history_.n_rows(); n > 0)
      summary_.row("at the end", "p' {:.2f} kPa, I_R {}", Value{"p_end", history_(n - 1, p), kPa},
                   index_text("IR_at_end", n - 1));
    if (scene_.output.energy)
      summary_.row("energy residual", "{:.2e} of the work exchanged", Value{"energy_residual", energy_residual()});
  }

private:
  bool any(bool (*is)(const Stage &)) const { return std::ranges::any_of(scene_.stages, is); }
  const Stage &stage_of(std::size_t row) const { return scene_.stages[static_cast<std::size_t>(history_(row, stage))]; }
  int constraints_at(std::size_t row) const { return static_cast<int>(history_(row, constraints)); }

  /// "3.000 (Eq. 2: 6.000)", of the contact law in force, in which 1 is isostatic, and Eq. (2) of the paper.
  std::string index_text(const char *key, std::size_t row)
  {
    return summary_.text("{:.3f}", Value{key, history_(row, ir)}) +
           (constraints_at(row) < 6 ? fmt::format(" (Eq. 2: {:.3f})", history_(row, ir_eq2)) : "");
  }

  /// The first row of the stages that shear, and extremes of their rows.
  void find_shearing()
  {
    for (std::size_t row = 0; row < history_.n_rows(); ++row)
      {
        const Stage &of = stage_of(row);
        if (!behaviour(of).shears())
          continue;
        if (!first_)
          first_ = row;
        min_p_ = std::min(min_p_, history_(row, p));
        if (is_driven(of) && history_(row, liquefied) == 0 && history_(row, indicator) > 0)
          max_indicator_ = std::max(max_indicator_.value_or(0), history_(row, indicator));
        if (is_simple_shear(of))
          continue;
        max_strain_ = std::max(max_strain_.value_or(0), std::abs(history_(row, eps)));
        max_q_ = std::max(max_q_, std::abs(history_(row, q)));
      }
  }

  void add_effort(const TestEffort &effort)
  {
    summary_["steps_since_resumed"] = effort.last_steps;
    summary_.row("run", "{} steps{} in {:.1f} s ({:.0f} steps/s)", Value{"steps", effort.steps},
                 effort.last_steps < effort.steps ? fmt::format(", the last {}", effort.last_steps) : "",
                 Value{"seconds", effort.seconds},
                 static_cast<double>(effort.last_steps) / std::max(effort.seconds, 1e-9));
    add_rate(scene_, summary_);
  }

  void add_onset(std::size_t onset)
  {
    const Stage &of = stage_of(onset);
    const double limit = as<LiquefiableShear>(of)->liquefaction_ratio, p0 = state_.path.p0();
    const auto n = state_.undrained.reversals_to_liquefaction();
    const std::size_t before = onset > 0 ? onset - 1 : onset;
    summary_["liquefaction"] = {{"row", onset}, {"ratio", limit}, {"cycle", static_cast<double>(n) / 2}};
    if (is_cyclic(of))
      summary_.row("cycles to liquefaction", "{:.1f} ({} reversals)", static_cast<double>(n) / 2, n);
    summary_.row(is_simple_shear(of) ? "|gamma| before it" : "strain before it", "{:.4f} %",
                 Value{"liquefaction.strain_before", state_.undrained.max_strain_before, percent});
    summary_.row("I_R in the row before", "{} at p'/p0' = {:.3f}", index_text("liquefaction.IR_before", before),
                 Value{"liquefaction.p_ratio_before", history_(before, p) / p0});
    summary_.row("I_R at onset", "{}", index_text("liquefaction.IR_at_onset", onset));
    add_recovery(onset, limit * p0);
  }

  /// From the onset on the smallest I_R, and its mean in the last row of each half cycle in which p' comes back above
  /// the limit.
  void add_recovery(std::size_t onset, double limit)
  {
    double least = history_(onset, ir), sum = 0, last = 0, half_cycle = history_(onset, reversals);
    int n = 0;
    const auto count = [&] {
      sum += last;
      n += last > 0;
      last = 0;
    };
    for (std::size_t row = onset + 1; row < history_.n_rows(); ++row)
      {
        if (history_(row, reversals) != half_cycle)
          count();
        half_cycle = history_(row, reversals);
        least = std::min(least, history_(row, ir));
        if (history_(row - 1, p) < limit && history_(row, p) >= limit)
          last = history_(row, ir);
      }
    count();
    summary_.row("smallest I_R after", "{:.3f}", Value{"liquefaction.IR_min", least});
    summary_["liquefaction.IR_recovered"] = nullptr;
    summary_.row("I_R as p'/p0 recovers", "{}",
                 n > 0 ? summary_.text("{:.3f} (mean of {})", Value{"liquefaction.IR_recovered", sum / n}, n)
                       : "it does not recover");
  }

  void add_shear_extremes()
  {
    const std::optional<ShearExtremes> shear = shear_extremes(run_, scene_);
    if (shear)
      {
        summary_.row("largest |gamma|", "{:.4f} %", Value{"gamma_max", shear->gamma, percent});
        summary_.row("largest |tau|", "{:.2f} kPa", Value{"tau_max", shear->tau, kPa});
      }
    summary_.row("lowest p'", "{:.3f} kPa", min_p_ / kPa);
    if (!shear)
      return;
    const std::string ratio =
        summary_.text("|tau| reached {:.4f} sigma'_v0, sigma'_v0 {:.2f} kPa",
                      Value{"stress_ratio_max", shear->max_ratio}, Value{"sigma_v0", shear->sigma_v0, kPa});
    summary_["CSR"] = nullptr;
    if (shear->requested_ratio > 0)
      summary_.row("CSR", "{:g} ({})", Value{"CSR", shear->requested_ratio}, ratio);
    else
      summary_.row("stress ratio", "{}", ratio);
  }

  double energy_residual() const
  {
    double done = 0, worst = 0;
    for (std::size_t row = 1; row < history_.n_rows(); ++row)
      {
        done += std::abs(history_(row, work) - history_(row - 1, work));
        worst = std::max(worst, std::abs(history_(row, residual)));
      }
    return done > 0 ? worst / done : 0;
  }

  const RunHistory &run_;
  const Scene &scene_;
  const DriveState &state_;
  const HistoryRows history_;
  Summary &summary_;
  std::optional<std::size_t> first_; ///< none: no stage shears
  double min_p_ = std::numeric_limits<double>::infinity(), max_q_ = 0;
  std::optional<double> max_strain_;    ///< of the axis, in triaxial stages
  std::optional<double> max_indicator_; ///< before liquefaction; none: no row of a driven stage has it
};
} // namespace

Summary summarise(const RunHistory &run, const Scene &scene, const std::map<std::string, double> &specimen,
                  const DriveState &state, const TestEffort &effort)
{
  Summary summary(scene.title, "Element test",
                  "relative_density e_min e_max preparation_friction_deg p0 strain_rate "
                  "inertial_number max_indicator shear_stage_first_row IR_at_start p_end IR_at_end "
                  "worst_overshoot energy_residual liquefaction");
  add_specimen(specimen, scene, summary);
  HistoryReport history(run, scene, state, summary);
  history.add_start(effort);
  history.add_liquefaction();
  if (scene.drive.on)
    add_jumps(run, state.path.p0(), summary);
  history.add_reversals();
  add_response(state, scene, summary);
  history.add_extremes();
  add_drained(run, scene, summary);
  add_stages(state, scene, summary);
  return summary;
}
} // namespace isostat
