// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/mesh_order.hpp"

#include "base/files/bytes.hpp"

#include <algorithm>

namespace isostat
{
namespace
{
using Bytes = std::vector<std::byte>;
constexpr std::size_t max_message = std::size_t{1} << 30; // MPI counts are ints

/// Bytes of every rank in turn, on the first; on the others nothing.
std::vector<Bytes> on_first_rank(Bytes mine, MPI_Comm communicator)
{
  int rank = 0, size = 1;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &size);
  const auto in_messages = [](Bytes &bytes, const auto &one) {
    for (std::size_t at = 0; at < bytes.size(); at += max_message)
      one(bytes.data() + at, static_cast<int>(std::min(max_message, bytes.size() - at)));
  };
  std::vector<Bytes> all;
  if (rank == 0)
    all.push_back(std::move(mine));
  for (int from = 1; from < size; ++from)
    if (rank == from)
      {
        const std::uint64_t length = mine.size();
        MPI_Send(&length, 1, MPI_UINT64_T, 0, 0, communicator);
        in_messages(mine, [&](std::byte *data, int n) { MPI_Send(data, n, MPI_BYTE, 0, 1, communicator); });
      }
    else if (rank == 0)
      {
        std::uint64_t length = 0;
        MPI_Recv(&length, 1, MPI_UINT64_T, from, 0, communicator, MPI_STATUS_IGNORE);
        all.emplace_back(length);
        in_messages(all.back(), [&](std::byte *data, int n) {
          MPI_Recv(data, n, MPI_BYTE, from, 1, communicator, MPI_STATUS_IGNORE);
        });
      }
  return all;
}
} // namespace

MeshOrder::MeshOrder(const FiniteElementSpace &space) : space_(space)
{
  for (std::size_t cell = 0; cell < space.n_cells(); ++cell)
    cell_number_.push_back(space.point_id[cell * space.n_gauss] / space.n_gauss);
  n_cells_ = space.n_cells();
  if (space.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, &n_cells_, 1, MPI_UNSIGNED_LONG, MPI_SUM, space.communicator());
  n_points_ = n_cells_ * space.n_gauss;
}

/// Rows of equal length, in the order of their numbers; every number below n occurs once.
std::vector<double> MeshOrder::rows(const std::vector<std::size_t> &numbers, std::size_t n,
                                    std::span<const double> mine) const
{
  std::vector<double> all;
  const auto place = [&](const std::vector<std::size_t> &which, std::span<const double> values) {
    if (values.empty())
      return;
    const std::size_t width = values.size() / which.size();
    all.resize(std::max(all.size(), n * width));
    for (std::size_t k = 0; k < which.size(); ++k)
      std::copy_n(&values[k * width], width, &all[which[k] * width]);
  };
  if (!space_.shared_out())
    {
      place(numbers, mine);
      return all;
    }
  ByteWriter out;
  out.row(numbers);
  out.numbers(mine);
  for (const Bytes &bytes : on_first_rank(out.take(), space_.communicator()))
    {
      ByteReader in(bytes, "mesh");
      std::vector<std::size_t> which;
      std::vector<double> values;
      in.row(which);
      in.row(values);
      place(which, values);
    }
  return all;
}

const std::vector<unsigned> &MeshOrder::table_of(const Vector &values) const
{
  return values.belongs_to(space_.displacement_partition()) ? space_.cell_dofs : space_.cell_pressures;
}

std::size_t MeshOrder::per_cell(const Vector &values) const
{
  return values.belongs_to(space_.displacement_partition()) ? 3 * space_.n_nodes : space_.pressure_nodes_per_cell();
}

std::size_t MeshOrder::n_numbers(const Vector &values) const { return n_cells_ * per_cell(values); }

std::vector<double> MeshOrder::unknowns(const Vector &values) const
{
  Vector whole = values;
  if (space_.shared_out())
    whole.update_ghost_values();
  std::vector<double> mine;
  for (unsigned i : table_of(values))
    mine.push_back(whole.local_element(i));
  return rows(cell_number_, n_cells_, mine);
}

void MeshOrder::set_unknowns(std::span<const double> of_cells, Vector &values) const
{
  const std::vector<unsigned> &table = table_of(values);
  const std::size_t width = per_cell(values);
  values = 0.0;
  for (std::size_t k = 0; k < table.size(); ++k)
    if (table[k] < values.locally_owned_size())
      values.local_element(table[k]) = of_cells[cell_number_[k / width] * width + k % width];
}

std::vector<double> MeshOrder::points(std::span<const double> values) const
{
  return rows(space_.point_id, n_points_, values);
}

void MeshOrder::set_points(std::span<const double> of_points, std::span<double> values) const
{
  if (values.empty())
    return;
  const std::size_t width = values.size() / space_.n_points();
  for (std::size_t q = 0; q < space_.n_points(); ++q)
    std::copy_n(&of_points[space_.point_id[q] * width], width, &values[q * width]);
}

std::vector<Bytes> MeshOrder::point_bytes(std::vector<Bytes> mine) const
{
  std::vector<Bytes> all(n_points_);
  if (!space_.shared_out())
    {
      for (std::size_t q = 0; q < mine.size(); ++q)
        all[space_.point_id[q]] = std::move(mine[q]);
      return all;
    }
  ByteWriter out;
  out.row(space_.point_id);
  for (const Bytes &bytes : mine)
    out.block(bytes);
  mine.clear();
  for (const Bytes &bytes : on_first_rank(out.take(), space_.communicator()))
    {
      ByteReader in(bytes, "mesh");
      std::vector<std::size_t> which;
      in.row(which);
      for (std::size_t number : which)
        {
          const auto block = in.block();
          all[number].assign(block.begin(), block.end());
        }
    }
  return all;
}

std::vector<Bytes> MeshOrder::own_point_bytes(const std::vector<Bytes> &all) const
{
  std::vector<Bytes> mine;
  for (std::size_t number : space_.point_id)
    mine.push_back(all[number]);
  return mine;
}
} // namespace isostat
