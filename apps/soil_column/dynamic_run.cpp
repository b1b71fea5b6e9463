// SPDX-License-Identifier: BSD-3-Clause
// Shaking of a column.
#include "apps/deposit/grain_files.hpp"
#include "apps/soil_column/column_run.hpp"
#include "apps/soil_column/surface_motion.hpp"
#include "base/tell.hpp"

#include <cmath>

namespace isostat
{
namespace
{
DynamicsSettings settings_of(const ColumnRequest &request, const std::array<Motion, 3> &motions)
{
  const ColumnScene &scene = request.scene;
  DynamicsSettings settings;
  if (scene.analysis.scheme == TimeScheme::implicit)
    settings.spectral_radius = scene.analysis.spectral_radius;
  settings.time_step = scene.analysis.time_step.value_or(0);
  if (!scene.has_grains()) // of which up to half as many steps again would be expensive
    settings.multiple = scene.output.history_interval;
  settings.safety = scene.analysis.safety;
  settings.mass_damping = scene.analysis.mass_damping;
  settings.viscosity = scene.analysis.viscosity.value_or(0);
  settings.viscous_above = scene.analysis.highest_frequency;
  settings.large_strain = scene.analysis.large_strain;
  settings.drainage = scene.water.drainage;
  settings.lagged_compressibility = scene.water.lagged_compressibility;
  settings.base = scene.base;
  settings.petsc = scene.analysis.petsc;
  settings.motion = motions;
  if (scene.load.kind != LoadKind::none)
    settings.surface_traction = [load = scene.load](double t) { return load.traction(t); };
  settings.free_fields = free_fields(scene, settings, request.threads, request.materials);
  return settings;
}

class DynamicRun : public ColumnRun<Dynamics>
{
public:
  DynamicRun(const ColumnRequest &request, const std::array<Motion, 3> &motions)
      : ColumnRun<Dynamics>(request, motions, settings_of(request, motions)),
        motion_(scene_, space_, motions_, run_.time_step())
  {
    if (n_total() > many_steps)
      warnings_.push_back(too_many_steps());
    if (const double periods = run_.time_step() * scene_.analysis.highest_frequency; is_implicit() && periods > 0.1)
      warnings_.push_back(
          fmt::format("implicit steps of {:.3g} s: there are {:.2g} in a period of analysis.highest_frequency, {:.3g} "
                      "Hz, and 10 to 20 "
                      "are needed to follow it. Give a smaller time_step, or a lower frequency of interest.",
                      run_.time_step(), 1 / periods, scene_.analysis.highest_frequency));
    if (resumed_)
      motion_.restore(*resumed_);
  }

private:
  static constexpr double many_steps = 1e7; ///< of a column of formulas: some minutes

  /// By the lowest elements, which the stable step mostly follows from.
  std::string too_many_steps() const
  {
    const auto height = [](const ColumnLayer &layer) { return layer.thickness / layer.n_cells(); };
    const auto lowest = std::ranges::min_element(scene_.layers, {}, height);
    return fmt::format("the run has {:.3g} time steps of {:.3g} s, the stable one being {:.3g} s; the lowest elements, "
                       "of layer.{}, are {:.3g} m high. Give them more height, the run a shorter duration or "
                       "analysis.scheme = \"implicit\", or expect hours; lines of progress say how many.",
                       n_total(), run_.time_step(), run_.stable_step(), lowest - scene_.layers.begin(),
                       height(*lowest));
  }

  void start() override
  {
    if (soil_.grains && !scene_.mesh.distributed)
      {
        grain_files_ = std::make_unique<GrainFiles>(request_.folder, scene_, soil_, space_, resumed_.get());
        grain_files_->open(resumed_.get());
      }
    if (soil_.grains)
      {
        for (std::size_t place : soil_.grains_places)
          range_ = {std::min(range_[0], velocities_[place]), std::max(range_[1], velocities_[place])};
        unsigned long n_packings = soil_.grains->owners().size();
        if (space_.shared_out())
          {
            const MPI_Comm all = space_.communicator();
            MPI_Allreduce(MPI_IN_PLACE, &n_packings, 1, MPI_UNSIGNED_LONG, MPI_SUM, all);
            MPI_Allreduce(MPI_IN_PLACE, &range_[0], 1, MPI_DOUBLE, MPI_MIN, all);
            MPI_Allreduce(MPI_IN_PLACE, &range_[1], 1, MPI_DOUBLE, MPI_MAX, all);
          }
        if (ranks().first())
          progress_.say(fmt::format("{} packings, V_s {:.0f} to {:.0f} m/s", n_packings, range_[0], range_[1]));
      }
    progress_.say(fmt::format(
        "{} time step {:.5g} ms, {} {:.5g} ms; {} steps{}", scheme_names[static_cast<int>(scene_.analysis.scheme)],
        1e3 * run_.time_step(), is_implicit() ? "explicit ones would be stable up to" : "stable up to",
        1e3 * run_.stable_step(), last_step_ + 1, resumed_ ? fmt::format(", from step {} on", run_.n_steps()) : ""));
  }

  /// Every n whole steps.
  bool due(const std::optional<double> &interval) const
  {
    return interval && run_.n_steps() % steps_in(*interval) == 0;
  }

  /// One step, and what is written of the instant it starts from.
  void step() override
  {
    const bool row = due(scene_.output.history_interval), profile = due(scene_.output.profile_interval),
               paraview = due(scene_.output.paraview_interval);
    if (grain_files_)
      look_at_grains(row, profile);
    solve([&] {
      if (row || profile || paraview)
        observe_step(run_, space_, instant_);
      else
        run_.step();
    });
    follower_.follow(run_);
    files_.history().follow(run_);
    motion_.follow(run_);
    if (grain_files_)
      grain_files_->follow(run_.n_steps(), run_.time());
    if (row || profile || paraview || files_.history().has_complete())
      write([&] {
        if (row)
          files_.record(instant_);
        if (profile)
          files_.profile(instant_, grain_files_ ? std::span(grain_files_->redundancy()) : std::span<const double>());
        if (paraview)
          files_.paraview(instant_);
        files_.write_rows();
      });
  }

  /// Grains as they are before the step.
  void look_at_grains(bool row, bool profile)
  {
    if (row)
      grain_files_->record(run_.n_steps(), run_.time());
    if (profile)
      grain_files_->profile(run_.n_steps(), run_.time());
    if (due(scene_.grain_output.snapshot_interval))
      grain_files_->snapshots(run_.time());
  }

  bool is_done() const override { return run_.n_steps() > last_step_; }
  double n_total() const override { return static_cast<double>(last_step_ + 1); }
  std::string place_of(std::uint64_t step) const override
  {
    return fmt::format("step {} (t = {:.6g} s): ", step, static_cast<double>(step) * run_.time_step());
  }

  bool has_long_steps() const override { return soil_.grains || is_implicit(); }
  bool is_implicit() const { return scene_.analysis.scheme == TimeScheme::implicit; }

  void add_to(ColumnCheckpoint &checkpoint) override
  {
    ColumnRun<Dynamics>::add_to(checkpoint);
    motion_.save(checkpoint);
    if (!grain_files_)
      return;
    grain_files_->flush();
    checkpoint.numbers.merge(grain_files_->counters());
  }

  void finish_files() override { motion_.write_spectra(request_.folder / "spectra.csv"); }

  /// Velocities of the soil of grains at its start, and the smallest redundancy index.
  void add_results(ColumnSummary &summary) override
  {
    summary.time_step = run_.time_step();
    summary.bands = motion_.bands();
    const ColumnLine *line = files_.line();
    summary.waves = carried_waves(scene_, velocities_,
                                  line ? softened_velocities(scene_, velocities_, space_, *line, follower_.peaks)
                                       : std::vector<double>(),
                                  space_);
    if (std::string coarse = softened_elements(scene_, summary.waves, motions_); !coarse.empty())
      summary.warnings.push_back(std::move(coarse));
    if (!grain_files_)
      return;
    const auto n_packings = soil_.grains->owners().size();
    const auto &[redundancy, depth, time, constraints] = grain_files_->minimum();
    summary.grains = {n_packings, range_[0], range_[1], scene_.output.profile_interval.has_value(),
                      redundancy, depth,     time,      constraints,
                      soil_.seeds};
  }

  std::uint64_t last_step() const
  {
    const double n = std::floor(scene_.analysis.duration / run_.time_step() * (1 + 1e-12));
    if (!(n <= most_steps))
      throw InputError(
          fmt::format("analysis.duration = {:g} s: must be at most {:g} s, because the time step is {:g} s and more "
                      "than {:g} of them cannot be counted.",
                      scene_.analysis.duration, most_steps * run_.time_step(), run_.time_step(), most_steps));
    return static_cast<std::uint64_t>(n);
  }

  const std::uint64_t last_step_ = last_step(); ///< the last one whose start is recorded
  SurfaceMotion motion_;
  std::unique_ptr<GrainFiles> grain_files_;  ///< null without grains
  std::array<double, 2> range_ = {1e300, 0}; ///< of velocities_ where the soil is of grains, of all ranks
};
} // namespace

RunResult run_dynamic(const ColumnRequest &request) { return DynamicRun(request, column_motions(request.scene)).go(); }
} // namespace isostat
