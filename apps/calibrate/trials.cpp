// SPDX-License-Identifier: BSD-3-Clause
#include "apps/calibrate/trials.hpp"

#include "apps/calibrate/laboratory.hpp"
#include "apps/common/element_test_runs.hpp"
#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/hash.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/progress.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
constexpr double quiet_seconds = 60; ///< then a line says what is at work
constexpr int by_the_system = 126;   ///< exit codes from here on: stopped, killed or crashed

fs::path with_ending(const fs::path &place, const char *ending) { return place.string() + ending; }

std::string id_of(const std::vector<Parameter> &parameters, const std::vector<double> &values)
{
  Hash hash;
  for (std::size_t k = 0; k < values.size(); ++k)
    hash.text(parameters[k].curve() + " " + parameters[k].override_(values[k]) + "\n");
  return fmt::format("{:016x}", hash.value());
}
} // namespace

Trials::Trials(const CalibrationPlan &plan, const SceneMaker &scenes, fs::path folder, RunPool pool,
               std::function<void(const std::string &)> say)
    : plan_(plan), scenes_(scenes), folder_(std::move(folder)), pool_(pool), say_(std::move(say))
{
  for (const PlanCurve &curve : plan_.curves)
    laboratory_.push_back(read_laboratory(curve, scenes_.pressure(curve)));
}

bool Trials::is_complete(const Trial &trial) const
{
  for (std::size_t c = 0; c < trial.curves.size(); ++c)
    if (!plan_.curves[c].blind && trial.curves[c] && !trial.curves[c]->failure.empty())
      return false;
  return true;
}

std::size_t Trials::best() const
{
  const auto rank = [this](const Trial &trial) { return std::pair(!is_complete(trial), trial.misfit); };
  std::size_t best = trials_.size();
  for (std::size_t t = 0; t < trials_.size(); ++t)
    if (trials_[t].done && (best == trials_.size() || rank(trials_[t]) < rank(trials_[best])))
      best = t;
  return best;
}

bool Trials::is_known(const Point &values) const
{
  const std::string id = id_of(scenes_.parameters(), values);
  return std::any_of(trials_.begin(), trials_.end(), [&](const Trial &t) { return t.id == id; });
}

std::vector<std::size_t> Trials::evaluate(const std::vector<Point> &points)
{
  std::vector<std::size_t> numbers, fresh;
  for (const Point &values : points)
    {
      const std::string id = id_of(scenes_.parameters(), values);
      const auto known = std::find_if(trials_.begin(), trials_.end(), [&](const Trial &t) { return t.id == id; });
      numbers.push_back(static_cast<std::size_t>(known - trials_.begin()));
      if (known != trials_.end())
        continue;
      fresh.push_back(numbers.back());
      trials_.push_back({id, values, std::vector<std::optional<CurveOutcome>>(plan_.curves.size())});
    }
  execute(fresh, false);
  return numbers;
}

void Trials::evaluate_blind(const std::set<std::size_t> &trials)
{
  execute(std::vector<std::size_t>(trials.begin(), trials.end()), true);
}

fs::path Trials::place(const Run &run) const
{
  return folder_ / "runs" / trials_[run.trial].id / fmt::format("{}_seed{}", plan_.curves[run.curve].name, run.seed);
}

std::vector<Trials::Run> Trials::runs_of(std::size_t trial, bool blind) const
{
  std::vector<Run> runs;
  for (std::size_t curve = 0; curve < plan_.curves.size(); ++curve)
    for (std::uint64_t k = 0; k < plan_.specimens.seeds && plan_.curves[curve].blind == blind; ++k)
      runs.push_back({trial, curve, plan_.specimens.first_seed + k});
  return runs;
}

/// Writes the scene of a run. What it cannot be made from is a failure of the run.
bool Trials::needs_run(const Run &run) const
{
  const fs::path at = place(run);
  if (fs::exists(with_ending(at, ".failed")))
    return false;
  make_folder(at.parent_path());
  try
    {
      const Scene scene = scenes_.trial(trials_[run.trial].values, plan_.curves[run.curve], run.seed);
      if (is_finished_run(at, scene))
        return false;
      write_replacing(with_ending(at, ".toml"), to_toml(scene));
      return true;
    }
  catch (const InputError &error)
    {
      write_replacing(with_ending(at, ".failed"), error.what());
      return false;
    }
}

void Trials::take(const Run &run, int code)
{
  const fs::path at = place(run), log = with_ending(at, ".log");
  ++n_runs_;
  if (code != 0 && code < by_the_system)
    write_replacing(with_ending(at, ".failed"), last_line(log));
}

/// All runs of some trials that are not there, side by side.
void Trials::execute(const std::vector<std::size_t> &trials, bool blind)
{
  std::vector<Run> todo;
  std::map<std::size_t, std::size_t> left;
  for (const std::size_t trial : trials)
    {
      for (const Run &run : runs_of(trial, blind))
        if (needs_run(run))
          {
            todo.push_back(run);
            ++left[trial];
          }
      if (left[trial] == 0)
        conclude(trial, blind);
    }
  std::vector<ChildRun> children;
  for (const Run &run : todo)
    children.push_back(element_test_run(with_ending(place(run), ".toml"), place(run), with_ending(place(run), ".log")));
  std::string ended;
  const ChildEvents events = {
      [&](std::size_t k, int code, double) {
        if (code >= by_the_system)
          {
            ended =
                fmt::format("{}: ended with code {}: {}", place(todo[k]).string(), code, last_line(children[k].log));
            return;
          }
        take(todo[k], code);
        if (--left[todo[k].trial] == 0)
          {
            ++n_computed_;
            conclude(todo[k].trial, blind);
          }
      },
      [&](const std::vector<std::size_t> &running) {
        if (since_line_.seconds() > quiet_seconds && !running.empty())
          say(fmt::format("       {} runs at work, the first in {}: {}", running.size(),
                          place(todo[running[0]]).string(), last_line(children[running[0]].log)));
      }};
  if (!run_children(pool_, children, events))
    throw Interrupted("interrupted; what has been run is kept, the same command goes on");
  if (!ended.empty())
    throw RunFailure(ended + "\n  It was stopped from outside or crashed. What has been run is kept, the same command "
                             "tries it again.");
}

CurveOutcome Trials::outcome(std::size_t trial, std::size_t curve) const
{
  for (const Run &run : runs_of(trial, plan_.curves[curve].blind))
    if (const fs::path failed = with_ending(place(run), ".failed"); run.curve == curve && fs::exists(failed))
      return {plan_.misfit.penalty, {}, fmt::format("seed {}: {}", run.seed, read_text(failed))};
  try
    {
      const Comparison result = comparison(trial, curve);
      return {result.misfit, result.scatter, ""};
    }
  catch (const InputError &error)
    {
      return {plan_.misfit.penalty, {}, error.what()};
    }
}

Comparison Trials::comparison(std::size_t trial, std::size_t curve) const
{
  std::vector<Curve> models;
  for (const Run &run : runs_of(trial, plan_.curves[curve].blind))
    if (run.curve == curve)
      models.push_back(read_model(place(run), plan_.curves[curve]));
  return compare(laboratory_[curve], models, plan_.curves[curve], plan_.misfit);
}

void Trials::conclude(std::size_t number, bool blind)
{
  Trial &trial = trials_[number];
  std::vector<double> misfits(plan_.curves.size());
  for (std::size_t curve = 0; curve < plan_.curves.size(); ++curve)
    {
      if (plan_.curves[curve].blind == blind)
        trial.curves[curve] = outcome(number, curve);
      misfits[curve] = trial.curves[curve] ? trial.curves[curve]->misfit : 0;
    }
  if (blind)
    return;
  trial.misfit = total_misfit(misfits, plan_.curves);
  trial.done = true;
  write_replacing(folder_ / "trials.csv", to_csv(*this, plan_, scenes_.parameters()));
  say(progress(number));
}

void Trials::say(const std::string &line)
{
  say_(line);
  since_line_.restart();
}

/// " 12 %  trial 7 of at most 60: misfit 0.132, best 0.098 in trial 4, ETA 20 min"
std::string Trials::progress(std::size_t number) const
{
  const auto done = static_cast<double>(std::count_if(trials_.begin(), trials_.end(), [](auto &t) { return t.done; }));
  const auto most = static_cast<double>(plan_.budget.trials);
  std::string text =
      fmt::format("{:3.0f} %  trial {} of at most {}: misfit {:.4f}{}, best {:.4f} in trial {}", 100 * done / most,
                  number + 1, plan_.budget.trials, trials_[number].misfit,
                  is_complete(trials_[number]) ? "" : " (a run FAILED)", trials_[best()].misfit, best() + 1);
  if (n_computed_ > 0 && done < most)
    text += ", ETA " + duration_text((most - done) * seconds() / static_cast<double>(n_computed_)) + " at most";
  return text;
}

std::string to_csv(const Trials &trials, const CalibrationPlan &plan, const std::vector<Parameter> &parameters)
{
  std::string text = "trial (-)";
  for (const Parameter &parameter : parameters)
    text += "," + parameter.label();
  text += ",misfit (-)";
  for (const PlanCurve &curve : plan.curves)
    if (!curve.blind)
      text += fmt::format(",misfit of {} (-)", curve.name);
  text += ",failed curves,folder\n";
  for (std::size_t t = 0; t < trials.all().size(); ++t)
    {
      const Trial &trial = trials.all()[t];
      if (!trial.done)
        continue;
      text += fmt::format("{}", t + 1);
      for (std::size_t k = 0; k < parameters.size(); ++k)
        text += "," + parameters[k].number(trial.values[k]);
      text += fmt::format(",{:.6f}", trial.misfit);
      std::string failed;
      for (std::size_t c = 0; c < plan.curves.size(); ++c)
        if (!plan.curves[c].blind)
          {
            text += fmt::format(",{:.6f}", trial.curves[c]->misfit);
            failed += trial.curves[c]->failure.empty() ? "" : (failed.empty() ? "" : " ") + plan.curves[c].name;
          }
      text += fmt::format(",{},runs/{}\n", failed, trial.id);
    }
  return text;
}
} // namespace isostat
