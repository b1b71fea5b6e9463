// SPDX-License-Identifier: BSD-3-Clause
// The rows of a test that its summary is made of.   tested: tests/python/run_test.py
#pragma once
#include "base/record/recorder.hpp"
#include "dem/scene/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace isostat
{
/// Chosen columns of a history, row by row.
class HistoryRows
{
public:
  HistoryRows(std::vector<double> values, std::size_t n_columns) : values_(std::move(values)), n_columns_(n_columns) {}

  std::size_t n_rows() const { return values_.size() / n_columns_; }
  double operator()(std::size_t row, std::size_t column) const { return values_[row * n_columns_ + column]; }

private:
  std::vector<double> values_;
  std::size_t n_columns_;
};

/// The history of a test, from its file or from memory.
class RunHistory
{
public:
  RunHistory(const std::vector<RecordColumn> &columns, std::vector<std::vector<double>> rows);
  /// Of history.csv in the folder of a run.   @throws InputError  a column is missing, a damaged table
  static RunHistory read(const std::filesystem::path &folder, const Scene &scene);

  /// @param names  of columns: "p", "eps_y"   @pre they are there
  HistoryRows of(const std::vector<std::string> &names) const;

private:
  std::vector<std::string> names_;
  std::vector<std::vector<double>> rows_;
};
} // namespace isostat
