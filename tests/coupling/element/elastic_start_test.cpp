// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/element/elastic_start.hpp"

#include "base/error.hpp"
#include "tests/coupling/rve_column.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using test::column_increments;

constexpr double small = 2e-7, large = 2e-4; ///< sizes of increments that keep elements asleep, and wake them

std::vector<Snapshot> specimens() { return {test::soft_specimen(4), test::soft_specimen(9)}; }

RveMaterialSettings sleepy(bool undrained = true)
{
  RveMaterialSettings settings;
  settings.undrained = undrained;
  settings.elastic_start = 0.1;
  return settings;
}

RveMaterialSettings wakeful(bool undrained = true)
{
  RveMaterialSettings settings = sleepy(undrained);
  settings.elastic_start = 0;
  return settings;
}

std::vector<Stress> run(RveMaterial &material, int from, int to, double size)
{
  std::vector<Stress> stresses(material.n_points());
  for (int k = from; k < to; ++k)
    {
      material.trial(column_increments(material.n_points(), k, size), stresses);
      material.commit();
    }
  return stresses;
}

/// The same bits in every grain and contact.
void expect_same_packings(const RveMaterial &a, const RveMaterial &b)
{
  for (std::size_t i = 0; i < a.n_points(); ++i)
    {
      const Snapshot one = a.element(i)->snapshot(), other = b.element(i)->snapshot();
      EXPECT_EQ(one.step, other.step);
      EXPECT_EQ(one.time, other.time);
      EXPECT_EQ(one.grains.position, other.grains.position);
      EXPECT_EQ(one.grains.velocity, other.grains.velocity);
      ASSERT_EQ(one.contacts.size(), other.contacts.size());
      for (std::size_t k = 0; k < one.contacts.size(); ++k)
        EXPECT_EQ(one.contacts[k].history.shear_force, other.contacts[k].history.shear_force);
    }
}
} // namespace

TEST(ElasticStart, TheLimitGrowsWithTheToleranceAndIsDeterministic)
{
  RveSettings settings;
  settings.frame = column_frame();
  const Rve rve(test::soft_specimen(4), settings);
  const ElasticStart tight = find_elastic_start(rve, settings, true, 0.05),
                     loose = find_elastic_start(rve, settings, true, 0.2);
  EXPECT_GT(loose.shear_limit, tight.shear_limit);
  EXPECT_GT(loose.shear_limit, 1e-5);
  EXPECT_LT(loose.shear_limit, 2e-3);
  EXPECT_EQ(find_elastic_start(rve, settings, true, 0.2).shear_limit, loose.shear_limit);
  EXPECT_EQ(rve.stress(), Rve(test::soft_specimen(4), settings).stress());
  EXPECT_EQ(loose.stiffness, rve.stiffness());
}

// What the limit promises, along a way that the probe does not take.
TEST(ElasticStart, ErrorAtTheLimitIsWhatTheTolerancePromises)
{
  RveSettings settings;
  settings.frame = column_frame();
  Rve rve(test::soft_specimen(4), settings);
  const ElasticStart start = find_elastic_start(rve, settings, true, 0.1);
  Mat3 h = Mat3::Zero();
  h(0, 2) = 0.6, h(1, 2) = 0.8; // gamma = 1 between the planes
  rve.undrained(start.shear_limit * h);
  const Mat3 elastic = start.stress_at(strain_vector(start.shear_limit * h, true));
  EXPECT_LT((rve.stress() - elastic).norm(), 0.15 * (elastic - start.stress).norm());
}

TEST(ElasticStart, AsleepTheStressIsThatOfTheSkeletonStiffness)
{
  for (bool undrained : {true, false})
    {
      RveMaterial material(specimens(), sleepy(undrained), MPI_COMM_SELF);
      std::vector<Stiffness> tangents(2);
      material.stiffness(tangents);
      const Mat3 at_start = material.element(0)->stress();
      const std::uint64_t step = material.element(0)->assembly().step();
      const Stress stress = run(material, 0, 10, small)[0];
      StrainVector strain = StrainVector::Zero();
      for (int k = 0; k < 10; ++k)
        {
          const Gradient h = column_increments(2, k, small)[0];
          strain += StrainVector{{h[0], h[4], h[8], h[5] + h[7], h[2] + h[6], h[1] + h[3]}};
        }
      const StrainVector change = tangents[0] * strain; // undrained: the tangent strips the volume
      const Stress zero = to_stress(at_start);
      for (int c = 0; c < 6; ++c)
        EXPECT_NEAR(stress[c] - zero[c], change[c], 1e-9 * std::abs(zero[2]));
      EXPECT_EQ(material.sleepers(), 2u);
      EXPECT_EQ(material.cost().steps, 0u);
      EXPECT_EQ(material.element(0)->assembly().step(), step); // the initial packing
    }
}

TEST(ElasticStart, AwakeTheBitsAreThoseOfAnElementThatNeverSlept)
{
  for (bool undrained : {true, false})
    {
      RveMaterial material(specimens(), sleepy(undrained), MPI_COMM_SELF),
          straight(specimens(), wakeful(undrained), MPI_COMM_SELF);
      EXPECT_NE(run(material, 0, 20, small), run(straight, 0, 20, small));
      EXPECT_EQ(material.sleepers(), 2u);
      for (int k = 20; k < 60 && material.sleepers() > 0; ++k)
        {
          const bool same = run(material, k, k + 1, large) == run(straight, k, k + 1, large);
          EXPECT_EQ(same, material.sleepers() == 0) << k;
        }
      ASSERT_EQ(material.sleepers(), 0u);
      EXPECT_EQ(run(material, 60, 80, large), run(straight, 60, 80, large));
      expect_same_packings(material, straight);
    }
}

TEST(ElasticStart, AWakeUpThatIsNotCommittedLeavesNoTrace)
{
  RveMaterial material(specimens(), sleepy(), MPI_COMM_SELF), calm(specimens(), sleepy(), MPI_COMM_SELF),
      straight(specimens(), wakeful(), MPI_COMM_SELF);
  run(straight, 0, 12, small);
  std::vector<Stress> strong(2), again(2), expected(2);
  straight.trial(column_increments(2, 50, 2e-3), expected);
  for (int k = 0; k < 12; k += 3)
    {
      EXPECT_EQ(run(material, k, k + 3, small), run(calm, k, k + 3, small));
      material.trial(column_increments(2, 50, 2e-3), strong);
      EXPECT_EQ(material.pack(), calm.pack()); // the trial is not in it
      material.trial(column_increments(2, 51, 2e-3), again);
      material.trial(column_increments(2, 50, 2e-3), again); // the history does not run again
      EXPECT_EQ(strong, again);
      if (k % 2)
        material.rollback();
      else
        material.trial(column_increments(2, k, small), again);
      EXPECT_EQ(material.element(0)->assembly().step(), calm.element(0)->assembly().step());
      material.rollback();
    }
  EXPECT_EQ(strong, expected);
  EXPECT_EQ(material.pack(), calm.pack());
  auto increments = column_increments(2, 3);
  increments[1][2] = 0.9; // cannot be taken
  EXPECT_THROW(material.trial(increments, again), RunFailure);
  EXPECT_EQ(material.pack(), calm.pack());
}

TEST(ElasticStart, BytesOfSleepersHoldTheirHistory)
{
  RveMaterial material(specimens(), sleepy(), MPI_COMM_SELF), other(specimens(), sleepy(), MPI_COMM_SELF),
      straight(specimens(), wakeful(), MPI_COMM_SELF);
  run(material, 0, 10, small);
  auto bytes = material.pack();
  run(other, 0, 3, large);
  other.unpack(bytes);
  EXPECT_EQ(other.pack(), bytes);
  EXPECT_EQ(other.sleepers(), 2u);
  EXPECT_EQ(run(material, 10, 15, small), run(other, 10, 15, small));
  run(straight, 0, 15, small);
  std::vector<Stress> stresses(2), resumed(2), expected(2);
  const auto strong = column_increments(2, 1, 2e-3);
  straight.trial(strong, expected);
  material.trial(strong, stresses), material.commit();
  other.trial(strong, resumed), other.commit();
  EXPECT_EQ(stresses, expected);
  EXPECT_EQ(resumed, expected);
  EXPECT_EQ(material.pack(), other.pack());
  EXPECT_THROW(straight.unpack(bytes), InputError);
  EXPECT_THROW(material.unpack(straight.pack()), InputError);
}

TEST(ElasticStart, ThreadsChangeNoBit)
{
  RveMaterialSettings two = sleepy();
  two.threads = 2;
  RveMaterial alone(specimens(), sleepy(), MPI_COMM_SELF), shared(specimens(), two, MPI_COMM_SELF);
  EXPECT_EQ(run(alone, 0, 10, small), run(shared, 0, 10, small));
  EXPECT_EQ(alone.pack(), shared.pack());
  EXPECT_EQ(run(alone, 10, 25, large), run(shared, 10, 25, large));
  EXPECT_EQ(alone.pack(), shared.pack());
}

TEST(ElasticStart, OutOfRangeIsRefused)
{
  RveMaterialSettings settings;
  settings.elastic_start = 1;
  EXPECT_THAT(message_of<InputError>([&] { settings.check(); }), testing::HasSubstr("elastic_start"));
}
} // namespace isostat
