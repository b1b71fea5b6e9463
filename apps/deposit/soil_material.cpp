// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/soil_material.hpp"

#include "apps/deposit/resistance.hpp"
#include "base/error.hpp"
#include "dem/prepare/random.hpp"
#include "fem/material/corotational.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <set>

namespace isostat
{
namespace
{
/// See SoilMaterial::seeds.
std::vector<std::vector<std::size_t>> drawn_seeds(const ColumnScene &scene,
                                                  const std::vector<SpecimenRequest> &requests)
{
  if (std::ranges::none_of(requests, [](const SpecimenRequest &request) { return request.mixed > 1; }))
    return {};
  std::vector<std::vector<std::size_t>> seeds;
  for (const SpecimenRequest &request : requests)
    {
      std::vector<std::size_t> &of_point = seeds.emplace_back();
      for (std::size_t k = 0; k < scene.grains.realisations; ++k)
        of_point.push_back(request.seed_of(k));
    }
  return seeds;
}

/// What messages call a point: "layer.0 (sand), depth 2.5 m", in a strip or block with x and y.
std::string point_name(const ColumnScene &scene, const CellTables &mesh, std::size_t q)
{
  const std::size_t layer = mesh.cell_layer[q / mesh.points_per_cell()];
  const std::string &name = scene.layers[layer].name;
  std::string text = fmt::format("layer.{}{}, depth {:.4g} m", layer, name.empty() ? "" : " (" + name + ")",
                                 mesh_spec(scene).depth(mesh.position[q]));
  for (unsigned axis = 0; axis + 1 < scene.mesh.dimension; ++axis)
    text += fmt::format(", {} {:.4g} m", "xy"[axis], mesh.position[q][axis]);
  return text;
}

/// The law of a library at some points.
std::unique_ptr<Material> placed_umat(const ColumnScene &scene, const CellTables &mesh, const ColumnLayer &soil,
                                      const std::vector<std::size_t> &points)
{
  std::vector<UmatPoint> places;
  for (std::size_t q : points)
    places.push_back({static_cast<int>(q) + 1, mesh.position[q], point_name(scene, mesh, q)});
  return std::make_unique<Umat>(soil.umat, soil.name, std::move(places));
}

/// A layer without grains at some points with their stress.
std::unique_ptr<Material> stressed_layer(const ColumnScene &scene, const CellTables &mesh, const ColumnLayer &soil,
                                         std::size_t layer, const std::vector<std::size_t> &points,
                                         const std::vector<Stress> &in_situ, const UserMaterials &user)
{
  try
    {
      auto material = soil.material == LayerMaterial::umat ? placed_umat(scene, mesh, soil, points)
                                                           : layer_material(soil, points.size(), user);
      if (scene.analysis.large_strain)
        material = std::make_unique<Corotational>(std::move(material));
      std::vector<Stress> stresses;
      for (std::size_t q : points)
        stresses.push_back(in_situ[q]);
      material->set_initial_stress(stresses);
      return material;
    }
  catch (const InputError &error)
    {
      throw InputError(fmt::format("layer.{} ({}): {}. Points count from the lower end of the layer; correct {}.",
                                   layer, soil.name, error.what(),
                                   soil.material == LayerMaterial::umat ? "umat.props, umat.statev or the layer's k0"
                                                                        : "the layer's k0 or its material"));
    }
}

/// The packings of a soil.   @throws InputError  of a slope that they cannot bear: layer, depth, and remedies
void bring_to_stress(const ColumnScene &scene, RveMaterial &grains, const std::vector<Stress> &stresses)
{
  try
    {
      grains.set_initial_stress(stresses);
    }
  catch (const RunFailure &failure)
    {
      if (!ground_line(scene.mesh).is_level())
        throw InputError(
            fmt::format("{}\n  The ground may be too steep for the packings. Give it a gentler one "
                        "(mesh.ground_z, mesh.file), denser packings (relative_density), or a k0 nearer to 1.",
                        failure.what()));
      if (scene.slope.tangent == 0)
        throw;
      throw InputError(
          fmt::format("{}\n  The slope may be too steep for the packings. Give a smaller slope.angle, denser "
                      "packings (relative_density), a k0 nearer to 1, or a deeper water.table.",
                      failure.what()));
    }
}

/// In situ stress in a box or a mesh of a file: K0 at the depth below the ground, and the shear stress by which the
/// horizontal stress, which falls with the ground, is in equilibrium on every vertical: to the second order of the
/// inclination.
std::vector<Stress> below_ground(const ColumnScene &scene, const CellTables &mesh)
{
  const MeshSpec spec = mesh_spec(scene);
  const double step = 1e-6 * scene.mesh.width;
  const double everywhere = scene.load.bears_on_all() ? scene.load.surcharge : 0; // a part's comes on in settle()
  std::vector<Stress> stresses;
  for (std::size_t q = 0; q < mesh.n_points(); ++q)
    {
      const double x = mesh.position[q][0];
      const double inclination = (spec.ground_at(x + step) - spec.ground_at(x - step)) / (2 * step);
      const double vertical = spec.vertical_effective_stress(mesh.position[q]) + everywhere;
      const double k0 = spec.soil.layers[mesh.cell_layer[q / mesh.points_per_cell()]].k0;
      stresses.push_back({-k0 * vertical, -k0 * vertical, -vertical, 0, -k0 * inclination * vertical, 0});
    }
  return stresses;
}

void check_user_materials(const ColumnScene &scene, const UserMaterials &given)
{
  std::set<std::string> asked;
  for (std::size_t i = 0; i < scene.layers.size(); ++i)
    {
      const ColumnLayer &layer = scene.layers[i];
      if (layer.material != LayerMaterial::user)
        continue;
      asked.insert(layer.name);
      if (!given.contains(layer.name))
        throw InputError(fmt::format("layer.{} (\"{}\"): its material is \"user\", but none was given for this name. "
                                     "Run it from Python with isostat.column.run(scene, materials={{\"{}\": ...}}), or "
                                     "give the layer another material: elastic, iwan, mohr_coulomb, grains, umat.",
                                     i, layer.name, layer.name));
    }
  for (const auto &[name, make] : given)
    if (!asked.contains(name))
      throw InputError(fmt::format("materials: one was given for \"{}\", but no layer of that name has the material "
                                   "\"user\". Correct the name, or the layer's material.",
                                   name));
}

bool has_weak_zone(const ColumnScene &scene)
{
  return scene.analysis.kind == AnalysisKind::biaxial && scene.biaxial.weak.cells > 0;
}

/// What points are made of: the layers, then what they are in a weak zone.
std::vector<ColumnLayer> soils_of(const ColumnScene &scene)
{
  std::vector<ColumnLayer> soils = resisting_layers(scene);
  if (has_weak_zone(scene))
    for (std::size_t k = 0; k < scene.layers.size(); ++k)
      soils.push_back(weakened(soils[k], scene.biaxial.weak));
  return soils;
}

/// The points of each of these.
std::vector<std::vector<std::size_t>> points_of(const ColumnScene &scene, const CellTables &mesh, std::size_t n_soils)
{
  std::vector<std::vector<std::size_t>> points(n_soils);
  for (std::size_t q = 0; q < mesh.n_points(); ++q)
    {
      const bool weak = has_weak_zone(scene) && in_weak_zone(scene, mesh.position[q]);
      points[mesh.cell_layer[q / mesh.points_per_cell()] + (weak ? scene.layers.size() : 0)].push_back(q);
    }
  return points;
}

/// Makes one part of all, which have their stress.
const Nonlocal &give_length(std::vector<CompositeMaterial::Part> &parts, const NonlocalParameters &parameters,
                            const CellTables &mesh, const std::vector<Stress> &stresses)
{
  std::vector<std::size_t> all(mesh.n_points());
  std::iota(all.begin(), all.end(), 0);
  auto nonlocal = std::make_unique<Nonlocal>(std::make_unique<CompositeMaterial>(std::move(parts)), parameters,
                                             mesh.position, mesh.weight);
  nonlocal->start_from(stresses);
  const Nonlocal &result = *nonlocal;
  parts.clear();
  parts.push_back({std::move(nonlocal), std::move(all)});
  return result;
}
} // namespace

SpecimenRequest drawn(SpecimenRequest request, const Place &place)
{
  const auto at = [&](int axis) {
    const double length = request.lot_length;
    return static_cast<std::uint64_t>(length > 0 ? std::floor(place[axis] / length) : std::round(1e6 * place[axis]));
  };
  const auto u = uniform(request.lot, RandomStream::packings, at(2), at(0) << 32 ^ at(1));
  request.drawn = static_cast<std::size_t>(u[0] * static_cast<double>(request.mixed));
  return request;
}

std::unique_ptr<Material> layer_material(const ColumnLayer &layer, std::size_t n_points, const UserMaterials &user)
{
  if (layer.material == LayerMaterial::umat)
    return std::make_unique<Umat>(layer.umat, layer.name, std::vector<UmatPoint>(n_points));
  return layer.material == LayerMaterial::user ? user.at(layer.name)(n_points) : formula_material(layer, n_points);
}

std::vector<Stress> in_situ_stress(const ColumnScene &scene, const CellTables &mesh)
{
  if (scene.analysis.kind == AnalysisKind::biaxial)
    {
      const double p = -scene.biaxial.confinement;
      return std::vector<Stress>(mesh.n_points(), Stress{p, p, p, 0, 0, 0});
    }
  if (scene.mesh.sides != Sides::tied || scene.mesh.given)
    return below_ground(scene, mesh);
  const SoilProfile soil = soil_profile(scene);
  std::vector<Stress> stresses(mesh.n_points());
  for (std::size_t q = 0; q < stresses.size(); ++q)
    stresses[q] =
        level_stress(scene, soil, soil.layers[mesh.cell_layer[q / mesh.points_per_cell()]].k0, mesh.position[q][2]);
  return stresses;
}

SoilMaterial soil_material(const ColumnScene &scene, const CellTables &mesh, int threads, const UserMaterials &user)
{
  check_user_materials(scene, user);
  const std::vector<Stress> in_situ = in_situ_stress(scene, mesh);
  const std::vector<ColumnLayer> soils = soils_of(scene);
  const std::vector<std::vector<std::size_t>> points = points_of(scene, mesh, soils.size());
  SoilMaterial soil;
  soil.layers.assign(soils.begin(), soils.begin() + static_cast<std::ptrdiff_t>(scene.layers.size()));
  std::vector<CompositeMaterial::Part> parts;
  std::vector<SpecimenRequest> requests;
  std::vector<std::string> names;
  std::vector<Stress> stresses;                        ///< of the points with grains
  for (std::size_t layer = soils.size(); layer-- > 0;) // from the base up, as points count
    if (soils[layer].material != LayerMaterial::grains)
      {
        // a part without points has a header all the same: states of all ranks fit together
        if (!points[layer].empty() || soils[layer].material != LayerMaterial::user)
          parts.push_back(
              {stressed_layer(scene, mesh, soils[layer], layer % scene.layers.size(), points[layer], in_situ, user),
               points[layer]});
      }
    else
      for (std::size_t q : points[layer])
        {
          soil.grains_places.push_back(q);
          requests.push_back(drawn(soils[layer].grains, mesh.position[q]));
          stresses.push_back(in_situ[q]);
          names.push_back(point_name(scene, mesh, q));
        }
  if (scene.has_grains())
    {
      soil.seeds = drawn_seeds(scene, requests);
      auto grains = std::make_unique<RveMaterial>(requests, scene.packings(threads),
                                                  scene.mesh.distributed ? MPI_COMM_SELF : MPI_COMM_WORLD);
      grains->name_points(names);
      bring_to_stress(scene, *grains, stresses);
      soil.grains = grains.get();
      parts.push_back({std::move(grains), soil.grains_places});
    }
  if (scene.analysis.kind == AnalysisKind::biaxial && scene.biaxial.nonlocal.length > 0)
    soil.nonlocal = &give_length(parts, scene.biaxial.nonlocal, mesh, in_situ);
  soil.material = std::make_unique<TimedMaterial>(std::move(parts));
  return soil;
}

std::vector<std::size_t> nearest_grains(const SoilMaterial &soil, const MeshSpec &mesh, std::span<const Place> places,
                                        const std::vector<double> &depths)
{
  std::vector<std::size_t> points;
  for (double depth : depths)
    {
      const auto away = [&](std::size_t q) {
        return std::hypot(places[q][0] - mesh.line[0], places[q][1] - mesh.line[1], mesh.depth(places[q]) - depth);
      };
      const auto &all = soil.grains_places;
      const auto best =
          std::min_element(all.begin(), all.end(), [&](std::size_t a, std::size_t b) { return away(a) < away(b); });
      points.push_back(static_cast<std::size_t>(best - all.begin()));
    }
  return points;
}
} // namespace isostat
