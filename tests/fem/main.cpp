// SPDX-License-Identifier: BSD-3-Clause
// The main of tests that use deal.II: MPI and PETSc are up while they run.
#include <gmock/gmock.h> // before deal.II, which has a macro Assert

#include <deal.II/base/mpi.h>

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
