// SPDX-License-Identifier: BSD-3-Clause
// Time of one step of a soil column next to its material: what the finite elements cost, per step and 200 elements.
// Settings take turns, seven rounds; median and range. The error that goes with it is that of the shear layer's
// transfer function (tests/verification/shear_layer_test.cpp).
//
//   column_step [elements]
#include "base/stopwatch.hpp"
#include "fem/libraries.hpp"
#include "fem/material/elastic.hpp"
#include "fem/solve/dynamics.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace
{
using namespace isostat;

/// Elastic soil that keeps the time spent in it.
class Timed : public Elastic
{
public:
  using Elastic::Elastic;
  mutable double spent = 0; ///< s

  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override
  {
    const TimedScope timed(spent);
    Elastic::trial(increments, stresses);
  }
  void commit() override
  {
    const TimedScope timed(spent);
    Elastic::commit();
  }
  void wave_moduli(std::span<WaveModuli> moduli) const override
  {
    const TimedScope timed(spent);
    Elastic::wave_moduli(moduli);
  }
};

struct Case
{
  const char *name;
  unsigned degree;
  Drainage drainage;
};

/// Time per step outside the material and inside it, us.
std::pair<double, double> step_cost(const Case &which, unsigned elements)
{
  constexpr int n_steps = 20000;
  SoilProfile soil{.layers = {{.name = "soil", .thickness = 20, .permeability = 1e-5, .cells = elements}}, .water = {}};
  const Discretisation<1> space({.soil = soil, .degree = which.degree}, shaken_supports(false));
  Timed material(ElasticParameters{}, space.n_points());
  DynamicsSettings settings{.drainage = which.drainage};
  settings.motion[0] = harmonic_motion(1, 2, 60, 1, 0.01);
  Dynamics run(space, material, settings);
  for (int k = 0; k < 1000; ++k)
    run.step();
  material.spent = {};
  const Stopwatch watch;
  for (int k = 0; k < n_steps; ++k)
    run.step();
  const double total = 1e6 * watch.seconds(), inside = 1e6 * material.spent;
  return {(total - inside) / n_steps, inside / n_steps};
}
} // namespace

int main(int argc, char **argv)
{
  const Libraries libraries;
  const unsigned elements = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 200;
  const Case cases[] = {{"undrained, degree 1", 1, Drainage::undrained},
                        {"undrained, degree 2", 2, Drainage::undrained},
                        {"dry, degree 2", 2, Drainage::dry},
                        {"u-p, degree 2", 2, Drainage::coupled}};
  std::vector<std::pair<double, double>> seen[std::size(cases)];
  for (int round = 0; round < 7; ++round)
    for (std::size_t k = 0; k < std::size(cases); ++k)
      seen[k].push_back(step_cost(cases[k], elements));
  std::printf("%u elements; us per step, median (range) of 7 rounds\n%-22s %-28s %s\n", elements, "", "finite elements",
              "elastic material");
  for (std::size_t k = 0; k < std::size(cases); ++k)
    {
      std::sort(seen[k].begin(), seen[k].end());
      std::printf("%-22s %6.2f (%.2f to %.2f)       %6.2f\n", cases[k].name, seen[k][3].first, seen[k].front().first,
                  seen[k].back().first, seen[k][3].second);
    }
}
