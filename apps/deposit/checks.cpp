// SPDX-License-Identifier: BSD-3-Clause
// Rules that bind several keys of a column's scene.
#include "apps/deposit/box.hpp"
#include "apps/deposit/default_mesh.hpp"
#include "apps/deposit/mesh_file.hpp"
#include "apps/deposit/slope.hpp"
#include "base/scene/reader.hpp"
#include "coupling/scene/packings.hpp"
#include "fem/material/iwan_scene.hpp"
#include "fem/material/mohr_coulomb_scene.hpp"
#include "fem/solve/newton_scene.hpp"
#include "fem/water/pore_fluid.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>

namespace isostat
{
namespace
{
void check_mesh(const SceneDocument &document, const ColumnScene &scene)
{
  if (scene.water.drainage == Drainage::coupled && scene.mesh.degree != 2)
    document.refuse("mesh.degree",
                    "must be 2 if water.drainage is \"coupled\", because pore pressures oscillate in pairs "
                    "of equal degree. Give degree = 2, or drainage = \"undrained\" or \"dry\".");
  if (scene.water.drainage == Drainage::undrained && scene.mesh.dimension != 1)
    document.refuse("mesh.dimension",
                    "must be 1 if water.drainage is \"undrained\", because only in a column does the "
                    "pore pressure follow from vertical equilibrium. Give drainage = \"coupled\", if need "
                    "be with a permeability of 0 m/s.");
  if (scene.analysis.large_strain && scene.water.drainage == Drainage::undrained)
    document.refuse("analysis.large_strain",
                    "has no effect if water.drainage is \"undrained\": such a column keeps its length. Remove it, or "
                    "give drainage = \"coupled\" or \"dry\".");
  if (scene.water.drained_base && scene.water.drainage != Drainage::coupled)
    document.refuse("water.base",
                    "has no effect unless water.drainage is \"coupled\": only then water moves. Remove it.");
  if (scene.mesh.distributed && scene.mesh.dimension == 1)
    document.refuse("mesh.distributed", "must be false in a column (dimension 1), which every rank solves as a whole.");
  if (scene.water.lagged_compressibility && scene.water.drainage != Drainage::undrained)
    document.refuse("water.lagged_compressibility",
                    "has no effect unless water.drainage is \"undrained\": the stiffness "
                    "of the water is part of \"coupled\". Remove it.");
}

/// Whether all of a layer lies above the water table.
bool is_above_table(const ColumnScene &scene, std::size_t layer)
{
  constexpr double near = 1e-6; // m
  double bottom = 0;
  for (std::size_t k = 0; k <= layer; ++k)
    bottom += scene.layers[k].thickness;
  return scene.water.table > 0 && bottom <= scene.water.table + near;
}

/// Air matters to pressure alone, and that only where the volume of the soil may change.
bool feels_air(const ColumnScene &scene)
{
  return scene.water.drainage == Drainage::coupled ||
         (scene.water.drainage == Drainage::undrained && scene.water.lagged_compressibility);
}

void check_air(const SceneDocument &document, const ColumnScene &scene)
{
  constexpr const char *remedy = "has no effect if water.drainage is \"dry\" or \"undrained\" at constant volume. Give "
                                 "drainage = \"coupled\", or remove it.";
  bool has_free_air = false;
  for (std::size_t i = 0; i < scene.layers.size(); ++i)
    {
      if (scene.layers[i].saturation == 1)
        continue;
      has_free_air = true;
      const std::string key = fmt::format("layer.{}.saturation", i);
      if (!feels_air(scene))
        document.refuse(key, remedy);
      if (is_above_table(scene, i))
        document.refuse(key,
                        "has no effect above the water table (water.table): there is no pore pressure. Remove it.");
    }
  if (scene.water.henry > 0 && !feels_air(scene))
    document.refuse("water.henry", remedy);
  if (scene.water.henry > 0 && !has_free_air && scene.water.air == AirLaw::constant)
    document.refuse("water.henry", "has no effect in saturated soil whose air has a constant stiffness. Give "
                                   "water.air = \"boyle\", a layer a saturation below 1, or remove it.");
  if (scene.water.air != AirLaw::boyle)
    return;
  if (!has_boyle_air(soil_profile(scene)) || !feels_air(scene))
    document.refuse("water.air", feels_air(scene)
                                     ? "has no effect without air. Give a layer a saturation below 1 or water a "
                                       "henry above 0, or remove it."
                                     : remedy);
  if (scene.analysis.kind == AnalysisKind::consolidation)
    document.refuse("water.air",
                    "must be \"constant\" in a consolidation, whose air keeps the stiffness that it has in "
                    "situ. Remove it.");
}

/// What follows from other keys where it is not given: densities, K0, viscosity, the interval of rows.
void complete(const SceneDocument &document, ColumnScene &scene)
{
  const auto weigh = [&](auto &part) {
    if (part.unit_weight)
      part.density = *part.unit_weight / scene.water.gravity;
    part.unit_weight.reset();
  };
  weigh(scene.base);
  for (std::size_t i = 0; i < scene.layers.size(); ++i)
    {
      weigh(scene.layers[i]);
      if (!document.find(fmt::format("layer.{}.k0", i)))
        scene.layers[i].k0 = scene.layers[i].default_k0();
    }
  if (scene.analysis.kind == AnalysisKind::dynamic && !scene.analysis.viscosity)
    {
      const auto is_elastic = [](const ColumnLayer &layer) { return layer.material == LayerMaterial::elastic; };
      const bool rings =
          scene.analysis.scheme == TimeScheme::explicit_ && !std::ranges::all_of(scene.layers, is_elastic);
      scene.analysis.viscosity = rings ? 1e-4 : 0;
    }
  if (!document.find("output.history_interval"))
    scene.output.history_interval =
        std::min(scene.output.history_interval, 0.25 / scene.analysis.highest_frequency); // rows show f up to 1/(4 dt)
}

/// That of the shear modulus, whose own range says nothing of soil.
void check_shear_velocity(const SceneDocument &document, const ColumnLayer &layer, const std::string &prefix)
{
  const Range range = column_schema().find_key("layer.shear_velocity")->range;
  if (!layer.shear_modulus)
    return;
  if (const double velocity = std::sqrt(*layer.shear_modulus / layer.density); !range.contains(velocity))
    document.refuse(prefix + ".shear_modulus",
                    fmt::format("gives a shear-wave velocity sqrt(G/density) of {:.3g} m/s; must be in [{:g} m/s, {:g} "
                                "m/s]. Check its unit.",
                                velocity, range.low, range.high));
}

bool water_flows(const ColumnScene &scene)
{
  return scene.water.drainage == Drainage::coupled &&
         (scene.analysis.kind == AnalysisKind::dynamic || scene.analysis.kind == AnalysisKind::consolidation);
}

void check_layer(const SceneDocument &document, ColumnScene &scene, std::size_t i)
{
  if (scene.layers[i].material == LayerMaterial::iwan)
    check_curve(document, scene, i);
  const ColumnLayer &layer = scene.layers[i];
  if (scene.mesh.distributed && layer.material == LayerMaterial::user)
    document.refuse(fmt::format("layer.{}.material", i),
                    "must not be \"user\" if mesh.distributed is true, because such a material keeps its points as "
                    "a whole, which no checkpoint can share out. Give distributed = false.");
  const std::string prefix = fmt::format("layer.{}", i);
  if (scene.water.drainage != Drainage::dry && !is_above_table(scene, i) && layer.density <= scene.water.density)
    document.refuse(prefix + ".density", fmt::format("must be above that of water, {} kg/m3, or the soil floats away.",
                                                     number_text(scene.water.density)));
  if (scene.water.drainage == Drainage::coupled && !document.find(prefix + ".permeability"))
    document.refuse(prefix + ".permeability", "is missing; water.drainage = \"coupled\" needs it. Give for example "
                                              "permeability = \"1e-5 m/s\", or \"0 m/s\" if no water should move.");
  if (layer.permeability_law != PermeabilityLaw::constant && !water_flows(scene))
    document.refuse(prefix + ".permeability_law",
                    "has no effect where no water moves: in an analysis of kind plate or biaxial, and unless "
                    "water.drainage is \"coupled\". Remove it.");
  if (layer.permeability_law != PermeabilityLaw::constant && layer.permeability == 0)
    document.refuse(prefix + ".permeability_law", "has no effect on a permeability of 0 m/s. Remove one of them.");
  check_shear_velocity(document, layer, prefix);
  const bool block = scene.analysis.kind == AnalysisKind::biaxial; // neither K0 nor, dry, water
  if (block && scene.water.drainage == Drainage::dry && layer.permeability > 0)
    document.refuse(prefix + ".permeability", "has no effect in a block if water.drainage is \"dry\". Remove it.");
  if (layer.material == LayerMaterial::iwan)
    check_iwan(document, prefix, layer.sand(), layer.sand_density);
  if (layer.material == LayerMaterial::iwan && !block && !layer.curve.is_given())
    check_k0(document, prefix, layer.sand(), layer.k0);
  if (layer.material == LayerMaterial::mohr_coulomb)
    check_mohr_coulomb(document, prefix, layer.mohr_coulomb);
  if (layer.material == LayerMaterial::umat)
    check_umat(document, prefix, layer.umat);
  constexpr unsigned most = 1000000;
  if (layer.cells == 0 && layer.cell_size == 0 && !may_choose_cells(scene, layer))
    document.refuse(prefix, "must have exactly one of cells, cell_size. Give for example cells = 10. Only layers of "
                            "elastic, iwan and mohr_coulomb may leave them out, and only in a dynamic analysis.");
  if (layer.cell_size > 0 && !(layer.thickness / layer.cell_size <= most))
    document.refuse(prefix + ".cell_size", fmt::format("would give more than {} cells. Give a larger one.", most));
}

void check_base(const SceneDocument &document, const Base &base)
{
  if (base.compliant() &&
      base.rock_p_velocity() * base.rock_p_velocity() <= 4.0 / 3.0 * base.shear_velocity * base.shear_velocity)
    document.refuse("base.p_velocity", "must be more than 1.155 times shear_velocity, or the rock has no bulk modulus. "
                                       "Leave it out for twice.");
}

void check_motions(const SceneDocument &document, const ColumnScene &scene)
{
  for (std::size_t i = 0; i < scene.motions.size(); ++i)
    {
      const ColumnMotion &motion = scene.motions[i];
      const std::string prefix = fmt::format("motion.{}", i);
      for (std::size_t j = 0; j < i; ++j)
        if (scene.motions[j].axis == motion.axis)
          document.refuse(prefix + ".axis", fmt::format("already has a motion ({}). Give each axis one [[motion]].",
                                                        document.where(fmt::format("motion.{}", j))));
      if (motion.axis == Axis::z && scene.water.drainage == Drainage::undrained && scene.base.compliant())
        document.refuse(prefix + ".axis", "must not be z if water.drainage is \"undrained\" above a compliant base: at "
                                          "constant volume no P wave comes up. Give drainage = \"coupled\".");
      if (motion.kind == MotionKind::record && motion.file.empty())
        document.refuse(prefix + ".file", "must name a file. Give the path of a record.");
      if (motion.kind == MotionKind::harmonic && 2 * motion.ramp > motion.duration)
        document.refuse(prefix + ".ramp", fmt::format("must be at most half of the duration, {} s, because the sine "
                                                      "rises and falls once. Give a shorter one.",
                                                      number_text(motion.duration)));
    }
}

/// Implicit steps: what they need, and what they do not have.
void check_scheme(const SceneDocument &document, const ColumnScene &scene)
{
  if (scene.analysis.kind != AnalysisKind::dynamic)
    return;
  const bool implicit = scene.analysis.scheme == TimeScheme::implicit;
  if (!implicit && scene.analysis.spectral_radius != ColumnAnalysis().spectral_radius)
    document.refuse("analysis.spectral_radius",
                    "has no effect on explicit steps. Remove it, or give scheme = \"implicit\".");
  if (!implicit)
    return;
  constexpr const char *key = "analysis.scheme";
  if (!scene.analysis.time_step)
    document.refuse(key,
                    "is implicit, where accuracy alone decides the time step. Give analysis.time_step, a twentieth "
                    "of the shortest period of interest.");
  if (scene.analysis.safety != ColumnAnalysis().safety)
    document.refuse("analysis.safety", "has no effect on implicit steps, all of which are stable. Remove it.");
  if (*scene.analysis.viscosity > 0)
    document.refuse("analysis.viscosity",
                    "has no effect on implicit steps. Remove it; analysis.spectral_radius damps what is too fast.");
  if (scene.water.drainage == Drainage::undrained)
    document.refuse(key, "must be explicit if water.drainage is \"undrained\", where soil keeps its volume without a "
                         "pressure. Give drainage = \"coupled\", if need be with a permeability of 0 m/s.");
  if (scene.water.air == AirLaw::boyle)
    document.refuse(key, "must be explicit if water.air is \"boyle\". Give air = \"constant\".");
  if (scene.analysis.large_strain)
    document.refuse(key, "must be explicit if analysis.large_strain is true. Remove one of them.");
  if (scene.mesh.sides == Sides::free_field)
    document.refuse(key, "must be explicit if mesh.sides is \"free-field\". Give sides = \"tied\" or \"walls\".");
  if (scene.has_grains())
    document.refuse(key, "must be explicit in soil of grains, whose own steps are what a run costs. Remove it.");
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    if (const ColumnLayer &layer = scene.layers[k]; scene.water.drainage == Drainage::coupled &&
                                                    layer.material == LayerMaterial::iwan && layer.iwan.contraction > 0)
      document.refuse(key, fmt::format("must be explicit in sand that liquefies, layer.{}: displacements depend on the "
                                       "step there. Remove it, or give the layer contraction = 0.",
                                       k));
}

void check_analysis(const SceneDocument &document, const ColumnScene &scene)
{
  check_scheme(document, scene);
  if (scene.analysis.kind == AnalysisKind::plate || scene.analysis.kind == AnalysisKind::biaxial)
    check_newton(document, "analysis", scene.load_steps.newton);
  if (scene.analysis.kind != AnalysisKind::consolidation)
    return;
  if (scene.water.drainage != Drainage::coupled)
    document.refuse("water.drainage", "must be \"coupled\" in a consolidation, which is the flow of the water.");
  if (scene.load.kind != LoadKind::step)
    document.refuse("load.kind", "must be \"step\" in a consolidation, which starts with a load. Give [load] kind = "
                                 "\"step\" and an amplitude.");
  if (!scene.motions.empty())
    document.refuse("motion", "has no effect in a consolidation, where nothing shakes. Remove [[motion]].");
  if (scene.base.compliant())
    document.refuse("base.kind", "must be \"rigid\" in a consolidation, where no waves have to leave.");
  if (scene.analysis.last_time <= scene.analysis.first_time)
    document.refuse("analysis.last_time", fmt::format("must be after first_time, {} s. Correct one of them.",
                                                      number_text(scene.analysis.first_time)));
}

/// Options are those of the linear systems that the run has.
void check_petsc(const SceneDocument &document, const ColumnScene &scene)
{
  const bool shaken = scene.analysis.kind == AnalysisKind::dynamic,
             implicit = shaken && scene.analysis.scheme == TimeScheme::implicit;
  std::vector<std::string_view> prefixes;
  if (!shaken || implicit || scene.mesh.sides != Sides::tied)
    prefixes.push_back("-statics_");
  if (shaken && !implicit && scene.water.drainage == Drainage::coupled)
    prefixes.push_back("-water_");
  const bool has_pressures =
      scene.analysis.kind == AnalysisKind::consolidation || (implicit && scene.water.drainage == Drainage::coupled);
  if (!has_pressures && scene.analysis.petsc.find("-statics_pc_type fieldsplit") != std::string::npos)
    document.refuse("analysis.petsc", "splits displacements from pore pressures, which only consolidation and implicit "
                                      "steps of coupled soil solve for. Give -statics_pc_type gamg or hypre.");
  std::istringstream words(scene.analysis.petsc);
  bool follows = false; // a value, which may be a negative number
  for (std::string word; words >> word; follows = true)
    if (!follows || (word[0] == '-' && word.size() > 1 && !std::isdigit(static_cast<unsigned char>(word[1]))))
      if (std::ranges::none_of(prefixes, [&](std::string_view prefix) { return word.starts_with(prefix); }))
        document.refuse("analysis.petsc",
                        prefixes.empty()
                            ? "has no effect without a linear system. Remove it."
                            : fmt::format("has the word {}, but options begin with {} in this analysis. Correct it.",
                                          word, fmt::join(prefixes, " or ")));
}

void check_depths(const SceneDocument &document, const ColumnScene &scene, const std::string &key,
                  const std::vector<double> &depths)
{
  const MeshSpec mesh = mesh_spec(scene);
  const double height = mesh.on_line(0)[2];
  for (std::size_t i = 0; i < depths.size(); ++i)
    if (depths[i] > height * (1 + 1e-12)) // the sum of layers is rounded
      document.refuse(key, fmt::format("must lie in the soil, in [0 m, {} m], but entry {} is {} m.",
                                       number_text(height), i + 1, number_text(depths[i])));
}

void check_grains(const SceneDocument &document, const ColumnScene &scene)
{
  if (!scene.has_grains())
    return;
  if (scene.analysis.kind == AnalysisKind::consolidation)
    document.refuse("grains", "belongs to a dynamic analysis; a consolidation has no packings. Give analysis.kind = "
                              "\"dynamic\", or layers another material.");
  if (scene.needs_common_library())
    check_packings(document, "grains", scene.grains);
  for (std::size_t i = 0; i < scene.layers.size(); ++i)
    check_lot(document, fmt::format("layer.{}", i), scene.layers[i].grains, scene.grains.realisations,
              "grains.realisations");
  check_depths(document, scene, "grains.path_depths", scene.grain_output.path_depths);
  check_depths(document, scene, "grains.snapshot_depths", scene.grain_output.snapshot_depths);
}

void check_output(const SceneDocument &document, const ColumnScene &scene)
{
  if (scene.mesh.distributed)
    for (const auto &[key, given] : {std::pair("output.profile_interval", scene.output.profile_interval.has_value()),
                                     std::pair("output.paraview_interval", scene.output.paraview_interval.has_value())})
      if (given)
        document.refuse(key, "is not possible if mesh.distributed is true, where no rank has the whole depth. Remove "
                             "it, or give distributed = false.");
  check_depths(document, scene, "output.depths", scene.output.depths);
}
} // namespace

void check_column(const SceneDocument &document, ColumnScene &scene)
{
  check_groups(document, scene);
  complete(document, scene);
  check_mesh_file(document, scene);
  find_in_situ_states(scene);
  check_mesh(document, scene);
  check_box(document, scene);
  check_plate(document, scene);
  check_biaxial(document, scene);
  for (std::size_t i = 0; i < scene.layers.size(); ++i)
    check_layer(document, scene, i);
  check_air(document, scene);
  check_slope(document, scene);
  check_base(document, scene.base);
  check_motions(document, scene);
  check_grains(document, scene);
  check_analysis(document, scene);
  check_petsc(document, scene);
  check_output(document, scene);
}
} // namespace isostat
