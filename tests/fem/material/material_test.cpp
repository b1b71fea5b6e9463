// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "fem/material/composite.hpp"
#include "fem/material/corotational.hpp"
#include "fem/material/elastic.hpp"
#include "fem/material/iwan_curve.hpp"
#include "fem/material/mohr_coulomb.hpp"
#include "fem/material/nonlocal.hpp"
#include "fem/material/umat.hpp"
#include "fem/material/viscoelastic.hpp"

#include <cstring>
#include <gmock/gmock.h>
#include <limits>
#include <random>

namespace isostat
{
namespace
{
using testing::HasSubstr;
constexpr std::size_t n = 5;

std::unique_ptr<Material> make_elastic() { return std::make_unique<Elastic>(ElasticParameters{}, n); }
std::unique_ptr<Material> make_iwan() { return std::make_unique<Iwan>(IwanParameters{}, n); }
std::unique_ptr<Material> make_mohr_coulomb() { return std::make_unique<MohrCoulomb>(MohrCoulombParameters{}, n); }
std::unique_ptr<Material> make_layers()
{
  std::vector<std::unique_ptr<Material>> parts;
  parts.push_back(std::make_unique<Iwan>(IwanParameters{}, 2));
  parts.push_back(std::make_unique<Elastic>(ElasticParameters{}, 0));
  parts.push_back(std::make_unique<Elastic>(ElasticParameters{}, 3));
  return stacked(std::move(parts));
}

std::unique_ptr<Material> make_composite()
{
  std::vector<CompositeMaterial::Part> parts;
  parts.push_back({std::make_unique<Iwan>(IwanParameters{}, 3), {4, 0, 2}});
  parts.push_back({std::make_unique<Elastic>(ElasticParameters{}, 2), {1, 3}});
  return std::make_unique<CompositeMaterial>(std::move(parts));
}

/// Points 0, 2, 4 and points 1, 3 lie side by side, all others out of reach.
std::unique_ptr<Material> make_nonlocal()
{
  const std::vector<std::array<double, 3>> positions = {
      {0, 0, 0}, {9, 0, 0}, {0.1, 0, 0.1}, {9, 0, 0.1}, {0, 0.1, 0.1}};
  const std::vector<double> volumes = {1, 2, 0.5, 1, 1};
  return std::make_unique<Nonlocal>(make_iwan(), NonlocalParameters{.length = 0.1}, positions, volumes);
}

std::unique_ptr<Material> make_iwan_of_curve()
{
  return std::make_unique<IwanOfCurve>(IwanParameters{}, fit_hyperbola(12), LoopReduction{0.6, 0.2, 2}, n);
}

std::unique_ptr<Material> make_viscoelastic()
{
  return std::make_unique<Viscoelastic>(make_iwan_of_curve(), 0.02); // in statics: time alone changes no stress
}

std::unique_ptr<Material> make_corotational() { return std::make_unique<Corotational>(make_viscoelastic()); }

std::unique_ptr<Material> make_umat()
{
  const std::vector<double> props = {50e6, 0.25, 0, 1};
  return std::make_unique<Umat>(UmatParameters{UMAT_PROBE, props, {}, 20}, "", std::vector<UmatPoint>(n));
}

/// What the solver relies on, of every material.
class MaterialProtocol : public testing::TestWithParam<std::unique_ptr<Material> (*)()>
{
protected:
  std::unique_ptr<Material> fresh() const
  {
    auto m = GetParam()();
    std::vector<Stress> s;
    for (std::size_t i = 0; i < n; ++i)
      s.push_back({-60e3 - 1e3 * i, -60e3, -100e3, 0, 0, 0});
    m->set_initial_stress(s);
    return m;
  }
  std::vector<Gradient> increments()
  {
    std::vector<Gradient> h(n);
    for (Gradient &point : h)
      for (double &x : point)
        x = 2e-5 * uniform(random);
    return h;
  }
  static std::vector<Stress> trial(Material &m, const std::vector<Gradient> &h)
  {
    std::vector<Stress> s(n);
    m.trial(h, s);
    return s;
  }
  void advance(Material &m, int steps)
  {
    for (int k = 0; k < steps; ++k)
      {
        trial(m, increments());
        m.commit();
      }
  }
  std::mt19937 random{3};
  std::uniform_real_distribution<double> uniform{-1, 1};
};

TEST_P(MaterialProtocol, EveryTrialStartsFromTheCommittedState)
{
  auto m = fresh();
  advance(*m, 100);
  const auto h = increments(), other = increments();
  const std::vector<Gradient> none(n);
  const auto bytes = m->pack();
  const auto rest = trial(*m, none), first = trial(*m, h);
  EXPECT_NE(first, rest);
  trial(*m, other);
  EXPECT_EQ(trial(*m, h), first);
  EXPECT_EQ(m->pack(), bytes);
  m->rollback();
  m->commit(); // nothing to keep
  EXPECT_EQ(m->pack(), bytes);
  EXPECT_EQ(trial(*m, none), rest);
  trial(*m, h);
  m->commit();
  m->commit(); // once is enough
  EXPECT_EQ(trial(*m, none), first);
  EXPECT_NE(m->pack(), bytes);
}

TEST_P(MaterialProtocol, ComesBackFromBytesBitForBit)
{
  auto m = fresh(), copy = GetParam()();
  advance(*m, 100);
  trial(*copy, increments()); // forgotten by unpack()
  copy->unpack(m->pack());
  copy->commit();
  for (int k = 0; k < 1000; ++k)
    {
      const auto h = increments();
      ASSERT_EQ(trial(*m, h), trial(*copy, h)) << k;
      m->commit();
      copy->commit();
    }
  EXPECT_EQ(m->pack(), copy->pack());
}

TEST_P(MaterialProtocol, PointsOfOneStateMakeAnother)
{
  auto m = fresh(), half = GetParam()();
  advance(*m, 20);
  const MaterialState late = m->pack();
  MaterialState mixed = half->pack();
  for (std::size_t k : {1, 3})
    mixed.points[k] = late.points[k];
  half->unpack(mixed);
  const std::vector<Gradient> none(n);
  const auto stresses = trial(*m, none), partly = trial(*half, none), start = trial(*GetParam()(), none);
  for (std::size_t k = 0; k < n; ++k)
    {
      EXPECT_NE(stresses[k], start[k]) << k;
      EXPECT_EQ(partly[k], k == 1 || k == 3 ? stresses[k] : start[k]) << k;
    }
  EXPECT_EQ(MaterialState::from_bytes(late.bytes()), late);
  const auto bytes = late.bytes();
  for (std::size_t size = 0; size < bytes.size(); size += 7)
    EXPECT_THROW(MaterialState::from_bytes(std::span(bytes).first(size)), InputError);
}

TEST_P(MaterialProtocol, RefusesOtherBytes)
{
  auto m = fresh();
  const auto bytes = m->pack();
  EXPECT_THROW(m->unpack(Elastic({1e6, 0.1}, n).pack()), InputError);
  EXPECT_THROW(m->unpack(Elastic({}, n + 1).pack()), InputError);
  EXPECT_THROW(m->unpack(Iwan({.contraction = 0.1}, n).pack()), InputError);
  EXPECT_THROW(m->unpack(Iwan({}, n - 1).pack()), InputError);
  EXPECT_THROW(m->unpack(MohrCoulomb({.cohesion = 2e3}, n).pack()), InputError);
  EXPECT_THROW(m->unpack(MohrCoulomb({}, n + 1).pack()), InputError);
  for (std::size_t size = 0; size < bytes.common.size(); size += 7)
    {
      auto cut = bytes;
      cut.common.resize(size);
      EXPECT_THROW(m->unpack(cut), InputError);
    }
  for (std::size_t size = 0; size < bytes.points[3].size(); size += 7)
    {
      auto cut = bytes;
      cut.points[3].resize(size);
      EXPECT_THROW(m->unpack(cut), InputError);
    }
  for (const bool in_common : {true, false})
    {
      auto longer = bytes;
      (in_common ? longer.common : longer.points[4]).push_back({});
      EXPECT_THROW(m->unpack(longer), InputError);
    }
  auto fewer = bytes;
  fewer.points.pop_back();
  EXPECT_THROW(m->unpack(fewer), InputError);
  EXPECT_EQ(m->pack(), bytes); // and none of them changed it
}

TEST_P(MaterialProtocol, NotANumberIsARunFailureThatNamesThePoint)
{
  auto m = fresh();
  auto h = increments();
  h[4][8] = std::numeric_limits<double>::quiet_NaN();
  const auto bytes = m->pack();
  const char *where = GetParam() == make_layers ? "'elastic', whose points are 2 to 4 of the mesh: elastic: point 2:"
                      : GetParam() == make_composite ? "'iwan', whose points are 4, 0, 2 of the mesh: iwan: point 0:"
                                                     : "point 4";
  EXPECT_THAT([&] { trial(*m, h); }, testing::ThrowsMessage<RunFailure>(HasSubstr(where)));
  m->commit();
  EXPECT_EQ(m->pack(), bytes);
}

TEST_P(MaterialProtocol, WaveModuliBoundTheStiffness)
{
  auto m = fresh();
  advance(*m, 50);
  std::vector<Stiffness> c(n);
  std::vector<WaveModuli> w(n);
  m->wave_moduli(w);
  trial(*m, increments());
  m->stiffness(c);
  for (std::size_t i = 0; i < n; ++i)
    {
      EXPECT_LE(c[i](2, 2), 1.001 * w[i].p); // p' and with it the moduli move within the increment
      EXPECT_LE(c[i](4, 4), 1.001 * w[i].s);
      EXPECT_GT(c[i](4, 4), 0);
    }
}

INSTANTIATE_TEST_SUITE_P(All, MaterialProtocol,
                         testing::Values(make_elastic, make_iwan, make_mohr_coulomb, make_layers, make_composite,
                                         make_nonlocal, make_iwan_of_curve, make_viscoelastic, make_corotational,
                                         make_umat));

TEST(CompositeMaterial, PointsOfTheFirstOfAStackComeFirst)
{
  std::vector<std::unique_ptr<Material>> parts;
  parts.push_back(std::make_unique<Elastic>(ElasticParameters{1e6, 0.2}, 2));
  parts.push_back(std::make_unique<Elastic>(ElasticParameters{5e6, 0.2}, 1));
  const auto m = stacked(std::move(parts));
  ASSERT_EQ(m->n_points(), 3u);
  std::vector<Gradient> h(3, Gradient{0, 0, 1e-3});
  std::vector<Stress> s(3);
  m->trial(h, s);
  EXPECT_DOUBLE_EQ(s[1][4], 1e3);
  EXPECT_DOUBLE_EQ(s[2][4], 5e3);
  parts.clear();
  parts.push_back(nullptr);
  EXPECT_THROW(stacked(std::move(parts)), InputError);
}

TEST(CompositeMaterial, PartsHaveTheirPoints)
{
  const auto part = [](double shear_modulus, std::vector<std::size_t> places) {
    const std::size_t points = places.size();
    return CompositeMaterial::Part{std::make_unique<Elastic>(ElasticParameters{shear_modulus, 0.2}, points),
                                   std::move(places)};
  };
  const auto composite = [&](std::vector<std::size_t> soft, std::vector<std::size_t> stiff) {
    std::vector<CompositeMaterial::Part> parts;
    parts.push_back(part(1e6, std::move(soft)));
    parts.push_back(part(5e6, std::move(stiff)));
    return CompositeMaterial(std::move(parts));
  };
  CompositeMaterial m = composite({2, 0}, {1});
  ASSERT_EQ(m.n_points(), 3u);
  std::vector<Gradient> h = {Gradient{0, 0, 1e-3}, Gradient{0, 0, 2e-3}, Gradient{0, 0, 3e-3}};
  std::vector<Stress> s(3);
  m.trial(h, s);
  EXPECT_DOUBLE_EQ(s[0][4], 1e3);
  EXPECT_DOUBLE_EQ(s[1][4], 10e3);
  EXPECT_DOUBLE_EQ(s[2][4], 3e3);
  EXPECT_THROW(composite({0, 1}, {1}), InputError); // two materials at a point
  EXPECT_THROW(composite({0, 1}, {3}), InputError); // beyond the last
  std::vector<CompositeMaterial::Part> other;
  other.push_back({std::make_unique<Elastic>(ElasticParameters{}, 2), {0}});
  EXPECT_THROW(CompositeMaterial(std::move(other)), InputError);
}
} // namespace
} // namespace isostat
