// SPDX-License-Identifier: BSD-3-Clause
// rank_model: what many ranks would give on a block of columns like one that was run, from the time steps that each of
// its packings took in each step, and the program's own placement and balance.
//
//   paths/d0 ... dN/history.h5     ->   columns side by side, each as the one that was run but later by a lag of its
//   own (grains.path_depths of a run:        step by step:  longest rank + elements + network
//    all its levels)
//
//   shared      every rank has the whole mesh, packings go where they balance     t = max_r T_r + N t_el +
//   Allgatherv distributed every rank has its columns, with their packings for good          t = max_r T_r + N/R
//   t_el + halo
//
//   rank_model results/COLUMN/paths --step-seconds 36e-6 --element-seconds 3.2e-6
//
// T_r: the threads of a rank take its packings in the order of falling cost, each when it is free.
//
// Assumed, not measured: the network, cores as fast as the one measured, and lags. Efficiency is the time of all
// packings over cores and wall clock.
#include "apps/common/command_line.hpp"
#include "base/error.hpp"
#include "base/files/hdf5.hpp"
#include "coupling/placement/placement.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <numeric>
#include <queue>
#include <random>

namespace
{
using namespace isostat;

struct Options
{
  std::string records;
  double step_seconds = 36e-6;             ///< of a time step of one packing
  double element_seconds = 3.2e-6;         ///< of a finite element in a step
  double latency = 2e-6, bandwidth = 10e9; ///< s; bytes/s
  double packing_bytes = 405e3;            ///< of a packing that moves
  double lag = 1;                          ///< columns start later by a random time up to this, s
  int threads = 1;                         ///< of a rank
  std::size_t interval = 100;              ///< steps between two looks at the balance
  std::uint64_t seed = 1;
};

/// Time steps of each packing in each step of the column: [level][step].
struct Records
{
  std::vector<std::vector<double>> steps;
  double time_step = 0;
  std::size_t n_steps() const { return steps.front().size(); }
};

Records read_records(const std::string &folder)
{
  Records records;
  for (int k = 0;; ++k)
    {
      const std::filesystem::path path = std::filesystem::path(folder) / fmt::format("d{}", k) / "history.h5";
      if (!std::filesystem::exists(path))
        break;
      const hdf5::File file = hdf5::File::open(path);
      records.steps.push_back(file.root().group("history").read<double>("packing_steps"));
      const auto time = file.root().group("history").read<double>("time");
      records.time_step = time.at(1) - time.at(0);
    }
  if (records.steps.empty())
    throw InputError(fmt::format("{}: holds no d0/history.h5. Run a column with grains.path_depths.", folder));
  return records;
}

/// A block of columns, and how long its packings take.
class Block
{
public:
  Block(const Records &records, std::size_t columns, const Options &options) : records_(records), options_(options)
  {
    std::mt19937_64 random(options.seed);
    const auto most = static_cast<std::uint64_t>(options.lag / records.time_step);
    for (std::size_t c = 0; c < columns; ++c)
      lags_.push_back(most ? random() % (most + 1) : 0);
  }
  std::size_t n_levels() const { return records_.steps.size(); }
  std::size_t n_packings() const { return lags_.size() * n_levels(); }
  /// Seconds of every packing, column by column.
  void costs(std::size_t step, std::vector<double> &seconds) const
  {
    const std::size_t n = records_.n_steps();
    for (std::size_t c = 0; c < lags_.size(); ++c)
      for (std::size_t level = 0; level < n_levels(); ++level)
        seconds[c * n_levels() + level] = options_.step_seconds * records_.steps[level][(step + n - lags_[c]) % n];
  }

private:
  const Records &records_;
  const Options &options_;
  std::vector<std::size_t> lags_;
};

struct Model
{
  double packings = 0, busiest = 0, elements = 0, network = 0; ///< s: all packings together; wall clock of the rest
  std::size_t moves = 0;
  double wall() const { return busiest + elements + network; }
  double efficiency(int cores) const { return packings / (cores * wall()); }
};

double gather_seconds(std::size_t bytes, int ranks, const Options &o)
{
  return ranks == 1 ? 0 : std::ceil(std::log2(ranks)) * o.latency + static_cast<double>(bytes) / o.bandwidth;
}

/// Wall clock of a rank whose threads take its packings in the order of falling mean cost, each when it is free.
double makespan(const std::vector<double> &seconds, const std::vector<std::size_t> &order, int threads)
{
  std::priority_queue<double, std::vector<double>, std::greater<>> busy_until;
  for (int t = 0; t < threads; ++t)
    busy_until.push(0);
  double last = 0;
  for (std::size_t id : order)
    {
      const double end = busy_until.top() + seconds[id];
      busy_until.pop();
      busy_until.push(end);
      last = std::max(last, end);
    }
  return last;
}

/// Packings of each rank by falling cost.
std::vector<std::vector<std::size_t>> orders_of(const std::vector<double> &mean, const Owners &owners, int ranks)
{
  std::vector<std::size_t> all(mean.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::ranges::stable_sort(all, [&](std::size_t a, std::size_t b) { return mean[a] > mean[b]; });
  std::vector<std::vector<std::size_t>> orders(ranks);
  for (std::size_t id : all)
    orders[owners[id]].push_back(id);
  return orders;
}

Model run(const Block &block, std::size_t n_steps, int ranks, bool shared, const Options &o)
{
  constexpr std::size_t row_bytes = 9 * sizeof(double); // ElementRow: stress, seconds, time steps, failed
  const std::size_t n = block.n_packings();
  std::vector<double> seconds(n);
  CostMeter meter(n);
  const std::vector<double> &mean = meter.means();
  Owners owners = longest_first(mean, ranks);
  if (!shared)
    for (std::size_t id = 0; id < n; ++id)
      owners[id] = static_cast<int>(id * ranks / n);
  auto orders = orders_of(mean, owners, ranks);
  Model model;
  for (std::size_t step = 0; step < n_steps; ++step)
    {
      block.costs(step, seconds);
      meter.add_trial(seconds);
      for (double s : seconds)
        model.packings += s;
      double longest = 0;
      for (const auto &order : orders)
        longest = std::max(longest, makespan(seconds, order, o.threads));
      model.busiest += longest;
      model.elements += o.element_seconds * static_cast<double>(shared ? n : n / ranks);
      model.network += shared ? gather_seconds(n * row_bytes, ranks, o) : (ranks > 1 ? 6 * o.latency : 0);
      if ((step + 1) % o.interval != 0)
        continue;
      orders = orders_of(mean, owners, ranks);
      if (!shared)
        continue;
      const Owners next = rebalanced(mean, owners, ranks, {});
      std::size_t moved = 0;
      for (std::size_t id = 0; id < n; ++id)
        moved += next[id] != owners[id];
      model.moves += moved;
      model.network += static_cast<double>(moved) * o.packing_bytes / (o.bandwidth * ranks) * 2;
      owners = next;
      orders = orders_of(mean, owners, ranks);
    }
  return model;
}

void report(const Records &records, const Options &options)
{
  fmt::print(
      "| columns | packings | cores | ranks | mesh | wall clock, s | efficiency | busiest rank, s | elements, s | "
      "network, s | moves |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  const std::vector<std::pair<std::size_t, int>> cases = {{1, 1},     {1, 2},      {16, 16},    {256, 16},
                                                          {256, 256}, {4096, 256}, {4096, 4096}};
  for (const auto &[columns, cores] : cases)
    for (const bool shared : {true, false})
      {
        const int ranks = cores / options.threads;
        if (cores % options.threads != 0 || (!shared && columns < static_cast<std::size_t>(ranks)))
          continue;
        const Block block(records, columns, options);
        const Model m = run(block, records.n_steps(), ranks, shared, options);
        fmt::print("| {} | {} | {} | {} | {} | {:.0f} | {:.2f} | {:.0f} | {:.1f} | {:.1f} | {} |\n", columns,
                   block.n_packings(), cores, ranks, shared ? "shared" : "distributed", m.wall(), m.efficiency(cores),
                   m.busiest, m.elements, m.network, m.moves);
      }
}
} // namespace

int main(int argc, char **argv)
{
  CLI::App line("What many ranks would give, from the measured time steps of the packings of one column");
  Options options;
  line.add_option("records", options.records, "folder paths of a soil_column run, of all its levels")->required();
  line.add_option("--step-seconds", options.step_seconds, "time step of a packing, s")->check(CLI::PositiveNumber);
  line.add_option("--element-seconds", options.element_seconds, "finite element in a step, s")
      ->check(CLI::PositiveNumber);
  line.add_option("--latency", options.latency, "of a message, s")->check(CLI::NonNegativeNumber);
  line.add_option("--bandwidth", options.bandwidth, "of a rank, bytes/s")->check(CLI::PositiveNumber);
  line.add_option("--packing-bytes", options.packing_bytes, "of a packing that moves")->check(CLI::PositiveNumber);
  line.add_option("--threads", options.threads, "of a rank; they share its packings")->check(CLI::Range(1, 1024));
  line.add_option("--lag", options.lag, "columns are late by a random time up to this, s")
      ->check(CLI::NonNegativeNumber);
  return run_command(line, argc, argv, [&] { report(read_records(options.records), options); });
}
