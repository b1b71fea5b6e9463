// SPDX-License-Identifier: BSD-3-Clause
#include "apps/isostat/convert.hpp"

#include "apps/common/command_line.hpp"
#include "base/error.hpp"
#include "base/tell.hpp"
#include "base/units.hpp"
#include "dem/prepare/convert.hpp"
#include "dem/prepare/packing_check.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
struct ConvertLine
{
  std::string in, out, format, unit, density = "2650 kg/m3";
  double scale = 1;
  bool overwrite = false, scale_named = false;
  ConvertOptions options;
};

void add_options(CLI::App &line, ConvertLine &asked)
{
  line.add_option("IN", asked.in,
                  "specimen, snapshot (.h5) or library.h5#s0007 of Isostat; LAMMPS dump or data file (units si, "
                  "atom_style sphere); text `x y z r` of YADE; CSV; VTP")
      ->required();
  line.add_option("OUT", asked.out, "the same packing in another format, by its ending: .h5 .dump .data .txt .csv .vtp")
      ->required();
  line.add_option("--to", asked.format,
                  "specimen, lammps-dump, lammps-data, yade, csv or vtp, where the ending is another");
  CLI::Option *scale = line.add_option("--scale", asked.scale, "metres in a unit of length of IN, such as 1e-3")
                           ->each([&asked](const std::string &) { asked.scale_named = true; });
  line.add_option("--length-unit", asked.unit, "unit of length of IN: m, cm, mm or um")
      ->excludes(scale)
      ->each([&asked](const std::string &) { asked.scale_named = true; });
  line.add_option("--density", asked.density, "of the grains, where IN does not say it; default 2650 kg/m3")
      ->each([&asked](const std::string &) { asked.options.density_named = true; });
  line.add_option("--domain", asked.options.domain, "rigid-box or periodic-cell, where IN does not say it")
      ->check(CLI::IsMember({"rigid-box", "periodic-cell"}));
  line.add_flag("--anyway", asked.options.anyway, "writes what the checks refuse");
  line.add_flag("--overwrite", asked.overwrite, "replaces OUT");
}

void run(ConvertLine asked)
{
  const PackingFormat format = asked.format.empty() ? format_of_file(asked.out) : format_named(asked.format);
  if (std::error_code ignored; !asked.overwrite && std::filesystem::exists(asked.out, ignored))
    throw InputError(fmt::format("{}: the file exists; give --overwrite to replace it, or another name", asked.out));
  if (const std::filesystem::path folder = std::filesystem::absolute(asked.out).parent_path();
      !std::filesystem::is_directory(folder))
    throw InputError(
        fmt::format("{}: there is no folder {}. Make it, or give another name.", asked.out, folder.string()));
  const auto quantity = [](const char *option, const std::string &text, Dimension dimension) {
    try
      {
        return parse_quantity(text, dimension).value;
      }
    catch (const InputError &error)
      {
        throw InputError(fmt::format("{} {}: {}", option, text, error.what()));
      }
  };
  asked.options.read.scale =
      asked.unit.empty() ? asked.scale : quantity("--length-unit", "1 " + asked.unit, Dimension::length);
  asked.options.metres_named = asked.scale_named && asked.options.read.scale == 1;
  asked.options.read.density = quantity("--density", asked.density, Dimension::density);
  const CheckedPacking packing = read_any_packing(asked.in, asked.options);
  std::vector<std::string> notes = packing.notes;
  std::ranges::copy(write_packing(asked.out, packing.specimen, format), std::back_inserter(notes));
  const Snapshot &state = packing.specimen.state;
  fmt::print("{}\n{}", asked.out, figures_text(packing_figures(state), state));
  for (const std::string &note : notes)
    warn(note);
}
} // namespace

int convert(const std::vector<std::string> &words)
{
  CLI::App line("A packing from one format into another, checked on the way: units, overlaps, box", "isostat convert");
  ConvertLine asked;
  add_options(line, asked);
  std::vector<char *> arguments;
  std::vector<std::string> copy = words;
  for (std::string &word : copy)
    arguments.push_back(word.data());
  return run_command(line, static_cast<int>(arguments.size()), arguments.data(), [&] { run(asked); });
}
} // namespace isostat
