// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/box.hpp"

#include "base/error.hpp"
#include "base/scene/ranges.hpp"
#include "base/scene/reader.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
using namespace ranges;

constexpr const char *side_choices[] = {"tied", "walls", "free-field"};

// clang-format off
constexpr Key in_mesh[] = {
  {.path = "points", .field = member<&ColumnMesh::points>, .value = "0", .range = {0, 4},
   .reason = "because elements are quadratic at most",
   .text = "Gauss points of an element along each axis; 0: as many as the degree in a column, else one more. 2 with "
           "degree 2 (reduced integration) needs fewer packings. Else at least the degree."},
  {.path = "sides", .field = member<&ColumnMesh::sides>, .value = "tied", .choices = side_choices,
   .text = "tied: opposite points of the sides move as one, as in ground without end; walls: a box (dimension 2) "
           "whose smooth walls move with its rigid base; free-field: a box whose waves leave through dashpots against "
           "the motion of level ground next to each side (dynamic, small strain, the ground level there). The soil of a "
           "box first settles into equilibrium from K0 stresses: docs/theory_column.md, section 9."},
  {.path = "file", .field = member<&ColumnMesh::file>, .presence = Presence::optional, .value = "slope.msh",
   .text = "A mesh of Gmsh (text, format 2.2 or 4.1) of quadrilaterals of any shape, in dimension 2 and not of a biaxial "
           "block, in place of width, cells_across, and thickness and cells of the layers: docs/column.md. The path is "
           "like that of `motion.file`."},
  {.path = "ground_x", .field = member<&ColumnMesh::ground_x>, .unit = unit::m, .presence = Presence::optional,
   .value = "[\"0 m\", \"20 m\"]", .range = not_negative,
   .text = "x of the points of an uneven surface, rising, on boundaries between elements; straight lines connect "
           "them. Only between walls; water, if any, covers all of it."},
  {.path = "ground_z", .field = member<&ColumnMesh::ground_z>, .unit = unit::m, .presence = Presence::optional,
   .value = "[\"4.87 m\", \"3.13 m\"]", .range = positive,
   .text = "Heights of these points above the base, the highest being that of all layers; where the ground is lower, "
           "every layer is thinner in proportion."},
};

constexpr Key in_load[] = {
  {.path = "surcharge_from", .field = member<&ColumnLoad::surcharge_from>, .unit = unit::m,
   .presence = Presence::optional, .value = "8 m", .range = not_negative,
   .text = "x where the surcharge begins, between walls, on a boundary between elements; left out: at the left wall. "
           "In a box a surcharge on a part is applied after the K0 stress; no surcharge has inertia."},
  {.path = "surcharge_to", .field = member<&ColumnLoad::surcharge_to>, .unit = unit::m, .presence = Presence::optional,
   .value = "12 m", .range = positive,
   .text = "x where it ends; left out: at the right wall. Between `surcharge_from` and the width, likewise; a plate "
           "has no surcharge on a part."},
};
// clang-format on

/// The surface of a box.
void check_ground(const SceneDocument &document, const ColumnScene &scene)
{
  const ColumnMesh &mesh = scene.mesh;
  if (mesh.ground_x.empty() && mesh.ground_z.empty())
    return;
  if (mesh.ground_z.empty())
    document.refuse("mesh.ground_x", "needs mesh.ground_z: each point of the surface has both coordinates.");
  if (mesh.ground_x.size() != mesh.ground_z.size())
    document.refuse("mesh.ground_z",
                    fmt::format("has length {}, mesh.ground_x {}; each point of the surface has both coordinates.",
                                mesh.ground_z.size(), mesh.ground_x.size()));
  const GroundLine ground = ground_line(mesh);
  try
    {
      ground.check();
    }
  catch (const InputError &error)
    {
      document.refuse("mesh.ground_x", error.what());
    }
  for (const auto &[x, z] : ground.points)
    if (x > mesh.width * (1 + 1e-9) || !mesh.is_boundary(x))
      document.refuse("mesh.ground_x", fmt::format("must be on boundaries between elements of {} m in a box of {} m, "
                                                   "because elements have straight sides, but has a point at {} m.",
                                                   number_text(mesh.width / mesh.cells_across), number_text(mesh.width),
                                                   number_text(x)));
  if (std::abs(ground.highest() - scene.height()) > 1e-6 * scene.height())
    document.refuse("mesh.ground_z", fmt::format("must reach {} m, the height of all layers, at its highest point, but "
                                                 "reaches {} m. Correct it, or the layers' thickness.",
                                                 number_text(scene.height()), number_text(ground.highest())));
}

/// Keys of a box where there is none.
void refuse_box_keys(const SceneDocument &document)
{
  for (const char *key : {"mesh.ground_x", "mesh.ground_z", "load.surcharge_from", "load.surcharge_to", "output.x"})
    if (document.find(key))
      document.refuse(key, "belongs to a box; where the sides are tied, all x are alike. Give mesh.sides = \"walls\" "
                           "or \"free-field\", or remove it.");
}

/// What cannot be in a box.
void refuse_around_box(const SceneDocument &document, const ColumnScene &scene)
{
  const bool walls = scene.mesh.sides == Sides::walls;
  if (scene.mesh.dimension != 2)
    document.refuse("mesh.sides", fmt::format("can be \"{}\" in 2 dimensions only, but mesh.dimension is {}. Give "
                                              "dimension = 2.",
                                              walls ? "walls" : "free-field", scene.mesh.dimension));
  if (walls && scene.base.compliant())
    document.refuse("base.kind", "must be \"rigid\" between walls, which move with the base. Give mesh.sides = "
                                 "\"free-field\".");
  if (!walls && scene.analysis.large_strain)
    document.refuse("analysis.large_strain", "must be false if mesh.sides is \"free-field\", whose tractions are those "
                                             "of small strain.");
  if (scene.analysis.kind == AnalysisKind::consolidation)
    document.refuse("analysis.kind", "must not be \"consolidation\" in a box; shake it, or move a plate.");
  if (scene.slope.tangent > 0)
    document.refuse("slope.angle",
                    "turns the axes of an infinite slope; a box is upright. Give the inclined surface by "
                    "mesh.ground_x and mesh.ground_z.");
  if (scene.water.table > 0)
    document.refuse("water.table",
                    "must be 0 m in a box, where water covers all soil, or none if drainage is \"dry\".");
}

/// The ground next to a free field is level, in whose column no static shear stress acts.
void check_level_ends(const SceneDocument &document, const ColumnScene &scene)
{
  const auto points = ground_line(scene.mesh).points;
  if (scene.mesh.sides != Sides::free_field || points.empty())
    return;
  const double near = 1e-6 * scene.height();
  if (std::abs(points[1][1] - points[0][1]) > near || std::abs(points.rbegin()[1][1] - points.back()[1]) > near)
    document.refuse("mesh.sides", "can be \"free-field\" only where the ground is level next to each side. Extend it.");
}

void check_places(const SceneDocument &document, const ColumnScene &scene)
{
  const ColumnLoad &load = scene.load;
  const double width = scene.mesh.width, from = load.surcharge_from.value_or(0), to = load.surcharge_to.value_or(width);
  if (scene.output.x.value_or(0) >= width)
    document.refuse("output.x", fmt::format("must lie in the box, in [0 m, {} m).", number_text(width)));
  if (load.bears_on_all())
    return;
  const char *key = load.surcharge_to ? "load.surcharge_to" : "load.surcharge_from";
  if (!(from < to && to <= width))
    document.refuse(key, fmt::format("must leave part of the surface under the surcharge: from {} m to {} m of {} m.",
                                     number_text(from), number_text(to), number_text(width)));
  if (from == 0 && load.surcharge_from)
    document.refuse("load.surcharge_from", "must be above 0 m, or be left out: then it begins at the wall.");
  if (to == width && load.surcharge_to)
    document.refuse("load.surcharge_to", "must be below the width, or be left out: then it ends at the wall.");
  for (const auto &[name, x] : {std::pair{"load.surcharge_from", from}, std::pair{"load.surcharge_to", to}})
    if (!scene.mesh.is_boundary(x))
      document.refuse(name, fmt::format("must be on a boundary between elements, which are {} m wide. Give a multiple "
                                        "of that.",
                                        number_text(width / scene.mesh.cells_across)));
  if (scene.analysis.kind == AnalysisKind::plate)
    document.refuse(key, "has no meaning with a plate; a surcharge then bears on all of the surface. Remove it.");
}
} // namespace

SceneFragment<ColumnMesh> box_keys() { return {in_mesh}; }

SceneFragment<ColumnLoad> strip_load_keys() { return {in_load}; }

void check_box(const SceneDocument &document, const ColumnScene &scene)
{
  if (scene.mesh.points > 0 && scene.mesh.points < scene.mesh.degree)
    document.refuse("mesh.points", fmt::format("must be 0 or at least the degree, {}, or elements have modes without "
                                               "stiffness.",
                                               scene.mesh.degree));
  if (scene.mesh.sides == Sides::tied)
    return refuse_box_keys(document);
  refuse_around_box(document, scene);
  check_places(document, scene);
  check_ground(document, scene);
  check_level_ends(document, scene);
}
} // namespace isostat
