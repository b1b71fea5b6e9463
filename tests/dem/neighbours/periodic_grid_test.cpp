// SPDX-License-Identifier: BSD-3-Clause
// Pairs of a periodic packing, and the list that follows them, against brute force over images.
#include "dem/neighbours/periodic_grid.hpp"

#include "base/error.hpp"
#include "dem/neighbours/verlet_list.hpp"
#include "tests/support/near.hpp"
#include "tests/support/random.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace isostat
{
namespace
{
using Pair = ContactList::Pair;
using test::Random;

struct Image
{
  Eigen::Vector3i shift;
  Vec3 branch; ///< from the first grain to this image of the second, m
};

/// Those of a cell's own corner, up to `range` edges away each way.
std::vector<Image> images_around(const Mat3 &edges, int range)
{
  std::vector<Image> images;
  for (int a = -range; a <= range; ++a)
    for (int b = -range; b <= range; ++b)
      for (int c = -range; c <= range; ++c)
        images.push_back({{a, b, c}, edges * Vec3(a, b, c)});
  return images;
}

/// visit(i, j, image) for every image, of the (2 range + 1)^3 about the second grain's place in the cell of the first,
/// whose surface is closer than `skin`.
template <typename Visit>
void for_near_images(const Packing &packing, const Mat3 &edges, double skin, int range, const Visit &visit)
{
  const Mat3 to_fraction = edges.inverse();
  const std::vector<Image> around = images_around(edges, range);
  for (std::uint32_t i = 0; i < packing.n_grains(); ++i)
    for (std::uint32_t j = i + 1; j < packing.n_grains(); ++j)
      {
        const Vec3 between = packing.centre(j) - packing.centre(i);
        const Eigen::Vector3i middle = (to_fraction * between).array().floor().cast<int>();
        const Vec3 nearest = between - edges * middle.cast<double>();
        const double reach = packing.radius(i) + packing.radius(j) + skin;
        for (const Image &image : around)
          if (const Vec3 branch = nearest + image.branch; branch.squaredNorm() < reach * reach)
            visit(i, j, Image{image.shift - middle, branch});
      }
}

std::map<Pair, Image> near_pairs(const Packing &packing, const Mat3 &edges, double skin, int range)
{
  std::map<Pair, Image> near;
  for_near_images(packing, edges, skin, range, [&](std::uint32_t i, std::uint32_t j, const Image &image) {
    EXPECT_TRUE(near.emplace(Pair(i, j), image).second) << "near through two images: the cell is too narrow";
  });
  return near;
}

/// Grains anywhere in the cell or, `far` edges from it, outside; they may overlap.
Packing random_packing(Random &random, std::size_t n, const Mat3 &edges, double radius, int far)
{
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (std::size_t i = 0; i < n; ++i)
    {
      radii.push_back(radius * (1 + 0.5 * random()));
      const Vec3 whole = ((far + 0.5) * random.vector()).array().round();
      centres.push_back(edges * (0.5 * random.vector() + Vec3::Constant(0.5) + whole));
    }
  return make_packing(centres, radii, 2650);
}

Mat3 leaning(const Vec3 &lengths, double ab, double ac, double bc)
{
  Mat3 edges = lengths.asDiagonal();
  edges.col(1) += ab * edges.col(0);
  edges.col(2) += ac * edges.col(0) + bc * edges.col(1);
  return edges;
}

struct Cell
{
  const char *name;
  Mat3 edges;
  std::size_t n;
};
std::vector<Cell> cells()
{
  const Vec3 cube = Vec3::Constant(2);
  return {{"cubic", cube.asDiagonal(), 200},
          {"sheared", leaning(cube, 0.6, -0.6, 0.5), 200},
          {"sheared_far", leaning(cube, 1.4, -0.9, 1.2), 200},
          {"leaning_by_five", leaning(cube, 5.3, -4.2, 3.1), 200}, // widths below a grain; periods that are not
          {"narrow_by_leaning", leaning(Vec3::Constant(0.91), 0.6, -0.6, 0.5), 60},
          {"left_handed", leaning(Vec3(2, -2, 2), 0.3, 0.5, -0.2), 200},
          {"elongated", leaning(Vec3(20, 1.3, 1.5), 0.1, 0, 0.4), 200},
          {"flat", leaning(Vec3(6, 6, 0.95), 0.5, 0.01, 0), 200},
          {"one_row", Vec3::Constant(0.91).asDiagonal(), 60},
          {"two_rows", leaning(Vec3(1.1, 1, 1.2), 0.3, 0.2, -0.3), 60},
          {"three_rows", leaning(Vec3(1.4, 1.5, 1.45), 0.1, 0, 0.2), 100},
          {"wide_and_empty", Vec3(300, 200, 400).asDiagonal(), 30}};
}
} // namespace

TEST(FindPairsInACell, EqualsBruteForceOverImages)
{
  Random random;
  std::size_t found = 0, across = 0;
  for (const Cell &cell : cells())
    for (const double skin : {0.0, 0.1})
      for (const int far : {0, 100})
        {
          const Packing packing = random_packing(random, cell.n, cell.edges, 0.1, far);
          SCOPED_TRACE(testing::Message() << cell.name << " skin " << skin << " far " << far);
          const auto expected = near_pairs(packing, cell.edges, skin, 3);
          const auto [pairs, images] = find_pairs(packing, cell.edges, skin);
          ASSERT_EQ(pairs.size(), expected.size());
          ASSERT_EQ(images.size(), expected.size());
          std::size_t p = 0;
          for (const auto &[pair, image] : expected)
            {
              ASSERT_EQ(pairs[p], pair);
              ASSERT_EQ(image_shift(images[p]), image.shift);
              across += image.shift != Eigen::Vector3i::Zero();
              ++p;
            }
          found += p;
        }
  EXPECT_GT(across, 1000u);
}

TEST(FindPairsInACell, OneGrainNearlyAsLargeAsTheCell)
{
  Random random(3);
  std::size_t found = 0;
  for (int run = 0; run < 50; ++run)
    {
      const Mat3 edges = leaning(Vec3::Constant(0.95), 2 * random(), 2 * random(), 2 * random());
      Packing packing = random_packing(random, 40, edges, 0.08, 3);
      packing.position[4 * 17 + 3] = 0.34;
      ASSERT_BELOW_BECAUSE(2 * max_reach(packing), 0.94, "two different grains fit side by side");
      ASSERT_GT(4 * packing.max_radius(), 0.95);
      const auto expected = near_pairs(packing, edges, 1e-3, 4);
      const auto [pairs, images] = find_pairs(packing, edges, 1e-3);
      ASSERT_EQ(pairs.size(), expected.size());
      for (std::size_t p = 0; p < pairs.size(); ++p)
        ASSERT_EQ(image_shift(images[p]), expected.at(pairs[p]).shift);
      found += pairs.size();
    }
  EXPECT_GT(found, 1000u);
}

TEST(FindPairsInACell, WhatIsTooFarAwayIsNamed)
{
  const Mat3 edges = leaning(Vec3::Ones(), 0.3, 0, 0.2);
  const Vec3 here(0.1, 0.2, 0.3), near(0.25, 0.2, 0.3);
  const auto find = [&](double a) {
    return find_pairs(make_packing({here, near + edges * Vec3(a, 0, 0)}, {0.1, 0.1}, 2650), edges, 0);
  };
  EXPECT_EQ(image_shift(find(511).second.at(0)), Eigen::Vector3i(-511, 0, 0));
  const auto failure = [&](double a) { return test::refusal<RunFailure>([&] { find(a); }); };
  test::expect_parts(failure(512), {"grains 0 and 1 are neighbours through 512 edges", "at most 511"});
  test::expect_parts(failure(1e300), {"grain 1 (id 1) is 1e+300 edges away", "within 1e+06"});
}

TEST(FindPairsInACell, NoneOneAndTwo)
{
  const Mat3 edges = leaning(Vec3::Ones(), 0.3, 0, 0.2);
  EXPECT_TRUE(find_pairs(make_packing({}, {}, 2650), edges, 0.1).first.empty());
  EXPECT_TRUE(find_pairs(make_packing({Vec3(1, 2, 3)}, {0.1}, 2650), edges, 0.1).first.empty());
  const Vec3 here(0.1, 0.2, 0.3), near(0.15, 0, 0);
  const auto [pairs, images] =
      find_pairs(make_packing({here + edges * Vec3(2, -3, 1), here + near}, {0.1, 0.1}, 2650), edges, 0);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(image_shift(images[0]), Eigen::Vector3i(2, -3, 1));
  // touching exactly is no pair, through a face neither
  EXPECT_TRUE(
      find_pairs(make_packing({Vec3(0.25, 0, 0), Vec3(3.75, 0, 0)}, {0.25, 0.25}, 2650), 4 * Mat3::Identity(), 0)
          .first.empty());
}

namespace
{
ContactHistory marked(const Pair &p) { return {Vec3(1, p.first, p.second), Vec3(2, p.first, p.second), {}, {}}; }

struct Motion
{
  const char *name;
  double drift, jitter; ///< per step; the mean radius is 0.12
  double shear, normal; ///< strain per step
};

/// Grains that drift and jitter in a cell that deforms and flips, with a list that follows them.
class MovingCell
{
public:
  explicit MovingCell(const Motion &m)
      : motion_(m), cell_(PeriodicCell::with_edges({2, 1.8, 2.2})),
        packing_(random_packing(random_, 120, cell_.edges, 0.12, 0))
  {
    for (std::size_t i = 0; i < packing_.n_grains(); ++i)
      drift_.push_back(m.drift * random_.vector());
    gradient_ << 0.5 * m.normal, m.shear, 0, 0, -m.normal, 0.7 * m.shear, 0, 0, 0.5 * m.normal;
    list_.update(packing_, cell_, 0, contacts_);
    contacts_.set_cell(cell_.edges);
    check();
  }

  void step()
  {
    const Mat3 growth = cell_.deform(gradient_);
    double maximum = 0;
    for (std::size_t i = 0; i < packing_.n_grains(); ++i)
      {
        const Vec3 moved = drift_[i] + motion_.jitter * random_.vector();
        packing_.set_centre(i, packing_.centre(i) + growth * packing_.centre(i) + moved);
        maximum = std::max(maximum, moved.norm());
      }
    if (const auto upright = cell_.upright_edges())
      flip(*upright);
    list_.update(packing_, cell_, maximum + growth.norm() * 2 * packing_.max_radius(), contacts_);
    contacts_.set_cell(cell_.edges);
  }

  /// Everything that touches is listed with the right image, and pairs that kept touching have their history.
  void check()
  {
    std::map<Pair, std::size_t> place;
    for (std::size_t p = 0; p < contacts_.n_pairs(); ++p)
      place[{contacts_.first()[p], contacts_.second()[p]}] = p;
    const auto now = near_pairs(packing_, cell_.edges, 0, 1);
    for (const auto &[pair, image] : now)
      {
        ASSERT_TRUE(place.contains(pair)) << pair.first << ' ' << pair.second;
        const std::size_t p = place[pair];
        ASSERT_BELOW_BECAUSE((contacts_.branch(packing_, p) - image.branch).norm(), 1e-13,
                             "round-off of coordinates of some units, as images are added in another order");
        if (touching_.contains(pair))
          {
            ASSERT_EQ(contacts_.history(p).normal, marked(pair).normal);
            ASSERT_EQ(contacts_.history(p).shear_force, marked(pair).shear_force);
          }
        contacts_.set_history(p, marked(pair));
      }
    n_touching += now.size();
    touching_ = now;
  }

  const PeriodicCell &cell() const { return cell_; }
  const VerletList &list() const { return list_; }
  std::size_t n_touching = 0;

private:
  void flip(const Mat3 &upright)
  {
    cell_.edges = upright;
    ++cell_.flips;
    const Mat3 to_fraction = upright.inverse();
    for (std::size_t i = 0; i < packing_.n_grains(); ++i)
      {
        const Vec3 whole = (to_fraction * packing_.centre(i)).array().floor();
        packing_.set_centre(i, packing_.centre(i) - upright * whole);
      }
    list_.invalidate();
  }

  Random random_;
  Motion motion_;
  Mat3 gradient_;
  PeriodicCell cell_;
  Packing packing_;
  std::vector<Vec3> drift_;
  VerletList list_;
  ContactList contacts_{HistoryLayout{{true, true, false, false}}};
  std::map<Pair, Image> touching_;
};

const Motion motions[] = {{"jitter", 0, 1e-3, 0, 0},           {"drift", 5e-4, 0, 0, 0},
                          {"fast", 1e-2, 1e-2, 0, 0},          {"shear", 1e-5, 1e-5, 1e-4, 0},
                          {"fast_shear", 1e-4, 1e-3, 6e-3, 0}, {"compression", 1e-5, 1e-5, 0, 1e-3},
                          {"all", 1e-5, 1e-4, 4e-3, -5e-4}};
} // namespace

class VerletListInACell : public testing::TestWithParam<Motion>
{};

TEST_P(VerletListInACell, NoContactIsMissedAndHistoryStays)
{
  const Motion m = GetParam();
  MovingCell moving(m);
  for (int step = 0; step < 300; ++step)
    {
      moving.step();
      ASSERT_NO_FATAL_FAILURE(moving.check()) << "step " << step;
    }
  EXPECT_GT(moving.n_touching, 15'000u);
  EXPECT_GT(moving.list().n_rebuilds(), 1u);
  EXPECT_GE(moving.cell().flips, m.shear > 1e-3 ? 1u : 0u);
}
INSTANTIATE_TEST_SUITE_P(Motions, VerletListInACell, testing::ValuesIn(motions),
                         [](const auto &m) { return std::string(m.param.name); });

TEST(VerletListOfACell, HomogeneousShearNeedsFewRebuilds)
{
  MovingCell moving({"", 0, 0, 1e-4, 0});
  for (int step = 0; step < 100; ++step)
    {
      moving.step();
      ASSERT_NO_FATAL_FAILURE(moving.check()) << "step " << step;
    }
  EXPECT_LT(moving.list().n_rebuilds(), 30u);
}

TEST(VerletListOfACell, OtherEdgesOfTheSameLatticeAreNoticed)
{
  // the same number of flips, but other ones: positions and edges have been replaced by those of another state
  Random random;
  PeriodicCell cell = PeriodicCell::with_edges(Vec3::Constant(2)), other = cell;
  other.edges.col(0) += other.edges.col(1);
  const Packing packing = random_packing(random, 100, cell.edges, 0.15, 0);
  ContactList contacts;
  VerletList list;
  list.update(packing, cell, 0, contacts);
  list.recheck();
  list.update(packing, other, 0, contacts);
  contacts.set_cell(other.edges);
  std::size_t touching = 0;
  for (std::size_t p = 0; p < contacts.n_pairs(); ++p)
    touching +=
        contacts.branch(packing, p).norm() < packing.radius(contacts.first()[p]) + packing.radius(contacts.second()[p]);
  EXPECT_EQ(touching, near_pairs(packing, cell.edges, 0, 1).size());
}

TEST(VerletListOfACell, ACellTooNarrowForItsGrainsIsRefused)
{
  const Packing packing = make_packing({Vec3::Zero(), Vec3(0.5, 0.5, 0.5)}, {0.2, 0.25}, 2650);
  const auto update = [&](const Vec3 &lengths) {
    ContactList contacts;
    VerletList list;
    list.update(packing, PeriodicCell::with_edges(lengths), 0, contacts);
  };
  EXPECT_NO_THROW(update({0.91, 0.91, 0.91})); // each grain next to itself does not matter: they are of two sizes
  EXPECT_THROW(update({3, 0.89, 3}), RunFailure);
  EXPECT_THROW(update({0.3, 3, 3}), RunFailure);
  // what counts is the distance to the next image, not the edges that were chosen for the lattice
  PeriodicCell sheared = PeriodicCell::with_edges({0.91, 0.91, 0.91});
  sheared.edges.col(1) += 0.6 * sheared.edges.col(0);
  sheared.edges.col(2) += 3 * sheared.edges.col(1);
  ASSERT_BELOW_BECAUSE(sheared.widths().minCoeff(), 0.5, "narrower than a grain");
  ContactList contacts;
  VerletList list;
  EXPECT_NO_THROW(list.update(packing, sheared, 0, contacts));
  PeriodicCell oblique = PeriodicCell::with_edges({3, 0.85, 3}); // edges are 3 long, their difference 0.85
  oblique.edges.col(1) += oblique.edges.col(0);
  ASSERT_GE(oblique.edges.colwise().norm().minCoeff(), 3);
  test::expect_parts(
      test::refusal<RunFailure>([&] { VerletList().update(packing, oblique, 0, contacts); }),
      {"shortest period of the periodic cell is 0.85 m", "two largest diameters together, 0.9 m", "Take more grains"});
}

TEST(VerletListOfACell, ACellThatGetsTooNarrowIsNoticedInTime)
{
  MovingCell moving({"", 1e-5, 1e-5, 0, 2e-3}); // flatter and flatter; near_pairs() fails where a pair meets twice
  const auto flatten = [&] {
    for (int step = 0; step < 1000; ++step)
      {
        moving.step();
        ASSERT_NO_FATAL_FAILURE(moving.check()) << "step " << step;
      }
  };
  EXPECT_THROW(flatten(), RunFailure);
}
} // namespace isostat
