// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <string>

namespace isostat
{
/// MPI, PETSc and p4est are up as long as this lives: the first line of a program that uses finite elements. deal.II
/// gets one thread per rank, PETSc no command line.   tested: by every test that links fem (tests/fem/main.cpp)
class Libraries
{
public:
  Libraries();
  ~Libraries();

private:
  struct Session;
  std::unique_ptr<Session> session_;
};

/// "deal.II 9.4.1": for the provenance of a result.
std::string finite_element_library();
} // namespace isostat
