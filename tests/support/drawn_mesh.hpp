// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/block.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

namespace isostat::test
{
/// A mesh of Gmsh, text of format 2.2: n[0] x n[1] (x n[2]) cells of the unit square or cube, whose corners are moved
/// to where `move` says; one layer, "soil". Coordinates are those of the file: z is the last one.
template <int dim, typename Move>
std::string gmsh_text(std::array<unsigned, 3> n, const Move &move)
{
  if (dim == 2)
    n[2] = 0;
  const auto tag = [&](unsigned i, unsigned j, unsigned k) { return 1 + i + (n[0] + 1) * (j + (n[1] + 1) * k); };
  std::string nodes, elements;
  unsigned n_elements = 0;
  for (unsigned k = 0; k <= n[2]; ++k)
    for (unsigned j = 0; j <= n[1]; ++j)
      for (unsigned i = 0; i <= n[0]; ++i)
        {
          const std::array<double, 3> at =
              move(std::array<double, 3>{1. * i / n[0], 1. * j / n[1], dim == 3 ? 1. * k / n[2] : 0});
          nodes += fmt::format("{} {} {} {}\n", tag(i, j, k), at[0], at[1], at[2]);
        }
  const auto add = [&](int type, int group, std::initializer_list<unsigned> corners) {
    elements += fmt::format("{} {} 2 {} 1", ++n_elements, type, group);
    for (unsigned corner : corners)
      elements += fmt::format(" {}", corner);
    elements += '\n';
  };
  const unsigned up = dim == 3 ? 1 : 0;
  for (unsigned k = 0; k < std::max(n[2], 1u); ++k)
    for (unsigned j = 0; j < n[1]; ++j)
      for (unsigned i = 0; i < n[0]; ++i)
        {
          const unsigned c[8] = {
              tag(i, j, k),      tag(i + 1, j, k),      tag(i + 1, j + 1, k),      tag(i, j + 1, k),
              tag(i, j, k + up), tag(i + 1, j, k + up), tag(i + 1, j + 1, k + up), tag(i, j + 1, k + up)};
          const bool ends[6] = {i == 0, i + 1 == n[0], j == 0, j + 1 == n[1], k == 0, k + 1 == n[2]};
          if constexpr (dim == 2)
            {
              add(3, 7, {c[0], c[1], c[2], c[3]});
              const unsigned sides[4][2] = {{c[3], c[0]}, {c[1], c[2]}, {c[0], c[1]}, {c[2], c[3]}};
              for (int f = 0; f < 4; ++f)
                if (ends[f])
                  add(1, 1 + f, {sides[f][0], sides[f][1]});
            }
          else
            {
              add(5, 7, {c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7]});
              const unsigned sides[6][4] = {{c[0], c[3], c[7], c[4]}, {c[1], c[2], c[6], c[5]},
                                            {c[0], c[1], c[5], c[4]}, {c[3], c[2], c[6], c[7]},
                                            {c[0], c[1], c[2], c[3]}, {c[4], c[5], c[6], c[7]}};
              for (int f = 0; f < 6; ++f)
                if (ends[f])
                  add(3, 1 + f, {sides[f][0], sides[f][1], sides[f][2], sides[f][3]});
            }
        }
  const std::string names =
      dim == 2 ? "5\n1 1 \"x_low\"\n1 2 \"x_high\"\n1 3 \"base\"\n1 4 \"surface\"\n2 7 \"soil\"\n"
               : "7\n2 1 \"x_low\"\n2 2 \"x_high\"\n2 3 \"y_low\"\n2 4 \"y_high\"\n2 5 \"base\"\n2 6 \"surface\"\n"
                 "3 7 \"soil\"\n";
  return fmt::format(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{}$EndPhysicalNames\n$Nodes\n{}\n{}$EndNodes\n"
      "$Elements\n{}\n{}$EndElements\n",
      names, std::count(nodes.begin(), nodes.end(), '\n'), nodes, n_elements, elements);
}

inline std::shared_ptr<const GivenMesh> read_gmsh_text(const std::string &text, unsigned dimension,
                                                       const std::vector<std::string> &layers = {"soil"})
{
  std::string path = std::filesystem::temp_directory_path() / "isostat_mesh_XXXXXX";
  close(mkstemp(path.data()));
  std::ofstream(path) << text;
  try
    {
      auto mesh = read_gmsh(path, dimension, layers);
      std::filesystem::remove(path);
      return mesh;
    }
  catch (...)
    {
      std::filesystem::remove(path);
      throw;
    }
}

/// Pushes corners inside of a square or cube of n cells a side about, by up to a part of a cell: digits far behind the
/// point stand for chance.
template <int dim>
struct PushedAbout
{
  unsigned cells;
  double part = 0.25;

  std::array<double, 3> operator()(std::array<double, 3> at) const
  {
    const std::array<double, 3> before = at;
    for (int d = 0; d < dim; ++d)
      if (before[d] == 0 || before[d] == 1)
        return at;
    for (int d = 0; d < dim; ++d)
      {
        const double phase = cells * (12.9898 * before[0] + 78.233 * before[1] + 37.719 * before[2]) + d;
        at[d] += part / cells * std::sin(43758.5453 * std::sin(phase));
      }
    return at;
  }
};

/// A soil of that mesh, of degree 2.
inline MeshSpec soil_of(std::shared_ptr<const GivenMesh> mesh)
{
  MeshSpec spec;
  spec.soil.layers = {{.name = "soil"}};
  spec.ground = mesh->ground;
  spec.given = std::move(mesh);
  return spec;
}
} // namespace isostat::test
