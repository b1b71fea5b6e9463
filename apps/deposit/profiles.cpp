// SPDX-License-Identifier: BSD-3-Clause
// Profiles over the depth in an HDF5 file.
#include "apps/deposit/output.hpp"

#include "base/error.hpp"
#include "base/files/hdf5.hpp"
#include "base/record/file_format.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
const std::string profiles_format = "isostat-column-profiles";
constexpr std::uint64_t profiles_schema_version = 1;
} // namespace

ProfileFile::ProfileFile(std::filesystem::path path, std::vector<double> depths, std::span<const double> sigma_v0,
                         std::span<const double> shear_velocity, std::size_t resume_rows, const Further &further)
    : path_(std::move(path)), depths_(std::move(depths))
{
  for (const auto &[name, unit] : point_columns)
    series_.push_back({name, unit, depths_.size()});
  series_.insert(series_.end(), further.series.begin(), further.series.end());
  waiting_.resize(series_.size());
  if (resume_rows > 0)
    load(resume_rows);
  hdf5::File file = hdf5::File::create(path_);
  hdf5::Group root = file.root();
  set_format(root, profiles_format, profiles_schema_version);
  root.write("depth", std::span<const double>(depths_), "m");
  root.write("sigma_v0", sigma_v0, "Pa");
  root.write("shear_velocity", shear_velocity, "m/s");
  for (const Constant &constant : further.constants)
    root.write(constant.name, std::span(constant.values), constant.unit);
  root.create_series("time", "s");
  for (const Series &series : series_)
    root.create_series(series.name, series.unit, series.width, std::max<std::size_t>(1, 4096 / series.width));
  append_waiting(root); // with what is kept in the same go: a kill here loses nothing
  file.commit();
  forget_waiting();
}

/// Takes the first rows of a file that is there as rows still to be written.
void ProfileFile::load(std::size_t rows)
{
  const hdf5::File file = hdf5::File::open(path_);
  const hdf5::Group root = file.root();
  refuse_newer(root, profiles_schema_version);
  if (root.read<double>("depth") != depths_)
    throw InputError(fmt::format("{}: has other depths; resume with the scene of the first run", path_.string()));
  times_ = root.read<double>("time");
  if (times_.size() < rows)
    throw InputError(fmt::format("{}: {} rows, the checkpoint expects {}; restore the file or resume from an earlier "
                                 "checkpoint",
                                 path_.string(), times_.size(), rows));
  times_.resize(rows);
  for (std::size_t k = 0; k < series_.size(); ++k)
    {
      waiting_[k] = root.read<double>(series_[k].name);
      waiting_[k].resize(rows * series_[k].width);
    }
  n_rows_ = rows;
}

void ProfileFile::append(double time, std::span<const double> values)
{
  times_.push_back(time);
  auto from = values.begin();
  for (std::size_t k = 0; k < series_.size(); ++k)
    {
      const auto to = from + static_cast<std::ptrdiff_t>(series_[k].width);
      waiting_[k].insert(waiting_[k].end(), from, to);
      from = to;
    }
  ++n_rows_;
  if (n_rows_ - n_written_ > std::max<std::size_t>(256, n_written_ / 4))
    flush();
}

void ProfileFile::flush()
{
  if (times_.empty())
    return;
  hdf5::File file = hdf5::File::update(path_);
  append_waiting(file.root());
  file.commit();
  forget_waiting();
}

void ProfileFile::append_waiting(hdf5::Group root) const
{
  root.append("time", times_);
  for (std::size_t k = 0; k < series_.size(); ++k)
    root.append(series_[k].name, waiting_[k]);
}

void ProfileFile::forget_waiting()
{
  n_written_ = n_rows_;
  times_.clear();
  for (std::vector<double> &values : waiting_)
    values.clear();
}

void ProfileFile::add(const char *name, std::span<const double> values, const char *unit)
{
  flush();
  hdf5::File file = hdf5::File::update(path_);
  file.root().write(name, values, unit);
  file.commit();
}
} // namespace isostat
