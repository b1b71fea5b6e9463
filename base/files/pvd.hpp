// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/dem/io/vtp_test.cpp
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace isostat
{
/// The list of (time, file) that ParaView opens as one animation (.pvd). Rewritten, aside and renamed, at each append.
class PvdCollection
{
public:
  /// @param path  of the .pvd; it appears with the first append
  /// @param resume_entries  how many of the entries in an existing file to keep; 0: start again. Those that no
  ///                        longer exist are left out, with a warning: a run does not end for a list of its files
  explicit PvdCollection(std::filesystem::path path, std::size_t resume_entries = 0);

  /// @param time  s
  /// @param file  path of the .vtp as seen from the folder of the .pvd, with its number at the end of the name
  void append(double time, const std::string &file);
  /// Those that were appended, listed or not.
  std::size_t n_entries() const { return n_lost_ + entries_.size(); }

private:
  std::filesystem::path path_;
  std::vector<std::pair<std::string, std::string>> entries_; ///< time as text, file
  std::size_t n_lost_ = 0;
};
} // namespace isostat
