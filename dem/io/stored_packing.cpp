// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/stored_packing.hpp"

#include "base/record/file_format.hpp"
#include "dem/io/snapshot_file.hpp"
#include "dem/io/specimen_library.hpp"
#include "dem/measure/stress.hpp"
#include "dem/measure/summary.hpp"

#include <cmath>

namespace isostat
{
void count_from_here(Snapshot &state)
{
  state.strain.setZero();
  state.time = 0;
  state.step = 0;
}

void add_figures(Specimen &specimen)
{
  const Snapshot &state = specimen.state;
  const Micromechanics m = micromechanics(state);
  auto &numbers = specimen.numbers;
  numbers["void_ratio"] = m.void_ratio;
  numbers["pressure_Pa"] = m.wall.p;
  numbers["grains"] = static_cast<double>(state.grains.n_grains());
  numbers["coordination"] = m.network.coordination_number();
  numbers["coordination_mechanical"] = m.network.mechanical_coordination_number();
  numbers["redundancy_index"] = m.network.redundancy_index();
  numbers["unbalanced_force"] = m.unbalanced;
  numbers["d50_m"] = state.grains.d50();
  if (state.cell)
    {
      const Vec3 stress = -contact_stress(state).diagonal();
      numbers["vertical_stress_Pa"] = stress[1];
      numbers["K0"] = 0.5 * (stress[0] + stress[2]) / stress[1];
    }
  std::erase_if(numbers,
                [](const auto &number) { return !std::isfinite(number.second); }); // of grains that do not touch
}

Specimen read_stored_packing(const std::filesystem::path &path, const std::string &entry)
{
  if (!entry.empty() || is_specimen_library(path))
    return read_library_entry(path, entry);
  const hdf5::File file = hdf5::File::open(path);
  if (format_of(file.root()) != "isostat-snapshot")
    return read_specimen(path);
  Specimen specimen = read_specimen(file.root());
  specimen.provenance["recipe"] = "snapshot " + path.string();
  count_from_here(specimen.state);
  return specimen;
}
} // namespace isostat
