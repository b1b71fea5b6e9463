// SPDX-License-Identifier: BSD-3-Clause
#include "apps/biaxial/run.hpp"

#include "apps/biaxial/files.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/deposit/checkpoint.hpp"
#include "apps/deposit/instant.hpp"
#include "base/error.hpp"
#include "base/record/progress.hpp"
#include "base/record/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <numeric>

namespace isostat
{
namespace
{
/// Time is the share of the way where no water moves, else s.
double end_of(const BiaxialScene &scene) { return scene.water.undrained() ? scene.test.duration : 1; }

StaticsSettings settings_of(const BiaxialScene &scene)
{
  StaticsSettings settings;
  const double way = scene.test.axial_strain * scene.mesh.height;
  const double end = end_of(scene);
  settings.pore_water = scene.water.undrained();
  settings.displacements = {{{Face::surface, 2}, [=](double t, const Place &) { return -way * t / end; }}};
  settings.newton = scene.newton;
  settings.min_force = scene.test.confinement * scene.mesh.width;
  settings.gives_up = stop_requested;
  return settings;
}

const char *method_of(const NewtonSettings &newton)
{
  if (newton.max_iterations == 0)
    return "relaxation";
  return newton.relaxation_iterations == 0 ? "Newton's method" : "Newton's method and relaxation";
}

constexpr double small = 0.1; ///< strain and rotation [-] up to which geometry of second order is a matter of per cent

std::vector<RecordColumn> columns(const BiaxialScene &scene)
{
  std::vector<RecordColumn> columns = {
      {"step"},       {"axial_strain"},   {"axial_stress", "Pa"}, {"lateral_strain"}, {"volumetric_strain"},
      {"iterations"}, {"trials"},         {"substeps"},           {"rejected"},       {"residual"},
      {"shear_mean"}, {"shear_quantile"}, {"shear_max"}};
  if (scene.water.undrained())
    columns.push_back({"pore_pressure", "Pa"});
  return columns;
}

std::string beyond_small(const BiaxialSummary &s)
{
  return fmt::format("from an axial strain of {:.3g} % on strains or rotations of the mesh are beyond {:g} %, but its "
                     "geometry takes them as small",
                     100 * *s.large_from, 100 * small);
}

/// Null where a run starts again.   @throws InputError  none that can be read, or of another scene
std::unique_ptr<ColumnCheckpoint> checkpoint_of(const BiaxialRequest &request)
{
  if (request.use != FolderUse::resume)
    return nullptr;
  auto checkpoint = std::make_unique<ColumnCheckpoint>(read_column_checkpoint(request.folder / "checkpoint"));
  check_same_scene(request.folder, checkpoint->scene, to_toml(request.scene));
  note_instruction_set(checkpoint->instruction_set);
  return checkpoint;
}

/// One run from its start to its end.
class BiaxialRun
{
public:
  explicit BiaxialRun(const BiaxialRequest &request)
      : request_(request), scene_(request.scene), resumed_(checkpoint_of(request)), space_(scene_),
        material_(block_material(scene_, space_, request.threads)),
        statics_(space_, *material_.material, settings_of(scene_))
  {
    summary_.points = space_.n_points();
    if (!resumed_)
      return;
    statics_.restore(resumed_->state);
    resumed_->get(summary_);
    if (summary_.steps != statics_.n_steps() || summary_.steps > scene_.test.steps)
      throw InputError(
          fmt::format("{}: has {} steps in its summary and {} in its state, of {}: it is damaged. Start again "
                      "with --overwrite.",
                      resumed_->file, summary_.steps, statics_.n_steps(), scene_.test.steps));
    if (resumed_->numbers.contains("large_from"))
      summary_.large_from = resumed_->number("large_from");
  }

  BiaxialSummary go()
  {
    open();
    try
      {
        run();
        history_->flush();
      }
    catch (const RunFailure &failure) // of its files
      {
        throw failure_of_run(failure, request_.folder, [&] { history_->flush(); });
      }
    summary_.complete = summary_.failure.empty();
    return with_costs();
  }

private:
  void run()
  {
    progress_.say(fmt::format("{} points, {} steps{}", space_.n_points(), scene_.test.steps,
                              resumed_ ? fmt::format(", from step {} on", summary_.steps) : ""));
    if (!resumed_)
      {
        record();
        files_->map(0, statics_);
      }
    while (summary_.steps < scene_.test.steps && finds_equilibrium())
      {
        follow();
        if (since_checkpoint_.seconds() > 60 * scene_.output.checkpoint_minutes)
          save();
      }
  }

  void open()
  {
    folder_ = open_result_folder(request_.folder, request_.use);
    if (!resumed_)
      note_provenance();
    history_ =
        std::make_unique<Recorder>(request_.folder, columns(scene_), counter(resumed_.get(), "rows"), to_toml(scene_));
    files_ = std::make_unique<BlockFiles>(request_.folder, space_, material_, scene_.water.undrained(),
                                          counter(resumed_.get(), "maps"));
    if (resumed_) // only now: the files may be refused
      note_provenance();
  }

  void note_provenance() const
  {
    write_provenance(request_.folder, to_toml(scene_), request_.command_line,
                     {{"threads", std::to_string(request_.threads)}});
  }

  /// The summary, which has the costs of earlier calls, with those of this one.
  BiaxialSummary with_costs() const
  {
    BiaxialSummary summary = summary_;
    summary.wall_seconds += since_start_.seconds();
    if (!material_.grains)
      return summary;
    const RveMaterialCost &cost = material_.grains->cost();
    summary.material_seconds += cost.batch_seconds;
    summary.tangent_seconds += cost.wave_seconds;
    summary.rve_steps += static_cast<double>(cost.steps);
    return summary;
  }

  void save()
  {
    history_->flush();
    ColumnCheckpoint checkpoint{statics_.save(), {}, {}, to_toml(scene_)};
    checkpoint.put(with_costs());
    if (summary_.large_from)
      checkpoint.numbers["large_from"] = *summary_.large_from;
    checkpoint.numbers["rows"] = static_cast<double>(history_->n_rows());
    checkpoint.numbers["maps"] = static_cast<double>(files_->n_maps());
    write_column_checkpoint(request_.folder / "checkpoint", checkpoint);
    since_checkpoint_.restart();
  }

  [[noreturn]] void stop()
  {
    save();
    throw Interrupted(fmt::format("interrupted after step {}; continue with --resume", summary_.steps));
  }

  void record()
  {
    std::vector<Gradient> gradients;
    gradients_of(space_, statics_.displacement(), gradients);
    std::vector<double> shear;
    double volume = 0, vertical = 0, lateral = 0, mean = 0;
    for (std::size_t q = 0; q < space_.n_points(); ++q)
      {
        const PointState point = point_state(gradients[q], statics_.stresses()[q]);
        const double part = space_.weight[q] / (scene_.mesh.width * scene_.mesh.height);
        volume += part * point.volumetric;
        vertical -= part * gradients[q][8];
        lateral -= part * gradients[q][0];
        mean += part * point.shear;
        shear.push_back(point.shear);
        summary_.max_strain = std::max(summary_.max_strain, 0.5 * (std::abs(point.volumetric) + point.shear));
        summary_.max_rotation = std::max(summary_.max_rotation, 0.5 * std::abs(gradients[q][2] - gradients[q][6]));
      }
    std::sort(shear.begin(), shear.end());
    const double quantile = shear[shear.size() * 9 / 10], median = shear[shear.size() / 2];
    const StaticsEffort &effort = statics_.effort();
    const double stress = scene_.test.confinement - statics_.reaction({Face::surface, 2}) / scene_.mesh.width;
    std::vector<double> row{static_cast<double>(summary_.steps),
                            vertical,
                            stress,
                            lateral,
                            volume,
                            1.0 * effort.iterations,
                            1.0 * effort.trials,
                            1.0 * effort.substeps,
                            1.0 * effort.rejected,
                            statics_.residual(),
                            mean,
                            quantile,
                            shear.back()};
    if (scene_.water.undrained())
      row.push_back(summary_.pore_pressure = mean_pore_pressure());
    history_->append(row);
    summary_.axial_strain = vertical;
    summary_.volumetric_strain = volume;
    summary_.last_stress = stress;
    summary_.localisation = median > 0 ? quantile / median : 1;
    if (!summary_.large_from && std::max(summary_.max_strain, summary_.max_rotation) > small)
      {
        summary_.large_from = vertical;
        progress_.say("  note: " + beyond_small(summary_));
      }
    if (summary_.steps == 0 || stress > summary_.peak_stress)
      {
        summary_.peak_stress = stress;
        summary_.peak_strain = vertical;
      }
  }

  /// Over the volume, excess, compression positive, Pa.
  double mean_pore_pressure() const
  {
    const std::vector<double> pressure = statics_.point_pressure();
    return std::inner_product(pressure.begin(), pressure.end(), space_.weight.begin(), 0.0) /
           (scene_.mesh.width * scene_.mesh.height);
  }

  /// The next load step. False, with what there is to say and a map of the last good sub-step, if it has none.
  bool finds_equilibrium()
  {
    if (stop_requested())
      stop();
    try
      {
        statics_.step((summary_.steps + 1.0) / scene_.test.steps * end_of(scene_) - statics_.time());
        return true;
      }
    catch (const StepGivenUp &) // a step of packings takes minutes
      {
        stop();
      }
    catch (const RunFailure &failure)
      {
        summary_.failure = failure.what();
      }
    back_to_committed();
    files_->map(statics_.time() / end_of(scene_) * scene_.test.axial_strain, statics_);
    return false;
  }

  /// What is written and said of a step.
  void follow()
  {
    ++summary_.steps;
    const StaticsEffort &effort = statics_.effort();
    summary_.iterations += effort.iterations;
    summary_.trials += effort.trials;
    summary_.substeps += effort.substeps;
    summary_.rejected += effort.rejected;
    record();
    if (summary_.steps % scene_.output.map_every == 0 || summary_.steps == scene_.test.steps)
      files_->map(summary_.axial_strain, statics_);
    progress_.say(fmt::format(
        "step {:>4} of {}  {:>6}  axial strain {:.4f}  stress {:.2f} kPa  volumetric {:+.5f}  {} iterations, "
        "{} trials, {} sub-steps, {} rejected, residual {:.1e}",
        summary_.steps, scene_.test.steps, duration_text(since_start_.seconds()), summary_.axial_strain,
        summary_.last_stress / 1e3, summary_.volumetric_strain, effort.iterations, effort.trials, effort.substeps,
        effort.rejected, statics_.residual()));
  }

  /// Packings show what the last trial left, even one that was given up: they go back by a trial of no strain.
  void back_to_committed()
  {
    const std::vector<Gradient> still(space_.n_points(), Gradient{});
    std::vector<Stress> stresses(space_.n_points());
    material_.material->trial(still, stresses);
    material_.material->rollback();
  }

  const BiaxialRequest &request_;
  const BiaxialScene &scene_;
  const Stopwatch since_start_;
  const Progress progress_{request_.quiet};
  const std::unique_ptr<ColumnCheckpoint> resumed_; ///< read before packings are prepared
  BlockMesh space_;
  BlockMaterial material_;
  Statics statics_;
  BiaxialSummary summary_;
  Stopwatch since_checkpoint_;
  FileLock folder_;
  std::unique_ptr<Recorder> history_;
  std::unique_ptr<BlockFiles> files_;
};
} // namespace

BiaxialSummary run_biaxial(const BiaxialRequest &request) { return BiaxialRun(request).go(); }

namespace
{
void add_block(const BiaxialScene &scene, std::size_t n_points, Summary &summary)
{
  summary["confinement_Pa"] = scene.test.confinement;
  summary.row("block", "{} x {} m, {} x {} elements of degree {}, {} points, {}", Value{"width_m", scene.mesh.width},
              Value{"height_m", scene.mesh.height}, Value{"cells_across", scene.mesh.cells_across},
              Value{"cells_up", scene.mesh.cells_up}, scene.mesh.degree, Value{"points", n_points},
              material_names[static_cast<int>(scene.soil.material)]);
  const std::string length = summary.text("{:.4g} m, against differences of strain {:.3g} of the wave moduli",
                                          Value{"nonlocal_length_m", scene.nonlocal.length},
                                          Value{"nonlocal_stiffness", scene.nonlocal.stiffness});
  if (scene.nonlocal.length > 0)
    summary.row("length", "{}", length);
}
} // namespace

Summary report_of(const BiaxialSummary &s, const BiaxialScene &scene)
{
  Summary summary(scene.title, "Block", "pore_pressure_Pa large_strain_from");
  summary["complete"] = s.complete;
  summary["failure"] = s.failure;
  summary["rve_steps"] = std::llround(s.rve_steps);
  add_block(scene, s.points, summary);
  summary.row("axial strain", "{:.4g} % in {} steps{}", Value{"axial_strain", s.axial_strain, percent},
              Value{"steps", s.steps}, s.complete ? "" : ", then it stopped");
  summary.row("axial stress", "{:.4g} kPa at the end, largest {:.4g} kPa at {:.3g} %",
              Value{"last_stress_Pa", s.last_stress, kPa}, Value{"peak_stress_Pa", s.peak_stress, kPa},
              Value{"peak_strain", s.peak_strain, percent});
  summary.row("volumetric strain", "{:+.4g} % (compression positive)",
              Value{"volumetric_strain", s.volumetric_strain, percent});
  if (scene.water.undrained())
    summary.row("pore pressure", "{:.4g} kPa above that at the start, mean of the block at the end",
                Value{"pore_pressure_Pa", s.pore_pressure, kPa});
  if (scene.water.undrained() && s.pore_pressure < -100e3)
    summary.row("warning", "a suction of more than the atmosphere's pressure, unless the pore pressure at the start "
                           "was higher: water cavitates then, here it does not");
  summary.row("shear strain", "90 % quantile {:.3g} times the median", Value{"localisation", s.localisation});
  summary.row("at a point", "strain up to {:.3g} %, rotation up to {:.3g} deg",
              Value{"max_strain", s.max_strain, percent},
              Value{"max_rotation_deg", s.max_rotation * 180 / std::numbers::pi});
  if (s.large_from)
    {
      summary["large_strain_from"] = *s.large_from;
      summary.row("warning", "{}", beyond_small(s));
    }
  summary.row("equilibrium", "{}: {} iterations, {} trials, {} sub-steps, {} rejected", method_of(scene.newton),
              Value{"iterations", s.iterations}, Value{"trials", s.trials}, Value{"substeps", s.substeps},
              Value{"rejected", s.rejected});
  if (!s.complete)
    summary.row("stopped", "{}", s.failure);
  return summary;
}
} // namespace isostat
