// SPDX-License-Identifier: BSD-3-Clause
// A block in plane strain, confined on its sides, compressed by its top: does a shear band form? Quasi-static, by
// Newton with the tangent of the material or by relaxation.
//
//      ____v____  smooth plate, moves down
//   -> |       | <-
//   -> |   #   | <-  constant pressure      # weak elements
//   -> |       | <-
//      ---------  smooth plate
#include "apps/deposit/grain_files.hpp"
#include "apps/deposit/instant.hpp"
#include "apps/deposit/output.hpp"
#include "apps/soil_column/analysis_run.hpp"
#include "base/fields.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/series_file.hpp"
#include "fem/space/vtu.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>

namespace isostat
{
namespace
{
/// Strain and rotation [-] up to which geometry of second order is a matter of per cent.
constexpr double small_strain = 0.1;

bool has_water(const ColumnScene &scene) { return scene.water.drainage == Drainage::coupled; }

/// Time is the share of the way where no water moves, else s.
double end_of(const ColumnScene &scene) { return has_water(scene) ? scene.biaxial.duration : 1; }

StaticsSettings block_settings(const ColumnScene &scene)
{
  const double way = scene.biaxial.axial_strain * scene.height(), end = end_of(scene);
  StaticsSettings settings;
  settings.pore_water = has_water(scene);
  settings.displacements = {{{Face::surface, 2}, [=](double t, const Place &) { return -way * t / end; }}};
  settings.petsc = scene.analysis.petsc;
  settings.newton = scene.load_steps.newton;
  settings.min_force = scene.biaxial.confinement * scene.mesh.width;
  return interruptible(settings);
}

std::vector<RecordColumn> columns_of(const ColumnScene &scene)
{
  std::vector<RecordColumn> columns = {
      {"step"},       {"axial_strain"},   {"axial_stress", "Pa"}, {"lateral_strain"}, {"volumetric_strain"},
      {"iterations"}, {"trials"},         {"substeps"},           {"rejected"},       {"residual"},
      {"shear_mean"}, {"shear_quantile"}, {"shear_max"}};
  if (has_water(scene))
    columns.push_back({"pore_pressure", "Pa"});
  return columns;
}

/// Difference of the principal strains in the plane: sqrt((eps_xx - eps_zz)^2 + gamma_xz^2) [-].
double shear_strain(const Gradient &h) { return std::hypot(h[0] - h[8], h[2] + h[6]); }
double volumetric_strain(const Gradient &h) { return -(h[0] + h[4] + h[8]); } ///< compression positive [-]

/// What the summary shows of a block. Strains and stresses compression positive, Pa.
struct BlockResult
{
  double axial_strain = 0;                 ///< reached
  double peak_stress = 0, peak_strain = 0; ///< largest axial stress; where
  double last_stress = 0;
  double volumetric_strain = 0; ///< at the end
  double pore_pressure = 0;     ///< excess, at the end, mean of the block
  double localisation = 0;      ///< 90 % quantile of the points' shear strain over its median; uniform: 1
  double max_strain = 0;        ///< largest amount of a principal strain of a point so far: the mesh takes it as small
  double max_rotation = 0;      ///< largest rotation of a point in the plane so far, (u_x,z - u_z,x)/2, alike, rad
  double large_from = 0;        ///< axial strain at which one of the two was first beyond a tenth; 0: they were not
  std::size_t iterations = 0, trials = 0, substeps = 0, rejected = 0;

  ISOSTAT_FIELDS(axial_strain, peak_stress, peak_strain, last_stress, volumetric_strain, pore_pressure, localisation,
                 max_strain, max_rotation, large_from, iterations, trials, substeps, rejected)
};

std::string beyond_small(const BlockResult &result)
{
  return fmt::format("from an axial strain of {:.3g} % on strains or rotations of the mesh are beyond {:g} %, but "
                     "its geometry takes them as small",
                     100 * result.large_from, 100 * small_strain);
}

const char *method_of(const NewtonSettings &newton)
{
  if (newton.max_iterations == 0)
    return "relaxation";
  return newton.relaxation_iterations == 0 ? "Newton's method" : "Newton's method and relaxation";
}

void add_block(const ColumnScene &scene, std::size_t n_points, Summary &summary)
{
  summary["analysis"] = analysis_names[static_cast<int>(AnalysisKind::biaxial)];
  summary["confinement_Pa"] = scene.biaxial.confinement;
  summary.row("block", "{} x {} m, {} x {} elements of degree {}, {} points, {}", Value{"width_m", scene.mesh.width},
              Value{"height_m", scene.height()}, Value{"cells_across", scene.mesh.cells_across},
              Value{"cells_up", cells_up(scene)}, scene.mesh.degree, Value{"points", n_points},
              material_names[static_cast<int>(scene.layers.front().material)]);
  const NonlocalParameters &nonlocal = scene.biaxial.nonlocal;
  const std::string length =
      summary.text("{:.4g} m, against differences of strain {:.3g} of the wave moduli",
                   Value{"nonlocal_length_m", nonlocal.length}, Value{"nonlocal_stiffness", nonlocal.stiffness});
  if (nonlocal.length > 0)
    summary.row("length", "{}", length);
}
/// @param failure  why it has stopped before its end; empty: it has not
Summary report_of(const BlockResult &r, const ColumnScene &scene, std::size_t n_points, std::size_t n_steps,
                  const std::string &failure)
{
  Summary summary(scene.title, "Block", "pore_pressure_Pa large_strain_from");
  summary["complete"] = failure.empty();
  summary["failure"] = failure;
  add_block(scene, n_points, summary);
  summary.row("axial strain", "{:.4g} % in {} steps{}", Value{"axial_strain", r.axial_strain, percent},
              Value{"steps", n_steps}, failure.empty() ? "" : ", then it stopped");
  summary.row("axial stress", "{:.4g} kPa at the end, largest {:.4g} kPa at {:.3g} %",
              Value{"last_stress_Pa", r.last_stress, kPa}, Value{"peak_stress_Pa", r.peak_stress, kPa},
              Value{"peak_strain", r.peak_strain, percent});
  summary.row("volumetric strain", "{:+.4g} % (compression positive)",
              Value{"volumetric_strain", r.volumetric_strain, percent});
  if (has_water(scene))
    summary.row("pore pressure", "{:.4g} kPa above that at the start, mean of the block at the end",
                Value{"pore_pressure_Pa", r.pore_pressure, kPa});
  if (has_water(scene) && r.pore_pressure < -100e3)
    summary.row("warning", "a suction of more than the atmosphere's pressure, unless the pore pressure at the start "
                           "was higher: water cavitates then, here it does not");
  summary.row("shear strain", "90 % quantile {:.3g} times the median", Value{"localisation", r.localisation});
  summary.row("at a point", "strain up to {:.3g} %, rotation up to {:.3g} deg",
              Value{"max_strain", r.max_strain, percent},
              Value{"max_rotation_deg", r.max_rotation * 180 / std::numbers::pi});
  if (r.large_from != 0)
    {
      summary["large_strain_from"] = r.large_from;
      summary.row("warning", "{}", beyond_small(r));
    }
  summary.row("equilibrium", "{}: {} iterations, {} trials, {} sub-steps, {} rejected",
              method_of(scene.load_steps.newton), Value{"iterations", r.iterations}, Value{"trials", r.trials},
              Value{"substeps", r.substeps}, Value{"rejected", r.rejected});
  if (!failure.empty())
    summary.row("stopped", "{}", failure);
  return summary;
}

class BiaxialRun : public AnalysisRun<Statics>
{
public:
  explicit BiaxialRun(const ColumnRequest &request) : AnalysisRun<Statics>(request, block_settings(request.scene))
  {
    restore();
    if (!resumed_)
      return;
    resumed_->get(result_);
    if (run_.n_steps() > scene_.load_steps.number)
      throw InputError(fmt::format("{}: has {} steps, of {}: it is damaged. Start again with --overwrite.",
                                   resumed_->file, run_.n_steps(), scene_.load_steps.number));
  }

private:
  /// What maps show of each point.
  struct MapField
  {
    const char *name, *unit;
    std::function<double(std::size_t point)> value;
  };

  void start() override
  {
    progress_.say(fmt::format("{} points, {} steps{}", space_.n_points(), scene_.load_steps.number,
                              resumed_ ? fmt::format(", from step {} on", run_.n_steps()) : ""));
    if (resumed_)
      return;
    record();
    map(0);
  }

  bool is_done() const override { return run_.n_steps() >= scene_.load_steps.number; }
  double n_total() const override { return scene_.load_steps.number; }

  /// One without equilibrium ends the run: what there is stays, with a map of the last good sub-step.
  void step() override
  {
    try
      {
        solve([&] {
          run_.step((static_cast<double>(run_.n_steps()) + 1) / scene_.load_steps.number * end_of(scene_) -
                    run_.time());
        });
      }
    catch (const RunFailure &failure)
      {
        failure_ = failure.what();
        // packings show what the last trial left, even one that was given up: they go back by a trial of no strain
        std::vector<Stress> stresses(space_.n_points());
        soil_.material->trial(std::vector<Gradient>(space_.n_points(), Gradient{}), stresses);
        soil_.material->rollback();
        return map(run_.time() / end_of(scene_) * scene_.biaxial.axial_strain);
      }
    record();
    if (run_.n_steps() % scene_.biaxial.map_every == 0 || is_done())
      map(result_.axial_strain);
  }

  std::string key_state() override
  {
    return fmt::format("axial strain {:.4f}  stress {:.2f} kPa  volumetric {:+.5f}  {} trials, {} sub-steps, residuals "
                       "{}",
                       result_.axial_strain, result_.last_stress / kPa, result_.volumetric_strain, run_.effort().trials,
                       run_.effort().substeps, run_.effort().convergence());
  }

  void open_files() override
  {
    history_ = std::make_unique<Recorder>(request_.folder, columns_of(scene_), counter(resumed_.get(), "rows"),
                                          to_toml(scene_));
    SeriesLayout layout{.format = "isostat-block-maps",
                        .of = "axial_strain",
                        .unit = "-",
                        .constants = {{"x", "m", along(0, space_.position)}, {"z", "m", along(2, space_.position)}},
                        .series = {}};
    for (const MapField &field : map_fields_)
      layout.series.push_back({field.name, field.unit, space_.n_points()});
    maps_ = std::make_unique<SeriesFile>(request_.folder / "maps.h5", layout, counter(resumed_.get(), "maps"));
    make_folder(request_.folder / "paraview");
    pictures_ = std::make_unique<PvdCollection>(request_.folder / "paraview/block.pvd", maps_->n_rows());
  }

  void flush_files() override
  {
    if (history_)
      history_->flush();
  }

  void add_to(ColumnCheckpoint &checkpoint) override
  {
    flush_files();
    checkpoint.put(result_);
    if (!history_)
      return;
    checkpoint.numbers["rows"] = static_cast<double>(history_->n_rows());
    checkpoint.numbers["maps"] = static_cast<double>(maps_->n_rows());
  }

  void record()
  {
    gradients_of(space_, run_.displacement(), gradients_);
    BlockResult &r = result_;
    r.axial_strain = r.volumetric_strain = 0;
    std::vector<double> shear;
    double lateral = 0, mean = 0;
    const double area = scene_.mesh.width * scene_.height();
    for (std::size_t q = 0; q < space_.n_points(); ++q)
      {
        const Gradient &h = gradients_[q];
        const double part = space_.weight[q] / area, here = shear_strain(h);
        r.volumetric_strain += part * volumetric_strain(h);
        r.axial_strain -= part * h[8];
        lateral -= part * h[0];
        mean += part * here;
        shear.push_back(here);
        r.max_strain = std::max(r.max_strain, 0.5 * (std::abs(volumetric_strain(h)) + here));
        r.max_rotation = std::max(r.max_rotation, 0.5 * std::abs(h[2] - h[6]));
      }
    std::ranges::sort(shear);
    const double quantile = shear[shear.size() * 9 / 10], median = shear[shear.size() / 2];
    r.localisation = median > 0 ? quantile / median : 1;
    r.last_stress = scene_.biaxial.confinement - run_.reaction({Face::surface, 2}) / scene_.mesh.width;
    const StaticsEffort &effort = run_.effort();
    std::vector<double> row = {static_cast<double>(run_.n_steps()), r.axial_strain, r.last_stress, lateral,
                               r.volumetric_strain};
    for (const unsigned count : {effort.iterations, effort.trials, effort.substeps, effort.rejected})
      row.push_back(count);
    row.insert(row.end(), {run_.residual(), mean, quantile, shear.back()});
    if (has_water(scene_))
      {
        const std::vector<double> pressure = run_.point_pressure();
        r.pore_pressure = std::inner_product(pressure.begin(), pressure.end(), space_.weight.begin(), 0.0) / area;
        row.push_back(r.pore_pressure);
      }
    write([&] {
      if (history_)
        history_->append(row);
    });
    follow(effort);
  }

  /// Peaks and sums.
  void follow(const StaticsEffort &effort)
  {
    BlockResult &r = result_;
    if (run_.n_steps() == 0 || r.last_stress > r.peak_stress)
      {
        r.peak_stress = r.last_stress;
        r.peak_strain = r.axial_strain;
      }
    if (r.large_from == 0 && std::max(r.max_strain, r.max_rotation) > small_strain)
      {
        r.large_from = r.axial_strain;
        progress_.say("  note: " + beyond_small(r));
      }
    r.iterations += effort.iterations;
    r.trials += effort.trials;
    r.substeps += effort.substeps;
    r.rejected += effort.rejected;
  }

  std::vector<MapField> map_fields() const
  {
    const auto stress = [this](std::size_t q) -> const Stress & { return run_.stresses()[q]; };
    std::vector<MapField> fields = {
        {"shear_strain", "-", [this](std::size_t q) { return shear_strain(gradients_[q]); }},
        {"volumetric_strain", "-", [this](std::size_t q) { return volumetric_strain(gradients_[q]); }},
        {"p", "Pa", [=](std::size_t q) { return -0.5 * (stress(q)[0] + stress(q)[2]); }},
        {"q", "Pa", [=](std::size_t q) { return 0.5 * std::hypot(stress(q)[0] - stress(q)[2], 2 * stress(q)[4]); }},
        {"void_ratio", "-", [this](std::size_t q) { return void_ratio_[q]; }},
        {"redundancy", "-", [this](std::size_t q) { return redundancy_[q]; }}};
    if (soil_.nonlocal)
      fields.push_back({"mean_shear_strain", "-", [this](std::size_t q) { return shear_strain(means_[q]); }});
    if (has_water(scene_))
      fields.push_back({"pore_pressure", "Pa", [this](std::size_t q) { return pressure_[q]; }});
    return fields;
  }

  /// What the fields read.   Collective.
  void look()
  {
    gradients_of(space_, run_.displacement(), gradients_);
    pressure_ = run_.point_pressure();
    means_.resize(gradients_.size());
    if (soil_.nonlocal)
      soil_.nonlocal->average(gradients_, means_);
    void_ratio_.assign(space_.n_points(), 0);
    redundancy_ = void_ratio_;
    if (!soil_.grains)
      return;
    std::vector<std::size_t> points(soil_.grains_places.size());
    std::iota(points.begin(), points.end(), 0);
    const std::vector<double> rows = measured(*soil_.grains, points);
    const std::size_t width = rows.size() / points.size(), e = column_number("e"), redundancy = column_number("IR");
    for (std::size_t k = 0; k < points.size(); ++k)
      {
        void_ratio_[soil_.grains_places[k]] = rows[k * width + e];
        redundancy_[soil_.grains_places[k]] = rows[k * width + redundancy];
      }
  }

  void map(double axial_strain)
  {
    look();
    write([&] {
      if (maps_)
        write_map(axial_strain);
    });
  }

  void write_map(double axial_strain)
  {
    std::vector<double> row;
    std::vector<PointField> fields;
    for (const MapField &field : map_fields_)
      {
        std::vector<double> &values = fields.emplace_back(PointField{field.name, {}}).values;
        for (std::size_t q = 0; q < space_.n_points(); ++q)
          values.push_back(field.value(q));
        row.insert(row.end(), values.begin(), values.end());
      }
    const std::string name = fmt::format("block_{:05d}.vtu", maps_->n_rows());
    maps_->append(axial_strain, row);
    maps_->flush();
    const std::span u(run_.displacement().begin(), run_.displacement().locally_owned_size());
    write_vtu(request_.folder / "paraview" / name, space_, {axial_strain, maps_->n_rows()}, {{"displacement", u}},
              fields);
    pictures_->append(axial_strain, name);
  }

  Summary report() override { return report_of(result_, scene_, space_.n_points(), run_.n_steps(), failure_); }

  BlockResult result_;
  std::vector<Gradient> gradients_, means_; ///< of the last map: of the points, and what a nonlocal material gets
  std::vector<double> pressure_, void_ratio_, redundancy_;
  const std::vector<MapField> map_fields_ = map_fields();
  std::unique_ptr<Recorder> history_; ///< and all files: on the rank that writes
  std::unique_ptr<SeriesFile> maps_;
  std::unique_ptr<PvdCollection> pictures_;
};
} // namespace

RunResult run_biaxial(const ColumnRequest &request) { return BiaxialRun(request).go(); }
} // namespace isostat
