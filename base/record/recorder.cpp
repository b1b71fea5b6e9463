// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/recorder.hpp"

#include "base/error.hpp"
#include "base/files/hdf5.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/file_format.hpp"
#include "base/tell.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <iterator>
#include <ostream>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
void add_number(std::string &lines, double x, bool last_of_row)
{
  fmt::format_to(std::back_inserter(lines), "{:.10g}{}", x, last_of_row ? '\n' : ',');
}

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
    resume(scene);
}

Recorder::~Recorder()
{
  try
    {
      if (!waiting_.empty() || !waiting_lines_.empty()) // else all is on the disk
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

hdf5::File Recorder::empty_history(const std::string &scene) const
{
  hdf5::File file = hdf5::File::create(hdf5_);
  set_format(file.root(), history_format, history_schema_version, scene);
  hdf5::Group series = file.root().create_group("history");
  for (const RecordColumn &column : columns_)
    series.create_series(column.name, column.unit.empty() ? "-" : column.unit);
  return file;
}

void Recorder::start_anew(const std::string &scene)
{
  write_replacing(csv_, header());
  csv_bytes_ = header().size();
  empty_history(scene).commit();
}

/// @throws InputError  it has other columns, or fewer rows
void Recorder::check(const hdf5::Group &root, std::size_t n_rows) const
{
  refuse_newer(root, history_schema_version);
  if (!root.has("history"))
    throw InputError(fmt::format("{}: no group \"history\"; restore the file or start the run again", hdf5_.string()));
  const hdf5::Group series = root.group("history");
  if (series.names().size() != columns_.size())
    throw InputError(fmt::format("{}: {} columns, expected {}; resume with the columns of the first run",
                                 hdf5_.string(), series.names().size(), columns_.size()));
  for (const RecordColumn &column : columns_)
    {
      const hdf5::Shape shape = series.has(column.name) ? series.shape(column.name) : hdf5::Shape{0};
      if (shape.size() != 1 || shape[0] < n_rows)
        throw InputError(fmt::format(
            "{}: column \"{}\" has the shape {}, the checkpoint expects {} rows; restore the file or resume "
            "from an earlier checkpoint",
            hdf5_.string(), column.name, shape, n_rows));
    }
}

template <class Use>
void Recorder::for_each_block(std::size_t n_rows, const Use &use) const
{
  constexpr std::size_t n_block = 4096; // a history of days is larger than the run that continues with it
  const hdf5::File file = hdf5::File::open(hdf5_);
  const hdf5::Group series = file.root().group("history");
  std::vector<std::vector<double>> block(columns_.size());
  for (std::size_t first = 0; first < n_rows; first += n_block)
    {
      for (std::size_t c = 0; c < block.size(); ++c)
        block[c] = series.rows(columns_[c].name, first, std::min(n_block, n_rows - first));
      use(block);
    }
}

void Recorder::resume(const std::string &scene)
{
  std::error_code ignored;
  if (fs::is_directory(csv_, ignored))
    throw InputError(fmt::format("{}: is a folder in place of a file; remove it", csv_.string()));
  check(hdf5::File::open(hdf5_).root(), n_rows_);
  hdf5::File file = empty_history(scene);
  hdf5::Group series = file.root().group("history");
  for_each_block(n_rows_, [&](const auto &block) {
    for (std::size_t c = 0; c < block.size(); ++c)
      series.append(columns_[c].name, block[c]);
  });
  file.commit();
  n_rows_in_hdf5_ = n_rows_;
  copy_to_csv();
}

void Recorder::copy_to_csv()
{
  std::uintmax_t n_bytes = 0;
  write_replacing(csv_, [&](std::ostream &out) {
    std::string lines = header();
    const auto write = [&] {
      out << lines;
      n_bytes += lines.size();
      lines.clear();
    };
    for_each_block(n_rows_in_hdf5_, [&](const auto &block) {
      for (std::size_t i = 0; i < block[0].size(); ++i)
        for (std::size_t c = 0; c < block.size(); ++c)
          add_number(lines, block[c][i], c + 1 == block.size());
      write();
    });
    write();
  });
  csv_bytes_ = n_bytes;
}

/// What the run has written, and needs again, was changed by others: no fault of its input.
template <typename Work>
void Recorder::with_own_file(const Work &work) const
{
  try
    {
      work();
    }
  catch (const InputError &error)
    {
      throw RunFailure(fmt::format("{}\n  It was whole when this run wrote it, and another program has removed or "
                                   "changed it since. Put it back and continue with --resume, or start again with "
                                   "--overwrite.",
                                   error.what()));
    }
}

void Recorder::mend_csv()
{
  waiting_lines_.clear();
  n_waiting_lines_ = 0;
  flush_hdf5();
  with_own_file([&] { copy_to_csv(); });
  warn(fmt::format("{} was removed or changed while the run writes it; it has been written again from {}",
                   csv_.string(), hdf5_.string()));
}

void Recorder::append(std::span<const double> row)
{
  assert(row.size() == columns_.size());
  for (std::size_t c = 0; c < row.size(); ++c)
    if (!std::isfinite(row[c]))
      throw RunFailure(fmt::format("{}: {} = {} in row {}; the run has gone wrong, or continued from a damaged "
                                   "checkpoint. Take shorter steps, or start again with --overwrite.",
                                   csv_.string(), columns_[c].name, row[c], n_rows_ + 1));
  for (std::size_t c = 0; c < row.size(); ++c)
    {
      waiting_.push_back(row[c] + 0.0); // -0 becomes 0
      add_number(waiting_lines_, waiting_.back(), c + 1 == row.size());
    }
  ++n_rows_;
  if (++n_waiting_lines_ >= rows_per_line_flush || since_lines_.seconds() > seconds_per_line_flush)
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
  since_lines_.restart();
  std::error_code error;
  if (fs::file_size(csv_, error) != csv_bytes_)
    return mend_csv();
  if (waiting_lines_.empty())
    return;
  errno = 0;
  std::ofstream out(csv_, std::ios::binary | std::ios::app);
  if (!out && errno == EACCES) // the file is not ours any more, the folder may be
    return mend_csv();
  out.write(waiting_lines_.data(), static_cast<std::streamsize>(waiting_lines_.size()));
  out.close();
  if (!out)
    {
      const std::string reason = std::strerror(errno);
      fs::resize_file(csv_, csv_bytes_, error);
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
  with_own_file([&] { append_to_hdf5(); });
  n_rows_in_hdf5_ = n_rows_;
  waiting_.clear();
}

void Recorder::append_to_hdf5() const
{
  hdf5::File file = hdf5::File::update(hdf5_);
  check(file.root(), n_rows_in_hdf5_);
  hdf5::Group series = file.root().group("history");
  std::vector<double> values(n_rows_ - n_rows_in_hdf5_);
  for (std::size_t c = 0; c < columns_.size(); ++c)
    {
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = waiting_[i * columns_.size() + c];
      series.resize(columns_[c].name, n_rows_in_hdf5_);
      series.append(columns_[c].name, values);
    }
  file.commit();
}
} // namespace isostat
