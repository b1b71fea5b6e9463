// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/recorder.hpp"

#include "base/error.hpp"
#include "base/files/hdf5.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/file_format.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
const std::string history_format = "isostat-history";
constexpr std::uint64_t history_schema_version = 1;
} // namespace

Recorder::Recorder(const fs::path &folder, std::vector<RecordColumn> columns, std::size_t resume_rows,
                   const std::string &scene)
    : csv_(folder / "history.csv"), hdf5_(folder / "history.h5"), columns_(std::move(columns)), n_rows_(resume_rows)
{
  assert(!columns_.empty());
  for ([[maybe_unused]] const RecordColumn &column : columns_)
    assert(!column.name.empty() && (column.name + column.unit).find_first_of(",\n\r") == std::string::npos &&
           column.name.find('/') == std::string::npos);
  make_folder(folder);
  if (resume_rows == 0)
    start_anew(scene);
  else
    resume();
}

Recorder::~Recorder()
{
  try
    {
      flush();
    }
  catch (const std::exception &)
    {}
}

std::string Recorder::header() const
{
  std::string line;
  for (const RecordColumn &column : columns_)
    line += fmt::format("{}{} ({})", line.empty() ? "" : ",", column.name, column.unit.empty() ? "-" : column.unit);
  return line + "\n";
}

void Recorder::start_anew(const std::string &scene)
{
  write_replacing(csv_, header());
  csv_bytes_ = header().size();
  hdf5::File file = hdf5::File::create(hdf5_);
  set_format(file.root(), history_format, history_schema_version, scene);
  hdf5::Group series = file.root().create_group("history");
  for (const RecordColumn &column : columns_)
    series.create_series(column.name, column.unit.empty() ? "-" : column.unit);
  file.commit();
}

std::uintmax_t Recorder::bytes_of_lines() const
{
  // line by line: a history of days is larger than the run that goes on with it
  std::ifstream in(csv_, std::ios::binary);
  std::string line;
  std::getline(in, line);
  if (in.eof() || line + "\n" != header())
    throw InputError(
        fmt::format("{}: found the header \"{}\", expected \"{}\"; resume with the columns of the first run, or "
                    "start anew in another folder",
                    csv_.string(), line, header().substr(0, header().size() - 1)));
  std::uintmax_t end = header().size();
  for (std::size_t row = 0; row < n_rows_; ++row)
    {
      std::getline(in, line);
      if (in.eof() || !in)
        throw InputError(fmt::format("{}: {} whole rows, the checkpoint expects {}; restore the file or resume from an "
                                     "earlier checkpoint",
                                     csv_.string(), row, n_rows_));
      end += line.size() + 1;
    }
  return end;
}

void Recorder::resume()
{
  csv_bytes_ = bytes_of_lines(); // both files are judged before one is changed
  resume_hdf5();
  std::error_code error;
  fs::resize_file(csv_, csv_bytes_, error);
  if (error)
    throw RunFailure(fmt::format("{}: cannot be cut to {} rows: {}; check its permissions", csv_.string(), n_rows_,
                                 error.message()));
}

void Recorder::resume_hdf5()
{
  hdf5::File file = hdf5::File::update(hdf5_);
  refuse_newer(file.root(), history_schema_version);
  if (!file.root().has("history"))
    throw InputError(fmt::format("{}: no group \"history\"; restore the file or start the run anew", hdf5_.string()));
  hdf5::Group series = file.root().group("history");
  if (series.names().size() != columns_.size())
    throw InputError(fmt::format("{}: {} columns, expected {}; resume with the columns of the first run",
                                 hdf5_.string(), series.names().size(), columns_.size()));
  for (const RecordColumn &column : columns_)
    {
      const std::size_t rows = series.has(column.name) ? series.shape(column.name)[0] : 0;
      if (rows < n_rows_)
        throw InputError(
            fmt::format("{}: column \"{}\" has {} rows, the checkpoint expects {}; restore the file or resume "
                        "from an earlier checkpoint",
                        hdf5_.string(), column.name, rows, n_rows_));
      series.resize(column.name, n_rows_);
    }
  file.commit();
  n_rows_in_hdf5_ = n_rows_;
}

void Recorder::append(std::span<const double> row)
{
  assert(row.size() == columns_.size());
  for (std::size_t c = 0; c < row.size(); ++c)
    fmt::format_to(std::back_inserter(waiting_lines_), "{:.10g}{}", row[c], c + 1 < row.size() ? ',' : '\n');
  waiting_.insert(waiting_.end(), row.begin(), row.end());
  ++n_rows_;
  if (++n_waiting_lines_ >= rows_per_line_flush)
    flush_lines();
  if (n_rows_ - n_rows_in_hdf5_ > std::max<std::size_t>(4096, n_rows_in_hdf5_ / 4))
    flush_hdf5();
}

void Recorder::flush()
{
  flush_lines();
  sync_to_disk(csv_); // a checkpoint that counts its rows may follow
  flush_hdf5();
}

void Recorder::flush_lines()
{
  if (waiting_lines_.empty())
    return;
  errno = 0;
  std::ofstream out(csv_, std::ios::binary | std::ios::app);
  out.write(waiting_lines_.data(), static_cast<std::streamsize>(waiting_lines_.size()));
  out.close();
  if (!out)
    {
      const std::string reason = std::strerror(errno);
      std::error_code ignored;
      fs::resize_file(csv_, csv_bytes_, ignored);
      throw RunFailure(
          fmt::format("{}: rows cannot be added: {}; check free space and permissions", csv_.string(), reason));
    }
  csv_bytes_ += waiting_lines_.size();
  waiting_lines_.clear();
  n_waiting_lines_ = 0;
}

void Recorder::flush_hdf5()
{
  if (waiting_.empty())
    return;
  hdf5::File file = hdf5::File::update(hdf5_);
  hdf5::Group series = file.root().group("history");
  std::vector<double> values(n_rows_ - n_rows_in_hdf5_);
  for (std::size_t c = 0; c < columns_.size(); ++c)
    {
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = waiting_[i * columns_.size() + c];
      series.append(columns_[c].name, values);
    }
  file.commit();
  n_rows_in_hdf5_ = n_rows_;
  waiting_.clear();
}
} // namespace isostat
