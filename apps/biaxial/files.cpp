// SPDX-License-Identifier: BSD-3-Clause
#include "apps/biaxial/files.hpp"

#include "apps/deposit/instant.hpp"
#include "apps/deposit/output.hpp"
#include "base/files/replace_file.hpp"
#include "dem/measure/summary.hpp"
#include "fem/space/vtu.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

double shear_strain(const Gradient &h) { return std::hypot(h[0] - h[8], h[2] + h[6]); }
} // namespace

PointState point_state(const Gradient &gradient, const Stress &stress)
{
  PointState state;
  state.shear = shear_strain(gradient);
  state.volumetric = -(gradient[0] + gradient[4] + gradient[8]);
  state.p = -0.5 * (stress[0] + stress[2]);
  state.q = 0.5 * std::hypot(stress[0] - stress[2], 2 * stress[4]);
  return state;
}

std::vector<BlockFiles::Quantity> BlockFiles::quantities(const BlockMaterial &material, bool undrained)
{
  std::vector<Quantity> all = {{"shear_strain", "-", &PointState::shear},
                               {"volumetric_strain", "-", &PointState::volumetric},
                               {"p", "Pa", &PointState::p},
                               {"q", "Pa", &PointState::q},
                               {"void_ratio", "-", &PointState::void_ratio},
                               {"redundancy", "-", &PointState::redundancy}};
  if (material.nonlocal)
    all.push_back({"mean_shear_strain", "-", &PointState::mean_shear});
  if (undrained)
    all.push_back({"pore_pressure", "Pa", &PointState::pore_pressure});
  return all;
}

SeriesLayout BlockFiles::layout() const
{
  SeriesLayout layout{.format = "isostat-block-maps",
                      .of = "axial_strain",
                      .unit = "-",
                      .constants = {{"x", "m", along(0, space_.position)}, {"z", "m", along(2, space_.position)}},
                      .series = {}};
  for (const Quantity &quantity : quantities_)
    layout.series.push_back({quantity.name, quantity.unit, space_.n_points()});
  return layout;
}

BlockFiles::BlockFiles(const fs::path &folder, const Discretisation<2> &space, const BlockMaterial &material,
                       bool undrained, std::size_t n_maps)
    : pictures_folder_(folder / "paraview"), space_(space), material_(material),
      quantities_(quantities(material, undrained)), maps_(folder / "maps.h5", layout(), n_maps),
      pictures_((make_folder(pictures_folder_), pictures_folder_ / "block.pvd"), n_maps)
{}

std::vector<PointState> BlockFiles::points(const Statics &statics) const
{
  std::vector<Gradient> gradients;
  gradients_of(space_, statics.displacement(), gradients);
  std::vector<Gradient> means(material_.nonlocal ? gradients.size() : 0);
  if (material_.nonlocal)
    material_.nonlocal->average(gradients, means);
  const std::vector<double> pressure = statics.point_pressure();
  std::vector<PointState> points;
  for (std::size_t q = 0; q < space_.n_points(); ++q)
    {
      PointState &point = points.emplace_back(point_state(gradients[q], statics.stresses()[q]));
      point.pore_pressure = pressure[q];
      if (material_.nonlocal)
        point.mean_shear = shear_strain(means[q]);
      if (!material_.grains)
        continue;
      const Micromechanics grains = micromechanics(material_.grains->element(q)->snapshot());
      point.void_ratio = grains.void_ratio;
      point.redundancy = grains.network.redundancy_index();
    }
  return points;
}

void BlockFiles::map(double axial_strain, const Statics &statics)
{
  const std::vector<PointState> points = this->points(statics);
  std::vector<double> row;
  std::vector<PointField> fields;
  for (const Quantity &quantity : quantities_)
    {
      std::vector<double> &values = fields.emplace_back(quantity.name, std::vector<double>{}).values;
      for (const PointState &point : points)
        values.push_back(point.*quantity.value);
      row.insert(row.end(), values.begin(), values.end());
    }
  const std::string name = fmt::format("block_{:05d}.vtu", maps_.n_rows());
  maps_.append(axial_strain, row);
  maps_.flush();
  const Vector &u = statics.displacement();
  const std::vector<double> displacement(u.begin(), u.begin() + u.locally_owned_size());
  write_vtu(pictures_folder_ / name, space_, {axial_strain, maps_.n_rows()}, {{"displacement", displacement}}, fields);
  pictures_.append(axial_strain, name);
}
} // namespace isostat
