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

/// Takes up `# box`, `# cell` and `##PERIODIC::`; any other comment says nothing of the domain.
void read_bounds(const fs::path &path, std::size_t line, const Words &words, std::string_view text, Bounds &bounds)
{
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
  if (words[0] == "#PERIODIC::")
    {
      std::array<double, 3> v{};
      const double volume = numbers_behind(words, v) ? v[0] * v[1] * v[2] : 0;
      if (!(*std::ranges::min_element(v) > 0 && volume > 0 && std::isfinite(volume)))
        reject(path, line,
               fmt::format("\"{}\"; expected ##PERIODIC:: x y z, three edges of a cell above 0 (m): Isostat has no "
                           "packing that is periodic along some axes only",
                           text));
      bounds.cell = PeriodicCell::with_edges(Vec3(v.data()));
    }
  if (bounds.box && bounds.cell)
    reject(path, line, "a second domain: the file has a box and a periodic cell; expected one of them");
}

/// A line of words only, such as `x y z r`.
bool is_header(std::string_view text)
{
  double ignored = 0;
  return std::ranges::none_of(split_words(text), [&](std::string_view word) { return parse(word, ignored); });
}

/// Names of columns: between commas if there are any, else between blanks, each with its unit, `x (m)`.
Words header_names(std::string_view text)
{
  if (text.find(',') != std::string_view::npos)
    return split_commas(text);
  Words names;
  for (const std::string_view word : split_words(text))
    if (names.empty() || !(word.starts_with('(') || word.starts_with('[')))
      names.push_back(word);
    else
      names.back() = std::string_view(names.back().data(), word.data() + word.size() - names.back().data());
  return names;
}

/// Rows of spheres, whose columns follow from a header, a comment, or how many there are.
struct RowReader
{
  const fs::path &path;
  double scale;
  Bounds bounds;
  SphereTable table;
  std::optional<SphereColumns> columns, of_comment;
  std::string missing;     ///< from a header that names other things
  std::size_t named = 0;   ///< words of a header
  std::size_t unnamed = 0; ///< columns, where nothing names them

  void check_units(std::size_t line) const
  {
    if (const std::string wrong = columns->wrong_unit(scale); !wrong.empty())
      reject(path, line, wrong);
  }

  void comment(std::size_t line, std::string_view text)
  {
    const std::string_view said = text.substr(text.find('#') + 1);
    const Words words = split_words(said);
    if (words.empty())
      return;
    read_bounds(path, line, words, text, bounds);
    if (!table.centres.empty())
      return;
    if (words[0] == "format" && words.size() == 2)
      format(line, words[1]);
    else if (const SphereColumns found(header_names(said)); found.missing().empty())
      of_comment = found;
  }

  /// `x_y_z_r_matId`
  void format(std::size_t line, std::string_view text)
  {
    Words names;
    for (std::size_t end = 0; end < text.size(); text.remove_prefix(std::min(end + 1, text.size())))
      {
        end = std::min(text.find('_'), text.size());
        names.push_back(text.substr(0, end));
      }
    const bool any_more = !names.empty() && names.back() == "attrs";
    if (any_more)
      names.pop_back();
    columns.emplace(names, 0, any_more);
    if (const std::string lacks = columns->missing(); !lacks.empty())
      reject(path, line, fmt::format("this format does not have {}; expected one such as x_y_z_r_matId", lacks));
  }

  void header(std::size_t line, std::string_view text)
  {
    const SphereColumns found(header_names(text));
    missing = found.missing();
    named = found.n_columns();
    columns = missing.empty() ? found : SphereColumns({"x", "y", "z", "r"});
    check_units(line);
  }

  void row(std::size_t line, std::string_view text)
  {
    const std::size_t n = split_words(text).size();
    if (table.centres.empty() && of_comment && of_comment->n_columns() == n)
      {
        columns = of_comment;
        check_units(line);
      }
    if (!missing.empty() && (n != 4 || n == named)) // one that names other columns than these four
      reject(path, line,
             fmt::format("the header above does not have {}; expected columns x, y, z and r or diameter (m). Is it a "
                         "packing?",
                         missing));
    if (!columns && (n == 4 || n == 5))
      {
        columns = n == 4 ? SphereColumns({"x", "y", "z", "r"}) : SphereColumns({"x", "y", "z", "r", "clumpId"});
        unnamed = n;
      }
    if (!columns || (unnamed > 0 && n != unnamed))
      reject(path, line,
             fmt::format("\"{}\"; expected four numbers x y z r (m) in every line, or five with the clump id", text));
    columns->read(path, line, text, table);
  }
};

RowReader read_rows(const fs::path &path, const std::string &text, double scale)
{
  RowReader reader{path, scale, {}, {}, {}, {}, {}, 0, 0};
  bool header_seen = false;
  const std::vector<std::string_view> lines = split_lines(text);
  for (std::size_t l = 0; l < lines.size(); ++l)
    {
      const Words words = split_words(lines[l]);
      if (words.empty())
        continue;
      if (words[0].starts_with('#'))
        reader.comment(l + 1, lines[l]);
      else if (reader.table.centres.empty() && !header_seen && is_header(lines[l]))
        {
          header_seen = true;
          reader.header(l + 1, lines[l]);
        }
      else
        reader.row(l + 1, lines[l]);
    }
  return reader;
}

std::string bounds_text(const Snapshot &s)
{
  if (s.cell)
    return fmt::format("# cell {}\n", fmt::join(s.cell->edges.reshaped(), " "));
  const Vec3 &a = s.box.lower, &b = s.box.upper;
  return fmt::format("# box {} {} {} {} {} {}\n", a[0], b[0], a[1], b[1], a[2], b[2]);
}
} // namespace

ForeignPacking read_sphere_text(const fs::path &path, const ReadOptions &options)
{
  const std::string text = read_text(path);
  const RowReader rows = read_rows(path, text, options.scale);
  const SphereTable &table = rows.table;
  const Bounds &bounds = rows.bounds;
  table.check(path);
  ForeignPacking found;
  found.state.law = options.law;
  found.state.cell = bounds.cell;
  if (!bounds.cell && !bounds.box)
    found.notes.emplace_back("The file has no line `# box xlo xhi ylo yhi zlo zhi`: the bounding box of the spheres is "
                             "taken.");
  if (!bounds.cell)
    {
      found.state.box = bounds.box ? *bounds.box : table.bounding_box();
      table.check_inside(path, found.state.box);
    }
  found.state.grains = table.packing(table.density(path, options.density, options.scale));
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
