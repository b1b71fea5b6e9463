// SPDX-License-Identifier: BSD-3-Clause
// The contact law against recorded pair paths of YADE (tests/reference/README.md): two driven spheres, or a sphere and
// a wall. Every row holds positions, half-step velocities and the forces that belong to them.
#include "base/files/csv_table.hpp"
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/contact/loop.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace isostat
{
namespace
{
constexpr double dt = 5e-8, r1 = 2e-4, r2 = 1.5e-4;

LinearRolling yade_law()
{
  LinearRolling law;
  law.friction = 0.3249196962329063; // tan 18 deg
  return law;
}

/// What the law gives in one step: fn, then fs, mb, mt, F2, T1, T2.
struct Response
{
  double normal_force = 0;
  std::array<Vec3, 6> vectors{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};
constexpr std::array<const char *, 6> vector_names{"fs", "mb", "mt", "F2", "T1", "T2"};

struct PairPath
{
  std::vector<ContactPair> pairs;
  std::vector<Response> expected;
};

PairPath read_path(const std::string &name)
{
  const std::string groups[] = {"x1", "x2", "v1", "v2", "w1", "w2", "fs", "mb", "mt", "F2", "T1", "T2"};
  std::vector<std::string> columns{"fn"};
  for (const auto &group : groups)
    for (char axis : {'x', 'y', 'z'})
      columns.push_back(group + axis);
  const CsvTable table(ISOSTAT_SOURCE_DIR "/tests/reference/pair/" + name + ".csv.gz", columns);
  PairPath path;
  for (std::size_t row = 0; row < table.n_rows(); ++row)
    {
      auto group = [&](std::size_t g) { return table.vector(row, 1 + 3 * g); };
      path.pairs.push_back({group(0), group(2), group(4), group(1), group(3), group(5), r1, r2});
      Response r{table(row, 0), {}};
      for (std::size_t v = 0; v < 6; ++v)
        r.vectors[v] = group(6 + v);
      path.expected.push_back(r);
    }
  return path;
}

Response scalar_response(const LinearRolling &law, const ContactPair &pair, ContactHistory &history)
{
  const ContactForce f = contact_force(law, pair, dt, history);
  return {f.normal_force,
          {history.shear_force, history.bending_moment, history.twisting_moment, f.force, f.torque1, f.torque2}};
}

/// The SIMD loop on a packing of two.
class KernelPair
{
public:
  explicit KernelPair(const LinearRolling &law)
      : law_(law), packing_(make_packing({Vec3::Zero(), Vec3(1, 0, 0)}, {r1, r2}, 2650)), list_(law.history())
  {
    list_.replace_pairs({{0, 1}}, 2);
  }
  Response response(const ContactPair &pair)
  {
    packing_.set_centre(0, pair.x1);
    packing_.set_centre(1, pair.x2);
    packing_.set_linear_velocity(0, pair.v1);
    packing_.set_linear_velocity(1, pair.v2);
    packing_.set_angular_velocity(0, pair.w1);
    packing_.set_angular_velocity(1, pair.w2);
    AlignedVector<double> action(8 * (2 + Packing::n_padding), 0.0);
    add_contact_forces(law_, packing_, dt, list_, action.data());
    const ContactHistory h = list_.history(0);
    const Vec3 force(&action[8]);
    EXPECT_EQ(Vec3(&action[0]), Vec3(-force)); // Newton's third law
    const double fn = (force - h.shear_force).dot(h.normal);
    return {fn, {h.shear_force, h.bending_moment, h.twisting_moment, force, Vec3(&action[4]), Vec3(&action[12])}};
  }

private:
  LinearRolling law_;
  Packing packing_;
  ContactList list_;
};

/// Largest error of each quantity over the path against its largest value on it; a quantity that is 0 throughout must
/// stay so against the largest of its kind.
class Misfit
{
public:
  void add(const Response &got, const Response &expected)
  {
    put(0, std::abs(got.normal_force - expected.normal_force), expected.normal_force);
    for (std::size_t v = 0; v < 6; ++v)
      put(1 + v, (got.vectors[v] - expected.vectors[v]).norm(), expected.vectors[v].norm());
  }
  void check(const std::string &who, double tolerance) const
  {
    for (std::size_t q = 0; q < error_.size(); ++q)
      {
        const bool is_force = q == 0 || q == 1 || q == 4;
        const double scale = largest_[q] > 0 ? largest_[q] : is_force ? largest_[0] : r2 * largest_[0];
        EXPECT_LE(error_[q], tolerance * scale) << who << ' ' << (q == 0 ? "fn" : vector_names[q - 1]);
      }
  }

private:
  void put(std::size_t q, double error, double value)
  {
    error_[q] = std::max(error_[q], error);
    largest_[q] = std::max(largest_[q], value);
  }
  std::array<double, 7> error_{}, largest_{};
};

/// A touching pair that has seen `steps` steps of sliding, rolling and twisting at once.
ContactPair moving_pair()
{
  const Vec3 n = Vec3(1, 2, -0.5).normalized();
  return {Vec3::Zero(),
          Vec3(0.01, 0, 0),
          Vec3(3, -2, 1),
          (r1 + r2 - 2e-7) * n,
          Vec3(0, 0.02, 0.01),
          Vec3(-5, 4, 8),
          r1,
          r2};
}
} // namespace

class RecordedPath : public testing::TestWithParam<const char *>
{};

TEST_P(RecordedPath, ScalarLawAndKernelFollowIt)
{
  const PairPath path = read_path(GetParam());
  ASSERT_GE(path.pairs.size(), 1999u);
  const LinearRolling law = yade_law();
  ContactHistory history;
  KernelPair kernel(law);
  Misfit scalar, simd;
  for (std::size_t i = 0; i < path.pairs.size(); ++i)
    {
      scalar.add(scalar_response(law, path.pairs[i], history), path.expected[i]);
      simd.add(kernel.response(path.pairs[i]), path.expected[i]);
    }
  scalar.check(std::string(GetParam()) + "_scalar", 1e-11);
  simd.check(std::string(GetParam()) + "_simd", 1e-11);
}
INSTANTIATE_TEST_SUITE_P(Pairs, RecordedPath, testing::Values("normal", "shear", "roll", "twist", "combined"),
                         [](const auto &path) { return std::string(path.param); });

TEST(RecordedWallPath, StiffnessIsThatOfAnEqualSphere)
{
  const PairPath path = read_path("wall");
  std::vector<WallOverlap> near;
  for (const ContactPair &pair : path.pairs) // body 1 is the wall, a plane normal to x; body 2 the sphere
    near.push_back({r2, r2 - (pair.x2.x() - pair.x1.x())});
  std::vector<WallResponse> at_once(near.size()), one_by_one(near.size());
  yade_law().walls(near, at_once);
  yade_law().ContactLaw::walls(near, one_by_one);

  Misfit misfit;
  std::size_t touching = 0;
  for (std::size_t i = 0; i < near.size(); ++i)
    {
      EXPECT_EQ(at_once[i].force, one_by_one[i].force);
      EXPECT_EQ(at_once[i].stiffness, one_by_one[i].stiffness);
      touching += near[i].overlap > 0;
      Response got;
      got.normal_force = at_once[i].force;
      got.vectors[3] = Vec3(got.normal_force, 0, 0);
      Response expected = path.expected[i];
      expected.vectors[4] = Vec3::Zero(); // a torque about the wall's own centre means nothing
      misfit.add(got, expected);
    }
  EXPECT_GT(touching, 500u);
  EXPECT_LT(touching, near.size());
  misfit.check("wall", 1e-11);
}

TEST(ContactLaw, NewContactStartsWithoutRotation)
{
  const LinearRolling law = yade_law();
  const ContactPair p = moving_pair();
  ContactHistory history;
  contact_force(law, p, 1e-12, history); // so short a step that nothing yields
  const Vec3 n = (p.x2 - p.x1).normalized();
  const ContactStiffness k = law.stiffness(r1, r2);
  const double alpha = (r1 + r2) / (p.x2 - p.x1).norm();
  const Vec3 vr = alpha * (p.v2 - p.v1) - (r2 * p.w2 + r1 * p.w1).cross(n);
  const Vec3 dw = p.w2 - p.w1;
  EXPECT_BELOW_BECAUSE((history.shear_force + k.shear * 1e-12 * (vr - vr.dot(n) * n)).norm(),
                       1e-14 * k.shear * 1e-12 * vr.norm(), "round-off of some twenty operations");
  EXPECT_BELOW_BECAUSE((history.bending_moment + k.rolling * 1e-12 * (dw - dw.dot(n) * n)).norm(),
                       1e-14 * k.rolling * 1e-12 * dw.norm(), "round-off of some twenty operations");
  EXPECT_BELOW_BECAUSE((history.twisting_moment + k.twisting * 1e-12 * dw.dot(n) * n).norm(),
                       1e-14 * k.twisting * 1e-12 * dw.norm(), "round-off of some twenty operations");
  EXPECT_EQ(history.normal, Vec3((p.x2 - p.x1) / (p.x2 - p.x1).norm()));
}

TEST(ContactLaw, LostContactForgets)
{
  const LinearRolling law = yade_law();
  const ContactPair p = moving_pair();
  ContactPair apart = p;
  apart.x2 *= 1.01;
  ContactHistory history;
  KernelPair kernel(law);
  const Response first = scalar_response(law, p, history);
  const Response first_simd = kernel.response(p);
  ASSERT_GT(history.shear_force.norm(), 0);
  const Response none = scalar_response(law, apart, history);
  EXPECT_EQ(none.normal_force, 0);
  for (const Response &r : {none, kernel.response(apart)})
    for (const Vec3 &v : r.vectors)
      EXPECT_EQ(v, Vec3::Zero());
  EXPECT_EQ(history.normal, Vec3::Zero());
  // the contact that comes back is a new one
  EXPECT_EQ(scalar_response(law, p, history).vectors, first.vectors);
  EXPECT_EQ(kernel.response(p).vectors, first_simd.vectors);
}

TEST(ContactLaw, SlidingAndRollingAreReachedFromBelow)
{
  const LinearRolling law = yade_law();
  const double fn = 2.0, length = law.rolling_length(r1, r2);
  EXPECT_DOUBLE_EQ(length, 0.5 * r2);
  // of a contact with these tangential force and bending moment
  const auto yield = [&](const LinearRolling &l, double fs, double mb) {
    ContactHistory history;
    history.shear_force = Vec3(fs, 0, 0);
    history.bending_moment = Vec3(0, mb, 0);
    return l.yield({r1, r2, 1e-6, fn, history}, yield_round_off);
  };
  EXPECT_TRUE(yield(law, law.friction * fn, 0).sliding);
  EXPECT_TRUE(yield(law, (1 - 0.9e-9) * law.friction * fn, 0).sliding);
  EXPECT_FALSE(yield(law, (1 - 1.1e-9) * law.friction * fn, 0).sliding);
  EXPECT_TRUE(yield(law, 0, length * fn).rolling);
  EXPECT_TRUE(yield(law, 0, (1 - 0.9e-9) * length * fn).rolling);
  EXPECT_FALSE(yield(law, 0, (1 - 1.1e-9) * length * fn).rolling);

  LinearRolling without = law;
  without.rolling = false;
  EXPECT_FALSE(yield(without, 0, length * fn).rolling);
  without.friction = 0;
  EXPECT_FALSE(yield(without, 0, 0).sliding);
}

TEST(ContactLaw, YieldedStateLiesOnTheSurface)
{
  const LinearRolling law = yade_law();
  ContactPair p = moving_pair();
  p.v2 *= 1000;
  p.w2 *= 1e5;
  ContactHistory history;
  const ContactForce f = contact_force(law, p, dt, history);
  EXPECT_NEAR_BECAUSE(history.shear_force.norm(), law.friction * f.normal_force, 1e-15 * f.normal_force,
                      "round-off of a vector that is scaled to its limit");
  EXPECT_NEAR_BECAUSE(history.bending_moment.norm(), 0.5 * r2 * f.normal_force, 1e-15 * r2 * f.normal_force,
                      "round-off of a vector that is scaled to its limit");
  const YieldState yield = law.yield({p.r1, p.r2, f.overlap, f.normal_force, history}, yield_round_off);
  EXPECT_TRUE(yield.sliding && yield.rolling);
}

TEST(ContactLaw, StiffnessesFollowFromTheFeatures)
{
  LinearRolling law = yade_law();
  const ContactStiffness k = law.stiffness(r1, r2);
  EXPECT_DOUBLE_EQ(k.normal, 1714285.714285714);
  EXPECT_DOUBLE_EQ(k.shear, 514285.71428571414);
  EXPECT_DOUBLE_EQ(k.rolling, 0.004628571428571427);
  EXPECT_DOUBLE_EQ(k.twisting, 0.004628571428571427);
  law.twisting = false;
  EXPECT_EQ(law.stiffness(r1, r2).twisting, 0);
  law.friction = 0;
  EXPECT_EQ(law.stiffness(r1, r2).shear, 0);
  EXPECT_EQ(law.stiffness(r1, r2).rolling, 0);
}
} // namespace isostat
