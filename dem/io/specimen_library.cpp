// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/specimen_library.hpp"

#include "base/error.hpp"
#include "base/record/file_format.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace isostat
{
namespace
{
const std::string library_format = "isostat-specimen-library";
constexpr std::size_t most_in_message = 40;

void check_header(const hdf5::Group &root)
{
  expect_specimens(root, library_format, library_schema_version, "a library made by isostat library");
}

std::vector<LibraryEntry> entries_of(const hdf5::Group &root)
{
  std::vector<LibraryEntry> entries;
  for (const std::string &name : root.names())
    {
      const Specimen described = read_specimen_description(root.group(name));
      entries.push_back({name, described.provenance, described.numbers});
    }
  return entries;
}

/// The number of "s0007" is 7; 0 for other names.
std::uint64_t number_of(const std::string &name)
{
  const bool counted = name.size() > 1 && name.size() < 19 && name[0] == 's' &&
                       std::all_of(name.begin() + 1, name.end(), [](unsigned char c) { return std::isdigit(c); });
  return counted ? std::stoull(name.substr(1)) : 0;
}

/// Of library_table().
struct Column
{
  const char *head, *number;
  int width, decimals;
  double unit = 1;
};
constexpr Column columns[] = {{"seed", "seed", 6, 0},
                              {"grains", "grains", 8, 0},
                              {"sigma_v kPa", "vertical_stress_Pa", 13, 2, 1e3},
                              {"p' kPa", "pressure_Pa", 10, 2, 1e3},
                              {"K0", "K0", 7, 3},
                              {"e", "void_ratio", 8, 4},
                              {"D_r", "relative_density", 7, 3},
                              {"Z", "coordination", 7, 3},
                              {"I_R", "redundancy_index", 7, 3}};

std::string cell(double value, int width, int decimals)
{
  return std::isfinite(value) ? fmt::format("{:>{}.{}f}", value, width, decimals) : fmt::format("{:>{}}", "-", width);
}
} // namespace

double LibraryEntry::number(const std::string &key) const
{
  const auto found = numbers.find(key);
  return found == numbers.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

std::string LibraryEntry::text(const std::string &key) const
{
  const auto found = provenance.find(key);
  return found == provenance.end() ? "" : found->second;
}

bool is_specimen_library(const std::filesystem::path &path)
{
  const hdf5::File file = hdf5::File::open(path);
  return format_of(file.root()) == library_format;
}

std::vector<LibraryEntry> list_library(const std::filesystem::path &path)
{
  const hdf5::File file = hdf5::File::open(path);
  check_header(file.root());
  return entries_of(file.root());
}

Specimen read_library_entry(const std::filesystem::path &path, const std::string &name)
{
  const hdf5::File file = hdf5::File::open(path);
  const hdf5::Group root = file.root();
  check_header(root);
  const std::vector<std::string> names = root.names();
  if (std::find(names.begin(), names.end(), name) != names.end())
    return read_specimen(root.group(name));
  if (names.empty())
    throw InputError(fmt::format("{}: a specimen library without entries; make it again", path.string()));
  throw InputError(fmt::format(
      "{}: {}. Name one of its {} entries, for example {}#{}:\n{}", path.string(),
      name.empty() ? "a library of specimens, but none of them is named" : fmt::format("has no entry \"{}\"", name),
      names.size(), path.string(), names[0], library_table(entries_of(root), most_in_message)));
}

std::string library_table(const std::vector<LibraryEntry> &entries, std::size_t most)
{
  std::string text = fmt::format("  {:<8} {:<10}", "entry", "stress");
  for (const Column &column : columns)
    text += fmt::format("{:>{}}", column.head, column.width);
  const std::size_t shown = std::min(most, entries.size());
  for (std::size_t i = 0; i < shown; ++i)
    {
      const LibraryEntry &entry = entries[i];
      const std::string consolidation = entry.text("consolidation");
      text += fmt::format("\n  {:<8} {:<10}", entry.name, consolidation.empty() ? "-" : consolidation);
      for (const Column &column : columns)
        text += cell(entry.number(column.number) / column.unit, column.width, column.decimals);
    }
  text += "\n";
  if (shown < entries.size())
    text += fmt::format("  and {} more\n", entries.size() - shown);
  return text;
}

LibraryWriter LibraryWriter::create(const std::filesystem::path &path)
{
  LibraryWriter writer(hdf5::File::create(path));
  set_format(writer.file_.root(), library_format, library_schema_version);
  return writer;
}

LibraryWriter LibraryWriter::append(const std::filesystem::path &path)
{
  list_library(path); // an InputError if it is not a whole library
  return LibraryWriter(hdf5::File::update(path));
}

void LibraryWriter::add(const std::string &name, const Specimen &specimen)
{
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_'; };
  hdf5::Group root = file_.root();
  if (name.empty() || !std::all_of(name.begin(), name.end(), allowed))
    throw InputError(fmt::format("{}: \"{}\" cannot name an entry; use letters, digits, '-' and '_'",
                                 root.file_path().string(), name));
  if (root.has(name))
    throw InputError(
        fmt::format("{}: an entry \"{}\" exists already; give another name", root.file_path().string(), name));
  write_specimen(root.create_group(name), specimen);
}

std::string LibraryWriter::next_name() const
{
  std::uint64_t maximum = 0;
  for (const std::string &name : file_.root().names())
    maximum = std::max(maximum, number_of(name));
  return fmt::format("s{:04d}", maximum + 1);
}
} // namespace isostat
