// SPDX-License-Identifier: BSD-3-Clause
#include "apps/biaxial/scene.hpp"

#include "base/scene/ranges.hpp"
#include "base/scene/reader.hpp"
#include "base/scene/writer.hpp"
#include "coupling/scene/packings.hpp"
#include "fem/material/iwan_scene.hpp"
#include "fem/material/mohr_coulomb_scene.hpp"
#include "fem/solve/newton_scene.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
using namespace ranges;

constexpr std::span<const char *const> materials(material_names, 4); ///< none of the user's own
constexpr unsigned iwan = kind_bit(LayerMaterial::iwan);
constexpr unsigned mohr_coulomb = kind_bit(LayerMaterial::mohr_coulomb);
constexpr unsigned formula = kind_bit(LayerMaterial::elastic) | iwan | mohr_coulomb;
constexpr unsigned grains = kind_bit(LayerMaterial::grains);

// clang-format off
constexpr Section sections[] = {
  {.name = "mesh", .text = "The block: plane strain, x across, z up."},
  {.name = "soil", .text = "What it is made of.", .kind_key = "material", .kinds_title = "Materials"},
  {.name = "nonlocal", .text = "A length, which the thickness of a shear band then has instead of that of an element."},
  {.name = "weak", .text = "A square of elements that differs from the rest, where a shear band can start."},
  {.name = "water", .text = "What the water in the pores does. It bears any suction: no limit of cavitation is set."},
  {.name = "test", .text = "Constant pressure on the sides; the top moves down, smooth as the base."},
  {.name = "newton", .text = "Solver of a load step."},
  {.name = "output", .text = "What is written, and how often. Output never changes a run."},
};

constexpr Range extents{1e-4, 1e6};
constexpr const char *because_extents = "because a block of soil is larger than its grains and smaller than a country";

constexpr Key block_keys[] = {
  {.path = "title", .field = member<&BiaxialScene::title>, .text = "What the scene shows; heads tables and figures."},

  {.path = "mesh.width", .field = member<&BiaxialScene::mesh, &BiaxialMesh::width>, .unit = unit::m, .value = "1 m",
   .range = extents, .reason = because_extents, .text = "Extent along x."},
  {.path = "mesh.height", .field = member<&BiaxialScene::mesh, &BiaxialMesh::height>, .unit = unit::m, .value = "2 m",
   .range = extents, .reason = because_extents, .text = "Extent along z."},
  {.path = "mesh.cells_across", .field = member<&BiaxialScene::mesh, &BiaxialMesh::cells_across>, .value = "8",
   .range = counts, .text = "Elements along x."},
  {.path = "mesh.cells_up", .field = member<&BiaxialScene::mesh, &BiaxialMesh::cells_up>, .value = "16",
   .range = counts, .text = "Elements along z."},
  {.path = "mesh.degree", .field = member<&BiaxialScene::mesh, &BiaxialMesh::degree>, .value = "1", .range = {1, 2},
   .text = "Degree of the displacement in an element."},
  {.path = "mesh.points", .field = member<&BiaxialScene::mesh, &BiaxialMesh::points>, .value = "2", .range = {1, 4},
   .text = "Gauss points of an element along each axis; 1 with degree 1 leaves modes without stiffness."},

  {.path = "soil.material", .field = member<&BiaxialScene::soil, &ColumnLayer::material>,
   .presence = Presence::required, .value = "elastic", .choices = materials,
   .text = "Linear elastic, parallel slip elements (Iwan), friction and cohesion (Mohr-Coulomb), or a packing of "
           "grains at every Gauss point."},
  {.path = "soil.shear_modulus", .field = member<&BiaxialScene::soil, &ColumnLayer::shear_modulus>, .unit = unit::MPa,
   .presence = Presence::required, .value = "50 MPa", .range = stresses, .reason = because_stresses, .kinds = formula,
   .text = "Shear modulus of small strain; of iwan and mohr_coulomb at the reference pressure."},
  {.path = "soil.poisson_ratio", .field = member<&BiaxialScene::soil, &ColumnLayer::poisson_ratio>, .value = "0.3",
   .range = {0, 0.5, false, true}, .kinds = formula, .text = "Poisson's ratio."},
};

constexpr Key test_keys[] = {
  {.path = "nonlocal.length", .field = member<&BiaxialScene::nonlocal, &NonlocalParameters::length>, .unit = unit::m,
   .value = "0 m", .range = not_negative,
   .text = "Each point of the soil gets the mean strain around it, with Gaussian weights of this standard deviation; "
           "Gauss points should not be farther apart than about 1.6 of it. 0: its own strain. Above 0 m it needs "
           "newton.max_iterations = 0 and relaxation."},
  {.path = "nonlocal.stiffness", .field = member<&BiaxialScene::nonlocal, &NonlocalParameters::stiffness>, .value = "1",
   .range = not_negative,
   .text = "Of the elastic stress against differences of strain and mean strain, over the wave moduli at the start."},

  {.path = "weak.cells", .field = member<&BiaxialScene::weak, &WeakZone::cells>, .value = "0",
   .text = "Elements along each side of the square; 0: there is none. The square lies in the block."},
  {.path = "weak.column", .field = member<&BiaxialScene::weak, &WeakZone::column>, .value = "0",
   .text = "Its lowest element along x, counted from 0."},
  {.path = "weak.row", .field = member<&BiaxialScene::weak, &WeakZone::row>, .value = "0",
   .text = "Its lowest element along z, counted from 0."},
  {.path = "weak.factor", .field = member<&BiaxialScene::weak, &WeakZone::factor>, .value = "0.8", .range = positive,
   .text = "Of stiffness, and of the strength of iwan and mohr_coulomb (tan(phi), cohesion, tan(psi)); of no meaning "
           "to grains."},
  {.path = "weak.relative_density",
   .field = member<&BiaxialScene::weak, &WeakZone::grains, &SpecimenRequest::relative_density>,
   .presence = Presence::optional, .value = "0.4", .range = {-1, 2},
   .reason = "because D_r is 0 at e_max and 1 at e_min, and no packing is as far beyond",
   .text = "D_r of its packings; left out: that of the soil."},
  {.path = "weak.realisation", .field = member<&BiaxialScene::weak, &WeakZone::grains, &SpecimenRequest::realisation>,
   .value = "0", .text = "Seed of its packings."},

  {.path = "test.confinement", .field = member<&BiaxialScene::test, &BiaxialTest::confinement>, .unit = unit::kPa,
   .value = "100 kPa", .range = stresses, .reason = because_stresses,
   .text = "Isotropic effective stress at the start, and what is on the sides throughout, beside the pore pressure at "
           "the start."},
  {.path = "test.axial_strain", .field = member<&BiaxialScene::test, &BiaxialTest::axial_strain>, .value = "0.05",
   .range = {-0.5, 0.5}, .text = "At the end: way of the top over the height, compression positive."},
  {.path = "test.steps", .field = member<&BiaxialScene::test, &BiaxialTest::steps>, .value = "50", .range = counts,
   .text = "Equal load steps."},
  {.path = "test.duration", .field = member<&BiaxialScene::test, &BiaxialTest::duration>,
   .unit = {Dimension::time, "s"}, .value = "100 s", .range = positive,
   .text = "Of the test; counts only where water moves."},
};

constexpr const char *drainages[] = {"drained", "undrained"};

constexpr Key water_keys[] = {
  {.path = "water.drainage", .field = member<&BiaxialScene::water, &BlockWater::drainage>, .value = "drained",
   .choices = drainages,
   .text = "No excess pore pressure; or no water leaves the block (u-p, degree 2 with 3 points). Then axial_stress is "
           "total without the pressure at the start, the sides keep their total stress, and p and q of maps are "
           "effective."},
  {.path = "water.permeability", .field = member<&BiaxialScene::water, &BlockWater::permeability>, .unit = unit::m_s,
   .value = "0 m/s", .range = not_negative,
   .text = "Hydraulic conductivity k, by which water moves inside of an undrained block; 0 m/s: it does not."},
  {.path = "water.porosity", .field = member<&BiaxialScene::water, &BlockWater::porosity>, .value = "0.4",
   .range = {0, 1, true, true}, .text = "Share of the pores, whose water is compressible (2.2 GPa); undrained."},
};

constexpr Key output_keys[] = {
  {.path = "output.folder", .field = member<&BiaxialScene::output, &BiaxialOutput::folder>,
   .presence = Presence::optional, .value = "results/my-run",
   .text = "Folder of the run; left out: results/ and the name of the scene file."},
  {.path = "output.map_every", .field = member<&BiaxialScene::output, &BiaxialOutput::map_every>, .value = "5",
   .range = counts, .text = "Load steps between two ParaView files and rows of maps.h5."},
  {.path = "output.checkpoint", .field = member<&BiaxialScene::output, &BiaxialOutput::checkpoint_minutes>,
   .unit = unit::min, .value = "5 min", .range = positive,
   .text = "Wall-clock time between checkpoints, which are written between load steps."},
};

constexpr Dimension dimensions[] = {Dimension::length, Dimension::pressure, Dimension::rate, Dimension::interval,
                                    Dimension::velocity, Dimension::time};

constexpr const char *manual_head =
R"(# Scene reference of the biaxial block

A scene is one TOML file that says all about a run of `biaxial`. This page is generated from the table in
`apps/biaxial/scene.cpp` (`biaxial_scene_manual()`); a test compares them. Ready scenes are in `apps/scenes/biaxial`.

- Quantities are text with a unit: `"1 m"`, `"100 kPa"`, `"30 deg"`. A bare number, or the unit of something else, is an
  error. What has no dimension is a plain number.
- Numbers other than 0 are between 1e-30 and 1e30 in size, in SI units.
- An unknown key is an error, and so is a key twice. Compression is positive; x points across, z up.
- `--set key=value` on the command line overrides the file: `--set test.steps=100`.

)";
// clang-format on

void check_undrained(const SceneDocument &document, const BiaxialMesh &mesh)
{
  if (mesh.degree != 2)
    document.refuse("mesh.degree",
                    fmt::format("must be 2 in an undrained block, beside a pore pressure of degree 1, and "
                                "is {}. Give degree = 2 and points = 3.",
                                mesh.degree));
  if (mesh.points < 3)
    document.refuse("mesh.points", fmt::format("must be 3 or 4 in an undrained block, and is {}: with fewer, elements "
                                               "have modes that soil of constant volume does not resist. Give points = "
                                               "3.",
                                               mesh.points));
}

void check(const SceneDocument &document, const BiaxialScene &scene)
{
  if (scene.has_grains())
    check_packings(document, "soil", scene.grains);
  check_lot(document, "soil", scene.soil.grains, scene.grains.realisations, "soil.realisations");
  if (scene.soil.material == LayerMaterial::iwan)
    check_iwan(document, "soil", scene.soil.iwan);
  if (scene.soil.material == LayerMaterial::mohr_coulomb)
    check_mohr_coulomb(document, "soil", scene.soil.mohr_coulomb);
  check_newton(document, "newton", scene.newton);
  if (scene.nonlocal.length > 0 && scene.newton.relaxation_iterations == 0)
    document.refuse("nonlocal.length",
                    "needs relaxation, because the tangent of a nonlocal material is not one of its points. Set "
                    "newton.max_iterations = 0 and newton.relaxation_iterations = 1000.");
  if (scene.water.undrained())
    check_undrained(document, scene.mesh);
  else if (scene.water.permeability > 0)
    document.refuse("water.permeability",
                    "belongs to an undrained block. Give water.drainage = \"undrained\", or remove "
                    "it.");
  if (scene.weak.column + scene.weak.cells > scene.mesh.cells_across)
    document.refuse("weak.column",
                    fmt::format("and weak.cells = {} let the weak zone reach out of the block of {} elements "
                                "across. Correct one of them.",
                                scene.weak.cells, scene.mesh.cells_across));
  if (scene.weak.row + scene.weak.cells > scene.mesh.cells_up)
    document.refuse("weak.row",
                    fmt::format("and weak.cells = {} let the weak zone reach out of the block of {} elements "
                                "up. Correct one of them.",
                                scene.weak.cells, scene.mesh.cells_up));
}

BiaxialScene checked_scene(const SceneDocument &document)
{
  BiaxialScene scene;
  fill_scene(document, scene);
  check(document, scene);
  return scene;
}
} // namespace

const SceneSchema &biaxial_schema()
{
  static const KeyTable keys{
      block_keys,
      splice<&BiaxialScene::soil, &ColumnLayer::iwan>("soil", iwan_keys(), iwan),
      splice<&BiaxialScene::soil, &ColumnLayer::mohr_coulomb>("soil", mohr_coulomb_keys(), mohr_coulomb),
      splice<&BiaxialScene::grains>("soil", packing_keys(), grains),
      splice<&BiaxialScene::soil, &ColumnLayer::grains>("soil", specimen_keys(), grains),
      splice<&BiaxialScene::soil, &ColumnLayer::grains>("soil", lot_keys(), grains),
      test_keys,
      water_keys,
      splice<&BiaxialScene::newton>("newton", newton_keys()),
      output_keys};
  static const SceneSchema schema{.keys = keys.keys(),
                                  .sections = sections,
                                  .groups = {},
                                  .dimensions = dimensions,
                                  .set_example = "test.steps=100",
                                  .defaults_head = "A biaxial block with the defaults of every key. A line \"# key = "
                                                   "value\" is a key without default, with an example.",
                                  .manual_head = manual_head};
  return schema;
}

BiaxialScene parse_biaxial_scene(const std::string &text, const std::string &name)
{
  return checked_scene(SceneDocument(biaxial_schema(), text, name, {}));
}

BiaxialScene read_biaxial_scene(const std::string &path, const std::vector<std::string> &overrides)
{
  const SceneDocument document(biaxial_schema(), read_scene_text(path), path, overrides);
  BiaxialScene scene = checked_scene(document);
  if (scene.has_grains())
    scene.grains.library = found_file(document, "soil.library", path, scene.grains.library);
  if (scene.output.folder.empty())
    scene.output.folder = results_folder(path);
  return scene;
}

std::string to_toml(const BiaxialScene &scene) { return write_scene(biaxial_schema(), scene); }

std::string default_biaxial_scene() { return write_defaults(biaxial_schema()); }

std::string biaxial_scene_manual() { return write_manual(biaxial_schema()); }
} // namespace isostat
