// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/files.hpp"

#include "base/files/replace_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
std::vector<double> chosen(const std::vector<double> &values, const std::vector<std::size_t> &which)
{
  std::vector<double> some;
  for (std::size_t k : which)
    some.push_back(values[k]);
  return some;
}

/// Points of a line, and displacement and, of what moves, velocity of its nodes, along x, y and z.
SeriesLayout layout_of(const ColumnLine &line, const std::vector<double> &vertical_stress,
                       const std::vector<double> &velocities, bool moves)
{
  SeriesLayout layout =
      profile_layout(line.point_depths, chosen(vertical_stress, line.points), chosen(velocities, line.points));
  layout.constants.push_back({"node_depth", "m", line.node_depths});
  for (const char axis : {'x', 'y', 'z'})
    layout.series.push_back({fmt::format("node_displacement_{}", axis), "m", line.nodes.size()});
  for (const char axis : {'x', 'y', 'z'})
    if (moves)
      layout.series.push_back({fmt::format("node_velocity_{}", axis), "m/s", line.nodes.size()});
  return layout;
}

/// Linear between nodes.   @param depths  of `values`, rising
double at_depth(const std::vector<double> &depths, const std::vector<double> &values, double depth)
{
  const auto above = std::ranges::upper_bound(depths, depth);
  const auto k = static_cast<std::size_t>(std::clamp(above - depths.begin(), 1L, std::ssize(depths) - 1));
  return std::lerp(values[k - 1], values[k], (depth - depths[k - 1]) / (depths[k] - depths[k - 1]));
}

/// profile.csv: the largest values of all steps at the points, from the surface down, with what nodes have at these
/// depths. Surface and base are nodes without strain and stress.   CSR = 0.65 tau/sigma'_v0 (Seed & Idriss 1971,
/// doi:10.1061/JSFEAQ.0001662) with the largest tau until r_u reaches ColumnPeaks::demand_ru
/// @param settlement  of the nodes at the end against the base, m
void write_profile(const fs::path &path, const ColumnLine &line, const ColumnPeaks &peaks,
                   const std::vector<double> &settlement, const std::vector<double> &vertical_stress)
{
  constexpr double mean_share = 0.65;
  std::string text = "depth (m),PGA (m/s2),PGV (m/s),PGD (m),settlement (m),gamma_max (-),tau_max (Pa),sigma_v0 (Pa),"
                     "tau_ratio (-),CSR (-),ru_max (-)\n";
  const auto add_nodes = [&](double depth) {
    text += fmt::format("{:.10g}", depth);
    for (const std::vector<double> *values :
         {&peaks.line_acceleration, &peaks.line_velocity, &peaks.line_displacement, &settlement})
      text += fmt::format(",{:.10g}", at_depth(line.node_depths, *values, depth));
  };
  add_nodes(line.node_depths.front());
  text += ",,,,,,\n";
  for (std::size_t k = 0; k < line.points.size(); ++k)
    {
      const double tau = peaks.line_tau[k], initial = vertical_stress[line.points[k]];
      add_nodes(line.point_depths[k]);
      text += fmt::format(",{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g}\n", peaks.line_gamma[k], tau, initial,
                          tau / initial, mean_share * peaks.line_demand[k] / initial, peaks.line_ru[k]);
    }
  add_nodes(line.node_depths.back());
  text += ",,,,,,\n";
  write_replacing(path, text);
}
} // namespace

ColumnFiles::ColumnFiles(fs::path folder, const ColumnScene &scene, const FiniteElementSpace &space,
                         const std::array<Motion, 3> &motions, std::size_t stride)
    : folder_(std::move(folder)), scene_text_(to_toml(scene)), space_(space),
      paraview_(scene.output.paraview_interval.has_value()), box_(scene.mesh.sides != Sides::tied),
      packings_(scene.has_grains() && scene.analysis.kind == AnalysisKind::dynamic),
      moves_(scene.analysis.kind == AnalysisKind::dynamic), history_(scene, space, motions, stride)
{
  if (!scene.mesh.distributed)
    line_ = column_line(space);
}

void ColumnFiles::open(const std::vector<double> &velocities, const ColumnCheckpoint *resumed)
{
  recorder_ = std::make_unique<Recorder>(folder_, history_.columns(), counter(resumed, "rows"), scene_text_);
  if (line_)
    profiles_ = std::make_unique<SeriesFile>(folder_ / "profiles.h5",
                                             layout_of(*line_, history_.vertical_stress(), velocities, moves_),
                                             counter(resumed, "profiles"));
  if (line_ && box_)
    maps_ = std::make_unique<BoxMaps>(folder_ / "maps.h5", space_, history_.vertical_stress(), velocities,
                                      counter(resumed, "profiles"), packings_);
  if (paraview_)
    {
      make_folder(folder_ / "paraview");
      pvd_ = std::make_unique<PvdCollection>(folder_ / "paraview" / "column.pvd", counter(resumed, "paraview"));
    }
}

void ColumnFiles::write_rows(bool at_the_end)
{
  while (const std::optional<std::vector<double>> row = history_.take(at_the_end))
    if (recorder_)
      recorder_->append(*row);
}

void ColumnFiles::profile(const ColumnInstant &instant, std::span<const double> redundancy)
{
  if (!profiles_)
    return;
  std::vector<double> values = columns_at(instant, line_->points, history_.vertical_stress());
  for (const std::vector<double> *of_nodes : {&instant.displacement, &instant.velocity})
    for (unsigned axis = 0; axis < 3 && (moves_ || of_nodes == &instant.displacement); ++axis)
      for (const unsigned dof : line_->nodes)
        values.push_back((*of_nodes)[dof + axis]);
  profiles_->append(instant.time, values);
  if (maps_)
    maps_->append(instant, redundancy);
}

void ColumnFiles::paraview(const ColumnInstant &instant)
{
  if (!pvd_)
    return;
  const std::string name = fmt::format("column_{:05d}.vtu", pvd_->n_entries());
  write_column_vtu(folder_ / "paraview" / name, space_, instant, history_.vertical_stress());
  pvd_->append(instant.time, name);
}

void ColumnFiles::flush()
{
  if (recorder_)
    recorder_->flush();
  if (profiles_)
    profiles_->flush();
  if (maps_)
    maps_->flush();
}

void ColumnFiles::save(ColumnCheckpoint &checkpoint, const ColumnPeaks &peaks)
{
  history_.save(checkpoint);
  if (!recorder_)
    return;
  flush();
  peaks.save(checkpoint);
  checkpoint.numbers["rows"] = static_cast<double>(recorder_->n_rows());
  checkpoint.numbers["profiles"] = profiles_ ? static_cast<double>(profiles_->n_rows()) : 0;
  checkpoint.numbers["paraview"] = pvd_ ? static_cast<double>(pvd_->n_entries()) : 0;
}

void ColumnFiles::finish(const ColumnPeaks &peaks, const Vector &displacement,
                         const std::optional<Spreading> &spreading)
{
  flush();
  if (!profiles_)
    return;
  profiles_->add("peak_gamma", peaks.line_gamma, "-");
  profiles_->add("peak_ru", peaks.line_ru, "-");
  profiles_->add("peak_acceleration", peaks.line_acceleration, "m/s2");
  profiles_->add("peak_velocity", peaks.line_velocity, "m/s");
  profiles_->add("peak_displacement", peaks.line_displacement, "m");
  if (moves_)
    {
      std::vector<double> settlement;
      const double of_base = displacement.local_element(line_->nodes.back() + 2);
      for (const unsigned dof : line_->nodes)
        settlement.push_back(of_base - displacement.local_element(dof + 2));
      profiles_->add("peak_tau", peaks.line_tau, "Pa");
      profiles_->add("end_settlement", settlement, "m");
      write_profile(folder_ / "profile.csv", *line_, peaks, settlement, history_.vertical_stress());
    }
  if (!spreading)
    return;
  profiles_->add("tau_0", spreading->line_shear, "Pa");
  profiles_->add("end_gamma_xz", spreading->line_gamma, "-");
  profiles_->add("end_displacement", spreading->line_displacement, "m");
}
} // namespace isostat
