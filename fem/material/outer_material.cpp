// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/outer_material.hpp"

#include <algorithm>

namespace isostat
{
OuterMaterial::OuterMaterial(const std::string &kind, std::unique_ptr<Material> inner, std::vector<double> parameters,
                             std::size_t row)
    : RowMaterial(kind + " " + inner->name(), std::move(parameters), inner->n_points(), row), inner_(std::move(inner))
{}

void OuterMaterial::commit()
{
  inner_->commit();
  RowMaterial::commit();
}

void OuterMaterial::rollback()
{
  inner_->rollback();
  RowMaterial::rollback();
}

MaterialState OuterMaterial::pack() const
{
  MaterialState state = RowMaterial::pack();
  const MaterialState inner = inner_->pack();
  ByteWriter out;
  out.block(state.common);
  out.append(inner.common);
  state.common = out.take();
  for (std::size_t k = 0; k < inner.points.size(); ++k)
    state.points[k].insert(state.points[k].end(), inner.points[k].begin(), inner.points[k].end());
  return state;
}

void OuterMaterial::unpack(const MaterialState &state)
{
  const auto copy = [](std::span<const std::byte> bytes) { return std::vector(bytes.begin(), bytes.end()); };
  ByteReader common(state.common, name());
  common.expect(state.points.size(), n_points(), "points");
  MaterialState own{copy(common.block()), {}}, inner{copy(common.rest()), {}};
  std::vector<double> row(n_points() > 0 ? committed_.size() / n_points() : 0);
  for (const auto &point : state.points)
    {
      ByteReader in(point, name());
      in.numbers(row, "numbers in a point");
      own.points.push_back(copy(std::span(point).first(point.size() - in.rest().size())));
      inner.points.push_back(copy(in.rest()));
    }
  if (std::ranges::all_of(inner.points, [](const auto &point) { return point.empty(); })) // kept as a whole
    inner.points.clear();
  std::vector<double> before = committed_;
  RowMaterial::unpack(own);
  try
    {
      inner_->unpack(inner);
    }
  catch (...) // nothing has changed
    {
      committed_ = std::move(before);
      throw;
    }
}
} // namespace isostat
