// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/row_material.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace isostat
{
RowMaterial::RowMaterial(std::string name, std::vector<double> parameters, std::size_t n_points, std::size_t row)
    : committed_(n_points * row), trial_(n_points * row), name_(std::move(name)), parameters_(std::move(parameters)),
      n_points_(n_points)
{}

std::string RowMaterial::at_point(std::size_t point) const { return name_ + ": point " + std::to_string(point) + ": "; }

void RowMaterial::commit()
{
  if (std::exchange(has_trial_, false))
    std::swap(committed_, trial_);
}

MaterialState RowMaterial::pack() const
{
  ByteWriter out;
  out.text(name_);
  out.numbers(parameters_);
  return {out.take(), packed_rows(committed_, n_points_)};
}

void RowMaterial::unpack(const MaterialState &state)
{
  ByteReader in(state.common, name_);
  in.expect(in.text(), name_);
  std::vector<double> stored = parameters_;
  in.numbers(stored, "parameters");
  if (stored != parameters_)
    in.fail(fmt::format("its parameters are {}", fmt::join(stored, ", ")));
  in.expect_end();
  std::vector<double> rows(committed_.size()); // nothing changes unless all fit
  unpack_rows(state, name_, rows, n_points_);
  committed_ = std::move(rows);
  has_trial_ = false;
}
} // namespace isostat
