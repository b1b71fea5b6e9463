// SPDX-License-Identifier: BSD-3-Clause
// Meshes of Gmsh: https://gmsh.info/doc/texinfo/gmsh.html, section "Gmsh file formats".
#include "fem/space/gmsh_file.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

/// Words of a file in their order, which know their line.
class Words
{
public:
  Words(const fs::path &path, const std::string &text) : path_(path), lines_(split_lines(text)) {}

  /// The next word; empty at the end of the file.
  std::string_view next()
  {
    while (at_ >= words_.size() && line_ < lines_.size())
      {
        words_ = split_words(lines_[line_++]);
        at_ = 0;
      }
    return at_ < words_.size() ? words_[at_++] : std::string_view();
  }
  double number()
  {
    double value = 0;
    if (const std::string_view word = next(); !parse(word, value) || !std::isfinite(value))
      wrong(fmt::format("\"{}\" where a number is expected. Save the mesh again, as text of version 4.1.", word));
    return value;
  }
  unsigned count()
  {
    const double value = number();
    if (!(value >= 0 && value < 4e9 && value == static_cast<unsigned>(value)))
      wrong(fmt::format("{} where a count is expected. Save the mesh again, as text of version 4.1.", value));
    return static_cast<unsigned>(value);
  }
  void skip(std::size_t n)
  {
    for (std::size_t k = 0; k < n; ++k)
      next();
  }
  [[noreturn]] void wrong(const std::string &what) const { reject(path_, std::max<std::size_t>(line_, 1), what); }

private:
  const fs::path &path_;
  std::vector<std::string_view> lines_, words_;
  std::size_t line_ = 0, at_ = 0;
};

void read_format(Words &words, GmshFile &contents)
{
  contents.version = words.number();
  if (contents.version != 2.2 && contents.version != 4.1)
    words.wrong(
        fmt::format("version {} of the format; must be 2.2 or 4.1. Save it with -format msh41.", contents.version));
  if (words.count() != 0)
    words.wrong("a binary mesh; must be text. Save it without -bin.");
  words.number();
}

void read_names(Words &words, GmshFile &contents)
{
  for (unsigned n = words.count(); n > 0; --n)
    {
      const unsigned dimension = words.count(), number = words.count();
      contents.names[{dimension, number}] = words.next();
    }
}

/// Of 4.1: physical groups of points, curves, surfaces, volumes.
void read_entities(Words &words, GmshFile &contents)
{
  std::array<unsigned, 4> counts;
  for (unsigned &count : counts)
    count = words.count();
  for (unsigned dimension = 0; dimension < 4; ++dimension)
    for (unsigned k = 0; k < counts[dimension]; ++k)
      {
        const unsigned tag = words.count();
        words.skip(dimension == 0 ? 3 : 6);
        const unsigned n = words.count();
        for (unsigned i = 0; i < n; ++i)
          if (const auto group = static_cast<unsigned>(std::abs(words.number())); i == 0)
            contents.groups[{dimension, tag}] = group;
        if (dimension > 0)
          words.skip(words.count());
      }
}

/// How many blocks a section of 4.1 has; one of 2.2 is one without a head.
unsigned n_blocks(Words &words, bool blocks)
{
  if (!blocks)
    return 1;
  const unsigned n = words.count();
  words.skip(3);
  return n;
}

void read_nodes(Words &words, GmshFile &contents)
{
  const bool blocks = contents.version > 4;
  for (unsigned left = n_blocks(words, blocks); left > 0; --left)
    {
      unsigned dimension = 0, parameters = 0;
      if (blocks)
        {
          dimension = words.count();
          words.count();
          parameters = words.count() > 0 ? dimension : 0;
        }
      std::vector<unsigned> tags(words.count());
      for (unsigned k = 0; blocks && k < tags.size(); ++k)
        tags[k] = words.count();
      for (unsigned tag : tags)
        {
          if (!blocks)
            tag = words.count();
          for (double &coordinate : contents.nodes[tag])
            coordinate = words.number();
          words.skip(parameters);
        }
    }
}

/// Of 4.1 in blocks whose elements have one type and group.
void read_elements(Words &words, GmshFile &contents)
{
  const bool blocks = contents.version > 4;
  for (unsigned left = n_blocks(words, blocks); left > 0; --left)
    {
      GmshElement element = {};
      if (blocks)
        {
          const unsigned dimension = words.count(), entity = words.count();
          element.type = words.count();
          const auto group = contents.groups.find({dimension, entity});
          element.group = group == contents.groups.end() ? 0 : group->second;
        }
      for (unsigned n = words.count(); n > 0; --n)
        {
          element.number = words.count();
          if (!blocks)
            {
              element.type = words.count();
              const unsigned n_tags = words.count();
              element.group = n_tags > 0 ? words.count() : 0;
              words.skip(n_tags > 0 ? n_tags - 1 : 0);
            }
          if (element.type >= gmsh_shapes.size() || !gmsh_shapes[element.type].name)
            words.wrong(fmt::format("element {} is of Gmsh's type {}; must have straight sides. Mesh it with order 1.",
                                    element.number, element.type));
          element.dimension = gmsh_shapes[element.type].dimension;
          element.nodes.resize(gmsh_shapes[element.type].nodes);
          for (unsigned &node : element.nodes)
            node = words.count();
          contents.elements.push_back(element);
        }
    }
}

} // namespace

GmshFile read_gmsh_file(const fs::path &path)
{
  const std::string text = read_text(path);
  Words words(path, text);
  GmshFile contents;
  constexpr std::pair<const char *, void (*)(Words &, GmshFile &)> sections[] = {{"$MeshFormat", read_format},
                                                                                 {"$PhysicalNames", read_names},
                                                                                 {"$Entities", read_entities},
                                                                                 {"$Nodes", read_nodes},
                                                                                 {"$Elements", read_elements}};
  for (std::string_view word = words.next(); !word.empty(); word = words.next())
    for (const auto &[name, section] : sections)
      if (word == name)
        {
          if (contents.version == 0 && section != read_format)
            words.wrong("no $MeshFormat ahead of this. Give a mesh that Gmsh has saved.");
          section(words, contents);
        }
  if (contents.elements.empty())
    throw InputError(fmt::format("{}: no elements; give a mesh that Gmsh has saved", path.string()));
  return contents;
}
} // namespace isostat
