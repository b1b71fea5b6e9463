// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/averaging.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>
#include <random>

namespace isostat
{
namespace
{
using Places = std::vector<std::array<double, 3>>;
constexpr double length = 0.11;

/// Points thrown into a block without order, with volumes of their own.
struct Cloud
{
  Places places;
  std::vector<double> volumes;

  Cloud()
  {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int k = 0; k < 300; ++k)
      {
        places.push_back({uniform(random), 0.3 * uniform(random), uniform(random)});
        volumes.push_back(0.2 + uniform(random));
      }
  }
  std::vector<double> field(int seed) const
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<double> x(places.size());
    for (double &value : x)
      value = uniform(random);
    return x;
  }
  double sum(const std::vector<double> &a, const std::vector<double> &b) const
  {
    double total = 0;
    for (std::size_t q = 0; q < a.size(); ++q)
      total += volumes[q] * a[q] * b[q];
    return total;
  }
};

std::vector<double> mean(const Averaging &averaging, const std::vector<double> &x)
{
  std::vector<double> y(x.size());
  averaging.apply(x, y, 1);
  return y;
}
} // namespace

TEST(Averaging, UniformFieldsAndSumsOverVolumesStay)
{
  const Cloud cloud;
  const Averaging averaging(length, cloud.places, cloud.volumes);
  const std::vector<double> ones(cloud.places.size(), 1), uniform(cloud.places.size(), 0.1234567);
  EXPECT_EQ(mean(averaging, uniform), uniform);
  for (int seed : {1, 2})
    {
      const auto x = cloud.field(seed);
      EXPECT_NEAR_BECAUSE(cloud.sum(ones, mean(averaging, x)), cloud.sum(ones, x), 1e-10,
                          "columns sum to 1 like rows: balanced to 1e-13, 300 points");
      EXPECT_BELOW_BECAUSE(cloud.sum(mean(averaging, x), mean(averaging, x)) / cloud.sum(x, x), 0.5, "means vary less");
    }
}

TEST(Averaging, IsSymmetricOverVolumes)
{
  const Cloud cloud;
  const Averaging averaging(length, cloud.places, cloud.volumes);
  const auto x = cloud.field(1), y = cloud.field(2);
  EXPECT_NEAR_BECAUSE(cloud.sum(x, mean(averaging, y)), cloud.sum(y, mean(averaging, x)), 1e-12, "round-off");
}

/// Of points on a line inside a long one: the mean of z is z, that of z^2 is z^2 + l^2.
TEST(Averaging, LengthIsTheStandardDeviationOfTheWeights)
{
  Places places;
  std::vector<double> heights, squares;
  for (int k = 0; k <= 400; ++k)
    {
      const double z = 0.01 * k;
      places.push_back({0, 0, z});
      heights.push_back(z);
      squares.push_back(z * z);
    }
  constexpr double own = 0.113; // no pair lies on the edge of the reach
  const Averaging averaging(own, places, std::vector<double>(places.size(), 0.01));
  EXPECT_NEAR_BECAUSE(mean(averaging, heights)[200], 2, 1e-12, "the weights are even about their point");
  EXPECT_CLOSE_BECAUSE(mean(averaging, squares)[200] - 4, own * own, 2e-3, "beyond 4 l there would be 1.1e-3 of it");
}

TEST(Averaging, NoLengthLeavesEveryFieldAsItIs)
{
  const Cloud cloud;
  const auto x = cloud.field(1);
  EXPECT_EQ(mean(Averaging(0, cloud.places, cloud.volumes), x), x);
}

TEST(Averaging, RefusesWhatIsNoBody)
{
  Cloud cloud;
  EXPECT_THROW(Averaging(-1, cloud.places, cloud.volumes), InputError);
  cloud.volumes[3] = 0;
  EXPECT_THROW(Averaging(1, cloud.places, cloud.volumes), InputError);
  cloud.volumes.pop_back();
  EXPECT_THROW(Averaging(1, cloud.places, cloud.volumes), InputError);
}
} // namespace isostat
