// SPDX-License-Identifier: BSD-3-Clause
// Consolidation of Cryer's sphere, 4 N^3 elements of degree 2 for an octant, by a split of displacements and
// pressures: the load at once, then steps of T = 0.01. What the linear solutions cost, and the error of the pressure in
// the middle.
// Prints a row of a table. consolidation_3d.py runs it for several sizes and ranks.
//
//   [mpirun -n RANKS] consolidation_3d N [STEPS [OPTIONS]]
#include "base/stopwatch.hpp"
#include "fem/libraries.hpp"
#include "tests/support/cryers_sphere.hpp"

#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <limits>
#include <sys/resource.h>

int main(int argc, char **argv)
{
  using namespace isostat;
  const Libraries libraries;
  const unsigned n = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 4;
  const unsigned steps = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 2;
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const Stopwatch watch;
  test::CryersSphere sphere(n, argc > 3 ? argv[3] : "-statics_pc_type fieldsplit", MPI_COMM_WORLD,
                            std::numeric_limits<double>::infinity());
  const double set_up = watch.seconds();
  sphere.statics.step_undrained();
  for (unsigned k = 0; k < steps; ++k)
    sphere.statics.step(0.01 * sphere.seconds);
  const LinearEffort effort = sphere.statics.linear_effort();
  const double error = sphere.pressure() - (steps == 0 ? 1 : sphere.exact(0.01 * steps));
  rusage use = {};
  getrusage(RUSAGE_SELF, &use);
  double of_ranks[2] = {static_cast<double>(use.ru_utime.tv_sec + use.ru_stime.tv_sec), use.ru_maxrss / 1e6};
  MPI_Allreduce(MPI_IN_PLACE, of_ranks, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  if (rank == 0)
    fmt::print("| {} | {} | {} | {} | {:.1f}, {} | {:.0f}, {:.0f} | {:.0f} | {:.1f} | {:.1e} |\n", 4 * n * n * n,
               sphere.space.displacement_vector().size() + sphere.space.pressure_vector().size(), ranks, effort.solves,
               static_cast<double>(effort.iterations) / static_cast<double>(effort.solves), effort.most, set_up,
               watch.seconds(), of_ranks[0], of_ranks[1], error);
}
