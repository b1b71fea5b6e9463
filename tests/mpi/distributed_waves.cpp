// SPDX-License-Identifier: BSD-3-Clause
// A block of saturated soil of two layers, shaken, on one mesh over all ranks: prints what must not depend on their
// number. Run by tests/mpi/ranks_test.py.
#include "fem/libraries.hpp"
#include "fem/solve/dynamics.hpp"
#include "tests/support/columns.hpp"

#include <cstdio>

namespace
{
using namespace isostat;

/// A value that one rank has, on all of them.
double shared(double value, bool mine)
{
  double sum = mine ? value : 0.0;
  MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return sum;
}

template <int dim>
void run(Drainage drainage, double saturation = 1, const std::vector<Refinement> &refine = {})
{
  MeshSpec mesh{.soil = {.layers = {{.name = "soft", .thickness = 4, .permeability = 1e-3, .cells = 3},
                                    {.name = "stiff", .thickness = 6, .permeability = 1e-4, .cells = 3}},
                         .water = {}},
                .width = {4, 3},
                .cells_across = {2, 2},
                .refine = refine};
  if (saturation < 1)
    {
      mesh.soil.layers[1].saturation = saturation;
      mesh.soil.water.air = AirLaw::boyle;
    }
  const Discretisation<dim> space(mesh, shaken_supports(false), MPI_COMM_WORLD);
  Elastic material({.shear_modulus = 5e7, .poisson_ratio = 0.25}, space.n_points());
  DynamicsSettings settings{.time_step = refine.empty() ? 5e-4 : 2e-4, .drainage = drainage};
  for (int axis = 0; axis < 3; ++axis)
    settings.motion[axis] = refine.empty() ? ricker_motion(1 - 0.2 * axis, 15 + axis, 0.1, 1e-3)
                                           : ricker_motion(1 - 0.2 * axis, 60 + axis, 0.02, 1e-3);
  Dynamics run(space, material, settings);
  for (int k = 0; k < (refine.empty() ? 400 : 100); ++k)
    run.step();
  const long top = space.find_dof({0, 0, 10}, 0), middle = space.find_pressure({0, 0, 6});
  const auto at = [](const Vector &v, long i) { return shared(i < 0 ? 0 : v.local_element(i), i >= 0); };
  const double u = at(run.displacement(), top), p = at(run.pressure(), middle), norm = run.displacement().l2_norm();
  const DynamicsEnergy energy = run.energy();
  const unsigned long mine = space.n_cells();
  unsigned long cells = 0, fewest = 0;
  MPI_Allreduce(&mine, &cells, 1, MPI_UNSIGNED_LONG, MPI_SUM, MPI_COMM_WORLD);
  MPI_Allreduce(&mine, &fewest, 1, MPI_UNSIGNED_LONG, MPI_MIN, MPI_COMM_WORLD);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0)
    {
      std::printf("cells %lu %lu\n", cells, fewest);
      std::printf("%d %.17g %.17g %.17g %.17g %.17g\n", dim, u, p, norm, energy.kinetic, energy.internal);
    }
}
} // namespace

int main()
{
  const Libraries libraries;
  run<2>(Drainage::coupled);
  run<3>(Drainage::coupled);
  run<3>(Drainage::dry);
  run<2>(Drainage::coupled, 0.98);
  const std::vector<Refinement> band_and_core = {{{-1, -1, 3}, {9, 9, 7}, 1}, {{0.8, 0.6, 4}, {3.2, 2.4, 6}, 2}};
  run<3>(Drainage::coupled, 1, band_and_core);
}
