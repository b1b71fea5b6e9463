// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/fem/space/given_mesh_test.cpp
#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace isostat
{
/// An element as a file has it.
struct GmshElement
{
  unsigned number, dimension, group; ///< tag; of its shape; physical group, 0: none
  std::vector<unsigned> nodes;       ///< tags
  std::size_t type;
};

struct GmshShape
{
  const char *name;
  unsigned dimension, nodes;
};

/// By their number in Gmsh: those of straight sides.
inline constexpr std::array<GmshShape, 16> gmsh_shapes = {{{},
                                                           {"line", 1, 2},
                                                           {"triangle", 2, 3},
                                                           {"quadrilateral", 2, 4},
                                                           {"tetrahedron", 3, 4},
                                                           {"hexahedron", 3, 8},
                                                           {"prism", 3, 6},
                                                           {"pyramid", 3, 5},
                                                           {},
                                                           {},
                                                           {},
                                                           {},
                                                           {},
                                                           {},
                                                           {},
                                                           {"point", 0, 1}}};

/// What a mesh of Gmsh says.
struct GmshFile
{
  double version = 0;
  std::map<std::array<unsigned, 2>, std::string> names; ///< of physical groups, by dimension and number
  std::map<std::array<unsigned, 2>, unsigned> groups;   ///< 4.1: of geometric entities, likewise; the first of each
  std::map<unsigned, std::array<double, 3>> nodes;      ///< by tag
  std::vector<GmshElement> elements;

  std::string name(const GmshElement &element) const
  {
    const auto found = names.find({element.dimension, element.group});
    return found == names.end() ? std::string() : found->second;
  }
};

/// Text of format 2.2 or 4.1.   @throws InputError  file:line, and what is expected there
GmshFile read_gmsh_file(const std::filesystem::path &path);
} // namespace isostat
