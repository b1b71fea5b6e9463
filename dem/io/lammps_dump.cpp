// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "dem/io/lammps.hpp"
#include "dem/io/lammps_box.hpp"
#include "dem/io/sphere_table.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;
using Words = std::vector<std::string_view>;

/// One frame of a dump, and the place of its lines.
struct DumpReader
{
  fs::path path;
  std::vector<std::string_view> lines;
  std::size_t next = 0;  ///< line to be read
  std::size_t whole = 0; ///< lines of whole frames

  bool done() const { return next >= lines.size() || (next + 1 == lines.size() && lines[next].empty()); }
  std::string_view take()
  {
    if (next >= lines.size())
      refuse("the dump ends within a frame; expected more lines. " + remedy());
    return lines[next++];
  }
  std::string remedy() const
  {
    return whole == 0
               ? "Is it cut off?"
               : fmt::format("It was cut off; `head -n {} {}` has the whole frames before.", whole, path.string());
  }
  [[noreturn]] void refuse(const std::string &what) const { reject(path, next, what); }

  double number(std::string_view word) const { return finite_number(path, next, word); }
  std::size_t count(std::string_view word) const
  {
    const double n = number(word);
    if (!is_count(n))
      refuse(fmt::format("{} atoms; expected a whole number below 2^32", word));
    return static_cast<std::size_t>(n);
  }
};

struct Frame
{
  LammpsBox box;
  bool periodic = false, says_boundaries = false;
  SphereTable spheres;
};

/// The three lines below `ITEM: BOX BOUNDS [xy xz yz] xx yy zz`.
void read_bounds(DumpReader &in, const Words &item, Frame &frame)
{
  if (std::ranges::find(item, "abc") != item.end())
    in.refuse(
        "a general triclinic box; expected one with xy xz yz. Write the dump with `dump_modify ... triclinic/general "
        "no`");
  const bool leans = std::ranges::find(item, "xy") != item.end();
  const std::size_t n_periodic = std::ranges::count(item, "pp");
  if (n_periodic != 0 && n_periodic != 3)
    in.refuse(
        fmt::format("boundaries {}; expected pp pp pp (a periodic cell), or no pp (a box with walls): Isostat has "
                    "no packing that is periodic along some axes only",
                    fmt::join(item.end() - std::min<std::size_t>(3, item.size()), item.end(), " ")));
  frame.periodic = n_periodic == 3;
  frame.says_boundaries = item.size() >= (leans ? 9 : 6); // ITEM: BOX BOUNDS [xy xz yz] xx yy zz
  if (leans && frame.says_boundaries && !frame.periodic)
    in.refuse("a leaning box with walls; expected pp pp pp: the walls of Isostat stand at right angles");
  RigidBox bounds;
  double *const tilt[] = {&frame.box.xy, &frame.box.xz, &frame.box.yz};
  for (int k = 0; k < 3; ++k)
    {
      const Words words = split_words(in.take());
      if (words.size() < (leans ? 3u : 2u))
        in.refuse(fmt::format("{} numbers; expected {} of the box", words.size(), leans ? 3 : 2));
      bounds.lower[k] = in.number(words[0]);
      bounds.upper[k] = in.number(words[1]);
      if (leans)
        *tilt[k] = in.number(words[2]);
    }
  frame.box.set_bounds(bounds);
  if (!((frame.box.upper - frame.box.lower).array() > 0).all())
    in.refuse("the box has no volume; expected lo < hi");
}

void read_atoms(DumpReader &in, const Words &item, std::size_t n_atoms, Frame &frame)
{
  const SphereColumns columns({item.begin() + 2, item.end()}, 1);
  if (const std::string missing = columns.missing(); !missing.empty())
    in.refuse(fmt::format("the dump does not have {}; write it with `dump ID all custom N FILE id type x y z radius`",
                          missing));
  for (std::size_t i = 0; i < n_atoms; ++i)
    {
      const std::string_view line = in.take();
      columns.read(in.path, in.next, line, frame.spheres);
    }
}

Frame read_frame(DumpReader &in)
{
  Frame frame;
  std::size_t n_atoms = 0;
  while (true)
    {
      const Words item = split_words(in.take());
      if (item.size() < 2 || item[0] != "ITEM:")
        in.refuse("expected a line `ITEM: ...` of a LAMMPS dump");
      if (item[1] == "BOX")
        read_bounds(in, item, frame);
      else if (item[1] == "ATOMS")
        {
          read_atoms(in, item, n_atoms, frame);
          return frame;
        }
      else if (item[1] == "NUMBER")
        n_atoms = in.count(in.take());
      else if (const std::string_view value = in.take(); item[1] == "UNITS" && value != "si")
        in.refuse(fmt::format("units {}; expected si. Scale the dump, or write it in a run with `units si`", value));
    }
}
} // namespace

ForeignPacking read_lammps_dump(const fs::path &path, const ReadOptions &options)
{
  const std::string text = read_text(path);
  DumpReader in{path, split_lines(text)};
  Frame frame;
  std::size_t n_frames = 0;
  for (; n_frames == 0 || !in.done(); ++n_frames)
    {
      frame = read_frame(in);
      in.whole = in.next;
    }
  frame.spheres.check(path);
  ForeignPacking found;
  if (n_frames > 1)
    found.notes.push_back(fmt::format("The dump has {} frames: the last one is taken.", n_frames));
  if (!frame.says_boundaries)
    {
      const auto [assumed, note] = frame.box.assumed_periodic(options.domain, "dump without boundaries");
      frame.periodic = assumed;
      if (!note.empty())
        found.notes.push_back(note);
    }
  if (!frame.periodic)
    frame.spheres.check_inside(path, {frame.box.lower, frame.box.upper});
  frame.box.bound(found.state, frame.periodic);
  found.state.law = options.law;
  found.state.grains = frame.spheres.packing(frame.spheres.density(path, options.density, options.scale));
  return found;
}

std::string lammps_dump(const Snapshot &snapshot)
{
  const Snapshot s = lammps_frame(snapshot);
  const auto [box, centres] = in_lammps_box(s);
  const RigidBox bounds = box.bounds();
  const double tilt[] = {box.xy, box.xz, box.yz};
  std::string text =
      fmt::format("ITEM: UNITS\nsi\nITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {}{}\n", s.step,
                  centres.size(), box.leans() ? "xy xz yz " : "", s.cell ? "pp pp pp" : "ff ff ff");
  for (int k = 0; k < 3; ++k)
    text += fmt::format("{} {}{}\n", bounds.lower[k], bounds.upper[k], box.leans() ? fmt::format(" {}", tilt[k]) : "");
  text += "ITEM: ATOMS id type x y z radius vx vy vz omegax omegay omegaz\n";
  for (std::size_t i = 0; i < centres.size(); ++i)
    {
      const double *v = &s.grains.velocity[4 * i], *w = &s.grains.spin[4 * i];
      fmt::format_to(std::back_inserter(text), "{} 1 {} {} {} {} {} {}\n", std::uint64_t{s.grains.id[i]} + 1,
                     centres[i][0], centres[i][1], centres[i][2], s.grains.radius(i), fmt::join(v, v + 3, " "),
                     fmt::join(w, w + 3, " "));
    }
  return text;
}
} // namespace isostat
