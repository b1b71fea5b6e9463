// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/packing_files.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/file_format.hpp"
#include "dem/io/lammps.hpp"
#include "dem/io/snapshot_file.hpp"
#include "dem/io/specimen_library.hpp"
#include "dem/io/text_tables.hpp"
#include "dem/io/vtp.hpp"
#include "dem/measure/stress.hpp"
#include "dem/measure/summary.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

struct NamedFormat
{
  std::string_view name;
  PackingFormat format;
  std::vector<std::string_view> endings;
};

const std::vector<NamedFormat> &formats()
{
  static const std::vector<NamedFormat> all = {{"specimen", PackingFormat::specimen, {".h5"}},
                                               {"lammps-dump", PackingFormat::lammps_dump, {".dump", ".lammpstrj"}},
                                               {"lammps-data", PackingFormat::lammps_data, {".data", ".lmp"}},
                                               {"yade", PackingFormat::text, {".txt", ".xyzr"}},
                                               {"csv", PackingFormat::csv, {".csv"}},
                                               {"vtp", PackingFormat::vtp, {".vtp"}}};
  return all;
}

std::string format_names()
{
  std::string text;
  for (const NamedFormat &f : formats())
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", f.name, fmt::join(f.endings, ", "));
  return text;
}

/// What a text is, by its first lines.
PackingFormat sniffed(const fs::path &path)
{
  const std::string text = read_text(path);
  if (text.starts_with("ITEM:"))
    return PackingFormat::lammps_dump;
  if (const std::size_t first = text.find_first_not_of(" \t\r\n"); first != std::string::npos && text[first] == '<')
    return PackingFormat::vtp;
  const std::string_view head = std::string_view(text).substr(0, 4000);
  if (head.find("xlo xhi") != std::string_view::npos && head.find("atoms") != std::string_view::npos)
    return PackingFormat::lammps_data;
  return PackingFormat::text;
}

/// Lengths times a factor; 1 changes no bit.
void scale_lengths(Snapshot &s, double factor)
{
  if (factor == 1)
    return;
  std::vector<Vec3> centres(s.grains.n_grains());
  std::vector<double> radii = s.grains.radii();
  for (std::size_t i = 0; i < centres.size(); ++i)
    {
      centres[i] = factor * s.grains.centre(i);
      radii[i] *= factor;
    }
  Packing scaled = make_packing(centres, radii, s.grains.density);
  scaled.id = s.grains.id;
  for (std::size_t i = 0; i < centres.size(); ++i)
    {
      scaled.set_linear_velocity(i, factor * s.grains.linear_velocity(i));
      scaled.set_angular_velocity(i, s.grains.angular_velocity(i));
    }
  s.grains = scaled;
  s.box = {factor * s.box.lower, factor * s.box.upper};
  if (s.cell)
    {
      s.cell->edges *= factor;
      s.cell->reference_volume = s.cell->edges.determinant();
    }
}

ForeignPacking read_text_file(const fs::path &path, const ReadOptions &options)
{
  switch (sniffed(path))
    {
    case PackingFormat::lammps_dump:
      return read_lammps_dump(path, options);
    case PackingFormat::lammps_data:
      return read_lammps_data(path, options);
    case PackingFormat::vtp:
      return read_grains_vtp(path, options);
    default:
      return read_sphere_text(path, options);
    }
}
} // namespace

PackingFormat format_named(const std::string &name)
{
  const auto found = std::ranges::find(formats(), name, &NamedFormat::name);
  if (found == formats().end())
    throw InputError(fmt::format("format {}; expected one of: {}", name, format_names()));
  return found->format;
}

PackingFormat format_of_file(const fs::path &path)
{
  const std::string ending = path.extension().string();
  for (const NamedFormat &f : formats())
    if (std::ranges::find(f.endings, ending) != f.endings.end())
      return f.format;
  throw InputError(fmt::format("{}: its ending does not say what to write; expected one of: {}. Or name the format.",
                               path.string(), format_names()));
}

ForeignPacking read_foreign_packing(const fs::path &path, const ReadOptions &options)
{
  if (!(options.density > 0 && std::isfinite(options.density)))
    throw InputError(fmt::format("grain density = {} kg/m3; expected > 0, such as 2650 for quartz", options.density));
  if (!(options.scale > 0 && std::isfinite(options.scale)))
    throw InputError(fmt::format("scale = {}; expected > 0, such as 1e-3 for a file in mm", options.scale));
  if (std::error_code ignored; fs::is_directory(path, ignored))
    {
      if (options.scale != 1)
        throw InputError(
            fmt::format("{}: a folder of tables holds forces and is in SI; expected a scale of 1", path.string()));
      return {import_tables(path, options.law, options.density), {}};
    }
  ForeignPacking found = read_text_file(path, options);
  if (const double density = found.state.grains.density; !(density > 0 && std::isfinite(density)))
    throw InputError(fmt::format("{}: grain density = {} kg/m3; expected > 0", path.string(), density));
  if (const double volume = found.state.volume(); !(volume > 0 && std::isfinite(volume)))
    throw InputError(fmt::format("{}: the {} has a volume of {}; expected a finite one above 0", path.string(),
                                 found.state.cell ? "periodic cell" : "box", volume));
  scale_lengths(found.state, options.scale);
  return found;
}

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

Specimen read_stored_packing(const fs::path &path, const std::string &entry)
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

std::vector<std::string> write_packing(const fs::path &path, const Specimen &specimen, PackingFormat format)
{
  const Snapshot &s = specimen.state;
  std::vector<std::string> notes;
  if (format == PackingFormat::specimen)
    {
      write_specimen(path, specimen);
      return notes;
    }
  if (!s.contacts.empty() || !s.wall_contacts.empty())
    notes.emplace_back(
        "Contacts with their forces are not kept by this format: a packing that comes back starts without "
        "shear forces, so let a stage `rebalance` come first.");
  if (s.grains.density != ReadOptions{}.density && format != PackingFormat::lammps_data)
    notes.push_back(fmt::format("The grain density, {} kg/m3, is not kept by this format: name it where the file is "
                                "read, --density \"{} kg/m3\".",
                                s.grains.density, s.grains.density));
  const bool lammps = format == PackingFormat::lammps_dump || format == PackingFormat::lammps_data;
  if (lammps && !fits_lammps(s))
    notes.emplace_back(
        "LAMMPS wants the first edge of a cell along x and the second in the plane xy: the packing is turned "
        "into this position, which costs the last digits.");
  if (format == PackingFormat::text && s.cell)
    notes.emplace_back(
        "YADE's text has no place for a periodic cell: it stands in the comment `# cell`, which Isostat reads "
        "and YADE does not; give O.cell.hSize there.");
  if (format == PackingFormat::vtp)
    write_grains_vtp(path, s);
  else
    write_replacing(path, format == PackingFormat::lammps_dump   ? lammps_dump(s)
                          : format == PackingFormat::lammps_data ? lammps_data(s)
                          : format == PackingFormat::csv         ? sphere_csv(s)
                                                                 : sphere_text(s));
  return notes;
}
} // namespace isostat
