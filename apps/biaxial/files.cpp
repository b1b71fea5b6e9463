// SPDX-License-Identifier: BSD-3-Clause
#include "apps/biaxial/files.hpp"

#include "apps/deposit/instant.hpp"
#include "base/error.hpp"
#include "base/files/hdf5.hpp"
#include "base/files/replace_file.hpp"
#include "base/files/vtk_xml.hpp"
#include "base/record/file_format.hpp"
#include "dem/measure/summary.hpp"

#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

double shear_strain(const Gradient &h) { return std::hypot(h[0] - h[8], h[2] + h[6]); }

void add_array(pugi::xml_node parent, const char *type, const std::string &name, int components,
               const std::string &text)
{
  pugi::xml_node array = parent.append_child("DataArray");
  array.append_attribute("type") = type;
  array.append_attribute("Name") = name.c_str();
  array.append_attribute("NumberOfComponents") = components;
  array.append_attribute("format") = "ascii";
  array.text() = text.c_str();
}

/// Corners of an element, each an element's own: place and displacement as text, in the order of VTK.
void add_corners(const Discretisation<2> &space, const Vector &u, std::string &places, std::string &displacements)
{
  constexpr unsigned order[] = {0, 1, 3, 2};
  for (std::size_t cell = 0; cell < space.n_cells(); ++cell)
    for (unsigned corner : order)
      {
        const auto [x, y, z] = space.corner[4 * cell + corner];
        const unsigned *dofs = &space.cell_dofs[3 * (cell * space.n_nodes + corner)];
        places += fmt::format("{:.9g} 0 {:.9g} ", x, z);
        for (int c = 0; c < 3; ++c)
          displacements += fmt::format("{:.9g} ", u.local_element(dofs[c]));
      }
}

void add_cells(pugi::xml_node cells, std::size_t n)
{
  std::string connectivity, offsets, types;
  for (std::size_t k = 0; k < n; ++k)
    {
      connectivity += fmt::format("{} {} {} {} ", 4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3);
      offsets += fmt::format("{} ", 4 * k + 4);
      types += "9 ";
    }
  add_array(cells, "Int64", "connectivity", 1, connectivity);
  add_array(cells, "Int64", "offsets", 1, offsets);
  add_array(cells, "UInt8", "types", 1, types);
}
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

BlockFiles::BlockFiles(fs::path folder, const Discretisation<2> &space, const BlockMaterial &material, bool undrained,
                       std::size_t n_maps)
    : folder_(std::move(folder)), space_(space), material_(material),
      pictures_((make_folder(folder_ / "paraview"), folder_ / "paraview/block.pvd"), n_maps),
      quantities_{{"shear_strain", "-", &PointState::shear},
                  {"volumetric_strain", "-", &PointState::volumetric},
                  {"p", "Pa", &PointState::p},
                  {"q", "Pa", &PointState::q},
                  {"void_ratio", "-", &PointState::void_ratio},
                  {"redundancy", "-", &PointState::redundancy}}
{
  if (material.nonlocal)
    quantities_.push_back({"mean_shear_strain", "-", &PointState::mean_shear});
  if (undrained)
    quantities_.push_back({"pore_pressure", "Pa", &PointState::pore_pressure});
  rows_.resize(quantities_.size());
  if (n_maps > 0)
    read_h5(n_maps);
}

void BlockFiles::read_h5(std::size_t n_maps)
{
  const hdf5::File file = hdf5::File::open(folder_ / "maps.h5");
  const hdf5::Group root = file.root();
  const auto read = [&](const char *name, std::size_t length) {
    std::vector<double> values = root.read<double>(name);
    if (values.size() < length)
      throw InputError(fmt::format("{}: `{}` has {} numbers, but {} are of before the checkpoint. Start anew with "
                                   "--overwrite.",
                                   (folder_ / "maps.h5").string(), name, values.size(), length));
    values.resize(length);
    return values;
  };
  strains_ = read("axial_strain", n_maps);
  for (std::size_t k = 0; k < rows_.size(); ++k)
    rows_[k] = read(quantities_[k].name, n_maps * space_.n_points());
}

void BlockFiles::map(double axial_strain, const Statics &statics)
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
  for (std::size_t k = 0; k < rows_.size(); ++k)
    for (const PointState &point : points)
      rows_[k].push_back(point.*quantities_[k].value);
  strains_.push_back(axial_strain);
  write_h5();
  const std::string name = fmt::format("block_{:05d}.vtu", strains_.size() - 1);
  write_vtu(folder_ / "paraview" / name, statics.displacement(), points);
  pictures_.append(axial_strain, name);
}

void BlockFiles::write_h5() const
{
  auto file = hdf5::File::create(folder_ / "maps.h5");
  hdf5::Group root = file.root();
  set_format(root, "isostat-block-maps", 1);
  std::vector<double> x, z;
  for (const auto &place : space_.position)
    {
      x.push_back(place[0]);
      z.push_back(place[2]);
    }
  root.write("x", x, "m");
  root.write("z", z, "m");
  root.write("axial_strain", strains_, "-");
  for (std::size_t k = 0; k < rows_.size(); ++k)
    root.write(quantities_[k].name, rows_[k], quantities_[k].unit, space_.n_points());
  file.commit();
}

void BlockFiles::write_vtu(const fs::path &path, const Vector &displacement,
                           const std::vector<PointState> &points) const
{
  pugi::xml_document document;
  pugi::xml_node piece = vtk_file(document, "UnstructuredGrid").append_child("UnstructuredGrid").append_child("Piece");
  piece.append_attribute("NumberOfPoints") = static_cast<unsigned long long>(4 * space_.n_cells());
  piece.append_attribute("NumberOfCells") = static_cast<unsigned long long>(space_.n_cells());
  std::string places, displacements;
  add_corners(space_, displacement, places, displacements);
  add_array(piece.append_child("Points"), "Float64", "position", 3, places);
  add_cells(piece.append_child("Cells"), space_.n_cells());
  add_array(piece.append_child("PointData"), "Float64", "displacement", 3, displacements);
  pugi::xml_node data = piece.append_child("CellData");
  const std::size_t n = space_.points_per_cell();
  for (const Quantity &quantity : quantities_)
    {
      std::string text;
      for (std::size_t cell = 0; cell < space_.n_cells(); ++cell)
        {
          double sum = 0;
          for (std::size_t q = cell * n; q < (cell + 1) * n; ++q)
            sum += points[q].*quantity.value;
          text += fmt::format("{:.9g} ", sum / static_cast<double>(n));
        }
      add_array(data, "Float64", quantity.name, 1, text);
    }
  save_xml(document, path);
}
} // namespace isostat
