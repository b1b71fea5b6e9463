// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/convert.hpp"

#include "base/error.hpp"
#include "dem/prepare/packing_check.hpp"
#include "dem/scene/scene.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// The domain that the user names instead of what the file says.
void set_domain(Snapshot &s, const std::string &file, const std::string &domain)
{
  if (domain.empty() || domain == (s.cell ? "periodic-cell" : "rigid-box"))
    return;
  if (domain != "periodic-cell")
    throw InputError(
        fmt::format("{}: domain {}; expected periodic-cell, which it has: grains reach through the faces of "
                    "a cell, where a box has walls. Leave it out.",
                    file, domain));
  s.cell.emplace();
  s.cell->edges = s.box.edges().asDiagonal();
  s.cell->reference_volume = s.box.volume();
  s.wall_contacts.clear();
}

std::vector<std::string> checked(const Snapshot &state, const std::string &file, const ConvertOptions &options)
{
  const double largest = options.metres_named ? largest_radius : largest_radius_of_file;
  try
    {
      return check_packing(
          state, file, [](const std::string &unit) { return "give --length-unit " + unit; }, largest);
    }
  catch (const InputError &error)
    {
      if (!options.anyway)
        throw;
      return {error.what()};
    }
}

void note_density(double is, const ConvertOptions &options, std::vector<std::string> &notes)
{
  if (options.density_named && std::abs(is / options.read.density - 1) > 1e-3)
    notes.push_back(
        fmt::format("The file says a grain density of {:g} kg/m3, which is taken: {:g} kg/m3 has no effect.", is,
                    options.read.density));
}
} // namespace

CheckedPacking read_any_packing(const std::string &file, const ConvertOptions &options)
{
  const SpecimenPlace place = specimen_place(file);
  if (std::filesystem::path(place.path).extension() == ".h5")
    {
      if (options.read.scale != 1)
        throw InputError(fmt::format("{}: a file of Isostat is in SI and holds forces; expected a scale of 1", file));
      CheckedPacking packing{read_stored_packing(place.path, place.entry), {}};
      set_domain(packing.specimen.state, file, options.domain);
      note_density(packing.specimen.state.grains.density, options, packing.notes);
      return packing;
    }
  ReadOptions how = options.read;
  how.domain = options.domain;
  ForeignPacking read = read_foreign_packing(file, how);
  set_domain(read.state, file, options.domain);
  CheckedPacking packing{{read.state, {{"recipe", "converted from " + file}}, {}}, read.notes};
  for (const std::string &warning : checked(read.state, file, options))
    packing.notes.push_back(warning);
  note_density(read.state.grains.density, options, packing.notes);
  packing.specimen.numbers = {{"grains", static_cast<double>(read.state.grains.n_grains())},
                              {"d50_m", read.state.grains.d50()},
                              {"void_ratio", void_ratio(read.state.volume(), read.state.grains.solid_volume())}};
  return packing;
}
} // namespace isostat
