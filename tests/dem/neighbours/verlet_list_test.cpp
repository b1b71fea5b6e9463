// SPDX-License-Identifier: BSD-3-Clause
#include "dem/neighbours/verlet_list.hpp"

#include "dem/neighbours/cell_grid.hpp"
#include "tests/support/random.hpp"

#include <gtest/gtest.h>

#include <map>

namespace isostat
{
namespace
{
using Pair = ContactList::Pair;
using test::Random;

double gap(const Packing &p, std::size_t i, std::size_t j)
{
  return (p.centre(j) - p.centre(i)).norm() - p.radius(i) - p.radius(j);
}

std::vector<Pair> all_pairs(const Packing &packing, double skin)
{
  std::vector<Pair> pairs;
  for (std::uint32_t i = 0; i < packing.n_grains(); ++i)
    for (std::uint32_t j = i + 1; j < packing.n_grains(); ++j)
      if (gap(packing, i, j) < skin)
        pairs.emplace_back(i, j);
  return pairs;
}

/// Grains at random in a box around the origin; they may overlap.
Packing random_packing(Random &random, std::size_t n, const Vec3 &half_edges, double radius)
{
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (std::size_t i = 0; i < n; ++i)
    {
      radii.push_back(radius * (1 + 0.5 * random()));
      centres.push_back(random.vector().cwiseProduct(half_edges - Vec3::Constant(radii[i])));
    }
  return make_packing(centres, radii, 2650);
}

ContactHistory marked(const Pair &p) { return {Vec3(1, p.first, p.second), Vec3(2, p.first, p.second), {}, {}}; }

/// Grains that drift and jitter in a box that deforms, with a list that follows them.
class MovingBox
{
public:
  MovingBox(double drift, double jitter, const Vec3 &strain_per_step, bool grains_follow)
      : jitter_(jitter), strain_(strain_per_step),
        followed_(grains_follow ? strain_per_step : Vec3::Zero()), box_{Vec3::Constant(-1), Vec3::Constant(1)},
        packing_(random_packing(random_, 150, Vec3::Ones(), 0.12))
  {
    for (std::size_t i = 0; i < packing_.n_grains(); ++i)
      drift_.push_back(drift * random_.vector());
    list_.update(packing_, box_, 0, contacts_);
    touching_ = all_pairs(packing_, 0);
    for (std::size_t p = 0; p < contacts_.n_pairs(); ++p)
      remember(p);
  }

  void step()
  {
    const RigidBox old = box_;
    for (int k = 0; k < 3; ++k)
      {
        box_.lower[k] *= 1 + strain_[k];
        box_.upper[k] *= 1 + strain_[k];
      }
    double maximum = 0;
    for (std::size_t i = 0; i < packing_.n_grains(); ++i)
      {
        const Vec3 moved = drift_[i] + jitter_ * random_.vector() + packing_.centre(i).cwiseProduct(followed_);
        packing_.set_centre(i, packing_.centre(i) + moved);
        maximum = std::max(maximum, moved.norm());
      }
    list_.update(packing_, box_, maximum + (box_.upper - old.upper).cwiseAbs().maxCoeff(), contacts_);
  }

  /// Everything that touches is listed, and pairs that kept touching have their history.
  void check()
  {
    std::map<Pair, std::size_t> place;
    for (std::size_t p = 0; p < contacts_.n_pairs(); ++p)
      place[{contacts_.first()[p], contacts_.second()[p]}] = p;
    const std::vector<Pair> now = all_pairs(packing_, 0);
    for (const Pair &pair : now)
      {
        ASSERT_TRUE(place.contains(pair)) << pair.first << ' ' << pair.second;
        if (std::binary_search(touching_.begin(), touching_.end(), pair))
          {
            ASSERT_EQ(contacts_.history(place[pair]).normal, marked(pair).normal);
            ASSERT_EQ(contacts_.history(place[pair]).shear_force, marked(pair).shear_force);
          }
        remember(place[pair]);
      }
    touching_ = now;
    for (int wall = 0; wall < 6; ++wall)
      {
        const auto &near = list_.near_wall()[wall];
        ASSERT_TRUE(std::is_sorted(near.begin(), near.end()));
        for (std::uint32_t i = 0; i < packing_.n_grains(); ++i)
          ASSERT_TRUE(wall_gap(packing_, box_, i, wall) >= 0 || std::binary_search(near.begin(), near.end(), i))
              << "grain " << i << " wall " << wall;
      }
  }
  std::uint64_t n_rebuilds() const { return list_.n_rebuilds(); }

private:
  void remember(std::size_t p) { contacts_.set_history(p, marked({contacts_.first()[p], contacts_.second()[p]})); }

  Random random_;
  double jitter_;
  Vec3 strain_, followed_;
  RigidBox box_;
  Packing packing_;
  std::vector<Vec3> drift_;
  VerletList list_;
  ContactList contacts_{HistoryLayout{{true, true, false, false}}};
  std::vector<Pair> touching_;
};

struct Motion
{
  const char *name;
  double drift, jitter; ///< per step; the mean radius is 0.12
  Vec3 strain;
  bool grains_follow = true;
};
const Motion motions[] = {{"jitter", 0, 1e-3, Vec3::Zero()},
                          {"drift", 5e-4, 0, Vec3::Zero()},
                          {"fast", 1e-2, 1e-2, Vec3::Zero()},
                          {"compression", 1e-5, 1e-5, Vec3(5e-5, -1e-4, 5e-5)},
                          {"collapse", 1e-5, 1e-5, Vec3::Constant(-1e-3)},
                          {"dilation", 1e-5, 1e-4, Vec3::Constant(2e-4)},
                          {"walls_alone", 1e-7, 0, Vec3(-2e-4, 1e-4, -1e-4), false}};
} // namespace

TEST(FindPairs, EqualsBruteForce)
{
  Random random;
  const Vec3 boxes[] = {Vec3::Ones(), Vec3(4, 0.5, 0.5), Vec3(0.3, 0.3, 5), Vec3(40, 40, 40)};
  for (const Vec3 &half_edges : boxes)
    for (const double skin : {0.0, 1e-3, 0.3})
      {
        const Packing packing = random_packing(random, 300, half_edges, 0.1);
        for (int threads : {1, 2, 3})
          EXPECT_EQ(find_pairs(packing, skin, threads), all_pairs(packing, skin))
              << half_edges.transpose() << " skin " << skin << " threads " << threads;
      }
}

TEST(FindPairs, NoneOneAndCoincident)
{
  EXPECT_TRUE(find_pairs(make_packing({}, {}, 2650), 0.1).empty());
  EXPECT_TRUE(find_pairs(make_packing({Vec3(1, 2, 3)}, {0.1}, 2650), 0.1).empty());
  const Vec3 here(1, 2, 3);
  const std::vector<Pair> both{{0, 1}};
  EXPECT_EQ(find_pairs(make_packing({here, here}, {0.1, 0.1}, 2650), 0), both);
  // the padding records behind the last grain are no grains
  EXPECT_EQ(find_pairs(make_packing({here, here + Vec3(0.15, 0, 0)}, {0.1, 0.1}, 2650), 0), both);
}

TEST(FindPairs, TouchingExactlyIsNoPair)
{
  EXPECT_TRUE(find_pairs(make_packing({Vec3::Zero(), Vec3(0.5, 0, 0)}, {0.25, 0.25}, 2650), 0).empty());
  EXPECT_TRUE(find_pairs(make_packing({Vec3::Zero(), Vec3(0.75, 0, 0)}, {0.25, 0.25}, 2650), 0.25).empty());
}

class VerletListMotion : public testing::TestWithParam<Motion>
{};

TEST_P(VerletListMotion, NoContactIsMissedAndHistoryStays)
{
  const Motion m = GetParam();
  MovingBox moving(m.drift, m.jitter, m.strain, m.grains_follow);
  for (int step = 0; step < 600; ++step)
    {
      moving.step();
      ASSERT_NO_FATAL_FAILURE(moving.check()) << "step " << step;
    }
  EXPECT_GT(moving.n_rebuilds(), 1u);
}
INSTANTIATE_TEST_SUITE_P(Motions, VerletListMotion, testing::ValuesIn(motions),
                         [](const auto &m) { return std::string(m.param.name); });

TEST(VerletList, HomogeneousStrainNeedsFewRebuilds)
{
  MovingBox moving(0, 0, Vec3(5e-5, -1e-4, 5e-5), true);
  const int steps = 100;
  for (int step = 0; step < steps; ++step)
    {
      moving.step();
      ASSERT_NO_FATAL_FAILURE(moving.check()) << "step " << step;
    }
  EXPECT_LT(moving.n_rebuilds(), 30u);
}

TEST(VerletList, RestNeedsNoRebuildAndInvalidateForcesALook)
{
  Random random;
  const RigidBox box{Vec3::Constant(-1), Vec3::Constant(1)};
  const Packing packing = random_packing(random, 50, Vec3::Ones(), 0.1);
  ContactList contacts;
  VerletList list;
  for (int step = 0; step < 10; ++step)
    list.update(packing, box, 0, contacts);
  EXPECT_EQ(list.n_rebuilds(), 1u);
  Packing moved = packing; // without telling the list
  moved.set_centre(0, moved.centre(1));
  list.invalidate();
  list.update(moved, box, 0, contacts);
  EXPECT_EQ(list.n_rebuilds(), 2u);
  EXPECT_EQ(Pair(contacts.first()[0], contacts.second()[0]), find_pairs(moved, list.skin())[0]);
}
} // namespace isostat
