// SPDX-License-Identifier: BSD-3-Clause
// The work of `isostat convert`, in the words of its command line.   tested: tests/apps/convert_test.py
#include "dem/prepare/convert.hpp"
#include "base/error.hpp"
#include "base/units.hpp"
#include "dem/prepare/packing_check.hpp"
#include "python/binding/binding.hpp"
#include "python/binding/warnings.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <pybind11/stl.h>

namespace isostat::python
{
namespace
{
namespace fs = std::filesystem;

double quantity(const char *option, const std::string &text, Dimension dimension)
{
  try
    {
      return parse_quantity(text, dimension).value;
    }
  catch (const InputError &error)
    {
      throw InputError(fmt::format("{} {}: {}", option, text, error.what()));
    }
}

/// @return the figures of the packing as text, and what is to be said of it
std::pair<std::string, std::vector<std::string>>
convert_file(const std::string &in, const std::string &out, const std::string &named_format,
             const std::optional<std::string> &unit, const std::optional<double> &scale,
             const std::optional<std::string> &density, const std::string &domain, bool anyway, bool overwrite)
{
  const PackingFormat format = named_format.empty() ? format_of_file(out) : format_named(named_format);
  if (std::error_code ignored; !overwrite && fs::exists(out, ignored))
    throw InputError(fmt::format("{}: the file exists; give --overwrite to replace it, or another name", out));
  if (const fs::path folder = fs::absolute(out).parent_path(); !fs::is_directory(folder))
    throw InputError(fmt::format("{}: there is no folder {}. Make it, or give another name.", out, folder.string()));
  ConvertOptions options;
  options.domain = domain;
  options.anyway = anyway;
  options.density_named = density.has_value();
  options.read.scale = unit ? quantity("--length-unit", "1 " + *unit, Dimension::length) : scale.value_or(1);
  options.metres_named = (unit || scale) && options.read.scale == 1;
  options.read.density = quantity("--density", density.value_or("2650 kg/m3"), Dimension::density);
  const CheckedPacking packing = read_any_packing(in, options);
  std::vector<std::string> notes = packing.notes;
  std::ranges::copy(write_packing(out, packing.specimen, format), std::back_inserter(notes));
  const Snapshot &state = packing.specimen.state;
  return {figures_text(packing_figures(state), state), notes};
}
} // namespace

void bind_convert(py::module_ &module)
{
  module.def("_speak_as_command", &speak_as_command);
  module.def("_convert_file", &convert_file, py::arg("source"), py::arg("target"), py::arg("format"), py::arg("unit"),
             py::arg("scale"), py::arg("density"), py::arg("domain"), py::arg("anyway"), py::arg("overwrite"));
}
} // namespace isostat::python
