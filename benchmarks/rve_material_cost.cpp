// SPDX-License-Identifier: BSD-3-Clause
// rve_material_cost: what a batch of representative volume elements costs in addition to the elements themselves.
//
//   loop      the strain of a whole round in one call of each element: nothing but time steps, per increment
//   alone     the elements advanced one after the other by Rve::undrained, nothing around them
//   dynamics  trial, commit: every trial is kept
//   Newton    three trials from each committed state, then commit
//
//   Shear increments of 1e-5 at constant volume, interleaved; processor time, medians of the rounds.
//
//   rve_material_cost --elements 20 --grains 1000 --rounds 5
#include "apps/common/command_line.hpp"
#include "base/stopwatch.hpp"
#include "coupling/batch/rve_material.hpp"
#include "tests/support/periodic.hpp"

#include <algorithm>
#include <ctime>
#include <fmt/format.h>
#include <numeric>
#include <span>

namespace
{
using namespace isostat;

/// Processor time, of all threads: what others do on the machine is not in it.
double seconds_of(const std::function<void()> &work)
{
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Options
{
  std::size_t elements = 20, grains = 1000;
  int rounds = 5, increments = 20, threads = 1;
  double young = 5e8;
};

Snapshot specimen(const Options &options)
{
  test::CellRecipe recipe;
  recipe.grading = test::small_grading(options.grains);
  recipe.law->young = options.young;
  recipe.pressure = 100e3;
  return test::prepare_in_cell(recipe);
}

/// Reversed in every round, so that both see the same kind of soil.
double shear_of(int round) { return round % 2 ? -1e-5 : 1e-5; }

/// What one round took; `loop_steps` are those of the elements that shear at once.
struct Round
{
  double loop, alone, kept, wall, tried, loop_steps;
};

/// The same specimens four times: sheared at once, in increments, as a material in a time loop and in Newton's.
struct Contenders
{
  Contenders(const Snapshot &start, const Options &o)
      : options(o), specimens(o.elements, start), kept(specimens, settings(o), MPI_COMM_WORLD),
        tried(specimens, settings(o), MPI_COMM_WORLD)
  {
    for (const Snapshot &s : specimens)
      {
        alone.emplace_back(s, RveSettings{});
        at_once.emplace_back(s, RveSettings{});
      }
  }

  static RveMaterialSettings settings(const Options &o)
  {
    RveMaterialSettings settings;
    settings.min_steps = 1; // as the elements alone
    settings.threads = o.threads;
    return settings;
  }

  Round round(double shear)
  {
    Mat3 h = Mat3::Zero();
    h(0, 1) = shear;
    const std::vector<Gradient> increments(options.elements, Gradient{0, 0, shear});
    std::vector<Stress> stresses(options.elements);
    Round r{};
    r.loop = seconds_of([&] {
      for (Rve &rve : at_once)
        r.loop_steps += static_cast<double>(rve.undrained(Mat3(options.increments * h)).steps);
    });
    r.alone = seconds_of([&] {
      for (int k = 0; k < options.increments; ++k)
        for (Rve &rve : alone)
          rve.undrained(h);
    });
    const Stopwatch watch;
    r.kept = seconds_of([&] { trials(kept, 1, increments, stresses); });
    r.wall = watch.seconds();
    r.tried = seconds_of([&] { trials(tried, 3, increments, stresses); });
    return r;
  }

  void trials(RveMaterial &material, int iterations, std::span<const Gradient> increments, std::span<Stress> stresses)
  {
    for (int k = 0; k < options.increments; ++k)
      {
        for (int iteration = 0; iteration < iterations; ++iteration)
          material.trial(increments, stresses);
        material.commit();
      }
  }

  Options options;
  std::vector<Snapshot> specimens;
  RveMaterial kept, tried;
  std::vector<Rve> alone, at_once;
};

void compare(const Snapshot &start, const Options &options)
{
  Contenders contenders(start, options);
  std::vector<double> in_loop, in_alone, in_kept, in_tried, ratio, to_loop, inside, steps;
  for (int round = 0; round < options.rounds + 1; ++round)
    {
      const RveMaterialCost before = contenders.kept.cost();
      const Round r = contenders.round(shear_of(round));
      if (round == 0) // the lists are made, the rate control finds its rate
        continue;
      const RveMaterialCost now = contenders.kept.cost();
      const double kept_steps = static_cast<double>(now.steps - before.steps);
      in_loop.push_back(r.loop / r.loop_steps * kept_steps); // the same number of steps
      to_loop.push_back(r.kept / in_loop.back());
      in_alone.push_back(r.alone), in_kept.push_back(r.kept), in_tried.push_back(r.tried / 3);
      ratio.push_back(r.kept / r.alone);
      inside.push_back((now.rve_seconds - before.rve_seconds) / r.wall);
      steps.push_back(kept_steps / static_cast<double>(options.increments * options.elements));
    }
  const double per = 1e3 / (options.increments * static_cast<double>(options.elements));
  fmt::print("{} elements x {} grains, {} increments of 1e-5 a round, {} rounds, {} threads, {:.0f} steps per "
             "increment\n",
             options.elements, options.grains, options.increments, options.rounds, options.threads, median(steps));
  fmt::print("loop      {:.3f} ms per element and increment\n", per * median(in_loop));
  fmt::print("alone     {:.3f} ms\n", per * median(in_alone));
  fmt::print(
      "dynamics  {:.3f} ms, {:.3f} of alone (smallest {:.3f}, largest {:.3f}), {:.3f} of loop; {:.4f} of its wall "
      "clock inside elements\n",
      per * median(in_kept), median(ratio), *std::ranges::min_element(ratio), *std::ranges::max_element(ratio),
      median(to_loop), median(inside));
  fmt::print("Newton    {:.3f} ms per trial\n", per * median(in_tried));
}

void measure_batch(const Snapshot &start, const Options &options)
{
  RveMaterial material(std::vector<Snapshot>(options.elements, start), {}, MPI_COMM_WORLD);
  const std::vector<Gradient> nothing(options.elements, Gradient{});
  std::vector<Stress> stresses(options.elements);
  std::vector<Stiffness> tangents(options.elements);
  std::vector<WaveModuli> moduli(options.elements);
  const auto many = [&](const std::function<void()> &work) {
    return seconds_of([&] {
             for (int k = 0; k < 1000; ++k)
               work();
           }) /
           1000;
  };
  const double empty = many([&] {
    material.trial(nothing, stresses);
    material.commit();
  });
  const double stiffness = seconds_of([&] { material.stiffness(tangents); });
  const double waves = seconds_of([&] { material.wave_moduli(moduli); });
  const double known = many([&] { material.wave_moduli(moduli); });
  MaterialState state;
  const double pack = seconds_of([&] { state = material.pack(); });
  const double unpack = seconds_of([&] { material.unpack(state); });
  fmt::print("batch without strain {:.1f} us; stiffness {:.0f} ms, wave moduli {:.0f} ms new, {:.2f} us known; pack "
             "{:.1f} ms, unpack {:.1f} ms, {:.2f} MB\n",
             1e6 * empty, 1e3 * stiffness, 1e3 * waves, 1e6 * known, 1e3 * pack, 1e3 * unpack,
             1e-6 * static_cast<double>(state.bytes().size()));
  fmt::print("G {:.1f} MPa, V_s {:.0f} m/s saturated\n", moduli[0].s / 1e6,
             std::sqrt(moduli[0].s / material.element(0)->saturated_density()));
}
/// A deposit of one element each half metre at K0 = 0.5, from one specimen at 100 kPa.
void prepare_column(const Snapshot &start, const Options &options)
{
  double all = 0, slowest = 0, miss = 0;
  for (std::size_t k = 0; k < options.elements; ++k)
    {
      const double vertical = 1e4 * 0.5 * (static_cast<double>(k) + 0.5);
      const Mat3 target = Vec3(-0.5 * vertical, -vertical, -0.5 * vertical).asDiagonal();
      Mat3 reached;
      const double seconds = seconds_of([&] {
        const auto packed = bring_to_stress(start, target, {}, {});
        reached = Rve(specimen_of(packed), {}).stress();
      });
      all += seconds;
      slowest = std::max(slowest, seconds);
      miss = std::max(miss, ((reached - target) / (target.trace() / 3)).cwiseAbs().maxCoeff());
    }
  fmt::print(
      "in situ: {} levels, sigma'_v = 2.5 to {:.4g} kPa: {:.2f} s each, {:.2f} s the slowest, missed by {:.2g} of "
      "p' at most\n",
      options.elements, 10 * 0.5 * (static_cast<double>(options.elements) - 0.5), all / options.elements, slowest,
      miss);
}
} // namespace

int main(int argc, char **argv)
{
  CLI::App line("Cost of a material of representative volume elements compared with the elements alone");
  Options options;
  line.add_option("--elements", options.elements, "elements of the batch")->check(CLI::Range(1, 1000));
  line.add_option("--grains", options.grains, "grains of each")->check(CLI::Range(100, 20000));
  line.add_option("--rounds", options.rounds, "rounds that count")->check(CLI::Range(1, 1000));
  line.add_option("--increments", options.increments, "increments of a round")->check(CLI::Range(1, 100000));
  line.add_option("--threads", options.threads, "threads of the batch")->check(CLI::Range(1, 1000));
  line.add_option("--young", options.young, "contact modulus, Pa")->check(CLI::PositiveNumber);
  MPI_Init(&argc, &argv);
  const int result = run_command(line, argc, argv, [&] {
    const Snapshot start = specimen(options);
    compare(start, options);
    measure_batch(start, options);
    prepare_column(start, options);
  });
  MPI_Finalize();
  return result;
}
