// SPDX-License-Identifier: BSD-3-Clause
// A whole HDF5 file, damaged as the bytes of a fuzzer choose: values, types, shapes, links and attributes; it is still
// one that HDF5 takes.
#pragma once
#include "tests/fuzz/choices.hpp"

#include <string>
#include <vector>

namespace isostat::fuzz
{
/// A group or dataset, or one of its attributes.
struct Member
{
  std::string object, attribute; ///< no attribute: empty
};

class WholeHdf5
{
public:
  explicit WholeHdf5(std::string bytes);

  /// The bytes of a file with at least one member damaged.
  std::string damaged(Choices &choices) const;

private:
  std::string bytes_;
  std::vector<Member> members_;
};
} // namespace isostat::fuzz
