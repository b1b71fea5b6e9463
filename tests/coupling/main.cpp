// SPDX-License-Identifier: BSD-3-Clause
// The main of tests that use MPI: it is up while they run.
#include <gmock/gmock.h>
#include <mpi.h>

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  testing::InitGoogleMock(&argc, argv);
  const int result = RUN_ALL_TESTS();
  MPI_Finalize();
  return result;
}
