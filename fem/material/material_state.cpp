// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/material_state.hpp"

namespace isostat
{
std::vector<std::byte> MaterialState::bytes() const
{
  ByteWriter out;
  out.block(common);
  out.count(points.size());
  for (const auto &point : points)
    out.block(point);
  return out.take();
}

MaterialState MaterialState::from_bytes(std::span<const std::byte> bytes)
{
  ByteReader in(bytes, "state of the soil");
  const auto copy = [](std::span<const std::byte> block) { return std::vector(block.begin(), block.end()); };
  MaterialState state;
  state.common = copy(in.block());
  for (std::uint64_t left = in.count(); left > 0; --left)
    state.points.push_back(copy(in.block()));
  in.expect_end();
  return state;
}

std::vector<std::vector<std::byte>> packed_rows(std::span<const double> values, std::size_t n_points)
{
  std::vector<std::vector<std::byte>> points(n_points);
  for (std::size_t k = 0; k < n_points; ++k)
    {
      ByteWriter out;
      out.numbers(values.subspan(k * (values.size() / n_points), values.size() / n_points));
      points[k] = out.take();
    }
  return points;
}

void unpack_rows(const MaterialState &state, const std::string &material, std::span<double> values,
                 std::size_t n_points)
{
  ByteReader({}, material).expect(state.points.size(), n_points, "points");
  for (std::size_t k = 0; k < n_points; ++k)
    {
      ByteReader in(state.points[k], material);
      in.numbers(values.subspan(k * (values.size() / n_points), values.size() / n_points), "numbers in a point");
      in.expect_end();
    }
}
} // namespace isostat
