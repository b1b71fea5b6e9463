// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/batch/exchange.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace isostat
{
namespace
{
constexpr int tag = 6017;
} // namespace

Exchange::Exchange(MPI_Comm comm, std::size_t longest_message) : comm_(comm), longest_message_(longest_message)
{
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
}

void Exchange::share_bytes(std::span<const std::size_t> ids, const Owners &owners, std::size_t width,
                           std::span<std::byte> rows) const
{
  if (size_ == 1 || ids.empty())
    return;
  std::vector<int> counts(size_, 0), begins(size_, 0); // in rows
  for (std::size_t id : ids)
    ++counts[owners[id]];
  for (int r = 1; r < size_; ++r)
    begins[r] = begins[r - 1] + counts[r - 1];
  Bytes mine, all(ids.size() * width);
  for (std::size_t id : ids)
    if (owners[id] == rank_)
      mine.insert(mine.end(), &rows[width * id], &rows[width * id] + width);
  MPI_Datatype row;
  MPI_Type_contiguous(static_cast<int>(width), MPI_BYTE, &row);
  MPI_Type_commit(&row);
  MPI_Allgatherv(mine.data(), counts[rank_], row, all.data(), counts.data(), begins.data(), row, comm_);
  MPI_Type_free(&row);
  std::vector<int> next = begins;
  for (std::size_t id : ids)
    std::copy_n(&all[width * static_cast<std::size_t>(next[owners[id]]++)], width, &rows[width * id]);
}

void Exchange::broadcast(Bytes &bytes, int root) const
{
  if (size_ == 1)
    return;
  std::uint64_t n = bytes.size();
  MPI_Bcast(&n, 1, MPI_UINT64_T, root, comm_);
  bytes.resize(n);
  for (std::size_t at = 0; at < n; at += longest_message_)
    MPI_Bcast(bytes.data() + at, static_cast<int>(std::min(longest_message_, n - at)), MPI_BYTE, root, comm_);
}

/// In parts of the longest message and a shorter one, maybe empty, by which receive() knows the end.
void Exchange::send(const Bytes &bytes, int to, std::vector<MPI_Request> &pending) const
{
  for (std::size_t at = 0; at <= bytes.size(); at += longest_message_)
    MPI_Isend(bytes.data() + at, static_cast<int>(std::min(longest_message_, bytes.size() - at)), MPI_BYTE, to, tag,
              comm_, &pending.emplace_back());
}

Bytes Exchange::receive(int from) const
{
  Bytes bytes;
  std::size_t part = longest_message_;
  while (part == longest_message_)
    {
      MPI_Status status;
      MPI_Probe(from, tag, comm_, &status);
      int n = 0;
      MPI_Get_count(&status, MPI_BYTE, &n);
      part = static_cast<std::size_t>(n);
      bytes.resize(bytes.size() + part);
      MPI_Recv(bytes.data() + bytes.size() - part, n, MPI_BYTE, from, tag, comm_, MPI_STATUS_IGNORE);
    }
  return bytes;
}

std::vector<Bytes> Exchange::gather(const Bytes &mine) const
{
  if (size_ == 1)
    return {mine};
  std::vector<Bytes> all;
  std::vector<MPI_Request> pending;
  if (rank_ == 0)
    {
      all.push_back(mine);
      for (int r = 1; r < size_; ++r)
        all.push_back(receive(r));
    }
  else
    send(mine, 0, pending);
  MPI_Waitall(static_cast<int>(pending.size()), pending.data(), MPI_STATUSES_IGNORE);
  return all;
}

std::vector<Bytes> Exchange::move(const std::vector<Bytes> &sent, const Owners &from, const Owners &to) const
{
  if (size_ == 1)
    return {};
  std::vector<MPI_Request> pending;
  pending.reserve(sent.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (from[i] == rank_ && to[i] != rank_)
      send(sent[next++], to[i], pending);
  std::vector<Bytes> received;
  for (std::size_t i = 0; i < from.size(); ++i) // messages of one rank arrive in the order they were sent
    if (from[i] != rank_ && to[i] == rank_)
      received.push_back(receive(from[i]));
  MPI_Waitall(static_cast<int>(pending.size()), pending.data(), MPI_STATUSES_IGNORE);
  return received;
}
} // namespace isostat
