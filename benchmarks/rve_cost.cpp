// SPDX-License-Identifier: BSD-3-Clause
// rve_cost: what a representative volume element costs, side by side with the box of the element tests.
//
//   step      constant-volume shear of a periodic cell and of a box, N grains each, same grading, density and pressure,
//             interleaved (cell, box, cell, box, ...): time per step and per contact
//   advance   milliseconds of an increment of 1e-5 of simple shear at the default tolerance, with its time steps
//   state     bytes per grain; microseconds of save, restore, pack; milliseconds of the condensed stiffness
//
//   rve_cost --grains 1000 --rounds 7
#include "apps/common/command_line.hpp"
#include "base/stopwatch.hpp"
#include "dem/motion/critical_step.hpp"
#include "dem/rve/rve.hpp"
#include "tests/support/periodic.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace
{
using namespace isostat;

double seconds_of(const std::function<void()> &work)
{
  const Stopwatch watch;
  work();
  return watch.seconds();
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Shear at constant volume, as the element tests do it: stress is measured in every step.
class Sheared
{
public:
  explicit Sheared(const Snapshot &specimen) : assembly(specimen), reference_{specimen.box}
  {
    assembly.settings.time_step =
        0.8 * critical_step_bound(assembly.law(), assembly.packing(), assembly.walls(), assembly.contacts());
  }
  void run(int steps)
  {
    for (int k = 0; k < steps; ++k)
      {
        assembly.compute_forces();
        stress += assembly.stress()(1, 1);
        const double step = 0.5 * assembly.settings.time_step;
        axial_ += step;
        if (assembly.cell())
          assembly.deform(Mat3(isochoric(step).asDiagonal()));
        else
          assembly.move(reference_.strained(isochoric(axial_)));
      }
  }
  std::size_t contacts()
  {
    assembly.compute_forces();
    const Snapshot s = assembly.snapshot();
    return s.contacts.size() + s.wall_contacts.size();
  }
  Assembly assembly;
  double stress = 0;

private:
  RigidBox reference_;
  double axial_ = 0;
};

void compare_steps(std::uint64_t grains, int rounds, int steps)
{
  Sheared cell(test::periodic_specimen(grains, 10)), box(test::specimen(grains, 10));
  cell.run(500), box.run(500);
  std::vector<double> in_cell, in_box, ratio;
  for (int r = 0; r < rounds; ++r)
    {
      in_cell.push_back(seconds_of([&] { cell.run(steps); }) / steps);
      in_box.push_back(seconds_of([&] { box.run(steps); }) / steps);
      ratio.push_back(in_cell.back() / in_box.back());
    }
  const double nc = static_cast<double>(cell.contacts()), nb = static_cast<double>(box.contacts());
  fmt::print("step, {} grains    cell {:.2f} us, {:.0f} contacts, {:.2f} ns each\n"
             "                     box  {:.2f} us, {:.0f} contacts (walls included), {:.2f} ns each\n"
             "                     cell / box {:.3f} per step (smallest {:.3f}, largest {:.3f}), {:.3f} per contact\n",
             grains, 1e6 * median(in_cell), nc, 1e9 * median(in_cell) / nc, 1e6 * median(in_box), nb,
             1e9 * median(in_box) / nb, median(ratio), *std::ranges::min_element(ratio),
             *std::ranges::max_element(ratio), median(ratio) * nb / nc);
}

void measure_element(std::uint64_t grains, int rounds)
{
  const Snapshot &specimen = test::periodic_specimen(grains, 10);
  Rve rve(specimen, {});
  Mat3 shear = Mat3::Zero();
  shear(0, 1) = 1e-5;
  std::vector<double> times, steps, saves, restores, packs;
  for (int r = 0; r < 3 * rounds; ++r)
    {
      RveResponse response;
      times.push_back(seconds_of([&] { response = rve.undrained(shear); }));
      steps.push_back(static_cast<double>(response.steps));
      RveState state;
      saves.push_back(seconds_of([&] { state = rve.save(); }));
      restores.push_back(seconds_of([&] { rve.restore(state); }));
      packs.push_back(seconds_of([&] { (void)rve.pack(); }));
    }
  fmt::print("advance, d gamma 1e-5  first {:.2f} ms ({:.0f} steps), median {:.2f} ms ({:.0f} steps), last {:.2f} ms "
             "({:.0f} steps)\n",
             1e3 * times.front(), steps.front(), 1e3 * median(times), median(steps), 1e3 * times.back(), steps.back());
  const Snapshot now = rve.snapshot();
  Mat6 c;
  const double t = seconds_of([&] { c = rve.stiffness(); });
  fmt::print("state                {:.0f} bytes per grain at {:.2f} contacts per grain; save {:.0f} us, restore {:.0f} "
             "us, pack {:.0f} us\n"
             "stiffness            {:.0f} ms; G_xy {:.1f} MPa, E_oed(y) {:.1f} MPa\n",
             static_cast<double>(rve.save().bytes()) / grains, 2.0 * now.contacts.size() / grains, 1e6 * median(saves),
             1e6 * median(restores), 1e6 * median(packs), 1e3 * t, c(5, 5) / 1e6, c(1, 1) / 1e6);
}
} // namespace

int main(int argc, char **argv)
{
  CLI::App line("Cost of a representative volume element compared with the box of the element tests");
  std::uint64_t grains = 1000;
  int rounds = 7, steps = 2000;
  line.add_option("--grains", grains, "grains of either packing")->check(CLI::Range(100, 20000));
  line.add_option("--rounds", rounds, "interleaved rounds of cell and box")->check(CLI::Range(1, 1000));
  line.add_option("--steps", steps, "steps of a round")->check(CLI::Range(10, 1000000));
  return run_command(line, argc, argv, [&] {
    compare_steps(grains, rounds, steps);
    measure_element(grains, rounds);
  });
}
