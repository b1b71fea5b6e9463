// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/vtu.hpp"

#include "base/files/replace_file.hpp"

#include <deal.II/base/data_out_base.h>
#include <deal.II/fe/fe_q.h>

#include <array>
#include <cmath>
#include <sstream>

namespace isostat
{
namespace
{
/// deal.II's writer, fed with elements as they are.
template <int dim>
class Elements : public dealii::DataOutInterface<dim, 3>
{
public:
  using Patch = dealii::DataOutBase::Patch<dim, 3>;
  using Range =
      std::tuple<unsigned, unsigned, std::string, dealii::DataComponentInterpretation::DataComponentInterpretation>;
  std::vector<Patch> patches;
  std::vector<std::string> names; ///< of all components
  std::vector<Range> vectors;

private:
  const std::vector<Patch> &get_patches() const override { return patches; }
  std::vector<std::string> get_dataset_names() const override { return names; }
  std::vector<Range> get_nonscalar_data_ranges() const override { return vectors; }
};

template <int dim>
Elements<dim> named(const std::vector<NodeField> &vectors, const std::vector<PointField> &means)
{
  Elements<dim> elements;
  for (const NodeField &field : vectors)
    {
      const auto at = static_cast<unsigned>(elements.names.size());
      elements.vectors.emplace_back(at, at + 2, field.name,
                                    dealii::DataComponentInterpretation::component_is_part_of_vector);
      elements.names.insert(elements.names.end(), 3, field.name);
    }
  for (const PointField &field : means)
    elements.names.push_back(field.name);
  return elements;
}

/// Place of each node of an element in the order x fastest, as patches have it.
template <int dim>
std::vector<unsigned> patch_order(unsigned degree)
{
  const dealii::FE_Q<dim> element(degree);
  std::vector<unsigned> order;
  for (const dealii::Point<dim> &point : element.get_unit_support_points())
    {
      unsigned at = 0;
      for (int d = dim; d-- > 0;)
        at = at * (degree + 1) + static_cast<unsigned>(std::lround(point[d] * degree));
      order.push_back(at);
    }
  return order;
}

std::vector<float> cell_means(const std::vector<PointField> &fields, std::size_t cell, std::size_t n)
{
  std::vector<float> means;
  for (const PointField &field : fields)
    {
      double mean = 0;
      for (std::size_t q = cell * n; q < (cell + 1) * n; ++q)
        mean += field.values[q] / static_cast<double>(n);
      means.push_back(static_cast<float>(mean));
    }
  return means;
}

template <int dim>
void write_elements(const std::filesystem::path &path, const FiniteElementSpace &space, VtuTime when,
                    const std::vector<NodeField> &vectors, const std::vector<PointField> &means)
{
  const unsigned degree = space.mesh().degree;
  const std::vector<unsigned> order = patch_order<dim>(degree);
  Elements<dim> elements = named<dim>(vectors, means);
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
      patch.data.reinit(static_cast<unsigned>(elements.names.size()), static_cast<unsigned>(order.size()));
      const std::vector<float> of_cell = cell_means(means, cell, space.points_per_cell());
      for (std::size_t a = 0; a < order.size(); ++a)
        {
          unsigned row = 0;
          for (const NodeField &field : vectors)
            for (unsigned c = 0; c < 3; ++c)
              patch.data(row++, order[a]) = static_cast<float>(space.at_node(field.values, cell, a, c));
          for (const float mean : of_cell)
            patch.data(row++, order[a]) = mean;
        }
    }
  dealii::DataOutBase::VtkFlags flags(when.time, static_cast<unsigned>(when.step));
  flags.print_date_and_time = false;
  elements.set_flags(flags);
  std::ostringstream text;
  elements.write_vtu(text);
  write_replacing(path, text.str());
}
} // namespace

void write_vtu(const std::filesystem::path &path, const FiniteElementSpace &space, VtuTime when,
               const std::vector<NodeField> &vectors, const std::vector<PointField> &means)
{
  constexpr std::array of_dimension = {write_elements<1>, write_elements<2>, write_elements<3>};
  of_dimension[space.dimension - 1](path, space, when, vectors, means);
}
} // namespace isostat
