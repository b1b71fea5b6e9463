// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/box.hpp"

#include "base/error.hpp"
#include "base/scene/ranges.hpp"
#include "base/scene/reader.hpp"
#include "base/tell.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

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
   .text = "tied: opposite points of the sides move as one, as in ground without end; walls: a box (dimension 2 or 3) "
           "whose smooth walls move with its rigid base; free-field: a box (dimension 2) whose waves leave through "
           "dashpots against the motion of level ground next to each side (dynamic, small strain, the ground level "
           "there). The soil of a box first settles into equilibrium from K0 stresses: docs/theory_column.md, section "
           "9."},
  {.path = "file", .field = member<&ColumnMesh::file>, .presence = Presence::optional, .value = "slope.msh",
   .text = "A mesh of Gmsh (text, format 2.2 or 4.1) of quadrilaterals or, in dimension 3, hexahedra of any shape, not of "
           "a biaxial block, in place of width, cells_across, and thickness and cells of the layers: docs/column.md. "
           "The path is like that of `motion.file`."},
  {.path = "ground_x", .field = member<&ColumnMesh::ground_x>, .unit = unit::m, .presence = Presence::optional,
   .value = "[\"0 m\", \"20 m\"]", .range = not_negative,
   .text = "x of the points of an uneven surface, rising, on boundaries between elements; straight lines connect "
           "them. Only in a box (sides); water, if any, covers all of it."},
  {.path = "ground_z", .field = member<&ColumnMesh::ground_z>, .unit = unit::m, .presence = Presence::optional,
   .value = "[\"4.87 m\", \"3.13 m\"]", .range = positive,
   .text = "Heights of these points above the base, the highest being that of all layers; where the ground is lower, "
           "every layer is thinner in proportion."},
};

constexpr Key in_refine[] = {
  {.path = "from", .field = member<&ColumnRefinement::from>, .unit = unit::m, .presence = Presence::optional,
   .value = "[\"4 m\", \"6 m\"]",
   .text = "x (of a block x, y) and height above the base where it begins; left out: at the ends of the soil."},
  {.path = "to", .field = member<&ColumnRefinement::to>, .unit = unit::m, .presence = Presence::optional,
   .value = "[\"8 m\", \"10 m\"]", .text = "Where it ends, likewise; above `from`."},
  {.path = "levels", .field = member<&ColumnRefinement::levels>, .value = "1", .range = {1, 8},
   .reason = "because a level makes 4 (in 3 dimensions 8) elements of one, and 8 levels a 256th of its length; give "
             "the layers more cells for more",
   .text = "How often elements whose centre is in the box are halved. Neighbours are halved, too, until elements that "
           "meet at a corner differ by one level."},
};

constexpr Key in_load[] = {
  {.path = "surcharge_from", .field = member<&ColumnLoad::surcharge_from>, .unit = unit::m,
   .presence = Presence::optional, .value = "8 m", .range = not_negative,
   .text = "x where the surcharge begins, in a box, on a boundary between elements; left out: at the left side. "
           "In a box a surcharge on a part is applied after the K0 stress, and reaches no side with a free field; no "
           "surcharge has inertia."},
  {.path = "surcharge_to", .field = member<&ColumnLoad::surcharge_to>, .unit = unit::m, .presence = Presence::optional,
   .value = "12 m", .range = positive,
   .text = "x where it ends; left out: at the right side. Between `surcharge_from` and the width, likewise; a plate "
           "has no surcharge on a part."},
};
// clang-format on

/// The surface of a box.
void check_ground(const SceneDocument &document, const ColumnScene &scene)
{
  const ColumnMesh &mesh = scene.mesh;
  if (mesh.ground_x.empty() && mesh.ground_z.empty())
    return;
  if (mesh.dimension == 3)
    document.refuse(mesh.ground_x.empty() ? "mesh.ground_z" : "mesh.ground_x",
                    "is the surface of a strip; in 3 dimensions give a mesh (mesh.file).");
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
  if (scene.mesh.dimension == 1 || (!walls && scene.mesh.dimension == 3))
    document.refuse("mesh.sides",
                    fmt::format("can be \"{}\" in {} dimensions only, but mesh.dimension is {}. Give "
                                "dimension = 2.",
                                walls ? "walls" : "free-field", walls ? "2 and 3" : "2", scene.mesh.dimension));
  if (walls && scene.base.compliant())
    document.refuse("base.kind", "must be \"rigid\" between walls, which move with the base. Give mesh.sides = "
                                 "\"free-field\".");
  if (!walls && scene.analysis.large_strain)
    document.refuse("analysis.large_strain", "must be false if mesh.sides is \"free-field\", whose tractions are those "
                                             "of small strain.");
  if (scene.analysis.kind == AnalysisKind::consolidation)
    document.refuse("analysis.kind",
                    "must not be \"consolidation\" in a box. Leave mesh.sides out (tied sides, as in ground without "
                    "end, with the load on all of it), or give kind = \"dynamic\" or \"plate\".");
  if (scene.slope.tangent > 0)
    document.refuse("slope.angle",
                    "turns the axes of an infinite slope; a box is upright. Give the inclined surface by "
                    "mesh.ground_x and mesh.ground_z.");
  if (scene.water.table > 0)
    document.refuse("water.table",
                    "must be 0 m in a box, where water covers all soil, or none if drainage is \"dry\".");
}

/// Thickness of each layer on a vertical of a mesh, m.
std::vector<double> thicknesses(const GivenMesh &mesh, std::size_t n_layers, double x)
{
  std::vector<double> sums(n_layers, 0.0);
  for (const auto &[low, high, layer] : mesh.on_vertical(x))
    sums[layer] += high - low;
  return sums;
}

/// Ground and layers next to a free field are level, in whose column no static shear stress acts; and what bears on it
/// does so everywhere.
void check_free_fields(const SceneDocument &document, const ColumnScene &scene)
{
  if (scene.mesh.sides != Sides::free_field)
    return;
  if (!scene.load.bears_on_all() && !(scene.load.surcharge_from && scene.load.surcharge_to))
    document.refuse(
        scene.load.surcharge_from ? "load.surcharge_from" : "load.surcharge_to",
        "leaves a surcharge on one side with a free field, whose column does not settle under it. Give both "
        "surcharge_from and surcharge_to, inside of the box, or none.");
  const auto points = ground_line(scene.mesh).points;
  const double near = 1e-6 * scene.height(), width = scene.mesh.width, inwards = width / 100;
  if (!points.empty())
    for (const auto &[side, next] : {std::pair(points[0], points[1]), std::pair(points.back(), points.rbegin()[1])})
      if (std::abs(next[1] - side[1]) > near)
        document.refuse(
            "mesh.sides",
            fmt::format("can be \"free-field\" only where the ground is level next to each side, but it has "
                        "{:g} m at x = {:g} m and {:g} m at x = {:g} m. Add a point of the same height.",
                        side[1], side[0], next[1], next[0]));
  if (const GivenMesh *mesh = scene.mesh.given.get())
    for (const double side : {0.0, width})
      {
        const std::vector<double> at = thicknesses(*mesh, scene.layers.size(), side),
                                  inside = thicknesses(*mesh, at.size(), side > 0 ? side - inwards : inwards);
        for (std::size_t k = 0; k < at.size(); ++k)
          if (std::abs(at[k] - inside[k]) > near)
            document.refuse(
                "mesh.sides",
                fmt::format("can be \"free-field\" only where layers are level next to each side, but at x = "
                            "{:g} m layer.{} dips. Extend the mesh.",
                            side, k));
      }
}

/// Whether a box reaches the elements at the lower and at the upper end of an axis across, by their centres.
std::array<bool, 2> reaches_sides(const ColumnScene &scene, const ColumnRefinement &box, unsigned axis)
{
  const double half = scene.mesh.width / scene.mesh.cells_across / 2;
  return {box.from.empty() || box.from[axis] < half, box.to.empty() || box.to[axis] > scene.mesh.width - half};
}

/// Elements at sides that are tied are alike; where several boxes reach them the mesh itself is asked.
void check_tied_boxes(const SceneDocument &document, const ColumnScene &scene)
{
  if (scene.mesh.sides != Sides::tied || scene.mesh.given)
    return;
  for (unsigned axis = 0; axis + 1 < scene.mesh.dimension; ++axis)
    for (const std::size_t side : {0, 1})
      {
        const auto reaches = [&](std::size_t end) {
          return std::ranges::find_if(
              scene.refine, [&](const ColumnRefinement &box) { return reaches_sides(scene, box, axis)[end]; });
        };
        if (const auto box = reaches(side); box != scene.refine.end() && reaches(1 - side) == scene.refine.end())
          document.refuse(fmt::format("refine.{}.{}", box - scene.refine.begin(), side == 0 ? "to" : "from"),
                          fmt::format("leaves elements at one side of two that are tied. Let both ends of the box "
                                      "reach a side, 0 m and {} m, or none, or give mesh.sides = \"walls\".",
                                      number_text(scene.mesh.width)));
      }
}

/// What a box covers of a block whose end it goes beyond, and the elements in it if they are many.
void note_box(const SceneDocument &document, const ColumnScene &scene, std::size_t k)
{
  const auto &[from, to, levels] = scene.refine[k];
  bool is_outside = false;
  std::vector<std::string> covered;
  double elements = 1;
  for (unsigned d = 0; d < scene.mesh.dimension; ++d)
    {
      const bool across = d + 1 < scene.mesh.dimension;
      const double end = across ? scene.mesh.width : scene.height();
      const double low = from.empty() ? 0 : std::max(from[d], 0.0), high = to.empty() ? end : std::min(to[d], end);
      is_outside = is_outside || (!from.empty() && from[d] < 0) || (!to.empty() && to[d] > end * (1 + 1e-9));
      covered.push_back(fmt::format("{:g} to {:g} m", low, high));
      double cells = across ? scene.mesh.cells_across : 0;
      for (const ColumnLayer &layer : scene.layers)
        cells += across ? 0 : layer.n_cells();
      elements *= std::ldexp(cells * (high - low) / end, static_cast<int>(levels));
    }
  const std::string box = fmt::format("{}: refine.{}", document.where(fmt::format("refine.{}", k)), k);
  if (is_outside)
    warn(fmt::format("{} goes beyond the soil; it covers {}", box, fmt::join(covered, ", ")));
  if (elements > 1e5)
    warn(fmt::format("{} makes about {:.1g} elements. Give fewer levels, or a smaller box.", box, elements));
}

/// Refuses a box between the centres of all elements, where these are as the scene says.
void check_centres(const SceneDocument &document, const ColumnScene &scene, std::size_t k)
{
  const auto &[from, to, levels] = scene.refine[k];
  for (unsigned d = 0; d < scene.mesh.dimension; ++d)
    {
      const bool is_up = d + 1 == scene.mesh.dimension;
      bool covers = is_up && !scene.mesh.ground_x.empty();
      const auto look = [&](double begin, double length, unsigned cells) {
        for (unsigned i = 0; i < cells && !covers; ++i)
          if (const double centre = begin + (i + 0.5) * length / cells;
              (from.empty() || from[d] < centre) && (to.empty() || centre < to[d]))
            covers = true;
        covers = covers || cells == 0; // chosen later
        return begin + length;
      };
      double z = 0;
      if (!is_up)
        look(0, scene.mesh.width, scene.mesh.cells_across);
      else
        for (std::size_t layer = scene.layers.size(); layer-- > 0;)
          z = look(z, scene.layers[layer].thickness, scene.layers[layer].n_cells());
      if (!covers)
        document.refuse(
            fmt::format("refine.{}.{}", k, to.empty() ? "from" : "to"),
            fmt::format("leaves no centre of an element in the box along {}. Give a larger box.", is_up ? "the height"
                                                                                                  : d == 0 ? "x"
                                                                                                           : "y"));
    }
}

void check_refinement(const SceneDocument &document, const ColumnScene &scene)
{
  const unsigned dimension = scene.mesh.dimension;
  if (scene.refine.empty())
    return;
  if (dimension == 1)
    document.refuse("refine", "needs mesh.dimension 2 or 3; elements of a column are those of its layers. Give cells.");
  if (scene.analysis.kind == AnalysisKind::biaxial)
    document.refuse("refine", "has no place in a biaxial block, whose elements are alike. Remove it.");
  for (std::size_t k = 0; k < scene.refine.size(); ++k)
    {
      const auto &[from, to, levels] = scene.refine[k];
      for (const auto &[key, place] : {std::pair{"from", &from}, std::pair{"to", &to}})
        if (!place->empty() && place->size() != dimension)
          document.refuse(fmt::format("refine.{}.{}", k, key),
                          fmt::format("must have {} lengths: {} and height above the base.", dimension,
                                      dimension == 2 ? "x" : "x, y"));
      for (unsigned d = 0; d < dimension; ++d)
        {
          const double end = d + 1 < dimension ? scene.mesh.width : scene.height();
          if (!to.empty() && !(to[d] > (from.empty() ? 0 : from[d])))
            document.refuse(fmt::format("refine.{}.to", k), "must be above refine.from, or 0 m, along each axis.");
          if (!scene.mesh.given && !from.empty() && !(from[d] < end))
            document.refuse(fmt::format("refine.{}.from", k),
                            fmt::format("must be below the end of the soil, {} m {}.", number_text(end),
                                        d + 1 < dimension ? "across" : "high"));
        }
      if (!scene.mesh.given)
        {
          check_centres(document, scene, k);
          note_box(document, scene, k);
        }
    }
  check_tied_boxes(document, scene);
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
    document.refuse("load.surcharge_from", "must be above 0 m, or be left out: then it begins at the side.");
  if (to == width && load.surcharge_to)
    document.refuse("load.surcharge_to", "must be below the width, or be left out: then it ends at the side.");
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

SceneFragment<ColumnRefinement> refinement_keys() { return {in_refine}; }

SceneFragment<ColumnLoad> strip_load_keys() { return {in_load}; }

void check_box(const SceneDocument &document, const ColumnScene &scene)
{
  if (scene.mesh.points > 0 && scene.mesh.points < scene.mesh.degree)
    document.refuse("mesh.points", fmt::format("must be 0 or at least the degree, {}, or elements have modes without "
                                               "stiffness.",
                                               scene.mesh.degree));
  check_refinement(document, scene);
  if (scene.mesh.sides == Sides::tied)
    return refuse_box_keys(document);
  refuse_around_box(document, scene);
  check_places(document, scene);
  check_ground(document, scene);
  check_free_fields(document, scene);
}
} // namespace isostat
