// SPDX-License-Identifier: BSD-3-Clause
// contact_loop: nanoseconds per contact and step of the contact loop alone (gather, law, history, scatter), for every
// instruction set of this machine, every variant of the law and three sizes. Google Benchmark: see --help.
//
//   taskset -c 0 contact_loop
//   taskset -c 0 contact_loop --benchmark_filter=full/AVX3 --benchmark_repetitions=5
//
// The packing is copies of the stored one of 1,000 grains in a row (tests/reference/n1000/medium, dense, 200 kPa), as
// it is: only touching pairs are listed, all lanes work. Time stands still (dt = 0), so every pass does the same.
#include "base/record/instruction_set.hpp"
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/contact/loop.hpp"
#include "dem/io/text_tables.hpp"
#include "dem/neighbours/cell_grid.hpp"
#include "dem/prepare/space_filling.hpp"
#include "tests/support/instruction_sets.hpp"
#include "tests/support/specimens.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <hwy/targets.h>

namespace
{
using namespace isostat;

struct Variant
{
  const char *name;
  LawFeatures on;
  bool energy;
  double hertz_exponent = 0; ///< 0: the linear law
};
constexpr Variant variants[] = {{"frictionless", {false, false, false}, false},
                                {"sliding", {true, false, false}, false},
                                {"rolling", {true, true, false}, false},
                                {"twisting", {true, false, true}, false},
                                {"full", {true, true, true}, false},
                                {"full+energy", {true, true, true}, true},
                                {"hertz-mindlin", {true, true, true}, false, 1.5},
                                {"hertz-mindlin+energy", {true, true, true}, true, 1.5},
                                {"asperities", {true, true, true}, false, 1.65}};

Law law_of(const Variant &variant)
{
  if (variant.hertz_exponent > 0)
    {
      HertzMindlin law = HertzMindlin().with(variant.on);
      law.exponent = variant.hertz_exponent;
      return law;
    }
  return test::paper_law().with(variant.on);
}

Packing moving_packing(std::size_t copies)
{
  const std::string folder = ISOSTAT_SOURCE_DIR "/tests/reference/n1000/medium";
  const Snapshot stored = sorted_along_curve(import_tables(folder, test::paper_law(), 2650));
  Packing packing = test::row_of_copies(stored, copies).grains;
  for (std::size_t i = 0; i < packing.n_grains(); ++i) // some slide, some roll
    {
      const double a = static_cast<double>(i);
      packing.set_linear_velocity(i, 1e-3 * Vec3(std::sin(a), std::cos(a), std::sin(2 * a)));
      packing.set_angular_velocity(i, 3.0 * Vec3(std::cos(a), std::sin(3 * a), std::cos(2 * a)));
    }
  return packing;
}

void run(benchmark::State &state, const Variant &variant, std::int64_t target, std::size_t copies)
{
  hwy::SetSupportedTargetsForTest(target);
  const Law law = law_of(variant);
  const Packing packing = moving_packing(copies);
  ContactList list(law->history());
  list.replace_pairs(find_pairs(packing, 0), static_cast<std::uint32_t>(packing.n_grains()));
  AlignedVector<double> action(8 * list.n_slots(), 0.0);
  DissipationPerPair losses;
  DissipationPerPair *const dissipation = variant.energy ? &losses : nullptr;
  for (int step = 0; step < 20; ++step) // a past for the contacts
    add_contact_forces(law, packing, 5e-8, list, action.data(), dissipation);
  for (auto _ : state)
    {
      add_contact_forces(law, packing, 0.0, list, action.data(), dissipation);
      benchmark::ClobberMemory();
    }
  using benchmark::Counter;
  const double contacts = static_cast<double>(list.n_pairs());
  state.counters["contacts"] = contacts;
  state.counters["per_contact"] = Counter(contacts, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["bytes_per_contact"] = static_cast<double>(list.bytes()) / contacts;
  hwy::SetSupportedTargetsForTest(0);
}
} // namespace

int main(int argc, char **argv)
{
  for (const std::size_t copies : {1u, 10u, 100u})
    for (const std::int64_t target : test::instruction_sets())
      for (const Variant &variant : variants)
        benchmark::RegisterBenchmark(
            fmt::format("{}/{}/{}", variant.name, hwy::TargetName(target), 1000 * copies).c_str(),
            [=](benchmark::State &state) { run(state, variant, target, copies); });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv))
    return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
