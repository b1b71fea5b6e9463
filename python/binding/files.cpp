// SPDX-License-Identifier: BSD-3-Clause
// HDF5 files and ParaView files of packings.   tested: tests/python/snapshot_test.py, tests/python/library_test.py
#include "base/error.hpp"
#include "dem/io/snapshot_file.hpp"
#include "dem/io/specimen_library.hpp"
#include "dem/io/stored_packing.hpp"
#include "dem/io/vtp.hpp"
#include "dem/prepare/relative_density.hpp"
#include "dem/scene/scene.hpp"
#include "python/binding/binding.hpp"
#include "python/binding/given.hpp"

#include <fmt/format.h>

namespace isostat::python
{
namespace
{
/// Paths as strings or pathlib.Path.
using fs_path = std::filesystem::path;

using Path = Given<fs_path, "path">;
using Overwrite = Given<bool, "overwrite">;

/// As the command line does.
void check_new(const fs_path &path, bool overwrite)
{
  if (std::error_code ignored; !overwrite && std::filesystem::exists(path, ignored))
    throw InputError(
        fmt::format("{}: the file exists; give overwrite=True to replace it, or another name", path.string()));
}

/// A writer that replaces a file only on request.
template <Name name, typename What>
auto to_new_file(void (*write)(const fs_path &, const What &))
{
  return [write](const Path &path, Given<const What *, name> what, Overwrite overwrite) {
    check_new(path, overwrite);
    write(path, *what);
  };
}

/// Adds what it does not say: figures, and a seed, which no other one has.   @return the names of the entries
std::vector<std::string> write_library(const fs_path &path, std::vector<Specimen> specimens, bool overwrite,
                                       bool append)
{
  if (overwrite && append)
    throw InputError("overwrite and append exclude each other: one replaces the library that the other adds to. Give "
                     "one of them.");
  std::error_code ignored;
  const bool extend = append && std::filesystem::exists(path, ignored);
  if (path.extension() != ".h5")
    throw InputError(fmt::format("{}: must end in .h5, because scenes recognise a library by it.", path.string()));
  if (!extend)
    check_new(path, overwrite);
  double next_seed = 1;
  const auto count = [&](const std::map<std::string, double> &numbers) {
    if (const auto seed = numbers.find("seed"); seed != numbers.end())
      next_seed = std::max(next_seed, seed->second + 1);
  };
  for (const LibraryEntry &entry : extend ? list_library(path) : std::vector<LibraryEntry>{})
    count(entry.numbers);
  for (const Specimen &specimen : specimens)
    count(specimen.numbers);
  LibraryWriter library = extend ? LibraryWriter::append(path) : LibraryWriter::create(path);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < specimens.size(); ++k)
    {
      if (!specimens[k].state.cell)
        throw InputError(fmt::format("specimen {}: is between rigid walls, but a library is for volume elements, which "
                                     "are periodic. Prepare it with specimen.domain = \"periodic-cell\".",
                                     k));
      add_figures(specimens[k]);
      if (specimens[k].numbers.try_emplace("seed", next_seed).second)
        next_seed += 1;
      names.push_back(library.next_name());
      library.add(names.back(), specimens[k]);
    }
  library.commit();
  return names;
}

std::map<std::string, std::map<std::string, double>> numbers_of_library(const Path &path)
{
  std::map<std::string, std::map<std::string, double>> entries;
  for (const LibraryEntry &entry : list_library(path.value))
    entries[entry.name] = entry.numbers;
  return entries;
}

/// For the command line: the table of a library, the recipes of its entries, and what to say of odd densities.
py::tuple describe_library(const Path &path)
{
  const std::vector<LibraryEntry> entries = list_library(path.value);
  std::vector<std::string> recipes, remarks;
  for (const LibraryEntry &entry : entries)
    {
      recipes.push_back(entry.text("recipe"));
      const double density = entry.number("relative_density");
      if (const std::string remark = density_remark(density); !remark.empty())
        remarks.push_back(fmt::format("{}: D_r = {:.3f}{}", entry.name, density, remark));
    }
  return py::make_tuple(library_table(entries), recipes, remarks);
}

/// Columns of history.h5 as arrays, with all their digits, and their units.   @throws InputError  damaged, or no history
py::tuple read_series(const Path &path)
{
  const hdf5::File file = hdf5::File::open(path.value);
  if (!file.root().has("history"))
    throw InputError(fmt::format("{}: no group \"history\"; restore the file", path.value.string()));
  const hdf5::Group series = file.root().group("history");
  py::dict columns, units;
  for (const std::string &name : series.names())
    {
      const std::vector<double> values = series.read<double>(name);
      columns[py::str(name)] = py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
      units[py::str(name)] = series.unit(name);
    }
  return py::make_tuple(columns, units);
}
} // namespace

void bind_files(py::module_ &module)
{
  py::class_<Specimen>(module, "Specimen", "A prepared packing with the story of how it was made.")
      .def(py::init([](Given<const Snapshot *, "snapshot"> state) {
             Specimen specimen{*state, {}, {}};
             add_figures(specimen);
             return specimen;
           }),
           py::arg("snapshot"))
      .def_property_readonly(
          "snapshot", [](const Specimen &s) { return std::make_shared<Snapshot>(s.state); }, "A copy of the packing.")
      .def_readonly("provenance", &Specimen::provenance, "Title, recipe, versions: text.")
      .def_readonly("numbers", &Specimen::numbers,
                    "Void ratio, relative density, pressure (Pa, compression positive), seed ... by name.");
  module.def(
      "read_snapshot", [](const Path &path) { return read_snapshot_file(path); }, py::arg("path"),
      "A snapshot_*.h5 of a run, or the packing of a specimen.");
  module.def(
      "read_specimen",
      [](const Path &file) {
        const SpecimenPlace place = specimen_place(file.value.string());
        return place.entry.empty() && !is_specimen_library(place.path) ? read_specimen(fs_path(place.path))
                                                                       : read_library_entry(place.path, place.entry);
      },
      py::arg("path"), "A specimen file, or one of a library: \"library.h5#s0007\".");
  module.def("write_specimen", to_new_file<"specimen", Specimen>(&write_specimen), py::arg("path"), py::arg("specimen"),
             py::kw_only(), py::arg("overwrite") = false, "An HDF5 file that `specimen.file` of a scene may name.");
  module.def(
      "write_library",
      [](const Path &path, Given<std::vector<Specimen>, "specimens"> specimens, Overwrite overwrite,
         Given<bool, "append"> append) { return write_library(path, specimens.value, overwrite, append); },
      py::arg("path"), py::arg("specimens"), py::kw_only(), py::arg("overwrite") = false, py::arg("append") = false,
      "Writes periodic specimens into one file, as `isostat library` does: a column takes its packings\n"
      "from it. Returns the names of the entries: \"library.h5#s0001\" is one. append: keeps existing ones.\n"
      "A column distinguishes realisations by numbers[\"seed\"]: that of the grading; specimens without "
      "one are counted on.");
  module.def("list_library", &numbers_of_library, py::arg("path"),
             "The numbers of each entry of a library by its name: seed, stresses in Pa, void ratio ...");
  module.def("_describe_library", &describe_library);
  module.def("read_series", &read_series, py::arg("path"),
             "Columns of a history.h5, with all their digits, and their units.");
  module.def("write_vtp", to_new_file<"snapshot", Snapshot>(&write_grains_vtp), py::arg("path"), py::arg("snapshot"),
             py::kw_only(), py::arg("overwrite") = false,
             "Grains for ParaView. An existing file is replaced only with `overwrite`.");
  module.def("write_force_chains_vtp", to_new_file<"snapshot", Snapshot>(&write_force_chains_vtp), py::arg("path"),
             py::arg("snapshot"), py::kw_only(), py::arg("overwrite") = false,
             "Force chains for ParaView. An existing file is replaced only with `overwrite`.");
}
} // namespace isostat::python
