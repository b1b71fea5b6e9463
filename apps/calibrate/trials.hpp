// SPDX-License-Identifier: BSD-3-Clause
// The trials of a calibration and their runs.   tested: tests/apps/calibrate_test.py
#pragma once
#include "apps/calibrate/curve.hpp"
#include "apps/calibrate/trial_scene.hpp"
#include "apps/common/child_runs.hpp"
#include "base/stopwatch.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace isostat
{
/// What came of the runs of one curve in one trial.
struct CurveOutcome
{
  double misfit = 0;             ///< Comparison; the penalty of a curve that failed [-]
  std::optional<double> scatter; ///< Comparison [-]
  std::string failure;           ///< why one of its runs failed; empty: none did
};

struct Trial
{
  std::string id;                                  ///< its folder, from the values
  std::vector<double> values;                      ///< of the parameters, on the scale of Parameter
  std::vector<std::optional<CurveOutcome>> curves; ///< of the plan; nothing: not computed (blind)
  double misfit = 0;                               ///< total_misfit of the fitted curves [-]
  bool done = false;
};

/// Runs trials in child processes, and answers those that have been run from what they left. A run that has finished,
/// or failed by itself, is never run again; one that was killed goes on from its checkpoint.
class Trials
{
public:
  using Point = std::vector<double>;

  /// @param pool  led by this process before the first run
  /// @param say  takes a line of progress
  Trials(const CalibrationPlan &plan, const SceneMaker &scenes, std::filesystem::path folder, RunPool pool,
         std::function<void(const std::string &)> say);

  const std::vector<Trial> &all() const { return trials_; }
  /// Smallest misfit, the first of equals; of trials all of whose fitted curves ran, if there are any.
  /// @pre one trial or more is done    tested: tests/apps/calibrate_test.py
  std::size_t best() const;
  bool is_complete(const Trial &trial) const; ///< whether no run of a fitted curve failed
  bool is_known(const Point &values) const;

  /// Runs the fitted curves of points, all runs side by side.   @return the numbers of their trials
  /// @throws Interrupted, RunFailure (a child crashed or was killed)
  std::vector<std::size_t> evaluate(const std::vector<Point> &points);
  /// Runs the blind curves of trials.   @throws as evaluate()
  void evaluate_blind(const std::set<std::size_t> &trials);

  /// The curves behind an outcome.   @pre it did not fail
  Comparison comparison(std::size_t trial, std::size_t curve) const;
  std::size_t n_runs() const { return n_runs_; } ///< of this call
  double seconds() const { return watch_.seconds(); }

private:
  struct Run
  {
    std::size_t trial, curve;
    std::uint64_t seed;
  };
  std::filesystem::path place(const Run &run) const;
  std::vector<Run> runs_of(std::size_t trial, bool blind) const;
  bool needs_run(const Run &run) const;
  void run(const std::vector<Run> &runs);
  void take(const Run &run, int code);
  void conclude(std::size_t trial, bool blind);
  CurveOutcome outcome(std::size_t trial, std::size_t curve) const;
  void execute(const std::vector<std::size_t> &trials, bool blind);
  std::string progress(std::size_t trial) const;
  void say(const std::string &line);

  CalibrationPlan plan_;
  const SceneMaker &scenes_;
  std::filesystem::path folder_;
  RunPool pool_;
  std::function<void(const std::string &)> say_;
  std::vector<Curve> laboratory_;
  std::vector<Trial> trials_;
  std::size_t n_runs_ = 0, n_computed_ = 0; ///< runs and trials of this call
  Stopwatch watch_, since_line_;
};

/// trials.csv: number, values in the units of the keys, misfits, folder.
std::string to_csv(const Trials &trials, const CalibrationPlan &plan, const std::vector<Parameter> &parameters);
} // namespace isostat
