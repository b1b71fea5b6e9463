// SPDX-License-Identifier: BSD-3-Clause
// The keys of a column's scene file. A new key is one entry here and one field in apps/deposit/scene.hpp; a rule that
// binds several keys is in apps/deposit/checks.cpp. Keys of formulas are in fem/material/iwan_scene.cpp and
// fem/material/mohr_coulomb_scene.cpp, those of air and viscosity in fem/water/pore_fluid_scene.cpp, those of packings
// in coupling/scene/packings.cpp.
#include "apps/deposit/box.hpp"
#include "apps/deposit/slope.hpp"

#include "base/scene/ranges.hpp"
#include "coupling/scene/packings.hpp"
#include "fem/material/iwan_scene.hpp"
#include "fem/material/mohr_coulomb_scene.hpp"
#include "fem/water/pore_fluid_scene.hpp"

namespace isostat
{
namespace
{
constexpr const char *base_choices[] = {"rigid", "compliant"};
constexpr const char *water_base_choices[] = {"closed", "drained"};
constexpr const char *permeability_laws[] = {"constant", "kozeny-carman"};
constexpr const char *load_axes[] = {"x", "y", "z"};
constexpr const char *load_choices[] = {"none", "step", "harmonic"};

using namespace ranges;
constexpr const char *because_rock = "because rock is not as light as water, nor as heavy as iron";

constexpr unsigned iwan = kind_bit(LayerMaterial::iwan);
constexpr unsigned mohr_coulomb = kind_bit(LayerMaterial::mohr_coulomb);
constexpr unsigned formula = kind_bit(LayerMaterial::elastic) | iwan | mohr_coulomb;
constexpr unsigned grains = kind_bit(LayerMaterial::grains);
constexpr unsigned compliant = kind_bit(BaseKind::compliant);
constexpr unsigned loaded = kind_bit(LoadKind::step) | kind_bit(LoadKind::harmonic);
constexpr unsigned dynamic = kind_bit(AnalysisKind::dynamic);
constexpr unsigned slow = kind_bit(AnalysisKind::plate) | kind_bit(AnalysisKind::biaxial);
constexpr unsigned consolidation = kind_bit(AnalysisKind::consolidation);

// clang-format off
constexpr Section sections[] = {
  {.name = "mesh", .text = "Elements of the soil. In every dimension the displacement has three components."},
  {.name = "refine",
   .text = "Elements that are smaller in a box, in 2 and 3 dimensions, not of a biaxial block: each `[[refine]]` halves "
           "those in it along all axes. With tied sides opposite ones are halved alike. docs/column.md.",
   .items = items_of<&ColumnScene::refine>, .empty_remedy = "Leave it out if no element is halved.",
   .set_example = "levels=2"},
  {.name = "water", .text = "Pore water. The water table, at the surface unless `table` says otherwise, drains freely."},
  {.name = "slope",
   .text = "The ground as an infinite slope. All axes turn with it: x points down the slope, depths are normal to the "
           "surface, and the soil carries a static shear stress from the start. In-situ stresses, safety, large "
           "displacements: docs/theory_column.md, section 8."},
  {.name = "layer",
   .text = "The soil: every `[[layer]]` is one layer, from the surface downwards as a borehole log reads. A key that "
           "does not belong to the material of its layer is an error. Give at most one of `cells` and `cell_size`, "
           "and, of elastic, iwan and mohr_coulomb, exactly one of `shear_velocity` and `shear_modulus`.",
   .kind_key = "material", .items = items_of<&ColumnScene::layers>, .needed = true,
   .empty_remedy = "Write [[layer]] with its thickness for each layer, from the surface downwards.",
   .default_kind = "elastic", .set_example = "thickness=\"2 m\"", .kinds_title = "Materials"},
  {.name = "base", .text = "What lies under the lowest layer.", .kind_key = "kind", .kinds_title = "Base kinds"},
  {.name = "motion",
   .text = "The acceleration of a rigid base, or of the outcrop of the rock if the base is compliant: one `[[motion]]` for "
           "each axis that moves (x and y horizontal, z up). Without any, the base is at rest.",
   .kind_key = "kind", .items = items_of<&ColumnScene::motions>,
   .empty_remedy = "Leave it out if the base is at rest.", .default_kind = "ricker",
   .set_example = "amplitude=\"0.1 g\"", .kinds_title = "Motion kinds"},
  {.name = "load", .text = "Traction on the surface.", .kind_key = "kind", .kinds_title = "Load kinds"},
  {.name = "grains",
   .text = "Packings of grains at the Gauss points of the layers whose material is \"grains\", with the law and rate "
           "control of the element tests."},
  {.name = "analysis",
   .text = "Waves (dynamic), the slow flow of water out of loaded soil without inertia (consolidation), a plate that moves "
           "slowly into a box of soil (plate), or a block without weight in plane strain, confined on its sides and "
           "compressed by its top (biaxial).",
   .kind_key = "kind", .kinds_title = "Analysis kinds"},
  {.name = "output", .text = "What is written, and how often. Output never changes a run."},
};

constexpr Key title_key[] = {
  {.path = "title", .field = member<&ColumnScene::title>, .text = "What the scene shows; heads tables and figures."},
};

constexpr Key mesh_keys[] = {
  {.path = "dimension", .field = member<&ColumnMesh::dimension>, .value = "1", .range = {1, 3},
   .reason = "because space has as many",
   .text = "1: a column, one Gauss-point stress per depth; 2: a plane strip (x, z); 3: a block."},
  {.path = "degree", .field = member<&ColumnMesh::degree>, .value = "2", .range = {1, 2},
   .reason = "because elements are linear or quadratic",
   .text = "Degree of the displacement in an element; the pore pressure has degree 1. 2 where drainage is \"coupled\"."},
  {.path = "width", .field = member<&ColumnMesh::width>, .unit = unit::m, .value = "1 m", .range = positive,
   .text = "Extent of a strip or block along x, of a block along y too; that of `file`."},
  {.path = "cells_across", .field = member<&ColumnMesh::cells_across>, .value = "1", .range = counts,
   .reason = one_or_more, .text = "Elements over the width; left out with `file`."},
  {.path = "distributed", .field = member<&ColumnMesh::distributed>, .value = "false",
   .text = "One mesh shared out over all MPI ranks, without profiles and files for ParaView; false: a copy on every "
           "rank, whose results are the same bits for any number of ranks. Of dimension 2 or 3, without a plate and "
           "materials of the user."},
};

constexpr Key water_keys[] = {
  {.path = "drainage", .field = member<&ColumnWater::drainage>, .value = "coupled", .choices = drainage_names,
   .text = "No water; saturated at constant volume without flow (a column only); or displacement and pore pressure "
           "coupled (u-p). Of a biaxial block dry: no excess pore pressure; coupled: no water leaves it. The sides keep "
           "their total stress then, axial_stress is total without the pressure at the start, and p and q of maps are "
           "effective."},
  {.path = "density", .field = member_of<ColumnWater, &ColumnWater::density>, .unit = unit::kg_m3,
   .value = "1000 kg/m3", .range = positive, .text = "Density of the water."},
  {.path = "bulk_modulus", .field = member_of<ColumnWater, &ColumnWater::bulk_modulus>, .unit = unit::GPa,
   .value = "2.2 GPa", .range = positive,
   .text = "Bulk modulus K_w of the water; air in it (`layer.saturation`) makes it softer."},
  {.path = "gravity", .field = member_of<ColumnWater, &ColumnWater::gravity>, .unit = unit::m_s2, .value = "9.81 m/s2",
   .range = positive, .text = "Acceleration of gravity, also for the weight of the soil."},
  {.path = "table", .field = member<&ColumnWater::table>, .unit = unit::m, .value = "0 m", .range = not_negative,
   .text = "Depth of the water table, on a boundary between elements; not where drainage is \"dry\". Soil above "
           "it has neither pore pressure nor buoyancy, also if drainage is \"undrained\"; its weight follows from the "
           "density of its layer, moisture included. Less than the height of the soil; 0 m in a box and on a submerged "
           "slope."},
  {.path = "base", .field = member<&ColumnWater::drained_base>, .value = "closed", .choices = water_base_choices,
   .text = "Whether water leaves through the base as well, as into gravel below: its excess pressure is 0 there. "
           "drained only where drainage is \"coupled\"."},
  {.path = "lagged_compressibility", .field = member<&ColumnWater::lagged_compressibility>, .value = "false",
   .text = "Undrained only: the volume changes by -dp/Q of the previous step, as with water of finite stiffness. The "
           "fluid must be stiffer than the skeleton, K_f/n > M."},
};

constexpr Key layer_keys[] = {
  {.path = "name", .field = member_of<ColumnLayer, &ColumnLayer::name>,
   .text = "Name of the layer, for tables and figures; with `mesh.file` its own."},
  {.path = "thickness", .field = member_of<ColumnLayer, &ColumnLayer::thickness>, .unit = unit::m,
   .presence = Presence::required, .value = "5 m", .range = {1e-3, 1e5},
   .reason = "because a layer without height has no cells, and the crust of the Earth is not as thick",
   .text = "Thickness of the layer; left out with `mesh.file`, whose cells it has: the mean."},
  {.path = "table", .field = member<&ColumnLayer::table>, .presence = Presence::optional, .value = "profile.csv",
   .kinds = formula,
   .text = "A CSV file in place of thickness, shear_velocity and density: its rows, from the surface down, become "
           "layers that share all other keys of this one. Its first line names the columns `thickness (m)`, "
           "`shear_velocity (m/s)` and `density (kg/m3)`; others are ignored. The path is like that of `motion.file`."},
  {.path = "cells", .field = member_of<ColumnLayer, &ColumnLayer::cells>, .presence = Presence::optional,
   .value = "10", .range = counts, .reason = one_or_more, .group = "cells",
   .text = "Elements through the thickness. A layer of elastic, iwan or mohr_coulomb in a dynamic analysis may leave "
           "out this and `cell_size`: its elements then carry waves of the motion up to `highest_frequency`, at ten "
           "nodes to a wave of its V_s in situ (0.4 of it in iwan and mohr_coulomb, which soften), and are at most 2 m "
           "(1 m) high. The resolved scene has the number."},
  {.path = "cell_size", .field = member_of<ColumnLayer, &ColumnLayer::cell_size>, .unit = unit::m,
   .presence = Presence::optional, .value = "0.5 m", .range = positive, .group = "cells",
   .text = "Largest height of an element; the layer gets the fewest elements that respect it. At most 1000000 "
           "elements."},
  {.path = "density", .field = member_of<ColumnLayer, &ColumnLayer::density>, .unit = unit::kg_m3,
   .value = "2000 kg/m3", .range = {500, 4000},
   .reason = "because dry peat is hardly lighter, and soil is not as heavy as ore", .group = "weight",
   .text = "Density of soil and water together; above a water table with its moisture, without water that of dry "
           "soil. Above that of the water where there is any."},
  {.path = "unit_weight", .field = member<&ColumnLayer::unit_weight>, .unit = unit::kN_m3,
   .presence = Presence::optional, .value = "18.5 kN/m3", .range = {5e3, 40e3},
   .reason = "because dry peat is hardly lighter, and soil is not as heavy as ore", .group = "weight",
   .text = "In place of the density: density times `water.gravity`. The resolved scene has the density."},
  {.path = "porosity", .field = member_of<ColumnLayer, &ColumnLayer::porosity>, .value = "0.4", .range = fraction,
   .reason = "because soil has both grains and pores", .text = "Pore volume over total volume."},
  {.path = "permeability", .field = member_of<ColumnLayer, &ColumnLayer::permeability>, .unit = unit::m_s,
   .presence = Presence::experiment, .value = "1e-5 m/s", .range = {0, 1},
   .reason = "because water flows down the gradient, and through gravel no faster",
   .text = "Hydraulic conductivity k; 0 m/s: no water moves. Must be given if the drainage is coupled."},
  {.path = "permeability_law", .field = member_of<ColumnLayer, &ColumnLayer::permeability_law>, .value = "constant",
   .choices = permeability_laws,
   .text = "constant: `permeability` at all times; kozeny-carman: that at the void ratio e of `porosity`, from which it "
           "follows e^3/(1 + e) as the pores close and open (docs/theory_column.md), and the storage of the water "
           "follows n. Only where drainage is \"coupled\" and water moves."},
  {.path = "k0", .field = member_of<ColumnLayer, &ColumnLayer::k0>, .presence = Presence::optional, .value = "0.5",
   .range = {0, 5, true}, .reason = "because both stresses are compression, and at 5 soil with 42 deg of friction fails",
   .text = "Horizontal over vertical effective stress in situ; on a slope, along the surface over normal to it. Left "
           "out: 1 - sin(phi) of mohr_coulomb; 1 - `strength_ratio` of iwan, whose sin(phi) in simple shear that is, "
           "but so that at most 0.9 of the strength is used; else 0.5."},
  {.path = "material", .field = member<&ColumnLayer::material>, .presence = Presence::required, .value = "elastic",
   .choices = material_names,
   .text = "Law of the soil skeleton: linear elastic; parallel slip elements (Iwan) whose stiffness and strength "
           "follow the mean effective stress; friction and cohesion (Mohr-Coulomb); a packing of grains at every "
           "Gauss point, see [grains]; a shared library with the interface of Abaqus (umat); or the user's law, which isostat.column.run() in Python takes by the name of "
           "the layer (docs/python.md), not with mesh.distributed."},
  {.path = "shear_velocity", .field = member<&ColumnLayer::shear_velocity>, .unit = unit::m_s,
   .presence = Presence::experiment, .value = "200 m/s", .range = {1, 6000},
   .reason = "because waves in mud are as slow, and in no rock as fast", .kinds = formula, .group = "stiffness",
   .text = "Shear-wave velocity V_s at small strain: G = density V_s^2; for iwan and mohr_coulomb at "
           "`reference_pressure`."},
  {.path = "shear_modulus", .field = member<&ColumnLayer::shear_modulus>, .unit = unit::MPa,
   .presence = Presence::optional, .value = "80 MPa", .range = stresses, .reason = because_stresses, .kinds = formula,
   .group = "stiffness",
   .text = "Shear modulus G at small strain; for iwan and mohr_coulomb at `reference_pressure`."},
  {.path = "reference_pressure", .field = member<&ColumnLayer::reference_pressure>, .unit = unit::kPa,
   .presence = Presence::optional, .value = "100 kPa", .range = stresses, .reason = because_stresses,
   .kinds = iwan | mohr_coulomb,
   .text = "Mean effective stress p_r at which the stiffness is given; left out: that in situ in the middle of the "
           "layer, so that V_s is the one measured there."},
  {.path = "poisson_ratio", .field = member<&ColumnLayer::poisson_ratio>, .value = "0.3",
   .range = {0, 0.5, false, true},
   .reason = "because the skeleton does not widen when it is stretched, and is compressible without its water",
   .kinds = formula, .text = "Poisson's ratio of the drained skeleton."},
  {.path = "damping", .field = member<&ColumnLayer::damping>, .presence = Presence::optional, .value = "0.01",
   .range = {0, 0.1}, .reason = "because more is not small: the soil would be three times as stiff at 30 Hz as at rest",
   .kinds = kind_bit(LayerMaterial::elastic) | iwan,
   .text = "Damping at small strain, ratio of critical, the same at all frequencies from 0.1 to 30 Hz; left out: that of "
           "`curve` at its smallest strain, else 0. V_s is that at 1 Hz then, and the time step is shorter. Not in a "
           "static analysis."},
};

constexpr Key shear_strength_key[] = {
  {.path = "shear_strength", .field = member<&ColumnLayer::shear_strength>, .unit = unit::kPa,
   .presence = Presence::optional, .value = "60 kPa", .range = stresses, .reason = because_stresses, .kinds = iwan,
   .text = "Shear strength at the mean effective stress in the middle of the layer, in place of `strength_ratio`."},
};

constexpr Key own_sand_key[] = {
  {.path = "library", .field = member<&ColumnLayer::grains, &SpecimenRequest::library>, .presence = Presence::optional,
   .value = "gravel.h5", .kinds = grains,
   .text = "Specimens of this layer's sand where it differs from that of `grains.library`; the path is like that one."},
};

constexpr Key base_keys[] = {
  {.path = "kind", .field = member_of<ColumnBase, &Base::kind>, .value = "rigid", .choices = base_choices,
   .text = "rigid: it has the given motion; compliant: elastic rock that absorbs waves (Lysmer dashpot); the motion "
           "is that of its outcrop."},
  {.path = "density", .field = member_of<ColumnBase, &Base::density>, .unit = unit::kg_m3,
   .presence = Presence::experiment, .value = "2300 kg/m3", .range = {1000, 5000}, .reason = because_rock,
   .kinds = compliant, .group = "rock weight", .text = "Density of the rock."},
  {.path = "unit_weight", .field = member<&ColumnBase::unit_weight>, .unit = unit::kN_m3,
   .presence = Presence::optional, .value = "23 kN/m3", .range = {10e3, 50e3}, .reason = because_rock,
   .kinds = compliant, .group = "rock weight", .text = "In place of the density, as that of a layer."},
  {.path = "shear_velocity", .field = member_of<ColumnBase, &Base::shear_velocity>, .unit = unit::m_s,
   .presence = Presence::required, .value = "800 m/s", .range = positive, .kinds = compliant,
   .text = "Shear-wave velocity in the rock."},
  {.path = "p_velocity", .field = member_of<ColumnBase, &Base::p_velocity>, .unit = unit::m_s, .presence = Presence::optional,
   .value = "1600 m/s", .range = positive, .kinds = compliant,
   .text = "P-wave velocity in the rock; left out: twice the shear velocity. More than 1.155 times the shear velocity."},
};

constexpr Key load_keys[] = {
  {.path = "kind", .field = member<&ColumnLoad::kind>, .value = "none", .choices = load_choices,
   .text = "How the traction varies in time."},
  {.path = "surcharge", .field = member<&ColumnLoad::surcharge>, .unit = unit::kPa, .value = "0 kPa",
   .range = not_negative,
   .text = "Vertical load per unit of surface, present from the start as part of the in-situ effective stress; on a "
           "slope its part along x is carried by shear."},
  {.path = "direction", .field = member<&ColumnLoad::direction>, .value = "z", .choices = load_axes, .kinds = loaded,
   .text = "Direction of the traction; along z compression is positive."},
  {.path = "amplitude", .field = member<&ColumnLoad::amplitude>, .unit = unit::kPa, .presence = Presence::required,
   .value = "10 kPa", .kinds = loaded, .text = "The traction, or the amplitude of its sine."},
  {.path = "frequency", .field = member<&ColumnLoad::frequency>, .unit = unit::Hz, .presence = Presence::required,
   .value = "1 Hz", .range = positive, .kinds = kind_bit(LoadKind::harmonic), .text = "Frequency of the sine."},
  {.path = "ramp", .field = member<&ColumnLoad::ramp>, .unit = unit::s, .value = "0 s", .range = not_negative,
   .kinds = loaded, .text = "Time in which the traction rises smoothly from zero."},
};

constexpr Key grain_output_keys[] = {
  {.path = "snapshot_depths", .field = member<&GrainOutput::snapshot_depths>, .unit = unit::m,
   .presence = Presence::optional, .value = "[\"2 m\", \"5 m\"]", .range = not_negative,
   .text = "Depths at which whole packings are stored, for ParaView and the program `micromechanics`. Within the soil."},
  {.path = "path_depths", .field = member<&GrainOutput::path_depths>, .unit = unit::m, .presence = Presence::optional,
   .value = "[\"5 m\"]", .range = not_negative,
   .text = "Depths at which the strain of every step and the stress after it are stored, for the program "
           "`rve_replay`, which strains the packing alone in the same way. Within the soil."},
  {.path = "snapshot_interval", .field = member<&GrainOutput::snapshot_interval>, .unit = unit::s, .value = "1 s",
   .range = positive, .text = "Time between them."},
};

constexpr Key output_keys[] = {
  {.path = "folder", .field = member<&ColumnOutput::folder>, .presence = Presence::optional, .value = "results/my-run",
   .text = "Folder of the run; left out: results/ and the name of the scene file."},
  {.path = "history_interval", .field = member<&ColumnOutput::history_interval>, .unit = unit::s, .value = "0.01 s",
   .range = {0, 10, true}, .reason = "because rows further apart show no shaking",
   .text = "Time between rows of the histories. A time step that is not given divides it; it is rounded to whole steps "
           "of one that is given or of a soil with grains, and if it is shorter every step has a row. A consolidation "
           "writes every step. Left out "
           "of a dynamic analysis whose `highest_frequency` f is above 25 Hz: 1/(4 f)."},
  {.path = "depths", .field = member<&ColumnOutput::depths>, .unit = unit::m, .presence = Presence::optional,
   .value = "[\"2 m\", \"5 m\"]", .range = not_negative,
   .text = "Depths below the surface at which stress paths and motions are recorded. Within the soil."},
  {.path = "x", .field = member<&ColumnOutput::x>, .unit = unit::m, .presence = Presence::optional, .value = "10 m",
   .range = not_negative,
   .text = "Of a strip: x of the vertical along which histories, depths and profiles are; left out: the middle between "
           "walls, else 0 m, as all x are equal where sides are tied."},
  {.path = "profile_interval", .field = member<&ColumnOutput::profile_interval>, .unit = unit::s,
   .presence = Presence::optional, .value = "0.1 s", .range = positive,
   .text = "Time between profiles over the depth, rounded to whole time steps; left out: maxima only. A consolidation "
           "writes every step."},
  {.path = "paraview_interval", .field = member<&ColumnOutput::paraview_interval>, .unit = unit::s,
   .presence = Presence::optional, .value = "0.5 s", .range = positive,
   .text = "Time between files for ParaView, rounded likewise; left out: none. A consolidation writes every step."},
  {.path = "checkpoint", .field = member<&ColumnOutput::checkpoint_minutes>, .unit = unit::min, .value = "5 min",
   .range = positive, .text = "Wall-clock time between checkpoints."},
  {.path = "spectrum_damping", .field = member<&ColumnOutput::spectrum_damping>, .value = "0.05",
   .range = {0, 1, false, true}, .reason = "because this is a fraction of critical",
   .text = "Damping of the oscillators of response spectra."},
};

constexpr KeyGroup groups[] = {{"cells"}, {"weight"}, {"rock weight", "density = \"2300 kg/m3\""}, {"stiffness", "shear_velocity = \"200 m/s\""}, {"scale"}, {"resistance"}};

using enum Dimension;
constexpr Dimension dimensions[] = {length, pressure, angle, rate, density, unit_weight, velocity, acceleration, frequency, duration, interval};

constexpr const char *defaults_head =
    "A soil column with the defaults of every key. A line \"# key = value\" is a key without default, with an example. "
    "What makes the experiment (layers, motion, duration) has no default and shows an example.";

constexpr const char *manual_head =
R"(# Scene reference of the soil column

A scene is one TOML file that describes a run of `soil_column`. This page is generated from the table in
`apps/deposit/schema.cpp` (`column_scene_manual()`); a test compares them. Ready scenes are in `apps/scenes/column`.

- Quantities are text with a unit: `"10 m"`, `"200 m/s"`, `"1e-5 m/s"`, `"0.2 g"`. A bare number, or the
  unit of something else, is an error. What has no dimension is a plain number.
- Numbers other than 0 are between 1e-30 and 1e30 in size, in SI units.
- An unknown key is an error, and so is a repeated key. Compression is positive; z points up, depths count downwards.
- `--set key=value` on the command line overrides the file: `--set analysis.safety=0.5`,
  `--set layer.0.thickness="4 m"` (the uppermost layer), `--set motion.0.peak="0.3 g"`. Of keys that exclude each
  other, the one set this way replaces the one in the file.

)";
// clang-format on
} // namespace

const SceneSchema &column_schema()
{
  static const KeyTable keys{title_key,
                             splice<&ColumnScene::mesh>("mesh", mesh_keys),
                             splice<&ColumnScene::mesh>("mesh", box_keys()),
                             KeyRun(refinement_keys().keys, "refine"),
                             splice<&ColumnScene::water>("water", water_keys),
                             splice<&ColumnScene::water>("water", pore_fluid_keys()),
                             splice<&ColumnScene::slope>("slope", slope_keys()),
                             KeyRun(layer_keys, "layer"),
                             splice("layer", saturation_keys(), 0, [](ColumnLayer &layer) -> Layer & { return layer; }),
                             splice<&ColumnLayer::curve>("layer", curve_keys(), iwan),
                             KeyRun(shear_strength_key, "layer"),
                             splice<&ColumnLayer::iwan>("layer", iwan_keys(), iwan),
                             splice<&ColumnLayer::sand_density>("layer", sand_density_keys(), iwan),
                             splice<&ColumnLayer::mohr_coulomb>("layer", mohr_coulomb_keys(), mohr_coulomb),
                             splice<&ColumnLayer::grains>("layer", specimen_keys(), grains),
                             KeyRun(own_sand_key, "layer"),
                             splice<&ColumnLayer::umat>("layer", umat_keys(), kind_bit(LayerMaterial::umat)),
                             splice<&ColumnLayer::grains>("layer", lot_keys(), grains),
                             splice<&ColumnScene::base>("base", base_keys),
                             KeyRun(ground_motion_keys().keys, "motion"),
                             splice<&ColumnScene::load>("load", strip_load_keys()),
                             splice<&ColumnScene::load>("load", load_keys),
                             splice<&ColumnScene::grains>("grains", packing_keys()),
                             splice<&ColumnScene::grain_output>("grains", grain_output_keys),
                             splice<&ColumnScene::analysis>("analysis", analysis_keys()),
                             splice<&ColumnScene::plate>("analysis", plate_keys(), kind_bit(AnalysisKind::plate)),
                             splice<&ColumnScene::biaxial>("analysis", biaxial_keys(), kind_bit(AnalysisKind::biaxial)),
                             splice<&ColumnScene::load_steps>("analysis", load_step_keys(), slow),
                             splice<&ColumnScene::output>("output", output_keys)};
  static const SceneSchema schema{.keys = keys.keys(),
                                  .sections = sections,
                                  .groups = groups,
                                  .dimensions = dimensions,
                                  .set_example = "analysis.safety=0.5",
                                  .defaults_head = defaults_head,
                                  .manual_head = manual_head};
  return schema;
}
} // namespace isostat
