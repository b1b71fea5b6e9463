// SPDX-License-Identifier: BSD-3-Clause
#include "fem/libraries.hpp"

#include <deal.II/base/mpi.h>

namespace isostat
{
/// PETSc keeps the addresses of its arguments, so they live as long as it does.
struct Libraries::Session
{
  char name[8] = "isostat", *arguments[2] = {name, nullptr}, **first = arguments;
  int n_arguments = 1;
  dealii::Utilities::MPI::MPI_InitFinalize libraries{n_arguments, first, 1};
};

Libraries::Libraries() : session_(std::make_unique<Session>()) {}
Libraries::~Libraries() = default;

std::string finite_element_library() { return "deal.II " DEAL_II_PACKAGE_VERSION; }
} // namespace isostat
