// SPDX-License-Identifier: BSD-3-Clause
// A material of grains on several ranks. Prints hashes that must be the same for any number of ranks and threads;
// returns 1 if something is wrong that can be seen inside.
//
//   mpirun -n RANKS rve_material_mpi THREADS FOLDER
#include "base/error.hpp"
#include "base/files/hash.hpp"
#include "tests/coupling/rve_column.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>

namespace
{
using namespace isostat;

constexpr std::size_t n_points = 5;
int rank = 0, size = 1;
bool good = true;

void say(const std::string &text)
{
  if (rank == 0)
    std::puts(text.c_str());
}

/// On all ranks or on none.
void expect(bool holds, const char *what)
{
  int mine = holds, all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (!all)
    say(std::string("WRONG: ") + what);
  good &= all != 0;
}

template <typename T>
std::uint64_t common_hash(const std::vector<T> &values)
{
  const std::uint64_t mine = Hash().words(std::as_bytes(std::span(values))).value();
  std::uint64_t first = mine;
  MPI_Bcast(&first, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  expect(first == mine, "ranks have different results");
  return mine;
}

std::vector<Stress> run(RveMaterial &material, int from, int to)
{
  std::vector<Stress> stresses(n_points);
  for (int k = from; k < to; ++k)
    {
      material.trial(test::column_increments(n_points, k), stresses);
      material.commit();
    }
  return stresses;
}

std::vector<Snapshot> specimens()
{
  std::vector<Snapshot> all;
  for (std::size_t i = 0; i < n_points; ++i)
    all.push_back(test::soft_specimen(i % 2 ? 4 : 9));
  return all;
}

/// The elements of the next rank.
Owners next_place(Owners owners)
{
  for (int &owner : owners)
    owner = (owner + 1) % size;
  return owners;
}

void run_and_move(const RveMaterialSettings &settings)
{
  RveMaterial still(specimens(), settings, MPI_COMM_WORLD), moved(specimens(), settings, MPI_COMM_WORLD);
  RveMaterialSettings restless = settings;
  restless.balance = {1.0, 0.0, 2};
  RveMaterial balanced(specimens(), restless, MPI_COMM_WORLD);
  for (int k = 0; k < 24; k += 4)
    {
      const std::uint64_t a = common_hash(run(still, k, k + 4));
      moved.place(next_place(moved.owners()));
      expect(a == common_hash(run(moved, k, k + 4)), "a move changes results");
      moved.place(Owners(n_points, k % size));
      expect(a == common_hash(run(balanced, k, k + 4)), "balance changes results");
      say(fmt::format("stress after {:2} trials  {:016x}", k + 4, a));
    }
  const std::uint64_t bytes = common_hash(still.pack().bytes());
  expect(bytes == common_hash(moved.pack().bytes()) && bytes == common_hash(balanced.pack().bytes()),
         "moves change packed bytes");
  say(fmt::format("packed                  {:016x}", bytes));
  std::vector<WaveModuli> moduli(n_points);
  std::vector<Stiffness> tangents(n_points);
  moved.wave_moduli(moduli);
  moved.stiffness(tangents);
  say(fmt::format("wave moduli, stiffness  {:016x} {:016x}", common_hash(moduli), common_hash(tangents)));
  RveMaterial resumed(specimens(), settings, MPI_COMM_WORLD);
  resumed.place(next_place(resumed.owners()));
  resumed.unpack(still.pack());
  expect(common_hash(run(still, 24, 30)) == common_hash(run(resumed, 24, 30)), "unpacked elements go another way");
}

Bytes numbered(std::size_t n, int seed)
{
  Bytes bytes(n);
  for (std::size_t i = 0; i < n; ++i)
    bytes[i] = static_cast<std::byte>(i * 7 + static_cast<std::size_t>(seed));
  return bytes;
}

/// Bytes longer than a message, as long as some, and none at all.
void exchange_in_parts()
{
  const Exchange exchange(MPI_COMM_WORLD, 100);
  for (std::size_t n : {0, 99, 100, 101, 200, 1234})
    {
      const std::vector<Bytes> all = exchange.gather(numbered(n, rank));
      bool right = all.size() == static_cast<std::size_t>(rank == 0 ? size : 0);
      for (std::size_t r = 0; r < all.size(); ++r)
        right &= all[r] == numbered(n, static_cast<int>(r));
      expect(right, "bytes are not gathered");
      Bytes told = rank == size - 1 ? numbered(n, 5) : Bytes{};
      exchange.broadcast(told, size - 1);
      expect(told == numbered(n, 5), "bytes are not broadcast");
      const Owners from = {0, 0, size - 1}, to = {size - 1, size - 1, 0};
      std::vector<Bytes> sent, due;
      if (size > 1 && rank == 0)
        sent = {numbered(n, 1), numbered(2 * n, 2)}, due = {numbered(300, 3)};
      else if (size > 1 && rank == size - 1)
        sent = {numbered(300, 3)}, due = {numbered(n, 1), numbered(2 * n, 2)};
      expect(exchange.move(sent, from, to) == due, "bytes are not moved");
    }
}

/// One element fails on its rank: all ranks stop with one message, and can continue.
void fail_on_purpose(const RveMaterialSettings &settings)
{
  RveMaterial material(specimens(), settings, MPI_COMM_WORLD);
  run(material, 0, 3);
  auto increments = test::column_increments(n_points, 3);
  increments[3][2] = 0.9;
  std::vector<Stress> stresses(n_points);
  std::string message;
  try
    {
      material.trial(increments, stresses);
    }
  catch (const RunFailure &failure)
    {
      message = failure.what();
    }
  common_hash(std::vector<char>(message.begin(), message.end()));
  say("stopped by: " + message);
  say(fmt::format("gone on                 {:016x}", common_hash(run(material, 3, 6))));
}

void start_in_situ(RveMaterialSettings settings, const std::filesystem::path &folder)
{
  settings.library = folder / "library.h5";
  settings.cache = folder / "cache.h5";
  if (rank == 0)
    test::write_library(settings.library);
  MPI_Barrier(MPI_COMM_WORLD);
  std::vector<SpecimenRequest> requests(n_points);
  std::vector<Stress> target(n_points);
  for (std::size_t i = 0; i < n_points; ++i)
    {
      requests[i].realisation = i % 2;
      target[i] = test::in_situ(20e3 + 10e3 * static_cast<double>(i / 2), 0.6);
    }
  RveMaterial prepared(requests, settings, MPI_COMM_WORLD), cached(requests, settings, MPI_COMM_WORLD);
  prepared.set_initial_stress(target);
  MPI_Barrier(MPI_COMM_WORLD); // the cache is written
  cached.set_initial_stress(target);
  const std::uint64_t bytes = common_hash(prepared.pack().bytes());
  expect(bytes == common_hash(cached.pack().bytes()), "the cache gives other elements");
  expect(list_library(settings.cache).size() == n_points, "the cache lacks elements");
  say(fmt::format("in situ                 {:016x}", bytes));
  target[2] = test::in_situ(50, 0.6);
  std::string message;
  try
    {
      cached.set_initial_stress(target);
    }
  catch (const InputError &error)
    {
      message = error.what();
    }
  common_hash(std::vector<char>(message.begin(), message.end()));
  say("refused: " + message);
}
} // namespace

int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  if (argc != 3)
    return 2;
  RveMaterialSettings settings;
  settings.threads = std::atoi(argv[1]);
  exchange_in_parts();
  run_and_move(settings);
  fail_on_purpose(settings);
  start_in_situ(settings, argv[2]);
  MPI_Finalize();
  return good ? 0 : 1;
}
