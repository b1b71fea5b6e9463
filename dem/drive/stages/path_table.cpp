// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/path_table.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/hash.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace isostat
{
namespace
{
constexpr const char *names[n_path_quantities] = {"stress_x", "stress_y", "stress_z", "tau",  "mean_stress",
                                                  "strain_x", "strain_y", "strain_z", "gamma"};

/// "stress_x (kPa)" -> quantity and factor to SI.
struct Heading
{
  std::optional<PathQuantity> quantity;
  double factor = 0; ///< 0: no unit of this quantity
};

Heading read_heading(std::string_view cell)
{
  const std::size_t bracket = cell.find(" (");
  const std::string_view name = cell.substr(0, bracket);
  const std::string_view unit = bracket == std::string_view::npos ? "" : cell.substr(bracket);
  const auto *found = std::find(std::begin(names), std::end(names), name);
  if (found == std::end(names))
    return {};
  Heading heading{static_cast<PathQuantity>(found - names), 0};
  const bool strain = is_strain(*heading.quantity);
  for (const auto &[text, factor] : {std::pair(" (-)", 1.0), std::pair(" (%)", 0.01)})
    if (strain && unit == text)
      heading.factor = factor;
  for (const auto &[text, factor] : {std::pair(" (Pa)", 1.0), std::pair(" (kPa)", 1e3), std::pair(" (MPa)", 1e6)})
    if (!strain && unit == text)
      heading.factor = factor;
  return heading;
}

/// Of the cells after the first.
std::vector<Heading> read_headings(const std::filesystem::path &file, const std::vector<std::string_view> &header)
{
  std::vector<Heading> headings;
  std::array<bool, n_path_quantities> seen = {};
  for (std::size_t c = 1; c < header.size(); ++c)
    {
      const Heading heading = read_heading(header[c]);
      if (!heading.quantity || heading.factor == 0)
        reject(file, 1,
               fmt::format(
                   "\"{}\" is not a column of a path; give any of {} with their units, stresses in (Pa), (kPa) or (MPa)"
                   ", strains in (-) or (%)",
                   header[c], fmt::join(names, ", ")));
      bool &here = seen[static_cast<std::size_t>(*heading.quantity)];
      if (here)
        reject(file, 1, fmt::format("\"{}\" is there twice", header[c]));
      here = true;
      headings.push_back(heading);
    }
  return headings;
}
} // namespace

const char *name_of(PathQuantity quantity) { return names[static_cast<std::size_t>(quantity)]; }

double PathTable::value(PathQuantity q, double place, double start) const
{
  const std::vector<double> &y = columns[static_cast<std::size_t>(q)];
  const auto next = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), place) - at.begin());
  if (next == at.size())
    return y.back();
  const double x0 = next > 0 ? at[next - 1] : 0, y0 = next > 0 ? y[next - 1] : start;
  return y0 + (place - x0) / (at[next] - x0) * (y[next] - y0);
}

std::uint64_t PathTable::hash() const
{
  Hash hash;
  hash.text(by_time ? "time" : "step").words(std::span<const double>(at));
  for (const std::vector<double> &column : columns)
    hash.words(std::span<const double>(column));
  return hash.value();
}

PathTable read_path_table(const std::filesystem::path &file)
{
  const std::string text = read_text(file);
  const std::vector<std::string_view> lines = split_lines(text);
  const CsvHeader named(file, lines.empty() ? std::string_view() : lines[0]);
  const std::vector<std::string_view> &header = named.columns;
  if (header.size() < 2 || (header[0] != "time (s)" && header[0] != "step (-)"))
    reject(file, 1,
           "a path has the columns \"time (s)\" or \"step (-)\", and then at least one stress or strain, as in \"step "
           "(-),stress_x (kPa),strain_y (-)\"");
  PathTable table;
  table.by_time = header[0] == "time (s)";
  const std::vector<Heading> headings = read_headings(file, header);
  for (std::size_t l = 1; l < lines.size(); ++l)
    {
      if (split_words(lines[l]).empty())
        continue;
      const std::vector<std::string_view> fields = named.row(file, l + 1, lines[l]);
      const double place = finite_number(file, l + 1, fields[0]);
      if (!(place > (table.at.empty() ? 0 : table.at.back())))
        reject(
            file, l + 1,
            fmt::format("{} = {:g}; must be above {:g}: rows follow each other, and the state of the specimen when the "
                        "stage begins is the one at 0. Remove this row or correct it",
                        header[0], place, table.at.empty() ? 0 : table.at.back()));
      table.at.push_back(place);
      for (std::size_t c = 0; c < headings.size(); ++c)
        {
          const double value = headings[c].factor * finite_number(file, l + 1, fields[c + 1]);
          if (is_compression(*headings[c].quantity) && value < 0)
            reject(file, l + 1,
                   fmt::format("{} = {}; must be >= 0, as grains without cohesion bear no tension. Correct it",
                               header[c + 1], fields[c + 1]));
          table.columns[static_cast<std::size_t>(*headings[c].quantity)].push_back(value);
        }
    }
  if (table.at.empty())
    reject(file, 2, "no rows; a path has at least one");
  return table;
}
} // namespace isostat
