// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/biaxial.hpp"

#include "apps/deposit/scene.hpp"
#include "base/scene/document.hpp"
#include "base/scene/ranges.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>

namespace isostat
{
namespace
{
using namespace ranges;

// clang-format off
constexpr Key of_block[] = {
  {.path = "confinement", .field = member<&Biaxial::confinement>, .unit = unit::kPa,
   .value = "100 kPa", .range = stresses, .reason = because_stresses,
   .text = "Isotropic effective stress at the start. With the initial pore pressure it acts on the sides throughout."},
  {.path = "axial_strain", .field = member<&Biaxial::axial_strain>, .value = "0.05", .range = {-0.5, 0.5},
   .reason = "because the mesh takes strains as small, and a half is far beyond",
   .text = "Final displacement of the top over the height, compression positive; not 0."},
  {.path = "test_duration", .field = member<&Biaxial::duration>, .unit = unit::s, .value = "100 s",
   .range = positive, .text = "Duration of the test; matters only where water moves."},
  {.path = "map_every", .field = member<&Biaxial::map_every>, .value = "5", .range = counts, .reason = one_or_more,
   .text = "Load steps between two ParaView files and rows of maps.h5."},

  {.path = "nonlocal", .table = true, .presence = Presence::optional, .value = "{ length = \"0.04 m\" }",
   .text = "A length that sets the thickness of a shear band, instead of the size of an element."},
  {.path = "nonlocal.length", .field = member<&Biaxial::nonlocal, &NonlocalParameters::length>, .unit = unit::m, .value = "0 m",
   .range = not_negative,
   .text = "Each point of the soil gets the mean strain around it, with Gaussian weights of this standard deviation; Gauss "
           "points should not be farther apart than about 1.6 of it. 0: its own strain. "
           "Above 0 m it needs max_iterations = 0 and relaxation."},
  {.path = "nonlocal.stiffness", .field = member<&Biaxial::nonlocal, &NonlocalParameters::stiffness>, .value = "1", .range = not_negative,
   .text = "Stiffness against differences between strain and mean strain, over the wave moduli at the start."},

  {.path = "weak", .table = true, .presence = Presence::optional, .value = "{ cells = 1, column = 3, row = 7 }",
   .text = "A square of elements that differs from the rest, where a shear band can start."},
  {.path = "weak.cells", .field = member<&Biaxial::weak, &WeakZone::cells>, .value = "0",
   .text = "Elements along each side of the square; 0: there is none. The square lies in the block."},
  {.path = "weak.column", .field = member<&Biaxial::weak, &WeakZone::column>, .value = "0", .text = "Its lowest element along x, counted from 0."},
  {.path = "weak.row", .field = member<&Biaxial::weak, &WeakZone::row>, .value = "0", .text = "Its lowest element along z, counted from 0."},
  {.path = "weak.factor", .field = member<&Biaxial::weak, &WeakZone::factor>, .value = "0.8", .range = positive,
   .text = "Of stiffness, and of the strength of iwan and mohr_coulomb (tan(phi), cohesion, tan(psi)); ignored by "
           "grains, umat and user."},
  {.path = "weak.relative_density", .field = member<&Biaxial::weak, &WeakZone::grains, &SpecimenRequest::relative_density>, .presence = Presence::optional, .value = "0.4", .range = {-1, 2},
   .reason = "because D_r is 0 at e_max and 1 at e_min, and no packing is as far beyond",
   .text = "D_r of its packings; left out: that of the soil."},
  {.path = "weak.realisation", .field = member<&Biaxial::weak, &WeakZone::grains, &SpecimenRequest::realisation>, .value = "0", .text = "Seed of its packings."},
};
// clang-format on

void check_weak_zone(const SceneDocument &document, const ColumnScene &scene)
{
  const WeakZone &weak = scene.biaxial.weak;
  for (const auto &[key, first, cells] : {std::tuple("analysis.weak.column", weak.column, scene.mesh.cells_across),
                                          {"analysis.weak.row", weak.row, cells_up(scene)}})
    if (first + weak.cells > cells)
      document.refuse(key, fmt::format("and weak.cells = {} let the weak zone reach out of the block of {} elements "
                                       "along this side. Correct one of them.",
                                       weak.cells, cells));
}

/// Keys that move, load or describe soil under its weight.
void refuse_beside_block(const SceneDocument &document, const ColumnScene &scene)
{
  const std::pair<const char *, bool> beside[] = {
      {"mesh.distributed", scene.mesh.distributed},
      {"mesh.sides", scene.mesh.sides != Sides::tied},
      {"water.table", scene.water.table > 0},
      {"water.base", scene.water.drained_base},
      {"slope.angle", scene.slope.tangent > 0},
      {"base.kind", scene.base.compliant()},
      {"motion", !scene.motions.empty()},
      {"load.kind", scene.load.kind != LoadKind::none},
      {"load.surcharge", scene.load.surcharge > 0},
      {"grains.path_depths", !scene.grain_output.path_depths.empty()},
      {"grains.snapshot_depths", !scene.grain_output.snapshot_depths.empty()},
      {"output.depths", !scene.output.depths.empty()},
      {"output.profile_interval", scene.output.profile_interval.has_value()},
      {"output.paraview_interval", scene.output.paraview_interval.has_value()}};
  for (const auto &[key, there] : beside)
    if (there)
      document.refuse(key, "has no effect on a biaxial block, which has no weight, and is moved by its top alone. "
                           "Remove it.");
}
} // namespace

SceneFragment<Biaxial> biaxial_keys() { return {of_block}; }

unsigned cells_up(const ColumnScene &scene)
{
  unsigned cells = 0;
  for (const ColumnLayer &layer : scene.layers)
    cells += layer.n_cells();
  return cells;
}

bool in_weak_zone(const ColumnScene &scene, const Place &place)
{
  const WeakZone &weak = scene.biaxial.weak;
  const auto inside = [&](double cell, unsigned first) { return cell > first && cell < first + weak.cells; };
  double below = 0, row = 0;
  for (auto layer = scene.layers.rbegin(); layer != scene.layers.rend() && place[2] > below; ++layer)
    {
      row += std::min(1.0, (place[2] - below) / layer->thickness) * layer->n_cells();
      below += layer->thickness;
    }
  return inside(place[0] / scene.mesh.width * scene.mesh.cells_across, weak.column) && inside(row, weak.row);
}

ColumnLayer weakened(const ColumnLayer &layer, const WeakZone &weak)
{
  ColumnLayer soil = layer;
  if (layer.from_formula())
    soil.shear_modulus = weak.factor * layer.small_strain_modulus();
  soil.shear_velocity.reset();
  soil.iwan.strength_ratio *= weak.factor;
  if (soil.shear_strength)
    *soil.shear_strength *= weak.factor;
  soil.iwan.phase_transformation_ratio *= weak.factor;
  soil.mohr_coulomb = weakened(soil.mohr_coulomb, weak.factor);
  soil.grains = weak.grains;
  soil.grains.library = layer.grains.library;
  if (!weak.grains.relative_density)
    soil.grains.relative_density = layer.grains.relative_density;
  return soil;
}

void check_biaxial(const SceneDocument &document, const ColumnScene &scene)
{
  if (scene.analysis.kind != AnalysisKind::biaxial)
    return;
  refuse_beside_block(document, scene);
  if (scene.mesh.dimension != 2)
    document.refuse("mesh.dimension", "must be 2 in a biaxial block, which is one in plane strain.");
  if (scene.biaxial.axial_strain == 0)
    document.refuse("analysis.axial_strain", "must not be 0, or nothing moves. Give for example 0.05.");
  if (scene.water.drainage == Drainage::coupled && scene.mesh.points > 0 && scene.mesh.points < 3)
    document.refuse("mesh.points", fmt::format("must be 3 or 4 in an undrained block, and is {}: with fewer, elements "
                                               "have modes that soil of constant volume does not resist. Give points = "
                                               "3.",
                                               scene.mesh.points));
  if (scene.biaxial.nonlocal.length > 0 && scene.load_steps.newton.relaxation_iterations == 0)
    document.refuse("analysis.nonlocal.length",
                    "needs relaxation, because the tangent of a nonlocal material is not one of its points. Set "
                    "analysis.max_iterations = 0 and analysis.relaxation_iterations = 1000.");
  check_weak_zone(document, scene);
}
} // namespace isostat
