// SPDX-License-Identifier: BSD-3-Clause
// Packings in and out.   tested: tests/python/snapshot_test.py
#include "dem/io/snapshot_file.hpp"
#include "dem/io/specimen_library.hpp"
#include "dem/io/text_tables.hpp"
#include "dem/io/vtp.hpp"
#include "dem/scene/scene.hpp"
#include "python/binding/binding.hpp"

namespace isostat::python
{
namespace
{
Snapshot read_stored(const std::string &path) { return read_snapshot_file(path); }
} // namespace

void bind_files(py::module_ &module)
{
  py::class_<Specimen>(module, "Specimen", "A prepared packing with the story of how it was made.")
      .def(py::init([](const Snapshot &state) {
             return Specimen{state, {}, {}};
           }),
           py::arg("snapshot"))
      .def_property_readonly(
          "snapshot", [](const Specimen &s) { return std::make_shared<Snapshot>(s.state); }, "A copy of the packing.")
      .def_readonly("provenance", &Specimen::provenance, "Title, recipe, versions: text.")
      .def_readonly("numbers", &Specimen::numbers, "Void ratio, relative density, pressure (Pa), seed ... by name.");
  module.def("read_snapshot", &read_stored, py::arg("path"), "A snapshot_*.h5 of a run, or the packing of a specimen.");
  module.def(
      "read_specimen",
      [](const std::string &file) {
        const SpecimenPlace place = specimen_place(file);
        return place.entry.empty() ? read_specimen(std::filesystem::path(place.path))
                                   : read_library_entry(place.path, place.entry);
      },
      py::arg("path"), "A specimen file, or one of a library: \"library.h5#s0007\".");
  module.def(
      "write_specimen",
      [](const std::string &path, const Specimen &specimen) { write_specimen(std::filesystem::path(path), specimen); },
      py::arg("path"), py::arg("specimen"), "An HDF5 file that `specimen.file` of a scene may name.");
  module.def(
      "import_tables",
      [](const std::string &path, const Law &law, double density) { return import_tables(path, law, density); },
      py::arg("path"), py::arg("law") = Law(), py::arg("density") = 2650.0,
      "A packing from text: a file of lines `x y z r` in m, or a folder with contact history (user guide).");
  module.def(
      "write_vtp", [](const std::string &path, const Snapshot &snapshot) { write_grains_vtp(path, snapshot); },
      py::arg("path"), py::arg("snapshot"), "Grains for ParaView.");
  module.def(
      "write_force_chains_vtp",
      [](const std::string &path, const Snapshot &snapshot) { write_force_chains_vtp(path, snapshot); },
      py::arg("path"), py::arg("snapshot"), "Force chains for ParaView.");
}
} // namespace isostat::python
