// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/solve/solver_state.hpp"

#include <filesystem>
#include <type_traits>

namespace isostat
{
/// All that a killed run of a column or a block needs to continue to the same bits.
struct ColumnCheckpoint
{
  SolverState state;
  std::map<std::string, double> numbers;              ///< rows written, largest values ...
  std::map<std::string, std::vector<double>> vectors; ///< largest values over the depth
  std::string scene;                                  ///< the resolved scene; a resumed run must have the same
  std::string instruction_set = {};                   ///< of the machine that wrote it; set by reading
  std::string file = {};                              ///< where it was read; not stored

  /// Stores and takes back what State::for_each(state, visit) visits with name and number.
  template <class State>
  void put(const State &state)
  {
    State::for_each(state, [&](const char *name, auto value) { numbers[name] = static_cast<double>(value); });
  }
  template <class State>
  void get(State &state) const
  {
    State::for_each(state, [&]<class Number>(const char *name, Number &value) {
      if constexpr (std::is_integral_v<Number>)
        value = count(name);
      else
        value = number(name);
    });
  }

  /// @throws InputError  the file lacks it
  double number(const std::string &name) const;
  std::size_t count(const std::string &name) const; ///< @throws InputError  no whole number either
  const std::vector<double> &vector(const std::string &name) const;
  /// @throws InputError  it has another length, too
  const std::vector<double> &vector(const std::string &name, std::size_t size) const;
};

/// A number of a checkpoint that counts; 0 without one.   @throws InputError  the file lacks it
inline std::size_t counter(const ColumnCheckpoint *checkpoint, const char *name)
{
  return checkpoint ? checkpoint->count(name) : 0;
}

/// As folder/last.h5 with folder/previous.h5 (base/record/checkpoint_folder.hpp).
/// @throws RunFailure  disk full, not writable: the older ones survive
void write_column_checkpoint(const std::filesystem::path &folder, const ColumnCheckpoint &checkpoint);

/// The newest that can be read.
/// @throws InputError when there is none, naming what is wrong with each
/// tested: tests/apps/soil_column_resume_test.py
ColumnCheckpoint read_column_checkpoint(const std::filesystem::path &folder);
} // namespace isostat
