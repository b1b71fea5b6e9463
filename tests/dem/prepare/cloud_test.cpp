// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/cloud.hpp"

#include "base/error.hpp"
#include "dem/prepare/grading.hpp"
#include "dem/prepare/random.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <limits>

namespace isostat
{
namespace
{
GradingSpec small_spec()
{
  GradingSpec spec;
  spec.grains = 500;
  return spec;
}

/// Smallest gap between two spheres, m; every pair is checked.
double smallest_gap(const Packing &packing)
{
  double gap = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      gap = std::min(gap, (packing.centre(i) - packing.centre(j)).norm() - packing.radius(i) - packing.radius(j));
  return gap;
}

bool all_inside(const Packing &packing, const RigidBox &box)
{
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    for (int k = 0; k < 3; ++k)
      if (packing.centre(i)[k] - packing.radius(i) < box.lower[k] ||
          packing.centre(i)[k] + packing.radius(i) > box.upper[k])
        return false;
  return true;
}

// First word block of Philox 4x64-10 for counter 0 and key 0, from the test vectors of Random123.
TEST(Random, IsPhilox)
{
  const auto u = uniform(0, RandomStream{0}, 0);
  EXPECT_EQ(u[0], static_cast<double>(0x16554d9eca36314cu >> 11) * 0x1p-53);
  EXPECT_EQ(u[1], static_cast<double>(0xdb20fe9d672d0fdcu >> 11) * 0x1p-53);
  EXPECT_EQ(u[2], static_cast<double>(0xd7e772cee186176bu >> 11) * 0x1p-53);
  EXPECT_EQ(u[3], static_cast<double>(0x7e68b68aec7ba23bu >> 11) * 0x1p-53);
}

TEST(Random, DependsOnEveryArgumentAndOnNothingElse)
{
  const auto u = uniform(1, RandomStream::cloud, 2, 3);
  EXPECT_EQ(u, uniform(1, RandomStream::cloud, 2, 3));
  EXPECT_NE(u, uniform(2, RandomStream::cloud, 2, 3));
  EXPECT_NE(u, uniform(1, RandomStream{77}, 2, 3));
  EXPECT_NE(u, uniform(1, RandomStream::cloud, 3, 3));
  EXPECT_NE(u, uniform(1, RandomStream::cloud, 2, 4));
}

// 40,000 numbers: standard error of the mean 1/sqrt(12 n) = 0.0014, of the variance 1/sqrt(180 n) = 0.0004; 4 of them.
TEST(Random, IsUniformOnTheUnitInterval)
{
  double sum = 0, sum_of_squares = 0;
  for (std::uint64_t c = 0; c < 10000; ++c)
    for (double u : uniform(5, RandomStream::cloud, c))
      {
        ASSERT_TRUE(u >= 0 && u < 1);
        sum += u;
        sum_of_squares += u * u;
      }
  const double mean = sum / 40000;
  EXPECT_NEAR_BECAUSE(mean, 0.5, 0.006, "four standard errors of the mean");
  EXPECT_NEAR_BECAUSE(sum_of_squares / 40000 - mean * mean, 1.0 / 12, 0.0016, "four standard errors of the variance");
}

TEST(Cloud, SpheresNeitherOverlapNorLeaveTheBox)
{
  const Cloud cloud = make_cloud(small_spec());
  ASSERT_EQ(cloud.packing.n_grains(), 500u);
  EXPECT_EQ(cloud.box.lower, Vec3::Zero());
  EXPECT_EQ(cloud.box.upper, Vec3::Constant(10e-3));
  EXPECT_GT(smallest_gap(cloud.packing), 0);
  EXPECT_TRUE(all_inside(cloud.packing, cloud.box));
}

TEST(Cloud, WideGradingHasNoOverlapsEither)
{
  GradingSpec spec;
  spec.table = {{1e-4, 0}, {20e-4, 100}};
  spec.grains = 3000;
  const Cloud cloud = make_cloud(spec);
  EXPECT_GT(cloud.packing.max_radius() / cloud.packing.min_radius(), 5);
  EXPECT_GT(smallest_gap(cloud.packing), 0);
  EXPECT_TRUE(all_inside(cloud.packing, cloud.box));
}

TEST(Cloud, HasTheSolidFractionAndTheScaledGrading)
{
  const GradingSpec spec; // the paper's specimen: 10,000 grains in a 10 mm cube
  const Cloud cloud = make_cloud(spec);
  const Packing &packing = cloud.packing;
  EXPECT_NEAR_BECAUSE(packing.solid_volume() / (0.33 * cloud.box.volume()), 1, 1e-12,
                      "round-off of a sum of 10,000 volumes");
  EXPECT_NEAR_BECAUSE(packing.d50() / cloud.upscaling, d_at(grading_curve(spec), 50), 0.01 * 0.14e-3,
                      "a percentile of 10,000 grains falls between two of them");
  EXPECT_TRUE(all_inside(packing, cloud.box));
  EXPECT_EQ(packing.density, 2650);
  EXPECT_EQ(packing.linear_velocity(7), Vec3::Zero());
}

TEST(Cloud, IdIsTheRankBySize)
{
  const GradingSpec spec = small_spec();
  const Cloud cloud = make_cloud(spec);
  const std::vector<double> sample = sample_diameters(grading_curve(spec), spec.grains);
  std::vector<bool> seen(spec.grains, false);
  for (std::size_t i = 0; i < spec.grains; ++i)
    {
      const std::uint32_t id = cloud.packing.id[i];
      ASSERT_LT(id, spec.grains);
      EXPECT_FALSE(seen[id]);
      seen[id] = true;
      EXPECT_DOUBLE_EQ(cloud.packing.radius(i), 0.5 * cloud.upscaling * sample[id]);
    }
}

// Mean distance of two random points of a cube is 0.66 edges; the mean spacing of 500 grains is 0.13 edges.
TEST(Cloud, NeighboursInMemoryAreNeighboursInSpace)
{
  const Packing packing = make_cloud(small_spec()).packing;
  double sum = 0;
  for (std::size_t i = 1; i < packing.n_grains(); ++i)
    sum += (packing.centre(i) - packing.centre(i - 1)).norm();
  EXPECT_BELOW_BECAUSE(sum / 499, 0.25 * 10e-3, "twice the mean spacing of grains, against 0.66 edges for any two");
}

TEST(Cloud, GrainsFillTheBoxEvenly)
{
  GradingSpec spec;
  const Packing packing = make_cloud(spec).packing;
  const double total_mass = packing.density * packing.solid_volume();
  Vec3 centre_of_mass = Vec3::Zero();
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    centre_of_mass += packing.mass(i) / total_mass * packing.centre(i);
  EXPECT_BELOW_BECAUSE((centre_of_mass / spec.cloud_edge - Vec3::Constant(0.5)).norm(), 0.02,
                       "scatter of a mean of positions drawn at random: sqrt(3/12/n) with the n grains of the cloud");
}

TEST(Cloud, HasTheMedianDiameterThatIsAskedFor)
{
  GradingSpec spec = small_spec();
  spec.d50 = 0.45e-3;
  for (const std::uint64_t grains : {50u, 500u, 3000u})
    {
      spec.grains = grains;
      spec.cloud_edge = 1; // not used
      const Cloud cloud = make_cloud(spec);
      EXPECT_NEAR_BECAUSE(cloud.packing.d50(), 0.45e-3, 1e-18, "round-off of a quotient and a product");
      EXPECT_NEAR_BECAUSE(cloud.packing.solid_volume() / cloud.box.volume(), spec.solid_fraction, 1e-13,
                          "round-off of a sum over grains and of a cube root");
      EXPECT_TRUE(all_inside(cloud.packing, cloud.box));
    }
  const double of_the_curve = make_cloud(spec).upscaling * d_at(grading_curve(spec), 50);
  EXPECT_NEAR_BECAUSE(of_the_curve / 0.45e-3, 1, 1e-3, "3,000 grains do not quite follow the curve");
}

TEST(Cloud, IsThatOfItsEdgeWhicheverIsGiven)
{
  GradingSpec by_edge = small_spec(), by_d50 = by_edge;
  by_edge.cloud_edge = 3.7e-3;
  const Cloud one = make_cloud(by_edge);
  by_d50.d50 = one.packing.d50();
  const Cloud other = make_cloud(by_d50);
  EXPECT_NEAR_BECAUSE(other.box.upper[0], 3.7e-3, 1e-17, "round-off of a sum over grains and of a cube root");
  EXPECT_NEAR_BECAUSE(other.upscaling / one.upscaling, 1, 1e-14, "the same");
}

/// The message names a solid fraction at which the grains have room.
TEST(Cloud, FewGrainsThatFindNoPlace)
{
  for (const std::uint64_t n : {2, 3, 8, 12})
    {
      GradingSpec spec;
      spec.grains = n;
      spec.d50 = 0.2e-3;
      spec.solid_fraction = 0.5;
      const std::string message = message_of<RunFailure>([&] { make_cloud(spec); });
      const std::string before = "There is room at grading.solid_fraction = ";
      ASSERT_THAT(message, testing::HasSubstr(before)) << n;
      spec.solid_fraction = std::stod(message.substr(message.find(before) + before.size()));
      EXPECT_EQ(make_cloud(spec).packing.n_grains(), n);
    }
}

TEST(Cloud, MedianByVolumeIsOneOfTheSizes)
{
  EXPECT_EQ(median_by_volume({3}), 3);
  EXPECT_EQ(median_by_volume({2, 1, 2, 1}), 2);
  EXPECT_EQ(median_by_volume({1, 1, 1, 1}), 1);
  EXPECT_EQ(median_by_volume({2, 1, 1, 1, 1, 1, 1, 1, 1}), 1); // half of the volume lies in the small ones
}

TEST(Cloud, SameSeedSameBitsOtherSeedOtherCloud)
{
  GradingSpec spec = small_spec();
  const Packing a = make_cloud(spec).packing, b = make_cloud(spec).packing;
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.id, b.id);
  spec.seed = 2;
  EXPECT_NE(a.position, make_cloud(spec).packing.position);
}

TEST(Cloud, JammingIsARunFailureWithARemedy)
{
  GradingSpec spec = small_spec();
  spec.solid_fraction = 0.6;
  test::expect_parts(message_of<RunFailure>([&] { make_cloud(spec); }),
                     {"solid_fraction = 0.6", "There is room at grading.solid_fraction = "});
}

TEST(Cloud, WrongInputIsRefused)
{
  const auto refused = [](const std::function<void(GradingSpec &)> &spoil, const std::string &key) {
    GradingSpec spec = small_spec();
    spoil(spec);
    EXPECT_THAT(message_of<InputError>([&] { make_cloud(spec); }), testing::HasSubstr(key));
  };
  refused([](GradingSpec &s) { s.grains = 0; }, "grading.grains = 0");
  refused([](GradingSpec &s) { s.cloud_edge = 0; }, "cloud_edge");
  refused([](GradingSpec &s) { s.d50 = 0; }, "d50");
  refused([](GradingSpec &s) { s.d50 = std::numeric_limits<double>::infinity(); }, "d50");
  refused([](GradingSpec &s) { s.solid_fraction = 0; }, "solid_fraction");
  refused([](GradingSpec &s) { s.solid_fraction = 1; }, "solid_fraction");
  refused([](GradingSpec &s) { s.density = -1; }, "density");
  refused([](GradingSpec &s) { s.curve = "beach"; }, "karlsruhe-fine-sand");
  refused([](GradingSpec &s) { s.grains = 1, s.solid_fraction = 0.9; }, "largest grain");
}
} // namespace
} // namespace isostat
