// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/series_file.hpp"

#include "base/error.hpp"
#include "base/record/file_format.hpp"

#include <fmt/format.h>

namespace isostat
{
SeriesFile::SeriesFile(std::filesystem::path path, SeriesLayout layout, std::size_t resume_rows)
    : path_(std::move(path)), layout_(std::move(layout)), waiting_(layout_.series.size())
{
  if (resume_rows > 0)
    load(resume_rows);
  hdf5::File file = hdf5::File::create(path_);
  hdf5::Group root = file.root();
  set_format(root, layout_.format, layout_.version);
  for (const auto &constant : layout_.constants)
    root.write(constant.name, std::span(constant.values), constant.unit);
  root.create_series(layout_.of, layout_.unit);
  for (const auto &series : layout_.series)
    root.create_series(series.name, series.unit, series.width, std::max<std::size_t>(1, 4096 / series.width));
  append_waiting(root); // with what is kept in the same go: a kill here loses nothing
  file.commit();
  forget_waiting();
}

/// Takes the first rows of an existing file as rows still to be written.
void SeriesFile::load(std::size_t rows)
{
  const hdf5::File file = hdf5::File::open(path_);
  const hdf5::Group root = file.root();
  refuse_newer(root, layout_.version);
  if (const auto &places = layout_.constants.front(); root.read<double>(places.name) != places.values)
    throw InputError(
        fmt::format("{}: has another `{}`; resume with the scene of the first run", path_.string(), places.name));
  const auto read = [&](const std::string &name, std::size_t width) {
    std::vector<double> values = root.read<double>(name);
    if (values.size() < rows * width)
      throw InputError(fmt::format("{}: {} rows, the checkpoint expects {}; restore the file, resume from an earlier "
                                   "checkpoint, or start again with --overwrite",
                                   path_.string(), values.size() / width, rows));
    values.resize(rows * width);
    return values;
  };
  at_ = read(layout_.of, 1);
  for (std::size_t k = 0; k < waiting_.size(); ++k)
    waiting_[k] = read(layout_.series[k].name, layout_.series[k].width);
  n_rows_ = rows;
}

void SeriesFile::append(double at, std::span<const double> values)
{
  at_.push_back(at);
  for (std::size_t k = 0; k < waiting_.size(); ++k)
    {
      const std::span<const double> row = values.first(layout_.series[k].width);
      waiting_[k].insert(waiting_[k].end(), row.begin(), row.end());
      values = values.subspan(row.size());
    }
  ++n_rows_;
  if (n_rows_ - n_written_ > std::max<std::size_t>(256, n_written_ / 4))
    flush();
}

void SeriesFile::flush()
{
  if (at_.empty())
    return;
  hdf5::File file = hdf5::File::update(path_);
  append_waiting(file.root());
  file.commit();
  forget_waiting();
}

void SeriesFile::append_waiting(hdf5::Group root) const
{
  root.append(layout_.of, at_);
  for (std::size_t k = 0; k < waiting_.size(); ++k)
    root.append(layout_.series[k].name, waiting_[k]);
}

void SeriesFile::forget_waiting()
{
  n_written_ = n_rows_;
  at_.clear();
  for (std::vector<double> &values : waiting_)
    values.clear();
}

void SeriesFile::add(const char *name, std::span<const double> values, const char *unit)
{
  flush();
  hdf5::File file = hdf5::File::update(path_);
  file.root().write(name, values, unit);
  file.commit();
}
} // namespace isostat
