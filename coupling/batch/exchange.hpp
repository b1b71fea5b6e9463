// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "coupling/placement/placement.hpp"
#include "fem/ranks/failure.hpp"

#include <type_traits>

namespace isostat
{
using Bytes = std::vector<std::byte>;

/// What goes between ranks. Every call is collective on the communicator, in the same order on all ranks; nothing is
/// summed by MPI, so results are bitwise the same for any number of ranks. One rank alone makes no MPI call but those
/// for its number.
/// tested: tests/mpi/rve_material_mpi.cpp
class Exchange
{
public:
  /// @param longest_message  bytes; more go in several messages, because MPI counts with int
  /// @pre MPI is initialised; `comm` stays valid as long as this
  explicit Exchange(MPI_Comm comm, std::size_t longest_message = std::size_t{1} << 30);

  int rank() const { return rank_; }
  int size() const { return size_; }

  /// Rows, one for each element: the owners of the elements `ids` (rising) have filled in those, afterwards
  /// everybody has them.   cost one MPI_Allgatherv
  template <typename Row>
  void share(std::span<const std::size_t> ids, const Owners &owners, std::span<Row> rows) const
  {
    static_assert(std::is_trivially_copyable_v<Row>);
    share_bytes(ids, owners, sizeof(Row), std::as_writable_bytes(rows));
  }

  /// See fail_together(); failures count by their element.
  void stop_together(const std::optional<RankFailure> &mine) const { fail_together(comm_, mine); }

  /// `bytes` of `root` on every rank.
  void broadcast(Bytes &bytes, int root) const;
  /// The bytes of each rank, in the order of ranks, on rank 0; nothing elsewhere.
  std::vector<Bytes> gather(const Bytes &mine) const;
  /// Brings elements from one placement to another. @param send  bytes of elements that leave this rank, in the order
  /// of their numbers     @return those that come, likewise
  std::vector<Bytes> move(const std::vector<Bytes> &send, const Owners &from, const Owners &to) const;

private:
  void share_bytes(std::span<const std::size_t> ids, const Owners &owners, std::size_t width,
                   std::span<std::byte> rows) const;
  void send(const Bytes &bytes, int to, std::vector<MPI_Request> &pending) const;
  Bytes receive(int from) const;

  MPI_Comm comm_;
  std::size_t longest_message_;
  int rank_ = 0, size_ = 1;
};
} // namespace isostat
