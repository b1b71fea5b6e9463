// SPDX-License-Identifier: BSD-3-Clause
// A drained triaxial test set up in code, without a scene file: a dense specimen of 300 grains in a box is compressed
// along y while the lateral stress stays at 100 kPa. What to see: q rises to a multiple of p' and the specimen, dense
// as it is, first contracts and then dilates: its void ratio falls and rises again.
#include "dem/prepare/compact.hpp"

#include <cmath>
#include <fmt/format.h>

using namespace isostat;

/// Prints a row whenever one is due; the preparation has its own rows, which are left out.
struct Printer : RunObserver
{
  bool silent = true;
  void record(const Assembly &assembly, const DriveState &, const Observation &seen, bool) override
  {
    if (!silent)
      fmt::print("{:9.3f}  {:8.2f}  {:7.2f}  {:.5f}\n", 100 * seen.axial, 1e-3 * seen.p, 1e-3 * seen.q,
                 void_ratio(assembly.volume(), assembly.solid_volume()));
  }
};

int main()
{
  const GradingSpec grading{.grains = 300, .cloud_edge = 3.1e-3};
  Law law; // the law of the scenes, with its default parameters
  law->young = 1e9;
  SpecimenSpec specimen;
  specimen.pressure = 100e3;
  const double preparation_friction = std::tan(2 * M_PI / 180); // little friction makes a dense packing

  Printer printer;
  const Snapshot loose = compact(make_cloud(grading), law, preparation_friction, {specimen, printer});
  Assembly assembly(rebalance(loose, law, {specimen, printer}));

  Drained drained;
  drained.strain_end = 0.02;
  Programme programme;
  programme.servo = specimen;
  programme.record = {.record_stress = 1e9, .record_strain = 1e-3, .record_steps = 1'000'000'000, .snapshots = "none"};
  programme.stages = {drained};

  printer.silent = false;
  fmt::print("axial (%)  p' (kPa)  q (kPa)  e\n");
  DriveState state;
  return run_programme(programme, assembly, state, printer) == RunOutcome::finished ? 0 : 1;
}
