// SPDX-License-Identifier: BSD-3-Clause
// What isostat.packings, which reads and writes files of other programs, takes from C++.
// tested: tests/python/packings_test.py, tests/apps/convert_test.py
#include "base/error.hpp"
#include "base/files/replace_file.hpp"
#include "base/units.hpp"
#include "dem/io/stored_packing.hpp"
#include "dem/io/text_tables.hpp"
#include "dem/prepare/packing_check.hpp"
#include "dem/prepare/space_filling.hpp"
#include "dem/scene/scene.hpp"
#include "python/binding/binding.hpp"
#include "python/binding/given.hpp"

#include <pybind11/functional.h>

namespace isostat::python
{
namespace
{
/// In SI.
double quantity(const std::string &text, const std::string &dimension)
{
  const Dimension kind = dimension == "length"     ? Dimension::length
                         : dimension == "pressure" ? Dimension::pressure
                                                   : Dimension::density;
  return parse_quantity(text, kind).value;
}

Specimen read_stored(const std::string &file)
{
  const SpecimenPlace place = specimen_place(file);
  return read_stored_packing(place.path, place.entry);
}

/// A packing from a file of another program.
Specimen converted(const Snapshot &state, const std::string &file)
{
  return {state,
          {{"recipe", "converted from " + file}},
          {{"grains", static_cast<double>(state.grains.n_grains())},
           {"d50_m", state.grains.d50()},
           {"void_ratio", void_ratio(state.volume(), state.grains.solid_volume())}}};
}

/// In the domain that the user names; empty: as it is.   @throws InputError  walls for a cell
Specimen with_domain(Specimen specimen, const std::string &file, const std::string &domain)
{
  Snapshot &s = specimen.state;
  if (domain.empty() || domain == (s.cell ? "periodic-cell" : "rigid-box"))
    return specimen;
  if (domain != "periodic-cell")
    throw InputError(
        fmt::format("{}: domain {}; expected periodic-cell, which it has: grains reach through the faces of "
                    "a cell, where a box has walls. Leave it out.",
                    file, domain));
  s.cell = PeriodicCell::with_edges(s.box.edges());
  s.wall_contacts.clear();
  return specimen;
}

Specimen along_curve(Specimen specimen)
{
  specimen.state = sorted_along_curve(specimen.state);
  return specimen;
}
} // namespace

void bind_packings(py::module_ &module)
{
  module.def("_speak_as_command", &speak_as_command);
  module.def("_in_python", &in_python);
  module.def("_quantity", &quantity);
  module.def("_read_stored", &read_stored);
  module.def("_converted", &converted);
  module.def("_with_domain", &with_domain);
  module.def("_along_curve", &along_curve);
  module.def("_check_packing",
             [](const Snapshot &snapshot, const std::string &file, const ScalingRemedy &remedy, bool metres_named) {
               return check_packing(snapshot, file, remedy, metres_named ? largest_radius : largest_radius_of_file);
             });
  module.def("_figures", [](const Snapshot &s) { return figures_text(packing_figures(s), s); });
  module.def("_import_tables", &import_tables, py::arg("folder"), py::arg("law") = Law(), py::kw_only(),
             py::arg("density"));
  module.def("_write_replacing",
             [](const std::filesystem::path &path, const std::string &text) { write_replacing(path, text); });
}
} // namespace isostat::python
