// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/history.hpp"

#include "apps/deposit/soil_material.hpp"
#include "apps/soil_column/peaks.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace isostat
{
namespace
{
constexpr std::size_t input_at = 2, base_at = 5, surface_at = 8, displacement_at = 14, settlement_at = 17;

std::array<long, 3> node_at(const FiniteElementSpace &space, const Place &place)
{
  return {space.find_dof(place, 0), space.find_dof(place, 1), space.find_dof(place, 2)};
}

/// Of the nodes of the vertical of the histories those nearest to the scene's depths.
std::vector<double> nearest_nodes(const ColumnScene &scene, const MeshSpec &mesh)
{
  std::vector<double> nearest;
  if (scene.analysis.kind != AnalysisKind::dynamic)
    return nearest;
  const std::vector<double> nodes = node_depths(mesh);
  for (const double depth : scene.output.depths)
    nearest.push_back(*std::ranges::min_element(nodes, {}, [&](double z) { return std::abs(z - depth); }));
  return nearest;
}

/// The node's values, 0 on ranks that do not have it.
void append(const std::vector<double> &values, const std::array<long, 3> &node, std::vector<double> &row)
{
  for (long dof : node)
    row.push_back(dof < 0 ? 0 : values[static_cast<std::size_t>(dof)]);
}
} // namespace

ColumnHistory::ColumnHistory(const ColumnScene &scene, const FiniteElementSpace &space,
                             const std::array<Motion, 3> &motions, std::size_t stride)
    : space_(space), motions_(motions), rigid_(!scene.base.compliant()),
      base_(node_at(space, {space.mesh().line[0], space.mesh().line[1], 0})),
      surface_(node_at(space, space.mesh().on_line(0))), motion_depths_(nearest_nodes(scene, space.mesh())),
      expansions_(scene, space), filter_(9 + 3 * motion_depths_.size(), stride), sample_(9 + 3 * motion_depths_.size())
{
  for (const double depth : motion_depths_)
    motion_nodes_.push_back(node_at(space, space.mesh().on_line(depth)));
  for (unsigned axis = 1; axis < space.dimension; ++axis)
    area_ *= scene.mesh.width;
  for (double depth : scene.output.depths)
    points_.push_back(point_at_depth(space, depth));
  for (const Stress &stress : in_situ_stress(scene, space))
    {
      vertical_stress_.push_back(-stress[2]);
      mean_stress_.push_back(mean_effective(stress));
    }
}

std::vector<RecordColumn> ColumnHistory::columns() const
{
  std::vector<RecordColumn> columns = {{"step", "-"}, {"time", "s"}};
  for (const auto &[what, unit] :
       {std::pair("input_a", "m/s2"), std::pair("base_a", "m/s2"), std::pair("surface_a", "m/s2"),
        std::pair("surface_v", "m/s"), std::pair("surface_u", "m")})
    for (const char *axis : {"x", "y", "z"})
      columns.push_back({std::string(what) + axis, unit});
  columns.insert(columns.end(), {{"settlement", "m"},
                                 {"max_ru", "-"},
                                 {"max_ru_depth", "m"},
                                 {"min_p_ratio", "-"},
                                 {"kinetic", "J/m2"},
                                 {"internal", "J/m2"},
                                 {"external", "J/m2"},
                                 {"residual", "J/m2"}});
  for (std::size_t k = 0; k < points_.size(); ++k)
    {
      columns.push_back({fmt::format("d{}_depth", k), "m"});
      for (const auto &[name, unit] : point_columns)
        columns.push_back({fmt::format("d{}_{}", k, name), unit});
    }
  for (std::size_t k = 0; k < expansions_.all().size(); ++k)
    columns.push_back({fmt::format("expansion_{}", k), "m"});
  for (std::size_t k = 0; k < motion_depths_.size(); ++k)
    {
      columns.push_back({fmt::format("d{}_node_depth", k), "m"});
      for (const char axis : {'x', 'y', 'z'})
        columns.push_back({fmt::format("d{}_a{}", k, axis), "m/s2"});
    }
  return columns;
}

ColumnHistory::Extremes ColumnHistory::extremes(const ColumnInstant &instant) const
{
  double ru = -std::numeric_limits<double>::infinity(), depth = 0, ratio = std::numeric_limits<double>::infinity();
  for (std::size_t q = 0; q < vertical_stress_.size(); ++q)
    {
      ratio = std::min(ratio, mean_effective(instant.stresses[q]) / mean_stress_[q]);
      if (const double here = instant.pressure[q] / vertical_stress_[q]; here > ru)
        {
          ru = here;
          depth = space_.mesh().depth(space_.position[q]);
        }
    }
  if (space_.shared_out())
    {
      take_max(ru, {&depth}, space_.communicator());
      MPI_Allreduce(MPI_IN_PLACE, &ratio, 1, MPI_DOUBLE, MPI_MIN, space_.communicator());
    }
  return {ru, depth, ratio};
}

void ColumnHistory::append_points(const ColumnInstant &instant, std::vector<double> &row) const
{
  for (const PointAtDepth &at : points_)
    {
      const PointValues values =
          at.point < 0 ? PointValues{} : point_values(instant, static_cast<std::size_t>(at.point), vertical_stress_);
      row.push_back(at.point < 0 ? 0 : at.depth);
      row.insert(row.end(), values.begin(), values.end());
    }
}

std::vector<double> ColumnHistory::row(const ColumnInstant &instant)
{
  std::vector<double> row = {0, 0, 0, 0, 0};
  append(instant.acceleration, base_, row);
  append(instant.acceleration, surface_, row);
  append(instant.velocity, surface_, row);
  append(instant.displacement, surface_, row);
  row.resize(settlement_at + 8, 0.0);
  append_points(instant, row);
  space_.sum_over_ranks(row);

  row[0] = static_cast<double>(instant.step);
  row[1] = state.time = instant.time;
  state.surface_acceleration = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const double input = row[input_at + axis] = motions_[axis].acceleration(instant.time);
      if (rigid_) // unknowns count from the moving base
        {
          row[base_at + axis] += input;
          row[surface_at + axis] += input;
        }
      state.surface_acceleration = std::max(state.surface_acceleration, std::abs(row[surface_at + axis]));
    }
  const Extremes extreme = extremes(instant);
  const DynamicsEnergy &energy = instant.energy;
  state.settlement = 0 - row[displacement_at + 2]; // never -0
  state.max_ru = extreme.ru;
  state.min_p_ratio = extreme.p_ratio;
  state.residual = energy.residual() / area_;
  const double tail[] = {state.settlement,        extreme.ru,
                         extreme.ru_depth,        extreme.p_ratio,
                         energy.kinetic / area_,  energy.internal / area_,
                         energy.external / area_, state.residual};
  std::copy(std::begin(tail), std::end(tail), row.begin() + settlement_at);
  for (std::size_t k = 4; k < 7; ++k)
    state.max_energy = std::max(state.max_energy, std::abs(tail[k]));
  const std::vector<double> expansions = expansions_.follow(instant);
  row.insert(row.end(), expansions.begin(), expansions.end());
  append_motions(instant, row);
  return row;
}

void ColumnHistory::append_motions(const ColumnInstant &instant, std::vector<double> &row) const
{
  std::vector<double> motions;
  for (const Trio &node : motion_nodes_)
    append(instant.acceleration, node, motions);
  space_.sum_over_ranks(motions);
  for (std::size_t k = 0; k < motion_nodes_.size(); ++k)
    {
      row.push_back(motion_depths_[k]);
      for (std::size_t axis = 0; axis < 3; ++axis)
        row.push_back(motions[3 * k + axis] + (rigid_ ? row[input_at + axis] : 0));
    }
}

void ColumnHistory::follow(const Dynamics &run)
{
  if (!filter_.filters())
    return;
  const auto put = [&](std::size_t at, const Trio &node) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      sample_[at + axis] = node[axis] < 0 ? 0 : run.acceleration(static_cast<unsigned>(node[axis]));
  };
  std::fill_n(sample_.begin(), 3, 0.0);
  put(3, base_);
  put(6, surface_);
  for (std::size_t k = 0; k < motion_nodes_.size(); ++k)
    put(9 + 3 * k, motion_nodes_[k]);
  space_.sum_over_ranks(sample_);
  for (std::size_t axis = 0; axis < 3; ++axis)
    {
      sample_[axis] = motions_[axis].acceleration(run.time() - run.time_step());
      for (std::size_t at = 3 + axis; rigid_ && at < sample_.size(); at += 3) // unknowns count from the moving base
        sample_[at] += sample_[axis];
    }
  filter_.follow(sample_);
}

std::optional<std::vector<double>> ColumnHistory::take(bool at_the_end)
{
  if (waiting_.empty() || !(at_the_end || is_complete(waiting_.front())))
    return {};
  std::vector<double> row = std::move(waiting_.front());
  waiting_.pop_front();
  if (!filter_.filters())
    return row;
  const std::vector<double> filtered = filter_.at(static_cast<std::uint64_t>(row[0]));
  std::copy_n(filtered.begin(), 9, row.begin() + input_at);
  const auto motions = row.end() - static_cast<std::ptrdiff_t>(4 * motion_nodes_.size());
  for (std::ptrdiff_t k = 0; k < std::ssize(motion_nodes_); ++k)
    std::copy_n(filtered.begin() + 9 + 3 * k, 3, motions + 4 * k + 1);
  return row;
}

void ColumnHistory::save(ColumnCheckpoint &checkpoint) const
{
  checkpoint.put(state);
  expansions_.save(checkpoint);
  checkpoint.numbers["filtered_steps"] = static_cast<double>(filter_.n_samples());
  checkpoint.vectors["filtered_accelerations"] = filter_.samples();
  std::vector<double> &rows = checkpoint.vectors["waiting_rows"];
  for (const std::vector<double> &row : waiting_)
    rows.insert(rows.end(), row.begin(), row.end());
}

void ColumnHistory::restore(const ColumnCheckpoint &checkpoint)
{
  checkpoint.get(state);
  expansions_.restore(checkpoint);
  filter_.restore(checkpoint.vector("filtered_accelerations"), checkpoint.count("filtered_steps"));
  const std::size_t n = columns().size(), n_rows = checkpoint.vector("waiting_rows").size() / n;
  const std::vector<double> &rows = checkpoint.vector("waiting_rows", n_rows * n);
  for (std::size_t k = 0; k < rows.size(); k += n)
    waiting_.emplace_back(rows.begin() + static_cast<std::ptrdiff_t>(k),
                          rows.begin() + static_cast<std::ptrdiff_t>(k + n));
}
} // namespace isostat
