// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/output.hpp"

#include "base/files/replace_file.hpp"
#include "fem/space/unknowns.hpp"

#include <deal.II/base/data_out_base.h>

#include <cmath>
#include <sstream>

namespace isostat
{
PointValues point_values(const ColumnInstant &instant, std::size_t q, std::span<const double> vertical_stress)
{
  const Gradient &h = instant.gradients[q];
  const Stress &s = instant.stresses[q];
  const double u = instant.pressure[q];
  return {h[2] + h[6], h[5] + h[7], -h[8], s[4], s[3], -s[2], mean_effective(s), u, u / vertical_stress[q]};
}

std::vector<double> columns_at(const ColumnInstant &instant, std::span<const std::size_t> points,
                               std::span<const double> vertical_stress)
{
  std::vector<double> values(points.size() * point_columns.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    {
      const PointValues row = point_values(instant, points[k], vertical_stress);
      for (std::size_t j = 0; j < row.size(); ++j)
        values[j * points.size() + k] = row[j];
    }
  return values;
}

namespace
{
constexpr unsigned n_vectors = 2; ///< displacement, velocity
constexpr unsigned n_fields = 3 * n_vectors + point_columns.size();

/// deal.II's writer, fed with elements that lie in space whatever the dimension of the mesh.
template <int dim>
class Elements : public dealii::DataOutInterface<dim, 3>
{
public:
  using Patch = dealii::DataOutBase::Patch<dim, 3>;
  std::vector<Patch> patches;

private:
  using Range =
      std::tuple<unsigned, unsigned, std::string, dealii::DataComponentInterpretation::DataComponentInterpretation>;
  const std::vector<Patch> &get_patches() const override { return patches; }
  std::vector<std::string> get_dataset_names() const override
  {
    std::vector<std::string> names = {"displacement", "displacement", "displacement",
                                      "velocity",     "velocity",     "velocity"};
    for (const auto &[name, unit] : point_columns)
      names.push_back(name);
    return names;
  }
  std::vector<Range> get_nonscalar_data_ranges() const override
  {
    const auto vector = dealii::DataComponentInterpretation::component_is_part_of_vector;
    return {{0, 2, "displacement", vector}, {3, 5, "velocity", vector}};
  }
};

/// Place of each node of an element in the order x fastest, as patches have it.
template <int dim>
std::vector<unsigned> patch_order(const dealii::DoFHandler<dim> &nodes, unsigned degree)
{
  std::vector<unsigned> order;
  for (const dealii::Point<dim> &point : nodes.get_fe().get_unit_support_points())
    {
      unsigned at = 0;
      for (int d = dim; d-- > 0;)
        at = at * (degree + 1) + static_cast<unsigned>(std::lround(point[d] * degree));
      order.push_back(at);
    }
  return order;
}

/// Means over the points of a cell.
PointValues cell_means(const CellTables &space, const ColumnInstant &instant, std::size_t cell,
                       std::span<const double> vertical_stress)
{
  PointValues mean = {};
  const std::size_t n = space.points_per_cell();
  for (std::size_t q = cell * n; q < (cell + 1) * n; ++q)
    {
      const PointValues row = point_values(instant, q, vertical_stress);
      for (std::size_t k = 0; k < row.size(); ++k)
        mean[k] += row[k] / static_cast<double>(n);
    }
  return mean;
}
} // namespace

template <int dim>
void write_column_vtu(const std::filesystem::path &path, const Discretisation<dim> &space, const ColumnInstant &instant,
                      std::span<const double> vertical_stress)
{
  const unsigned degree = space.mesh().degree;
  const std::vector<unsigned> order = patch_order<dim>(space.unknowns().nodes(), degree);
  Elements<dim> elements;
  for (std::size_t cell = 0; cell < space.n_cells(); ++cell)
    {
      auto &patch = elements.patches.emplace_back();
      patch.patch_index = static_cast<unsigned>(cell);
      patch.n_subdivisions = degree;
      patch.reference_cell = dealii::ReferenceCells::get_hypercube<dim>();
      const std::size_t n_corners = space.pressure_nodes_per_cell();
      for (std::size_t v = 0; v < n_corners; ++v)
        {
          const auto [x, y, z] = space.corner[cell * n_corners + v];
          patch.vertices[v] = dealii::Point<3>(x, y, z);
        }
      patch.data.reinit(n_fields, static_cast<unsigned>(order.size()));
      const PointValues means = cell_means(space, instant, cell, vertical_stress);
      for (std::size_t a = 0; a < order.size(); ++a)
        {
          for (unsigned c = 0; c < 3; ++c)
            {
              const unsigned dof = space.cell_dofs[(cell * order.size() + a) * 3 + c];
              patch.data(c, order[a]) = static_cast<float>(instant.displacement[dof]);
              patch.data(3 + c, order[a]) = static_cast<float>(instant.velocity[dof]);
            }
          for (unsigned k = 0; k < means.size(); ++k)
            patch.data(3 * n_vectors + k, order[a]) = static_cast<float>(means[k]);
        }
    }
  dealii::DataOutBase::VtkFlags flags(instant.time, static_cast<unsigned>(instant.step));
  flags.print_date_and_time = false;
  elements.set_flags(flags);
  std::ostringstream text;
  elements.write_vtu(text);
  write_replacing(path, text.str());
}

#define ISOSTAT_INSTANTIATE(dim) \
  template void write_column_vtu<dim>(const std::filesystem::path &, const Discretisation<dim> &, \
                                      const ColumnInstant &, std::span<const double>);
ISOSTAT_INSTANTIATE(1)
ISOSTAT_INSTANTIATE(2)
ISOSTAT_INSTANTIATE(3)
#undef ISOSTAT_INSTANTIATE
} // namespace isostat
