// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/grain_files.hpp"

#include "apps/deposit/ranks.hpp"
#include "base/error.hpp"
#include "dem/io/snapshot_file.hpp"
#include "dem/io/vtp.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <mpi.h>
#include <numeric>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

/// The columns of a profile among those of Micromechanics.
constexpr const char *profile_columns[] = {"IR", "Z", "F_yx", "f_S", "f_R", "f_SR"};

std::size_t column_number(const std::string &name)
{
  const auto &columns = Micromechanics::columns();
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].first == name)
      return k;
  throw RunFailure("micromechanics have no column " + name);
}

std::size_t counter(const ColumnCheckpoint *checkpoint, const std::string &name)
{
  return checkpoint ? static_cast<std::size_t>(checkpoint->numbers.at(name)) : 0;
}
} // namespace

GrainFiles::GrainFiles(fs::path folder, const ColumnScene &scene, const SoilMaterial &soil,
                       const std::vector<double> &depths, const ColumnCheckpoint *resumed)
    : folder_(std::move(folder)), grains_(*soil.grains), from_above_(soil.grains_places.size()),
      n_snapshots_(counter(resumed, "grain_snapshots"))
{
  if (resumed)
    min_ = {resumed->numbers.at("min_IR"), resumed->numbers.at("min_IR_depth"), resumed->numbers.at("min_IR_time")};
  for (std::size_t place : soil.grains_places)
    depths_.push_back(depths[place]);
  std::iota(from_above_.begin(), from_above_.end(), 0);
  std::stable_sort(from_above_.begin(), from_above_.end(),
                   [&](std::size_t a, std::size_t b) { return depths_[a] < depths_[b]; });
  chosen_ = nearest_grains(soil, depths, scene.output.depths);
  pictured_ = nearest_grains(soil, depths, scene.grain_output.snapshot_depths);
}

void GrainFiles::open(const ColumnCheckpoint *resumed)
{
  std::vector<RecordColumn> history = {{"step", "-"}, {"time", "s"}}, profiles = history;
  for (std::size_t k = 0; k < chosen_.size(); ++k)
    {
      history.push_back({fmt::format("d{}_depth", k), "m"});
      for (const auto &[name, unit] : Micromechanics::columns())
        history.push_back({fmt::format("d{}_{}", k, name), unit});
    }
  for (std::size_t k = 0; k < from_above_.size(); ++k)
    {
      profiles.push_back({fmt::format("p{}_depth", k), "m"});
      for (const char *name : profile_columns)
        profiles.push_back({fmt::format("p{}_{}", k, name), "-"});
    }
  history_ = std::make_unique<Recorder>(folder_ / "grain_history", history, counter(resumed, "grain_rows"));
  profiles_ = std::make_unique<Recorder>(folder_ / "grain_profiles", profiles, counter(resumed, "grain_profiles"));
  if (pictured_.empty())
    return;
  fs::create_directories(folder_ / "grains");
  for (std::size_t k = 0; k < pictured_.size(); ++k)
    pictures_.push_back(std::make_unique<PvdCollection>(folder_ / "grains" / fmt::format("d{}.pvd", k), n_snapshots_));
}

/// Micromechanics of the first packing of some points, one after the other, on every rank.
std::vector<double> GrainFiles::measured(const std::vector<std::size_t> &points) const
{
  const std::size_t width = Micromechanics::columns().size();
  std::vector<double> values(points.size() * width, 0.0);
  together([&] {
    for (std::size_t k = 0; k < points.size(); ++k)
      if (const Rve *element = grains_.element(points[k]))
        {
          const std::vector<double> row = micromechanics(element->snapshot()).row();
          std::copy(row.begin(), row.end(), values.begin() + static_cast<std::ptrdiff_t>(k * width));
        }
  });
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return values; // all but the owner added zeros: exact
}

void GrainFiles::record(std::uint64_t step, double time)
{
  if (chosen_.empty())
    return;
  const std::size_t width = Micromechanics::columns().size();
  const std::vector<double> values = measured(chosen_);
  std::vector<double> row = {static_cast<double>(step), time};
  for (std::size_t k = 0; k < chosen_.size(); ++k)
    {
      row.push_back(depths_[chosen_[k]]);
      row.insert(row.end(), values.begin() + static_cast<std::ptrdiff_t>(k * width),
                 values.begin() + static_cast<std::ptrdiff_t>((k + 1) * width));
    }
  together([&] {
    if (history_)
      history_->append(row);
  });
}

void GrainFiles::profile(std::uint64_t step, double time)
{
  const std::size_t width = Micromechanics::columns().size(), redundancy = column_number("IR");
  const std::vector<double> values = measured(from_above_);
  std::vector<double> row = {static_cast<double>(step), time};
  for (std::size_t k = 0; k < from_above_.size(); ++k)
    {
      row.push_back(depths_[from_above_[k]]);
      for (const char *name : profile_columns)
        row.push_back(values[k * width + column_number(name)]);
      if (const double ir = values[k * width + redundancy]; ir < min_.redundancy)
        min_ = {ir, depths_[from_above_[k]], time};
    }
  together([&] {
    if (profiles_)
      profiles_->append(row);
  });
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
        auto file = hdf5::File::create(stem.string() + ".h5");
        write_snapshot(file.root(), snapshot);
        file.commit();
        write_grains_vtp(stem.string() + ".vtp", snapshot);
      }
  for (std::size_t k = 0; k < pictures_.size(); ++k)
    pictures_[k]->append(time, fmt::format("d{}_{:05d}.vtp", k, n_snapshots_));
}

void GrainFiles::flush()
{
  if (history_)
    history_->flush();
  if (profiles_)
    profiles_->flush();
}

std::map<std::string, double> GrainFiles::counters() const
{
  return {{"grain_rows", history_ ? static_cast<double>(history_->n_rows()) : 0},
          {"grain_profiles", profiles_ ? static_cast<double>(profiles_->n_rows()) : 0},
          {"grain_snapshots", static_cast<double>(n_snapshots_)},
          {"min_IR", min_.redundancy},
          {"min_IR_depth", min_.depth},
          {"min_IR_time", min_.time}};
}
} // namespace isostat
