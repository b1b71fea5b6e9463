// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/grain_files.hpp"

#include "apps/deposit/ranks.hpp"
#include "base/files/replace_file.hpp"
#include "coupling/element/strain_record.hpp"
#include "dem/io/snapshot_file.hpp"
#include "dem/io/vtp.hpp"
#include "dem/measure/summary.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <mpi.h>
#include <numeric>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
/// The columns of a profile among those of Micromechanics, the redundancy index first and what it counts last.
constexpr const char *profile_columns[] = {"IR", "Z", "F_yx", "f_S", "f_R", "f_SR", "IR_constraints"};

std::vector<std::size_t> counted_to(std::size_t n)
{
  std::vector<std::size_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}
} // namespace

std::size_t column_number(const std::string &name)
{
  const auto &columns = Micromechanics::columns();
  return static_cast<std::size_t>(
      std::find_if(columns.begin(), columns.end(), [&](const auto &column) { return column.first == name; }) -
      columns.begin());
}

GrainFiles::GrainFiles(fs::path folder, const ColumnScene &scene, const SoilMaterial &soil,
                       const FiniteElementSpace &space, const ColumnCheckpoint *resumed)
    : folder_(std::move(folder)), grains_(*soil.grains),
      pictured_(nearest_grains(soil, space.mesh(), space.position, scene.grain_output.snapshot_depths)),
      followed_(nearest_grains(soil, space.mesh(), space.position, scene.grain_output.path_depths)),
      n_snapshots_(counter(resumed, "grain_snapshots")), n_path_rows_(counter(resumed, "grain_paths")),
      places_(soil.grains_places), redundancy_(space.n_points(), std::numeric_limits<double>::quiet_NaN())
{
  if (resumed)
    min_ = {resumed->number("min_IR"), resumed->number("min_IR_depth"), resumed->number("min_IR_time"),
            resumed->number("min_IR_constraints")};
  for (std::size_t place : soil.grains_places)
    depths_.push_back(space.mesh().depth(space.position[place]));
  history_.columns = counted_to(Micromechanics::columns().size());
  history_.points = nearest_grains(soil, space.mesh(), space.position, scene.output.depths);
  for (const char *name : profile_columns)
    profiles_.columns.push_back(column_number(name));
  profiles_.points = counted_to(depths_.size());
  std::stable_sort(profiles_.points.begin(), profiles_.points.end(),
                   [&](std::size_t a, std::size_t b) { return depths_[a] < depths_[b]; });
}

fs::path GrainFiles::path_folder(std::size_t k) const { return folder_ / "paths" / fmt::format("d{}", k); }

void GrainFiles::open(Table &table, const char *folder, std::size_t resume_rows) const
{
  std::vector<RecordColumn> columns = {{"step", "-"}, {"time", "s"}};
  for (std::size_t k = 0; k < table.points.size(); ++k)
    {
      columns.push_back({fmt::format("{}{}_depth", table.prefix, k), "m"});
      for (std::size_t column : table.columns)
        {
          const auto &[name, unit] = Micromechanics::columns()[column];
          columns.push_back({fmt::format("{}{}_{}", table.prefix, k, name), unit});
        }
    }
  table.rows = std::make_unique<Recorder>(folder_ / folder, columns, resume_rows);
}

void GrainFiles::open(const ColumnCheckpoint *resumed)
{
  on_first_rank([&] {
    open(history_, "grain_history", counter(resumed, "grain_rows"));
    open(profiles_, "grain_profiles", counter(resumed, "grain_profiles"));
    if (!pictured_.empty())
      make_folder(folder_ / "grains");
    for (std::size_t k = 0; k < pictured_.size(); ++k)
      pictures_.push_back(
          std::make_unique<PvdCollection>(folder_ / "grains" / fmt::format("d{}.pvd", k), n_snapshots_));
    for (std::size_t k = 0; k < followed_.size(); ++k)
      paths_.push_back(std::make_unique<Recorder>(path_folder(k), strain_record_columns(), n_path_rows_));
  });
  together([&] {
    for (std::size_t k = 0; !resumed && k < followed_.size(); ++k)
      if (const Rve *element = grains_.element(followed_[k]))
        {
          StrainRecord start;
          start.depth = depths_[followed_[k]];
          start.packing = element->pack();
          start.settings = grains_.element_settings();
          write_strain_record_start(path_folder(k), start);
        }
  });
}

std::vector<double> measured(const RveMaterial &grains, const std::vector<std::size_t> &points)
{
  const std::size_t width = Micromechanics::columns().size();
  std::vector<double> values(points.size() * width, 0.0);
  together([&] {
    for (std::size_t k = 0; k < points.size(); ++k)
      if (const Rve *element = grains.element(points[k]))
        {
          const std::vector<double> row = micromechanics(element->snapshot()).row();
          std::copy(row.begin(), row.end(), values.begin() + static_cast<std::ptrdiff_t>(k * width));
        }
  });
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return values; // all but the owner added zeros: exact
}

/// @return the row: step, time, and for each point its depth and the columns
std::vector<double> GrainFiles::append(Table &table, std::uint64_t step, double time) const
{
  const std::size_t width = Micromechanics::columns().size();
  const std::vector<double> values = measured(grains_, table.points);
  std::vector<double> row = {static_cast<double>(step), time};
  for (std::size_t k = 0; k < table.points.size(); ++k)
    {
      row.push_back(depths_[table.points[k]]);
      for (std::size_t column : table.columns)
        row.push_back(values[k * width + column]);
    }
  together([&] {
    if (table.rows)
      table.rows->append(row);
  });
  return row;
}

void GrainFiles::record(std::uint64_t step, double time)
{
  if (!history_.points.empty())
    append(history_, step, time);
}

void GrainFiles::profile(std::uint64_t step, double time)
{
  const std::vector<double> row = append(profiles_, step, time);
  const std::size_t n = profiles_.columns.size();
  for (std::size_t k = 0, at = 2; at < row.size(); ++k, at += 1 + n)
    {
      redundancy_[places_[profiles_.points[k]]] = row[at + 1];
      if (row[at + 1] < min_.redundancy)
        min_ = {row[at + 1], row[at], time, row[at + n]};
    }
}

void GrainFiles::snapshots(double time)
{
  if (pictured_.empty())
    return;
  together([&] { write_packings(time); });
  ++n_snapshots_;
}

void GrainFiles::write_packings(double time)
{
  for (std::size_t k = 0; k < pictured_.size(); ++k)
    if (const Rve *element = grains_.element(pictured_[k]))
      {
        const Snapshot snapshot = element->snapshot();
        const fs::path stem = folder_ / "grains" / fmt::format("d{}_{:05d}", k, n_snapshots_);
        write_snapshot_file(stem.string() + ".h5", snapshot);
        write_grains_vtp(stem.string() + ".vtp", snapshot);
      }
  for (std::size_t k = 0; k < pictures_.size(); ++k)
    pictures_[k]->append(time, fmt::format("d{}_{:05d}.vtp", k, n_snapshots_));
}

void GrainFiles::follow(std::uint64_t step, double time)
{
  if (followed_.empty())
    return;
  ++n_path_rows_;
  together([&] {
    for (std::size_t k = 0; k < paths_.size(); ++k)
      paths_[k]->append(strain_record_row(step, time, grains_.increment(followed_[k]), grains_.stress(followed_[k]),
                                          grains_.steps_of(followed_[k])));
  });
}

void GrainFiles::flush()
{
  for (const Table *table : {&history_, &profiles_})
    if (table->rows)
      table->rows->flush();
  for (const auto &rows : paths_)
    rows->flush();
}

std::map<std::string, double> GrainFiles::counters() const
{
  return {{"grain_rows", static_cast<double>(history_.n_rows())},
          {"grain_profiles", static_cast<double>(profiles_.n_rows())},
          {"grain_snapshots", static_cast<double>(n_snapshots_)},
          {"grain_paths", static_cast<double>(n_path_rows_)},
          {"min_IR", min_.redundancy},
          {"min_IR_depth", min_.depth},
          {"min_IR_time", min_.time},
          {"min_IR_constraints", min_.constraints}};
}
} // namespace isostat
