// SPDX-License-Identifier: BSD-3-Clause
// The main of tests that use finite elements: MPI and PETSc are up while they run.
#include "fem/libraries.hpp"

#include <gmock/gmock.h>

int main(int argc, char **argv)
{
  const isostat::Libraries libraries;
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
