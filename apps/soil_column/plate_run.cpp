// SPDX-License-Identifier: BSD-3-Clause
// A rigid plate on a part of the boundary of a box moves slowly: footing, trapdoor, wall.
#include "apps/soil_column/plate_forces.hpp"
#include "apps/soil_column/statics_run.hpp"

namespace isostat
{
namespace
{
StaticsSettings settings_of(const ColumnScene &scene)
{
  const Plate &plate = scene.plate;
  const double way = plate.inwards() * plate.displacement;
  StaticsSettings settings;
  settings.displacements = {{{patch_face(0), plate.axis()}, [way](double t, const Place &) { return way * t; }}};
  settings.petsc = scene.analysis.petsc;
  settings.newton = scene.load_steps.newton;
  settings.min_force = 1e-3 * largest_weight(scene); // before the plate has a force of its own
  return settings;
}

const std::vector<RecordColumn> columns = {
    {"step"},           {"displacement", "m"}, {"force", "N/m"}, {"shear_force", "N/m"},
    {"pressure", "Pa"}, {"iterations"},        {"trials"},       {"substeps"},
    {"rejected"},       {"residual"}};

class PlateRun : public StaticsRun
{
public:
  explicit PlateRun(const ColumnRequest &request)
      : StaticsRun(request, settings_of(request.scene)), forces_(scene_, space_, run_.stresses())
  {
    if (!resumed_)
      return;
    resumed_->get(result_);
    const std::vector<double> &start = resumed_->vector("plate_in_situ", 3);
    forces_.set_start({start[0], start[1], start[2]});
  }

private:
  void start() override
  {
    progress_.say(fmt::format("{} points, {} steps{}", space_.n_points(), scene_.load_steps.number,
                              resumed_ ? fmt::format(", from step {} on", run_.n_steps()) : ""));
    if (!resumed_)
      record_plate();
  }

  void open_files() override
  {
    StaticsRun::open_files();
    rows_ = std::make_unique<Recorder>(request_.folder / "plate", columns,
                                       static_cast<std::size_t>(resumed_ ? run_.n_steps() + 1 : 0));
  }
  void flush_files() override
  {
    StaticsRun::flush_files();
    if (rows_)
      rows_->flush();
  }

  void step() override
  {
    try
      {
        solve([&] { run_.step((static_cast<double>(run_.n_steps()) + 1) / scene_.load_steps.number - run_.time()); });
      }
    catch (const RunFailure &failure)
      {
        throw RunFailure(fmt::format("{}\n  force on the plate: at most {:.6g} kN/m, at {:+.4g} m; {:.6g} kN/m last",
                                     failure.what(), result_.largest / 1e3, result_.largest_at, result_.last / 1e3));
      }
    record_plate();
  }

  void record_plate()
  {
    record();
    const auto [force, shear] = forces_.forces(run_);
    const double pressure = forces_.pressure(run_.stresses()), moved = run_.time() * scene_.plate.displacement;
    const StaticsEffort &effort = run_.effort();
    if (rows_)
      rows_->append(std::vector<double>{static_cast<double>(run_.n_steps()), moved, force, shear, pressure,
                                        1.0 * effort.iterations, 1.0 * effort.trials, 1.0 * effort.substeps,
                                        1.0 * effort.rejected, run_.residual()});
    result_.follow(moved, force, run_.residual());
    progress_.say(
        fmt::format("step {:>4} of {}  displacement {:+.5g} m  force {:.5g} kN/m  pressure {:.5g} kPa  {} trials, "
                    "{} sub-steps, residuals {}",
                    run_.n_steps(), scene_.load_steps.number, moved, force / 1e3, pressure / 1e3, effort.trials,
                    effort.substeps, effort.convergence()));
  }

  std::string key_state() override
  {
    return fmt::format("displacement {:+.4g} m  force {:.4g} kN/m", run_.time() * scene_.plate.displacement,
                       result_.last / 1e3);
  }
  bool is_done() const override { return run_.n_steps() >= scene_.load_steps.number; }
  double n_total() const override { return scene_.load_steps.number; }
  void add_to(ColumnCheckpoint &checkpoint) override
  {
    StaticsRun::add_to(checkpoint);
    if (rows_)
      rows_->flush();
    checkpoint.put(result_);
    checkpoint.vectors["plate_in_situ"] = {forces_.start().begin(), forces_.start().end()};
  }
  void add_results(ColumnSummary &summary) override
  {
    result_.length = forces_.length();
    summary.plate = result_;
  }

  PlateForces forces_;
  PlateResult result_;
  std::unique_ptr<Recorder> rows_;
};
} // namespace

RunResult run_plate(const ColumnRequest &request) { return PlateRun(request).go(); }
} // namespace isostat
