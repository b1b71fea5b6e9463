// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "dem/io/lammps.hpp"
#include "dem/io/lammps_box.hpp"
#include "dem/io/sphere_table.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <unordered_map>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;
using Words = std::vector<std::string_view>;

/// What a data file holds, line by line.
struct DataFile
{
  fs::path path;
  std::size_t line = 0; ///< that is being read, from 1
  LammpsBox box;
  std::array<bool, 3> bounded{};
  double n_atoms = -1;
  SphereTable spheres;
  std::unordered_map<std::uint32_t, std::size_t> index_of_id;

  [[noreturn]] void refuse(const std::string &what) const { reject(path, line, what); }

  std::vector<double> numbers(const Words &words, std::size_t least) const
  {
    std::vector<double> values(words.size());
    for (std::size_t k = 0; k < words.size(); ++k)
      values[k] = finite_number(path, line, words[k]);
    if (values.size() < least)
      refuse(fmt::format("{} numbers; expected {}", values.size(), least));
    return values;
  }

  /// A line of the header, such as `0 1 xlo xhi`.
  void header(const Words &words)
  {
    const auto ends_with = [&](std::initializer_list<std::string_view> ending) {
      return words.size() == 2 * ending.size() && std::equal(ending.begin(), ending.end(), words.end() - ending.size());
    };
    const Words first(words.begin(), words.begin() + words.size() / 2);
    if (words.size() == 2 && words[1] == "atoms")
      n_atoms = numbers(first, 1)[0];
    else if (words.back() == "avec" || words.back() == "abc")
      refuse("a general triclinic box; expected xlo xhi and xy xz yz");
    else if (ends_with({"xy", "xz", "yz"}))
      {
        const std::vector<double> tilt = numbers(first, 3);
        box.xy = tilt[0], box.xz = tilt[1], box.yz = tilt[2];
      }
    else
      for (int k = 0; k < 3; ++k)
        if (const std::string axis(1, "xyz"[k]); ends_with({axis + "lo", axis + "hi"}))
          {
            const std::vector<double> ends = numbers(first, 2);
            box.lower[k] = ends[0], box.upper[k] = ends[1];
            bounded[k] = ends[0] < ends[1];
            if (!bounded[k])
              refuse("the box has no volume; expected lo < hi");
          }
  }

  /// id type diameter density x y z
  void atom(const Words &words)
  {
    const std::vector<double> v = numbers(words, 7);
    spheres.densities.push_back(v[3]);
    spheres.ids.push_back(grain_id(path, line, v[0], 1));
    spheres.radii.push_back(v[2] / 2);
    spheres.centres.emplace_back(v[4], v[5], v[6]);
    spheres.line_of.push_back(line);
    index_of_id.emplace(spheres.ids.back(), spheres.ids.size() - 1);
  }

  /// id vx vy vz wx wy wz
  void velocity(const Words &words)
  {
    const std::vector<double> v = numbers(words, 7);
    const auto found = index_of_id.find(grain_id(path, line, v[0], 1));
    if (found == index_of_id.end())
      refuse(fmt::format("velocity of atom {}, which is not in the section Atoms; expected it there, above", v[0]));
    spheres.velocities.resize(spheres.ids.size(), Vec3::Zero());
    spheres.spins.resize(spheres.ids.size(), Vec3::Zero());
    spheres.velocities[found->second] = Vec3(v[1], v[2], v[3]);
    spheres.spins[found->second] = Vec3(v[4], v[5], v[6]);
  }
};

/// The name of a section, such as `Pair Coeffs`; empty for a line of the header or of numbers.
std::string section_name(const Words &words)
{
  const char c = words[0].empty() ? ' ' : words[0].front();
  return c >= 'A' && c <= 'Z' ? std::string(words[0]) : "";
}

void read_line(DataFile &data, std::string_view text, std::string &section)
{
  const Words words = split_words(text.substr(0, text.find('#')));
  if (words.empty())
    return;
  if (const std::string name = section_name(words); !name.empty())
    {
      section = name;
      const std::size_t comment = text.find('#');
      const Words style = split_words(comment == std::string_view::npos ? "" : text.substr(comment + 1));
      if (name == "Atoms" && !style.empty() && style[0] != "sphere")
        data.refuse(fmt::format("atom_style {}; expected sphere: no other has radii", style[0]));
    }
  else if (section.empty())
    data.header(words);
  else if (section == "Atoms")
    data.atom(words);
  else if (section == "Velocities")
    data.velocity(words);
}
} // namespace

ForeignPacking read_lammps_data(const fs::path &path, const ReadOptions &options)
{
  const std::string text = read_text(path);
  const std::vector<std::string_view> lines = split_lines(text);
  DataFile data;
  data.path = path;
  std::string section;
  const std::string_view title = lines.empty() ? "" : lines[0];
  if (const std::size_t units = title.find("units = "); units != std::string_view::npos)
    if (const Words said = split_words(title.substr(units + 8)); !said.empty() && said[0] != "si")
      reject(path, 1, fmt::format("units {}; expected si. Write the file in a run with `units si`", said[0]));
  for (std::size_t l = 1; l < lines.size(); ++l) // the first line is a title
    {
      data.line = l + 1;
      read_line(data, lines[l], section);
    }
  if (!std::ranges::all_of(data.bounded, [](bool there) { return there; }))
    throw InputError(
        fmt::format("{}: the box is not complete; expected lines `lo hi xlo xhi`, ylo yhi and zlo zhi", path.string()));
  if (data.n_atoms < 0)
    throw InputError(fmt::format("{}: no line `N atoms`; expected one in the header", path.string()));
  if (data.n_atoms != static_cast<double>(data.spheres.centres.size()))
    throw InputError(fmt::format("{}: {} atoms are promised, {} are there; is the file cut off?", path.string(),
                                 data.n_atoms, data.spheres.centres.size()));
  data.spheres.check(path);
  ForeignPacking found;
  bool periodic = title.find("periodic cell") != std::string_view::npos;
  if (!periodic && title.find("rigid box") == std::string_view::npos)
    {
      const auto [assumed, note] = data.box.assumed_periodic(options.domain, "data file");
      periodic = assumed;
      if (!note.empty())
        found.notes.push_back(note);
    }
  if (!periodic)
    data.spheres.check_inside(path, {data.box.lower, data.box.upper});
  data.box.bound(found.state, periodic);
  found.state.law = options.law;
  found.state.grains = data.spheres.packing(data.spheres.density(path, options.density));
  return found;
}

std::string lammps_data(const Snapshot &snapshot)
{
  const Snapshot s = lammps_frame(snapshot);
  const auto [box, centres] = in_lammps_box(s);
  std::string text =
      fmt::format("LAMMPS data file of Isostat, atom_style sphere, units si, {}\n\n{} atoms\n1 atom types\n\n",
                  s.cell ? "periodic cell" : "rigid box", centres.size());
  for (int k = 0; k < 3; ++k)
    text += fmt::format("{0} {1} {2}lo {2}hi\n", box.lower[k], box.upper[k], "xyz"[k]);
  if (box.leans())
    text += fmt::format("{} {} {} xy xz yz\n", box.xy, box.xz, box.yz);
  text += "\nAtoms # sphere\n\n";
  const auto id = [&](std::size_t i) { return std::uint64_t{s.grains.id[i]} + 1; };
  for (std::size_t i = 0; i < centres.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{} 1 {} {} {} {} {}\n", id(i), 2 * s.grains.radius(i), s.grains.density,
                   centres[i][0], centres[i][1], centres[i][2]);
  text += "\nVelocities\n\n";
  for (std::size_t i = 0; i < centres.size(); ++i)
    {
      const double *v = &s.grains.velocity[4 * i], *w = &s.grains.spin[4 * i];
      fmt::format_to(std::back_inserter(text), "{} {} {}\n", id(i), fmt::join(v, v + 3, " "), fmt::join(w, w + 3, " "));
    }
  return text;
}
} // namespace isostat
