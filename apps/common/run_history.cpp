// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/run_history.hpp"

#include "apps/common/run_output.hpp"
#include "base/error.hpp"
#include "base/files/csv_table.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
RunHistory::RunHistory(const std::vector<RecordColumn> &columns, std::vector<std::vector<double>> rows)
    : rows_(std::move(rows))
{
  for (const RecordColumn &column : columns)
    names_.push_back(column.name);
}

RunHistory RunHistory::read(const std::filesystem::path &folder, const Scene &scene)
{
  const std::vector<RecordColumn> columns = history_columns(scene);
  std::vector<std::string> names;
  for (const auto &[name, unit] : columns)
    names.push_back(fmt::format("{} ({})", name, unit));
  const CsvTable table(folder / "history.csv", names);
  std::vector<std::vector<double>> rows(table.n_rows(), std::vector<double>(columns.size()));
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (std::size_t column = 0; column < columns.size(); ++column)
      rows[row][column] = table(row, column);
  return {columns, std::move(rows)};
}

HistoryRows RunHistory::of(const std::vector<std::string> &names) const
{
  std::vector<std::size_t> places;
  for (const std::string &name : names)
    {
      places.push_back(static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin()));
      if (places.back() == names_.size())
        throw InputError(fmt::format("a history without the column {}", name));
    }
  std::vector<double> values;
  for (const std::vector<double> &row : rows_)
    for (const std::size_t place : places)
      values.push_back(row[place]);
  return {std::move(values), names.size()};
}
} // namespace isostat
