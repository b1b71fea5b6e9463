// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/io/specimen_library.hpp"

#include <filesystem>
#include <optional>

namespace isostat
{
/// A specimen brought to its stress in situ, for the cache.
struct InSituState
{
  std::string recipe;            ///< in_situ_recipe()
  std::string source;            ///< entry of the library it came from; may be empty
  std::vector<std::byte> packed; ///< bring_to_stress()
};

/// States as bytes, for another rank.   @throws InputError  from append_states(): the bytes are not those of to_bytes()
std::vector<std::byte> to_bytes(const std::vector<InSituState> &states);
void append_states(std::vector<InSituState> &states, std::span<const std::byte> bytes);

/// Specimens at their stress in situ, kept from run to run: a specimen library (specimen_library.hpp) whose entries are
/// named by a hash of their recipe, which is in `provenance` and is compared as well. Any entry can be the specimen
/// of an element test.
/// tested: tests/coupling/in_situ/in_situ_start_test.cpp
class InSituCache
{
public:
  /// @param path  need not exist; empty: nothing is kept. A damaged one counts as empty.
  /// @throws InputError  another kind of file, or newer than the program
  explicit InSituCache(std::filesystem::path path);

  std::optional<Snapshot> find(const std::string &recipe) const;
  /// Adds what does not exist yet, aside and renamed. A damaged file is kept with the ending ".damaged", and a line on
  /// stderr says so. So does one that cannot be written, which is as before: the run has its states.
  void add(const std::vector<InSituState> &states) const;

private:
  void write(const std::vector<InSituState> &states) const;

  std::filesystem::path path_;
  std::vector<LibraryEntry> entries_;
};
} // namespace isostat
