// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/batch/rve_material.hpp"

#include "base/error.hpp"
#include "coupling/element/axes.hpp"
#include "tests/coupling/rve_column.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using test::column_increments;

std::vector<Snapshot> specimens()
{
  return {test::soft_specimen(4), test::soft_specimen(9), test::soft_specimen(4, 50e3)};
}

std::vector<Stress> run(RveMaterial &material, int from, int to)
{
  std::vector<Stress> stresses(material.n_points());
  for (int k = from; k < to; ++k)
    {
      material.trial(column_increments(material.n_points(), k), stresses);
      material.commit();
    }
  return stresses;
}

RveMaterialSettings drained()
{
  RveMaterialSettings settings;
  settings.undrained = false;
  return settings;
}
} // namespace

TEST(RveMaterial, ABatchIsAsManySingleElements)
{
  for (bool undrained : {true, false})
    {
      RveMaterialSettings settings;
      settings.undrained = undrained;
      RveMaterial material(specimens(), settings, MPI_COMM_SELF);
      RveSettings element{.motion = settings.motion};
      element.min_steps = settings.min_steps;
      element.frame = column_frame();
      std::vector<Rve> alone;
      for (const Snapshot &s : specimens())
        alone.emplace_back(s, element);
      std::vector<Stress> stresses(3);
      for (int k = 0; k < 20; ++k)
        {
          const auto increments = column_increments(3, k);
          material.trial(increments, stresses);
          material.commit();
          for (int i = 0; i < 3; ++i)
            {
              const Mat3 h = to_matrix(increments[i]);
              const Mat3 s = (undrained ? alone[i].undrained(h) : alone[i].advance(h)).stress;
              ASSERT_EQ(stresses[i], to_stress(s)) << k << " " << i;
            }
        }
    }
}

// So a column's shear xz is the simple shear xy of the element tests bit for bit.
TEST(RveMaterial, ShearOfTheColumnIsThatOfTheElementTests)
{
  RveMaterial material({test::soft_specimen(4)}, {}, MPI_COMM_SELF);
  RveSettings same{.motion = RveMaterialSettings{}.motion};
  same.min_steps = RveMaterialSettings{}.min_steps;
  Rve test_element(test::soft_specimen(4), same);
  Mat3 h = Mat3::Zero();
  h(0, 1) = 1e-5;
  std::vector<Gradient> increment(1, Gradient{});
  increment[0][2] = 1e-5;
  std::vector<Stress> stress(1);
  for (int k = 0; k < 30; ++k)
    {
      material.trial(increment, stress);
      material.commit();
      const Mat3 s = test_element.undrained(h).stress;
      ASSERT_EQ(stress[0], (Stress{s(0, 0), s(2, 2), s(1, 1), -s(1, 2), s(0, 1), -s(0, 2)})) << k;
    }
}

TEST(RveMaterial, EachTrialStartsFromTheCommittedState)
{
  RveMaterial material(specimens(), {}, MPI_COMM_SELF);
  std::vector<Stress> first(3), other(3), again(3);
  for (int k = 0; k < 40; k += 4) // beyond the 500 steps after which the way back is shortened
    {
      run(material, k, k + 4);
      material.trial(column_increments(3, 100 + k), first);
      material.trial(column_increments(3, 200 + k, 1e-4), other);
      material.trial(column_increments(3, 100 + k), again);
      ASSERT_EQ(first, again) << k;
      ASSERT_NE(first, other) << k;
    }
}

TEST(RveMaterial, RollbackLeavesNoTrace)
{
  RveMaterial material(specimens(), {}, MPI_COMM_SELF), straight(specimens(), {}, MPI_COMM_SELF);
  std::vector<Stress> stresses(3);
  for (int k = 0; k < 30; k += 3)
    {
      material.trial(column_increments(3, 300 + k, 1e-4), stresses);
      material.rollback();
      material.commit(); // nothing to commit
      EXPECT_EQ(run(material, k, k + 3), run(straight, k, k + 3));
    }
  EXPECT_EQ(material.pack(), straight.pack());
  material.trial(column_increments(3, 7), stresses);
  EXPECT_NE(material.element(0)->stress(), straight.element(0)->stress());
  EXPECT_THROW(material.place(material.owners()), RunFailure);
  material.rollback();
  EXPECT_EQ(material.element(0)->stress(), straight.element(0)->stress());
}

TEST(RveMaterial, BytesContinueToTheSameBits)
{
  RveMaterial material(specimens(), {}, MPI_COMM_SELF), other(specimens(), {}, MPI_COMM_SELF);
  std::vector<Stress> stresses(3);
  std::vector<WaveModuli> moduli(3), moduli_after(3);
  run(material, 0, 10);
  material.wave_moduli(moduli);
  const auto committed = material.pack();
  material.trial(column_increments(3, 77), stresses);
  EXPECT_EQ(material.pack(), committed); // the trial is not in it
  run(other, 0, 3);
  other.unpack(committed);
  EXPECT_EQ(other.pack(), committed);
  material.rollback();
  EXPECT_EQ(run(material, 10, 30), run(other, 10, 30));
  EXPECT_EQ(material.pack(), other.pack());
  other.wave_moduli(moduli_after); // kept, not found again
  EXPECT_EQ(moduli[1].p, moduli_after[1].p);
  EXPECT_EQ(other.cost().stiffnesses, 0u);
}

TEST(RveMaterial, BytesOfAnotherMaterialAreRefused)
{
  RveMaterial material(specimens(), {}, MPI_COMM_SELF), two({specimens()[0], specimens()[1]}, {}, MPI_COMM_SELF),
      live(specimens(), drained(), MPI_COMM_SELF);
  auto bytes = material.pack();
  EXPECT_THAT(message_of<InputError>([&] { two.unpack(bytes); }), testing::HasSubstr("3 points, expected 2"));
  EXPECT_THROW(live.unpack(bytes), InputError);
  auto cut = bytes;
  cut.points[2].resize(cut.points[2].size() - 9);
  EXPECT_THROW(material.unpack(cut), InputError);
  bytes.points[1][bytes.points[1].size() / 2] ^= std::byte{1};
  EXPECT_THROW(material.unpack(bytes), InputError);
}

TEST(RveMaterial, ThreadsAndTheirNumberChangeNoBit)
{
  RveMaterialSettings two;
  two.threads = 2;
  RveMaterial alone(specimens(), {}, MPI_COMM_SELF), shared(specimens(), two, MPI_COMM_SELF);
  EXPECT_EQ(run(alone, 0, 20), run(shared, 0, 20));
  EXPECT_EQ(alone.pack(), shared.pack());
}

TEST(RveMaterial, UndrainedKeepsVolume)
{
  RveMaterial closed(specimens(), {}, MPI_COMM_SELF), open(specimens(), drained(), MPI_COMM_SELF);
  const double e = closed.element(1)->void_ratio();
  run(closed, 0, 20);
  EXPECT_NEAR_BECAUSE(closed.element(1)->void_ratio(), e, 1e-12, "round-off of some hundred time steps");
  std::vector<Gradient> compressed(3, Gradient{});
  for (Gradient &h : compressed)
    h[8] = -1e-4;
  std::vector<Stress> stresses(3);
  open.trial(compressed, stresses);
  open.commit();
  EXPECT_NEAR_BECAUSE(open.element(1)->void_ratio(), e - 1e-4 * (1 + e), 1e-7, "second order of a strain of 1e-4");
}

TEST(RveMaterial, AFailureNamesThePointAndChangesNothing)
{
  RveMaterial material(specimens(), {}, MPI_COMM_SELF);
  run(material, 0, 3);
  const auto before = material.pack();
  auto increments = column_increments(3, 3);
  increments[1][2] = std::nan("");
  std::vector<Stress> stresses(3);
  const std::string message = message_of<RunFailure>([&] { material.trial(increments, stresses); });
  EXPECT_THAT(message, testing::HasSubstr("rve: point 1: "));
  EXPECT_THAT(message, testing::HasSubstr("not a number"));
  increments[1][2] = 0.9; // too large, even in 64 parts
  increments[2][2] = 0.9;
  EXPECT_THAT(message_of<RunFailure>([&] { material.trial(increments, stresses); }),
              testing::HasSubstr("rve: point 1: an increment of displacement gradient of 0.9"));
  material.commit();
  EXPECT_EQ(material.pack(), before);
}

TEST(RveMaterial, RealisationsAreAveraged)
{
  RveMaterialSettings pairs;
  pairs.realisations = 2;
  const std::vector<Snapshot> four = {test::soft_specimen(4), test::soft_specimen(9), test::soft_specimen(4, 50e3),
                                      test::soft_specimen(9, 50e3)};
  RveMaterial mean(four, pairs, MPI_COMM_SELF), single(four, {}, MPI_COMM_SELF);
  auto increments = column_increments(2, 5);
  std::vector<Stress> of_two(2), of_four(4), deviation(2);
  mean.trial(increments, of_two);
  mean.commit();
  single.trial(std::vector{increments[0], increments[0], increments[1], increments[1]}, of_four);
  mean.scatter(deviation);
  for (int i = 0; i < 2; ++i)
    for (int c = 0; c < 6; ++c)
      {
        EXPECT_EQ(of_two[i][c], (of_four[2 * i][c] + of_four[2 * i + 1][c]) / 2);
        EXPECT_NEAR_BECAUSE(deviation[i][c], std::abs(of_four[2 * i][c] - of_four[2 * i + 1][c]) / std::sqrt(2),
                            1e-9 * std::abs(of_two[i][2]), "cancellation of nearly equal stresses");
      }
  EXPECT_THROW(RveMaterial(specimens(), pairs, MPI_COMM_SELF), InputError); // three cannot be shared out
}

TEST(RveMaterial, TangentIsThatOfTheElementAndAnswersForSmallTrials)
{
  RveMaterial material({test::soft_specimen(4)}, drained(), MPI_COMM_SELF),
      closed({test::soft_specimen(4)}, {}, MPI_COMM_SELF);
  std::vector<Stiffness> c(1), cu(1);
  material.stiffness(c);
  EXPECT_EQ(c[0], material.element(0)->stiffness(Sliding::plastic));
  closed.stiffness(cu);
  EXPECT_BELOW_BECAUSE((cu[0] * Stiffness::Identity().leftCols<3>().rowwise().sum()).norm() / c[0].norm(), 1e-9,
                       "round-off: the sum of its columns cancels");
  EXPECT_EQ(cu[0].col(4), c[0].col(4));
  std::vector<WaveModuli> moduli(1);
  material.wave_moduli(moduli);
  EXPECT_BELOW_BECAUSE(c[0](2, 2) / moduli[0].p, 1 + 1e-12, "round-off of the eigenvalues");
  EXPECT_BELOW_BECAUSE(std::min(c[0](3, 3), c[0](4, 4)) / moduli[0].s, 1 + 1e-12, "round-off of the eigenvalues");
  EXPECT_LT(moduli[0].s, moduli[0].p);
}

TEST(RveMaterial, WaveModuliAreFoundAgainWhenThePressureRises)
{
  RveMaterialSettings settings = drained();
  RveMaterial material({test::soft_specimen(4)}, settings, MPI_COMM_SELF);
  std::vector<WaveModuli> moduli(1);
  std::vector<Stress> stress(1);
  std::vector<Gradient> compressed(1, Gradient{{0, 0, 0, 0, 0, 0, 0, 0, -2e-4}});
  material.wave_moduli(moduli);
  material.wave_moduli(moduli);
  EXPECT_EQ(material.cost().stiffnesses, 1u);
  material.trial(compressed, stress);
  material.wave_moduli(moduli); // the committed state is the same
  EXPECT_EQ(material.cost().stiffnesses, 1u);
  double p = 0;
  for (int k = 0; k < 5 && p < 150e3; ++k)
    {
      material.trial(compressed, stress);
      material.commit();
      p = -(stress[0][0] + stress[0][1] + stress[0][2]) / 3;
    }
  ASSERT_GT(p, 126e3);
  material.wave_moduli(moduli);
  EXPECT_EQ(material.cost().stiffnesses, 2u);
}

} // namespace isostat
