// SPDX-License-Identifier: BSD-3-Clause
#include "fem/solve/free_field.hpp"

#include "base/error.hpp"
#include "fem/water/biot_integrals.hpp"
#include "fem/water/pore_fluid.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::size_t on_x[] = {0, 5, 4}; ///< sigma_xx, sigma_xy, sigma_xz in a Stress

/// What of the settings of a block is that of its columns.
DynamicsSettings column_settings(DynamicsSettings block)
{
  block.time_step = block.multiple = 0; // that of the block: Dynamics::choose_step()
  block.free_fields.clear();
  return block;
}
} // namespace

FreeField::FreeField(Face side, std::unique_ptr<const FiniteElementSpace> column, std::unique_ptr<Material> material,
                     DynamicsSettings block)
    : side_(side), space_(std::move(column)), material_(std::move(material)),
      column_(*space_, *material_, column_settings(std::move(block))),
      initial_(column_.stresses().begin(), column_.stresses().end()), dashpots_(space_->displacement_vector()),
      traction_(dashpots_)
{
  std::vector<WaveModuli> moduli(space_->n_points());
  material_->wave_moduli(moduli);
  const bool coupled = column_.settings().drainage == Drainage::coupled;
  if (coupled)
    porous_ = porous_points(*space_);
  const std::vector<PoreFluid> fluids = coupled ? pore_fluids(*space_) : std::vector<PoreFluid>();
  integrate(
      [&](std::size_t q, std::size_t c) {
        const std::size_t cell = q / space_->points_per_cell();
        const double water = coupled && space_->cell_is_wet[cell] ? 1 / fluids[q].storage(0) : 0;
        return std::sqrt(space_->mesh().soil.layers[space_->cell_layer[cell]].density *
                         (c == 0 ? moduli[q].p + water : moduli[q].s));
      },
      dashpots_);
}

/// int N_A value(point, component) dz on the side, per m of the block along y.
template <typename Value>
void FreeField::integrate(const Value &value, Vector &sums) const
{
  for (std::size_t q = 0; q < space_->n_points(); ++q)
    for (std::size_t c = 0; c < 3; ++c)
      {
        const std::size_t cell = q / space_->n_gauss;
        const double at_point = space_->weight[q] * value(q, c);
        for (std::size_t a = 0; a < space_->n_nodes; ++a)
          sums.local_element(space_->cell_dofs[(cell * space_->n_nodes + a) * 3 + c]) +=
              at_point * space_->shapes(q)[a];
      }
}

void FreeField::join(const FiniteElementSpace &block)
{
  const MeshSpec &mesh = block.mesh();
  const double width = mesh.given ? mesh.given->width() : mesh.width[0], x = side_ == Face::x_low ? 0 : width,
               near = 1e-9 * (width + mesh.ground_at({x, 0, 0}));
  const std::vector<Place> places = block.node_places(), of_column = space_->node_places();
  const Vector area = block.face_area(side_);
  bool fits = true;
  nodes_.clear();
  for (unsigned i = 0; i < places.size(); i += 3)
    if (area.local_element(i) > 0)
      {
        const auto node =
            std::ranges::find_if(of_column, [&](const Place &at) { return std::abs(at[2] - places[i][2]) < near; });
        fits = fits && node != of_column.end() && std::abs(places[i][0] - x) < near;
        nodes_.push_back({i, static_cast<unsigned>(node - of_column.begin())});
      }
  if (!block.on_every_rank(fits))
    throw InputError("mesh: a side with a free field has nodes that are not those of a column at its end; it must be "
                     "one vertical line.");
  corners_.clear();
  if (column_.settings().drainage == Drainage::coupled)
    for (unsigned k = 0; k < space_->cell_pressures.size(); ++k)
      if (const unsigned i = space_->cell_pressures[k];
          std::ranges::count(space_->cell_pressures.begin(), space_->cell_pressures.begin() + k, i) == 0)
        if (const long in_block = block.find_pressure({x, 0, space_->corner[k][2]}); in_block >= 0)
          corners_.push_back({static_cast<unsigned>(in_block), i});
}

void FreeField::add_dashpots(Vector &coefficients) const
{
  for (const auto &[i, k] : nodes_)
    for (unsigned c = 0; c < 3; ++c)
      coefficients.local_element(i + c) += dashpots_.local_element(k + c);
}

void FreeField::step(Vector &load)
{
  const std::span<const Stress> now = column_.skeleton_stresses();
  const std::vector<Stress> stresses(now.begin(), now.end()); // the column's momentum (4) at this time
  try
    {
      column_.step();
    }
  catch (const RunFailure &failure)
    {
      throw RunFailure(fmt::format("in the level ground next to the side of {} x: {}",
                                   side_ == Face::x_low ? "the lowest" : "the highest", failure.what()));
    }
  if (!corners_.empty() && space_->mesh().soil.permeability_varies())
    porous_ = porous_points(*space_, volume_strains(*space_, column_.displacement()));
  const std::vector<double> pressure = column_.point_pressure(); // of the same time
  const double normal = side_ == Face::x_low ? -1 : 1;
  traction_ = 0;
  integrate(
      [&](std::size_t q, std::size_t c) {
        return normal * (stresses[q][on_x[c]] - initial_[q][on_x[c]] - (c == 0 ? pressure[q] : 0));
      },
      traction_);
  for (const auto &[i, k] : nodes_)
    for (unsigned c = 0; c < 3; ++c)
      load.local_element(i + c) +=
          traction_.local_element(k + c) + dashpots_.local_element(k + c) * column_.velocity(k + c);
}

void FreeField::add_inflow(Vector &inflow) const
{
  const DynamicsSettings &settings = column_.settings();
  const double of_base =
      settings.base.compliant() ? 0 : settings.motion[0].acceleration(column_.time() - column_.time_step());
  const std::size_t n_i = space_->pressure_nodes_per_cell();
  Vector flow = space_->pressure_vector();
  for (std::size_t q = 0; q < space_->n_points(); ++q)
    {
      const std::size_t cell = q / space_->n_gauss;
      double acceleration = of_base;
      for (std::size_t a = 0; a < space_->n_nodes; ++a)
        acceleration +=
            space_->shapes(q)[a] * column_.acceleration(space_->cell_dofs[(cell * space_->n_nodes + a) * 3]);
      for (std::size_t i = 0; i < n_i && space_->cell_is_wet[cell]; ++i)
        flow.local_element(space_->cell_pressures[cell * n_i + i]) += space_->weight[q] * porous_.mobility[q] *
                                                                      porous_.fluid_density * acceleration *
                                                                      space_->pressure_shapes(q)[i];
    }
  for (const auto &[i, k] : corners_)
    inflow.local_element(i) += (side_ == Face::x_low ? -1 : 1) * flow.local_element(k);
}
} // namespace isostat
