// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/block.hpp"

#include <deal.II/grid/tria.h>

#include <memory>

namespace isostat
{
/// What the material number of deal.II's cells says. It goes with a cell whichever rank has it and however cells are
/// numbered there.
struct CellMark
{
  unsigned number, layer; ///< in the whole mesh: as given, or from the base up, x fastest; of SoilProfile::layers

  unsigned packed(std::size_t n_layers) const { return number * static_cast<unsigned>(n_layers) + layer; }
  static CellMark of(unsigned packed, std::size_t n_layers)
  {
    const auto n = static_cast<unsigned>(n_layers);
    return {packed / n, packed % n};
  }
};

/// The cells of a block, as deal.II numbers them: from the base up in a column, else x fastest, or as given. Faces have
/// the numbers of boundary_id().   @param tied_sides  opposite sides are neighbours   @param shared_out  each rank gets
/// a part
/// @throws InputError  a degree, thickness, width, density or number of cells that cannot be; a given mesh of
///                     another dimension, or whose sides do not fit together where they are tied
/// tested: tests/fem/space/discretisation_test.cpp, given_mesh_test.cpp
template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> make_mesh(const MeshSpec &spec, bool tied_sides, bool shared_out,
                                                      MPI_Comm communicator);
} // namespace isostat
