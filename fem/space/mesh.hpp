// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/block.hpp"

#include <deal.II/grid/tria.h>

#include <memory>

namespace isostat
{
/// The cells of a block, as deal.II numbers them: from the base up in a column, else x fastest. Faces have the numbers
/// of boundary_id().   @param tied_sides  opposite sides are neighbours   @param shared_out  each rank gets a part
/// @throws InputError  a degree, thickness, width, density or number of cells that cannot be tested:
/// tests/fem/space/discretisation_test.cpp
template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> make_mesh(const MeshSpec &spec, bool tied_sides, bool shared_out,
                                                      MPI_Comm communicator);
} // namespace isostat
