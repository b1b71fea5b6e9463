// SPDX-License-Identifier: BSD-3-Clause
// Bytes as a packing of another program (LAMMPS, VTP, text of YADE, CSV, plain or gzipped): grains that are taken have
// a size, and come back from a text of spheres with the same bits.
#include "dem/io/packing_files.hpp"
#include "tests/fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
  using namespace isostat;
  const fuzz::MemoryFile file(fuzz::text_of(data, size));
  const ReadOptions options;
  const auto packing = fuzz::accepted([&] { return read_foreign_packing(file.path(), options); });
  if (!packing)
    return 0;
  const Packing &grains = packing->state.grains;
  fuzz::require(grains.n_grains() > 0 && grains.min_radius() > 0, "there are grains, and they have a size");
  const fuzz::MemoryFile text(sphere_text(packing->state));
  const ForeignPacking again = read_sphere_text(text.path(), options);
  fuzz::require(again.state.grains.position == grains.position, "a text of spheres keeps them");
  return 0;
}
