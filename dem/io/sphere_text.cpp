// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/sphere_text.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "dem/io/sphere_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;
using Words = std::vector<std::string_view>;

/// What the comments of a file say of its domain.
struct Bounds
{
  std::optional<RigidBox> box;
  std::optional<PeriodicCell> cell;
};

/// As many finite numbers behind the first word; false otherwise.
template <std::size_t n>
bool numbers_behind(const Words &words, std::array<double, n> &values)
{
  bool good = words.size() == n + 1;
  for (std::size_t k = 0; good && k < n; ++k)
    good = parse(words[k + 1], values[k]) && std::isfinite(values[k]);
  return good;
}

/// Takes up `# box` and `# cell`; any other comment says nothing.
void read_comment(const fs::path &path, std::size_t line, std::string_view text, Bounds &bounds)
{
  const Words words = split_words(text.substr(text.find('#') + 1));
  if (words.empty())
    return;
  if (words[0] == "box")
    {
      std::array<double, 6> v{};
      if (!numbers_behind(words, v) || !(v[0] < v[1] && v[2] < v[3] && v[4] < v[5]))
        reject(path, line, fmt::format("\"{}\"; expected # box xlo xhi ylo yhi zlo zhi, each pair rising (m)", text));
      bounds.box = RigidBox{Vec3(v[0], v[2], v[4]), Vec3(v[1], v[3], v[5])};
    }
  if (words[0] == "cell")
    {
      std::array<double, 9> v{};
      PeriodicCell cell;
      if (numbers_behind(words, v))
        cell.edges = Eigen::Map<const Mat3>(v.data());
      cell.reference_volume = cell.edges.determinant();
      if (words.size() != 10 || !(cell.reference_volume > 0 && std::isfinite(cell.reference_volume)))
        reject(path, line,
               fmt::format("\"{}\"; expected # cell ax ay az bx by bz cx cy cz, three edges of a right-handed cell (m)",
                           text));
      bounds.cell = cell;
    }
}

/// A line of words only, such as `x y z r`.
bool is_header(std::string_view text)
{
  double ignored = 0;
  return std::ranges::none_of(split_words(text), [&](std::string_view word) { return parse(word, ignored); });
}

SphereTable read_rows(const fs::path &path, const std::string &text, Bounds &bounds)
{
  const SphereColumns plain({"x", "y", "z", "r"});
  SphereColumns columns = plain;
  SphereTable table;
  std::string missing; // from a header
  bool header_seen = false, named = false;
  const std::vector<std::string_view> lines = split_lines(text);
  for (std::size_t l = 0; l < lines.size(); ++l)
    {
      Words words = split_words(lines[l]);
      if (words.empty())
        continue;
      if (words[0].starts_with('#'))
        read_comment(path, l + 1, lines[l], bounds);
      else if (table.centres.empty() && !header_seen && is_header(lines[l]))
        {
          header_seen = true;
          if (lines[l].starts_with(',')) // a column without a name, as pandas writes it
            words.insert(words.begin(), "");
          const SphereColumns of_header(words);
          missing = of_header.missing();
          named = missing.empty();
          columns = named ? of_header : plain;
        }
      else if (header_seen && !named && words.size() != 4)
        reject(
            path, l + 1,
            fmt::format("the header above has not {}; expected columns x, y, z and r or diameter (m). Is it a packing?",
                        missing));
      else if (!named && words.size() != 4)
        reject(path, l + 1, fmt::format("\"{}\"; expected four numbers x y z r (m)", lines[l]));
      else
        columns.read(path, l + 1, lines[l], table);
    }
  return table;
}

std::string bounds_text(const Snapshot &s)
{
  if (s.cell)
    return fmt::format("# cell {}\n", fmt::join(s.cell->edges.reshaped(), " "));
  const Vec3 &a = s.box.lower, &b = s.box.upper;
  return fmt::format("# box {} {} {} {} {} {}\n", a[0], b[0], a[1], b[1], a[2], b[2]);
}
} // namespace

ForeignPacking read_sphere_text(const fs::path &path, const Law &law, double density)
{
  const std::string text = read_text(path);
  Bounds bounds;
  const SphereTable table = read_rows(path, text, bounds);
  table.check(path);
  ForeignPacking found;
  found.state.law = law;
  found.state.cell = bounds.cell;
  if (!bounds.cell && !bounds.box)
    found.notes.emplace_back("The file has no line `# box xlo xhi ylo yhi zlo zhi`: the bounding box of the spheres is "
                             "taken.");
  if (!bounds.cell)
    {
      found.state.box = bounds.box ? *bounds.box : table.bounding_box();
      table.check_inside(path, found.state.box);
    }
  found.state.grains = table.packing(density);
  return found;
}

std::string sphere_text(const Snapshot &s)
{
  std::string text = bounds_text(s) + "# x y z r in m\n";
  for (std::size_t i = 0; i < s.grains.n_grains(); ++i)
    {
      const double *x = &s.grains.position[4 * i];
      fmt::format_to(std::back_inserter(text), "{}\t{}\t{}\t{}\n", x[0], x[1], x[2], x[3]);
    }
  return text;
}

std::string sphere_csv(const Snapshot &s)
{
  std::string text = bounds_text(s) + "id,x,y,z,r,vx,vy,vz,wx,wy,wz\n";
  for (std::size_t i = 0; i < s.grains.n_grains(); ++i)
    {
      const double *x = &s.grains.position[4 * i], *v = &s.grains.velocity[4 * i], *w = &s.grains.spin[4 * i];
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{}\n", s.grains.id[i], x[0], x[1], x[2],
                     x[3], v[0], v[1], v[2], w[0], w[1], w[2]);
    }
  return text;
}
} // namespace isostat
