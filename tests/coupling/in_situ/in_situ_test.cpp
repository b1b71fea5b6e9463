// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/in_situ/in_situ.hpp"

#include "base/error.hpp"
#include "tests/coupling/rve_column.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;

class InSitu : public TemporaryFolder
{
protected:
  InSitu()
  {
    settings.library = folder / "library.h5";
    settings.cache = folder / "cache.h5";
    test::write_library(settings.library);
  }
  RveMaterialSettings settings;
};
} // namespace

TEST_F(InSitu, StressIsReachedAndASecondStartIsTheSame)
{
  const std::vector<Stress> target = {test::in_situ(70e3, 0.5), test::in_situ(40e3, 1), test::in_situ(10e3, 0.6)};
  const std::vector<SpecimenRequest> requests = {{0.5, 0}, {0.5, 1}, {0.5, 0}};
  RveMaterial first(requests, settings, MPI_COMM_SELF);
  first.set_initial_stress(target);
  std::vector<Stress> stress(3);
  first.trial(std::vector<Gradient>(3, Gradient{}), stress);
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 6; ++c)
      EXPECT_NEAR_BECAUSE(stress[i][c], target[i][c], -0.01 * (target[i][0] + target[i][1] + target[i][2]) / 3,
                          "what set_initial_stress() promises: 1 % of p'")
          << i << c;
  RveMaterial second(requests, settings, MPI_COMM_SELF); // from the cache
  second.set_initial_stress(target);
  EXPECT_EQ(first.pack(), second.pack());
  const auto entries = list_library(settings.cache);
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_THAT(entries[0].text("source"), testing::StartsWith("s000"));
}

TEST_F(InSitu, TheShearOfASlopeIsReachedOnEveryPath)
{
  const std::vector<double> tangents = {0.009, 0.07, 0.18, 0.3}; // of 0.5 to 17 deg
  std::vector<Stress> target;
  for (double tangent : tangents)
    target.push_back({-30e3, -30e3, -60e3, 0, 60e3 * tangent, 0});
  for (const InSituPath path : {InSituPath::all_stresses, InSituPath::no_lateral_strain})
    {
      settings.in_situ.path = path;
      RveMaterial material(std::vector<SpecimenRequest>(target.size()), settings, MPI_COMM_SELF);
      material.set_initial_stress(target);
      std::vector<Stress> stress(target.size());
      material.trial(std::vector<Gradient>(target.size(), Gradient{}), stress);
      for (std::size_t k = 0; k < target.size(); ++k)
        {
          const double p = -(stress[k][0] + stress[k][1] + stress[k][2]) / 3;
          EXPECT_NEAR_BECAUSE(stress[k][4], target[k][4], 0.01 * p, "what set_initial_stress() promises: 1 % of p'");
          EXPECT_NEAR_BECAUSE(stress[k][2], target[k][2], 0.01 * p, "what set_initial_stress() promises: 1 % of p'");
        }
    }
}

TEST_F(InSitu, AShearBeyondTheStrengthIsNotReached)
{
  settings.in_situ.max_steps = 20'000;
  RveMaterial material(std::vector<SpecimenRequest>(1), settings, MPI_COMM_SELF);
  EXPECT_THAT(message_of<RunFailure>([&] {
                material.set_initial_stress(std::vector{Stress{-60e3, -60e3, -60e3, 0, 60e3, 0}});
              }),
              AllOf(HasSubstr("shear 60 kPa: not reached"),
                    HasSubstr("K0 or the slope may be beyond what the packing can carry")));
}

TEST_F(InSitu, IsAtRest)
{
  const std::vector<Stress> target = {test::in_situ(70e3, 0.5), test::in_situ(5e3, 0.5), test::in_situ(2e3, 0.5)};
  RveMaterial material(std::vector<SpecimenRequest>(3), settings, MPI_COMM_SELF);
  material.set_initial_stress(target);
  std::vector<Stress> before(3), after(3);
  const std::vector<Gradient> nothing(3, Gradient{}), tiny(3, Gradient{{0, 0, 1e-13, 0, 0, 0, 0, 0, 0}});
  material.trial(nothing, before);
  for (int k = 0; k < 1000; ++k) // a time step each
    {
      material.trial(tiny, after);
      material.commit();
    }
  double worst = 0;
  for (int i = 0; i < 3; ++i)
    {
      const double p = -(before[i][0] + before[i][1] + before[i][2]) / 3;
      EXPECT_BELOW_BECAUSE(material.element(i)->kinetic_stress().norm() / p, 1e-4, "a packing at rest");
      for (int c = 0; c < 6; ++c)
        worst = std::max(worst, std::abs(after[i][c] - before[i][c]) / p);
    }
  EXPECT_BELOW_BECAUSE(worst, 0.01, "what set_initial_stress() promises: 1 % of p'");
  material.set_initial_stress(target);
  material.trial(nothing, after);
  EXPECT_EQ(before, after);
}

TEST_F(InSitu, WithoutLateralStrainThePackingChoosesItsK0)
{
  settings.in_situ.path = InSituPath::no_lateral_strain;
  RveMaterial material(std::vector<SpecimenRequest>(1), settings, MPI_COMM_SELF);
  material.set_initial_stress(std::vector{test::in_situ(150e3, 0.5)});
  const Mat3 stress = material.element(0)->stress();
  EXPECT_NEAR_BECAUSE(stress(2, 2), -150e3, 1500, "what set_initial_stress() promises");
  EXPECT_GT(stress(0, 0), -145e3);
  const PeriodicCell cell = material.element(0)->save().grains.cell, start = *test::soft_specimen(4, 100e3).cell;
  EXPECT_NEAR_BECAUSE(cell.edges(0, 0) / start.edges(0, 0), 1, 1e-12, "round-off of 1e4 time steps");
  EXPECT_LT(cell.edges(1, 1), start.edges(1, 1));
}

TEST_F(InSitu, GivenElementsGoToTheirStressToo)
{
  RveMaterial material({test::soft_specimen(9)}, settings, MPI_COMM_SELF);
  material.set_initial_stress(std::vector{test::in_situ(120e3, 0.7)});
  EXPECT_NEAR_BECAUSE(material.element(0)->stress()(2, 2), -120e3, 1200, "what set_initial_stress() promises");
}

TEST_F(InSitu, PointsMayBeOfOtherSands)
{
  LibraryWriter writer = LibraryWriter::create(folder / "coarse.h5");
  test::CellRecipe coarse = test::soft_recipe(4, 100e3);
  coarse.grading = test::small_grading(250);
  coarse.law->young = 1e9;
  Specimen specimen;
  specimen.state = test::prepare_in_cell(coarse);
  specimen.numbers = {{"seed", 4}, {"relative_density", 0.5}, {"vertical_stress_Pa", 100e3}, {"K0", 1.0}};
  writer.add(writer.next_name(), specimen);
  writer.commit();
  const std::vector<SpecimenRequest> requests = {{0.5, 0}, {0.5, 0, folder / "coarse.h5"}, {0.5, 0}};
  const std::vector<Stress> target(3, test::in_situ(90e3, 0.8));
  RveMaterial both(requests, settings, MPI_COMM_SELF), again(requests, settings, MPI_COMM_SELF);
  both.set_initial_stress(target);
  for (const std::size_t point : {0, 1, 2})
    {
      const Assembly &assembly = both.element(point)->assembly();
      EXPECT_EQ(assembly.packing().n_grains(), point == 1 ? 250u : 200u);
      EXPECT_EQ(assembly.law()->young, point == 1 ? 1e9 : 5e8);
    }
  EXPECT_EQ(list_library(settings.cache).size(), 2u) << "equal points share their state in situ";
  again.unpack(both.pack());
  std::vector<Stress> one(3), other(3);
  both.trial(test::column_increments(3, 1), one);
  again.trial(test::column_increments(3, 1), other);
  EXPECT_EQ(one, other);
}

TEST_F(InSitu, RefusesWhatCannotBe)
{
  RveMaterial material(std::vector<SpecimenRequest>(2), settings, MPI_COMM_SELF);
  const auto with = [&](const Stress &second) {
    return [&, second] { material.set_initial_stress(std::vector{test::in_situ(70e3, 0.5), second}); };
  };
  EXPECT_THAT(message_of<InputError>(with(test::in_situ(100, 0.5))),
              AllOf(HasSubstr("rve: point 1: sigma'_v = 0.1 kPa"), HasSubstr("below 0.5 kPa")));
  EXPECT_THAT(message_of<InputError>(with(test::in_situ(-70e3, 0.5))), HasSubstr("compressed in all directions"));
  settings.in_situ.max_steps = 3000;
  RveMaterial hasty(std::vector<SpecimenRequest>(1), settings, MPI_COMM_SELF);
  EXPECT_THAT(message_of<RunFailure>([&] { hasty.set_initial_stress(std::vector{test::in_situ(60e3, 0.02)}); }),
              AllOf(HasSubstr("rve: point 0: sigma'_v = 60 kPa"), HasSubstr("not reached from a specimen at")));
  std::vector<Stress> stress(1);
  EXPECT_THAT(message_of<RunFailure>([&] { hasty.trial(std::vector<Gradient>(1), stress); }),
              HasSubstr("set_initial_stress"));
  RveMaterialSettings lost;
  lost.library = folder / "none.h5";
  RveMaterial nowhere(std::vector<SpecimenRequest>(1), lost, MPI_COMM_SELF);
  EXPECT_THAT(message_of<InputError>([&] { nowhere.set_initial_stress(std::vector{test::in_situ(60e3, 1)}); }),
              HasSubstr("none.h5"));
}
} // namespace isostat
