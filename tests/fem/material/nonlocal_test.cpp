// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/nonlocal.hpp"

#include "base/error.hpp"
#include "fem/material/composite.hpp"
#include "fem/material/elastic.hpp"
#include "fem/material/iwan.hpp"
#include "tests/support/near.hpp"

#include <gmock/gmock.h>
#include <random>

namespace isostat
{
namespace
{
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr NonlocalParameters parameters{.length = 0.1, .stiffness = 0.3};
constexpr ElasticParameters soft{2e7, 0.2}, stiff{1e8, 0.3};

/// A block of 6 x 1 x 8 points, volumes and places a little irregular.
struct Block
{
  std::vector<std::array<double, 3>> places;
  std::vector<double> volumes;
  std::mt19937 random{5};

  Block()
  {
    for (int k = 0; k < 48; ++k)
      {
        places.push_back({0.08 * (k % 6) + 0.02 * number(), 0, 0.08 * (k / 6) + 0.02 * number()});
        volumes.push_back(1 + 0.3 * number());
      }
  }
  double number() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  std::size_t size() const { return places.size(); }
  std::vector<Gradient> field(double size)
  {
    std::vector<Gradient> h(places.size());
    for (Gradient &point : h)
      for (double &x : point)
        x = size * number();
    return h;
  }
  std::unique_ptr<Nonlocal> nonlocal(std::unique_ptr<Material> inner) const
  {
    auto material = std::make_unique<Nonlocal>(std::move(inner), parameters, places, volumes);
    material->set_initial_stress(std::vector<Stress>(size()));
    return material;
  }
  /// Soft points below, stiff ones above.
  std::unique_ptr<Nonlocal> two_soils() const
  {
    std::vector<std::unique_ptr<Material>> parts;
    parts.push_back(std::make_unique<Elastic>(soft, 24));
    parts.push_back(std::make_unique<Elastic>(stiff, 24));
    return nonlocal(stacked(std::move(parts)));
  }
  static const ElasticParameters &soil(std::size_t q) { return q < 24 ? soft : stiff; }
  static Stiffness hooke(std::size_t q) { return isotropic_stiffness(soil(q).bulk_modulus(), soil(q).shear_modulus); }
  /// sum w stress : strain
  double work(const std::vector<Stress> &s, const std::vector<Gradient> &h) const
  {
    double sum = 0;
    for (std::size_t q = 0; q < size(); ++q)
      for (int c = 0; c < 6; ++c)
        sum += volumes[q] * s[q][c] * strain(h[q])[c];
    return sum;
  }
  /// sum w [psi(W eps) + (eps - W eps) : A : (eps - W eps) / 2] of the two soils, as it is written.
  double energy(const std::vector<Gradient> &h) const
  {
    using Row = Eigen::Matrix<double, 6, 1>;
    std::vector<Gradient> means(size());
    Averaging(parameters.length, places, volumes).apply<9>(h, means);
    double sum = 0;
    for (std::size_t q = 0; q < size(); ++q)
      {
        const auto of_mean = strain(means[q]), of_point = strain(h[q]);
        const Row mean = Row::Map(of_mean.data()), rest = Row::Map(of_point.data()) - mean;
        sum += volumes[q] / 2 * (mean.dot(hooke(q) * mean) + parameters.stiffness * rest.dot(hooke(q) * rest));
      }
    return sum;
  }
};

std::vector<Stress> trial(Material &material, const std::vector<Gradient> &h)
{
  std::vector<Stress> s(h.size());
  material.trial(h, s);
  return s;
}
} // namespace

/// Also at the boundary, and after a path on which strain was not uniform.
TEST(Nonlocal, UniformStrainIsTheInnerMaterials)
{
  Block block;
  const Stress start = {-60e3, -70e3, -100e3, 0, 5e3, 0};
  const auto nonlocal = std::make_unique<Nonlocal>(std::make_unique<Iwan>(IwanParameters{}, block.size()), parameters,
                                                   block.places, block.volumes);
  Iwan inner(IwanParameters{}, block.size());
  nonlocal->set_initial_stress(std::vector<Stress>(block.size(), start));
  inner.set_initial_stress(std::vector<Stress>(block.size(), start));
  for (int step = 0; step < 50; ++step)
    {
      Gradient h;
      for (double &x : h)
        x = 1e-4 * block.number();
      const std::vector<Gradient> field(block.size(), h);
      const auto expected = trial(inner, field), found = trial(*nonlocal, field);
      for (std::size_t q = 0; q < block.size(); ++q)
        for (int c = 0; c < 6; ++c)
          ASSERT_NEAR_BECAUSE(found[q][c], expected[q][c], 1e-9, "round-off of 1e5 Pa, 50 times") << step << " " << q;
      nonlocal->commit();
      inner.commit();
    }
}

TEST(Nonlocal, InitialStressStaysWhateverItsField)
{
  Block block;
  const auto nonlocal = block.nonlocal(std::make_unique<Elastic>(soft, block.size()));
  std::vector<Stress> start(block.size());
  for (Stress &s : start)
    for (double &x : s)
      x = 1e5 * block.number();
  nonlocal->set_initial_stress(start);
  EXPECT_EQ(trial(*nonlocal, std::vector<Gradient>(block.size())), start);
}

TEST(Nonlocal, StressIsTheDerivativeOfTheEnergy)
{
  Block block;
  const auto nonlocal = block.two_soils();
  auto h = block.field(1e-3);
  const auto stresses = trial(*nonlocal, h);
  EXPECT_CLOSE_BECAUSE(block.work(stresses, h), 2 * block.energy(h), 1e-12, "a quadratic form; round-off");
  constexpr int component[] = {0, 4, 8, 5, 2, 1}; // of h, whose strain is that of a stress
  for (std::size_t q : {0, 5, 21, 30, 47})
    for (int c = 0; c < 6; ++c)
      {
        double &x = h[q][component[c]];
        const double at = x, by = 1e-3;
        x = at + by;
        const double above = block.energy(h);
        x = at - by;
        const double below = block.energy(h);
        x = at;
        EXPECT_NEAR_BECAUSE((above - below) / (2 * by) / block.volumes[q], stresses[q][c], 1e-5,
                            "central differences of a quadratic form of 1e4 J: round-off over the increment")
            << q << " " << c;
      }
}

TEST(Nonlocal, WorkIsReciprocal)
{
  Block block;
  const auto nonlocal = block.two_soils();
  const auto a = block.field(1e-3), b = block.field(1e-3);
  const double of_b = block.work(trial(*nonlocal, a), b);
  EXPECT_NEAR_BECAUSE(block.work(trial(*nonlocal, b), a), of_b, 1e-9 * block.work(trial(*nonlocal, a), a), "round-off");
}

/// So that a relaxation with them for a mass is stable, and explicit steps are.
TEST(Nonlocal, WaveModuliBoundTheWorkOfAnyField)
{
  Block block;
  const auto nonlocal = block.two_soils();
  std::vector<WaveModuli> moduli(block.size());
  nonlocal->wave_moduli(moduli);
  std::vector<Gradient> h = block.field(1e-3);
  double largest = 0;
  for (int round = 0; round < 60; ++round) // towards the field that is stiffest by this measure
    {
      const auto stresses = trial(*nonlocal, h);
      double bound = 0;
      for (std::size_t q = 0; q < block.size(); ++q)
        {
          const auto e = strain(h[q]);
          const Eigen::Matrix<double, 6, 1> row = Eigen::Matrix<double, 6, 1>::Map(e.data());
          bound += block.volumes[q] * row.dot(isotropic_stiffness(bulk_modulus(moduli[q]), moduli[q].s) * row);
        }
      largest = std::max(largest, block.work(stresses, h) / bound);
      const double size = 1e-3 / std::sqrt(bound);
      for (std::size_t q = 0; q < block.size(); ++q)
        h[q] = {size * stresses[q][0], 0, size * stresses[q][4], 0, size * stresses[q][1], 0, 0, 0,
                size * stresses[q][2]};
    }
  EXPECT_LE(largest, 1);
  EXPECT_GT(largest, 0.7) << "no bound to be proud of";
}

TEST(Nonlocal, DifferencesOfStrainMeetTheirOwnStiffness)
{
  Block block;
  const auto nonlocal = block.nonlocal(std::make_unique<Elastic>(stiff, block.size()));
  Elastic local(stiff, block.size());
  auto h = block.field(0);
  h[20][2] = 1e-3; // a single point
  const double energy = block.work(trial(*nonlocal, h), h), of_local = block.work(trial(local, h), h);
  std::vector<Gradient> mean(block.size());
  nonlocal->average(h, mean);
  const double kept = mean[20][2] / h[20][2]; // W_qq
  EXPECT_BELOW_BECAUSE(kept, 0.25, "else the length would be that of the points");
  EXPECT_GT(energy, parameters.stiffness * (1 - kept) * (1 - kept) * of_local);
  EXPECT_LT(energy, (kept + parameters.stiffness) * of_local);
}

TEST(Nonlocal, RefusesAStateOfAnotherLength)
{
  Block block;
  const auto nonlocal = block.nonlocal(std::make_unique<Elastic>(soft, block.size()));
  Nonlocal other(std::make_unique<Elastic>(soft, block.size()), {.length = 0.2, .stiffness = 0.3}, block.places,
                 block.volumes);
  const auto bytes = other.pack();
  EXPECT_THAT([&] { other.unpack(nonlocal->pack()); },
              ThrowsMessage<InputError>(HasSubstr("its parameters are 0.1, ")));
  EXPECT_EQ(other.pack(), bytes);
}

TEST(Nonlocal, RefusesWhatItCannotBe)
{
  Block block;
  const auto make = [&](std::unique_ptr<Material> inner, NonlocalParameters p) {
    Nonlocal(std::move(inner), p, block.places, block.volumes);
  };
  EXPECT_THROW(make(nullptr, parameters), InputError);
  EXPECT_THROW(make(std::make_unique<Elastic>(soft, 3), parameters), InputError);
  EXPECT_THROW(make(std::make_unique<Elastic>(soft, block.size()), {.length = -1}), InputError);
  EXPECT_THROW(make(std::make_unique<Elastic>(soft, block.size()), {.length = 1, .stiffness = -1}), InputError);
}
} // namespace isostat
