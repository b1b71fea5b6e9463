// SPDX-License-Identifier: BSD-3-Clause
// Consolidation of a column: the load comes in an instant, then the water leaves.
#include "apps/soil_column/statics_run.hpp"

#include <limits>

namespace isostat
{
namespace
{
/// @param petsc  options of the linear system
StaticsSettings settings_of(const ColumnLoad &load, bool pore_water, const std::string &petsc)
{
  StaticsSettings settings;
  settings.pore_water = pore_water;
  settings.petsc = petsc;
  settings.tractions = {{Face::surface, [load](double t, const Place &) { return load.traction(t); }}};
  return settings;
}

/// Of the surface, when all water has left; not-a-number if the soil cannot bear the load.
double final_settlement(const ColumnRequest &request, const FiniteElementSpace &space)
{
  const ColumnScene &scene = request.scene;
  const SoilMaterial soil = soil_material(scene, space, 1, request.materials);
  const bool splits = scene.analysis.petsc.find("fieldsplit") != std::string::npos; // a mesh too large for LU
  Statics drained(space, *soil.material,
                  interruptible(settings_of(scene.load, false, splits ? "-statics_pc_type gamg" : "")));
  double settlement = std::numeric_limits<double>::quiet_NaN();
  try
    {
      drained.step(scene.analysis.last_time); // all of the load is on by then
    }
  catch (const RunFailure &)
    {
      return settlement;
    }
  const long dof = space.find_dof(space.mesh().on_line(0), 2);
  settlement = dof < 0 ? 0 : 0 - drained.displacement().local_element(static_cast<unsigned>(dof));
  space.sum_over_ranks({&settlement, 1});
  return settlement;
}

class ConsolidationRun : public StaticsRun
{
public:
  explicit ConsolidationRun(const ColumnRequest &request)
      : StaticsRun(request, settings_of(request.scene.load, true, request.scene.analysis.petsc))
  {
    if (resumed_)
      immediate_settlement_ = resumed_->number("immediate_settlement");
  }

private:
  void start() override
  {
    progress_.say(fmt::format("{} steps from {:.5g} s to {:.5g} s{}", ends_.size(), ends_.front(), ends_.back(),
                              resumed_ ? fmt::format(", from {:.5g} s on", run_.time()) : ""));
    if (!resumed_ && !at_once_) // the step of a load at once has its own row
      record();
  }

  void step() override
  {
    const bool load_comes = at_once_ && run_.n_steps() == 0;
    solve([&] {
      if (load_comes)
        run_.step_undrained();
      else
        run_.step(ends_[n_done()] - run_.time());
    });
    record();
    if (load_comes)
      immediate_settlement_ = files_.history().state.settlement;
  }

  /// Steps of the time table that are done; a load that comes at once takes its own step.
  std::size_t n_done() const { return static_cast<std::size_t>(run_.n_steps()) - (at_once_ ? 1 : 0); }
  bool is_done() const override { return run_.n_steps() > 0 && n_done() >= ends_.size(); }
  double n_total() const override { return static_cast<double>(ends_.size()) + 1; }
  void add_to(ColumnCheckpoint &checkpoint) override
  {
    StaticsRun::add_to(checkpoint);
    checkpoint.numbers["immediate_settlement"] = immediate_settlement_;
  }

  void add_results(ColumnSummary &summary) override
  {
    summary.final_settlement = final_settlement(request_, space_);
    summary.degree =
        (summary.last.settlement - immediate_settlement_) / (summary.final_settlement - immediate_settlement_);
  }

  const std::vector<double> ends_ = scene_.analysis.times();
  const bool at_once_ = scene_.load.ramp == 0;
  double immediate_settlement_ = 0; ///< without any flow, m
};
} // namespace

RunResult run_consolidation(const ColumnRequest &request) { return ConsolidationRun(request).go(); }
} // namespace isostat
