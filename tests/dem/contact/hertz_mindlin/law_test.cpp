// SPDX-License-Identifier: BSD-3-Clause
// The Hertz-Mindlin law against pairs driven by LAMMPS (tests/reference/README.md), and against closed forms.
#include "base/files/csv_table.hpp"
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/contact/loop.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace isostat
{
namespace
{
constexpr double r1 = 2e-4, r2 = 1.5e-4;

/// Rows of two driven spheres, and F2, T1, T2 that LAMMPS finds.
struct DrivenPath
{
  std::vector<ContactPair> pairs;
  std::vector<std::array<Vec3, 3>> expected;
};

DrivenPath read_path(const std::string &name)
{
  std::vector<std::string> columns;
  for (const char *group : {"x1", "x2", "v1", "v2", "w1", "w2", "F2", "T1", "T2"})
    for (char axis : {'x', 'y', 'z'})
      columns.push_back(std::string(group) + axis);
  const CsvTable table(ISOSTAT_SOURCE_DIR "/tests/reference/pair_hertz/" + name + ".csv.gz", columns);
  DrivenPath path;
  for (std::size_t row = 0; row < table.n_rows(); ++row)
    {
      const auto group = [&](std::size_t g) { return table.vector(row, 3 * g); };
      path.pairs.push_back({group(0), group(2), group(4), group(1), group(3), group(5), r1, r2});
      path.expected.push_back({group(6), group(7), group(8)});
    }
  return path;
}

/// A grain and its image by half a turn meet with +-`speed` along x and +-`slip` along y, until they part.
struct Impact
{
  double overlap = 0, duration = 0;       ///< largest, m; s
  double restitution = 0, tangential = 0; ///< speeds after over normal and tangential speed before [-]
  double spin = 0;                        ///< about z, 1/s
  double energy_change = 0;               ///< over the kinetic energy before [-]
};

Impact impact(const HertzMindlin &law, double radius, double speed, double slip, double steps_per_contact)
{
  const double mass = 4.0 / 3.0 * M_PI * std::pow(radius, 3) * 2650, inertia = 0.4 * mass * radius * radius;
  const double dt =
      2.87 * std::pow(std::pow(mass / 2, 2) / (radius / 2 * std::pow(law.contact_modulus(), 2) * 2 * speed), 0.2) /
      steps_per_contact;
  Vec3 x(-radius, 0, 0), v(speed, slip, 0), w(0, 0, 0); // of the first; the second is its image by a half turn about z
  x += 0.3 * dt * v;                                    // so that the first step already sees an overlap
  ContactHistory history;
  Impact out;
  for (bool touched = false;; out.duration += dt)
    {
      const ContactPair pair{x, v, w, -x, -v, w, radius, radius};
      const ContactForce f = contact_force(law, pair, dt, history);
      if (touched && !f.touching)
        break;
      touched |= f.touching;
      out.overlap = std::max(out.overlap, f.overlap);
      v += dt / mass * -f.force;
      w += dt / inertia * f.torque1;
      x += dt * v;
    }
  const Vec3 n = -x.normalized();
  out.restitution = -v.dot(n) / speed;
  out.tangential = v.y() / (slip != 0 ? slip : 1);
  out.spin = w.z();
  const double before = 0.5 * mass * (speed * speed + slip * slip);
  out.energy_change = (0.5 * mass * v.squaredNorm() + 0.5 * inertia * w.squaredNorm()) / before - 1;
  return out;
}

/// Two equal spheres whose overlap and slip are set; their contact does not turn.
class Bench
{
public:
  explicit Bench(const HertzMindlin &law, double overlap) : law_(law), overlap_(overlap) { step(0, 0); }

  /// Moves by so much, in steps so small that the path is followed.   @return work done on the contact by slip, J
  double go(double overlap_change, double slip, int steps = 2000)
  {
    double work = 0;
    for (int i = 0; i < steps; ++i)
      work += step(overlap_change / steps, slip / steps);
    return work;
  }
  double shear() const { return -history_.shear_force.y(); } ///< N, of the same sign as slip
  double normal() const { return law_.normal_force(r1, r1, overlap_); }
  double overlap() const { return overlap_; }

private:
  double step(double overlap_change, double slip)
  {
    overlap_ += overlap_change;
    const double before = shear();
    const double spin = -slip / (2 * r1); // slip by spins alone: v_r = -(R1 w1 + R2 w2) x n along y
    const ContactPair pair{Vec3::Zero(),
                           Vec3::Zero(),
                           Vec3(0, 0, spin),
                           Vec3(2 * r1 - overlap_, 0, 0),
                           Vec3::Zero(),
                           Vec3(0, 0, spin),
                           r1,
                           r1};
    contact_force(law_, pair, 1, history_);
    return 0.5 * (before + shear()) * slip;
  }
  HertzMindlin law_;
  double overlap_;
  ContactHistory history_;
};
} // namespace

class LammpsPath : public testing::TestWithParam<const char *>
{};

TEST_P(LammpsPath, IsFollowedToRoundOff)
{
  const DrivenPath path = read_path(GetParam());
  ASSERT_GE(path.pairs.size(), 1200u);
  const bool shear = std::string(GetParam()) == "shear";
  const HertzMindlin law = HertzMindlin().with({true, !shear, !shear});
  ContactHistory history;
  std::array<double, 3> error{}, largest{};
  std::size_t sliding = 0, sticking = 0, opened = 0, rolling = 0;
  for (std::size_t i = 0; i < path.pairs.size(); ++i)
    {
      const ContactForce f = contact_force(law, path.pairs[i], 5e-8, history);
      const std::array<Vec3, 3> got{f.force, f.torque1, f.torque2};
      for (int q = 0; q < 3; ++q)
        {
          error[q] = std::max(error[q], (got[q] - path.expected[i][q]).norm());
          largest[q] = std::max(largest[q], path.expected[i][q].norm());
        }
      const double fs = history.shear_force.norm(), limit = law.friction * f.normal_force;
      rolling += law.yield({r1, r2, f.overlap, f.normal_force, history}, yield_round_off).rolling;
      opened += !f.touching, sliding += f.touching && fs >= 0.999999 * limit, sticking += fs > 0 && fs < 0.99 * limit;
    }
  for (int q = 0; q < 3; ++q)
    EXPECT_BELOW_BECAUSE(error[q], 1e-12 * largest[q], "round-off of sums of some thousand increments");
  EXPECT_EQ(rolling > 200, std::string(GetParam()) == "roll");
  if (shear)
    {
      EXPECT_GT(sliding, 200u);
      EXPECT_GT(sticking, 200u);
      EXPECT_GT(opened, 10u);
    }
}
INSTANTIATE_TEST_SUITE_P(Pairs, LammpsPath, testing::Values("shear", "roll", "twist"),
                         [](const auto &path) { return std::string(path.param); });

TEST(HertzMindlin, NormalImpactIsThatOfHertz)
{
  // Johnson, Contact Mechanics (1985), section 11.4, two spheres of mass m, R* = R/2, m* = m/2, V = 2 v
  const HertzMindlin law;
  const double radius = 1e-4, speed = 0.1, mass = 4.0 / 3.0 * M_PI * std::pow(radius, 3) * 2650;
  const double overlap =
      std::pow(15 * mass / 2 * std::pow(2 * speed, 2) / (16 * law.contact_modulus() * std::sqrt(radius / 2)), 0.4);
  const double duration = 2.9432 * overlap / (2 * speed);
  double error[3];
  for (int k = 0; k < 3; ++k)
    {
      const Impact seen = impact(law, radius, speed, 0, 50 << (2 * k));
      error[k] = std::abs(seen.restitution - 1);
      EXPECT_CLOSE_BECAUSE(seen.overlap, overlap, 2.0 / (50 << (2 * k)), "the peak falls between two steps");
      EXPECT_CLOSE_BECAUSE(seen.duration, duration, 2.5 / (50 << (2 * k)), "it ends with a step that sees no overlap");
    }
  EXPECT_BELOW_BECAUSE(error[2], 0.02 * error[0], "falls with the square of the step but where it ends between two");
}

TEST(HertzMindlin, ObliqueImpactThatSlidesLosesWhatFrictionTakes)
{
  // Thornton, Ning, Wu, Nasrullah & Li (2001): sliding throughout, tangential impulse = mu normal impulse; rebound
  // speed v_t - mu (1 + e) v_n, spin 5/2 mu (1 + e) v_n/R, here of each of two spheres that meet with 2 v_n
  const HertzMindlin law;
  const double radius = 1e-4, speed = 0.1, slip = 0.3;
  const Impact seen = impact(law, radius, speed, slip, 2000);
  ASSERT_GT(slip, 3.5 * law.friction * 2 * speed) << "slides to the end";
  EXPECT_CLOSE_BECAUSE(seen.tangential * slip, slip - law.friction * 2 * speed, 3e-3,
                       "the contact tilts by some u/R = 3e-3 while it lasts");
  EXPECT_CLOSE_BECAUSE(std::abs(seen.spin), 2.5 * law.friction * 2 * speed / radius, 5e-3,
                       "the contact tilts by some u/R = 3e-3 while it lasts, and torque has the arm R - u/2");
}

TEST(HertzMindlin, ObliqueImpactThatSticksGivesBackLessThanItTook)
{
  // the contact point swings back and forth while the contact lasts, from once at the larger angles to twice
  const HertzMindlin law;
  const double radius = 1e-4, speed = 0.1;
  for (const double slip : {0.01, 0.02, 0.05, 0.1, 0.2})
    {
      const Impact seen = impact(law, radius, speed, slip, 2000);
      const double after = seen.tangential * slip - std::abs(seen.spin) * radius;
      EXPECT_LT(std::abs(after), slip) << slip;
      EXPECT_EQ(after<0, slip> 0.05) << slip << ", " << after;
      EXPECT_LT(seen.energy_change, 0) << slip;
      EXPECT_GT(seen.energy_change, -slip * slip / (slip * slip + speed * speed)) << slip;
    }
}

TEST(HertzMindlin, TangentialLoadingIsThatOfMindlinAndDeresiewiczAtBothEnds)
{
  // under constant N: dT/d(slip) = 8 G* a at first, T = mu N [1 - (1 - slip/s)^(3/2)] up to s = 3 mu N/(16 G* a)
  const HertzMindlin law;
  const double overlap = 2e-7, radius = std::sqrt(r1 / 2 * overlap);
  const double stiffness = 2 * law.young / ((1 + law.poisson) * (2 - law.poisson)) * radius;
  Bench bench(law, overlap);
  const double limit = law.friction * bench.normal(), end = 1.5 * limit / stiffness;
  double most = 0;
  for (int k = 1; k <= 300; ++k)
    {
      bench.go(0, 0.01 * end / 2, 20);
      const double slip = 0.005 * k * end;
      const double exact = limit * (slip < end ? 1 - std::pow(1 - slip / end, 1.5) : 1);
      if (k == 1)
        {
          EXPECT_CLOSE_BECAUSE(bench.shear(), stiffness * slip, 1e-9, "round-off; no slip in the area of contact");
          EXPECT_CLOSE_BECAUSE(bench.shear(), exact, 2e-3, "partial slip at a two-hundredth of the way to sliding");
        }
      most = std::max(most, std::abs(bench.shear() - exact) / limit);
    }
  EXPECT_CLOSE_BECAUSE(bench.shear(), limit, 1e-9, "round-off");
  EXPECT_NEAR_BECAUSE(most, std::pow(1.0 / 3.0, 1.5), 2e-3,
                      "partial slip is left out: T = mu N where it is 0.81 of it");
}

TEST(HertzMindlin, NoClosedCycleCreatesEnergy)
{
  // loaded, sheared, unloaded and sheared back, in all orders; the contact does not slide
  HertzMindlin law;
  law.friction = 1e3;
  const double deep = 4e-7, shallow = 1e-7, slip = 1e-8;
  Bench unloaded_under_shear(law, deep);
  double work = unloaded_under_shear.go(0, slip);
  const double held = work;
  work += unloaded_under_shear.go(shallow - deep, 0) + unloaded_under_shear.go(0, -slip);
  EXPECT_CLOSE_BECAUSE(work, 0.5 * held, 1e-3, "kn fell to a half: so did the force, and the work that comes back");
  EXPECT_NEAR_BECAUSE(unloaded_under_shear.shear() / (held / slip), 0, 1e-9, "round-off: the spring is where it was");

  Bench loaded_under_shear(law, shallow);
  work = loaded_under_shear.go(0, slip);
  const double first = work;
  work += loaded_under_shear.go(deep - shallow, 0);
  const double back = slip / 2; // the force is unchanged and the contact twice as stiff
  work += loaded_under_shear.go(0, -back);
  EXPECT_CLOSE_BECAUSE(work, 0.5 * first, 1e-3, "half of the work comes back from a spring twice as stiff");
  EXPECT_NEAR_BECAUSE(loaded_under_shear.shear() / (first / slip), 0, 1e-9, "round-off");
}

TEST(HertzMindlin, MomentsShrinkWithTheContactToo)
{
  // rolled and twisted while pressed hard, turned back while pressed lightly: half of the energy comes back
  HertzMindlin law;
  law.rolling_limit = 1e3;
  ContactHistory history;
  const auto step = [&](double overlap, const Vec3 &turn) { // turn of the second against the first sphere
    const ContactPair pair{Vec3::Zero(), Vec3::Zero(), -0.5 * turn, Vec3(2 * r1 - overlap, 0, 0),
                           Vec3::Zero(), 0.5 * turn,   r1,          r1};
    const Vec3 before = history.bending_moment + history.twisting_moment;
    contact_force(law, pair, 1, history);
    return -0.5 * (before + history.bending_moment + history.twisting_moment).dot(turn);
  };
  const Vec3 turn(1e-6, 2e-6, -1e-6);
  const auto go = [&](double overlap, const Vec3 &whole) {
    double work = 0;
    for (int k = 0; k < 2000; ++k)
      work += step(overlap, whole / 2000);
    return work;
  };
  step(4e-7, Vec3::Zero());
  const double held = go(4e-7, turn);
  step(1e-7, Vec3::Zero());
  const double back = -go(1e-7, -turn);
  EXPECT_GT(held, 0);
  EXPECT_CLOSE_BECAUSE(back, 0.5 * held, 2e-3, "kn fell to a half: so did the moments, and the work that comes back");
  EXPECT_BELOW_BECAUSE((history.bending_moment + history.twisting_moment).norm(), 1e-9 * held / turn.norm(),
                       "round-off");
}

/// Spheres, asperities of a power between, and cones.
class OfExponent : public testing::TestWithParam<double>
{
protected:
  OfExponent() { law.exponent = GetParam(); }
  HertzMindlin law;
};
INSTANTIATE_TEST_SUITE_P(Shapes, OfExponent, testing::Values(1.5, 1.7, 2.0));

TEST_P(OfExponent, ForceIsThatOfTheElasticHalfSpace)
{
  // by reduction of the dimension (Popov, Hess and Willert, 2019, section 2.3): with the gap f(r),
  // g(x) = x int_0^x f'(r)/sqrt(x^2 - r^2) dr, u = g(a), F = 2 E* int_0^a [u - g(x)] dx; r = x sin t
  const double reduced = r1 * r2 / (r1 + r2), edge = law.asperity * reduced, m = 1 / (law.exponent - 1);
  const auto slope = [&](double r) { return m * edge * edge / (2 * reduced) * std::pow(r / edge, m - 1) / edge; };
  const int n = 4000;
  const auto g = [&](double x) {
    double sum = 0;
    for (int k = 0; k < n; ++k)
      sum += slope(x * std::sin(M_PI / 2 * (k + 0.5) / n)) * M_PI / 2 / n;
    return x * sum;
  };
  for (const double radius : {0.1 * edge, edge, 3 * edge})
    {
      const double u = g(radius);
      double area = 0;
      for (int k = 0; k < 400; ++k)
        area += (u - g(radius * (k + 0.5) / 400)) * radius / 400;
      EXPECT_CLOSE_BECAUSE(law.normal_stiffness(r1, r2, u), 2 * law.contact_modulus() * radius, 1e-6,
                           "midpoint rule of 4,000 parts; kn = 2 E* a");
      EXPECT_CLOSE_BECAUSE(law.normal_force(r1, r2, u), 2 * law.contact_modulus() * area, 1e-5,
                           "midpoint rule of 400 parts");
    }
}

TEST_P(OfExponent, WallIsThePlaneOfSymmetryOfTwoGrains)
{
  for (const double overlap : {1e-9, 1e-7, 1e-5})
    {
      const WallResponse wall = law.wall(r1, overlap);
      EXPECT_CLOSE_BECAUSE(wall.force, law.normal_force(r1, r1, 2 * overlap), 1e-14, "round-off");
      EXPECT_CLOSE_BECAUSE(wall.stiffness, 2 * law.normal_stiffness(r1, r1, 2 * overlap), 1e-14, "round-off");
      EXPECT_CLOSE_BECAUSE(law.wall_energy(r1, overlap, wall.force),
                           0.5 * law.normal_energy(2 * overlap, wall.force, 0), 1e-14, "round-off");
    }
}

TEST_P(OfExponent, StiffnessAndEnergyBelongToTheForce)
{
  const double u = 3e-7, h = 1e-4 * u;
  const double slope = (law.normal_force(r1, r2, u + h) - law.normal_force(r1, r2, u - h)) / (2 * h);
  EXPECT_CLOSE_BECAUSE(law.stiffness(r1, r2, u).normal, slope, 1e-8, "central difference with a step of 1e-4");
  const ContactHistory history;
  const auto energy = [&](double overlap) {
    return law.energy({r1, r2, overlap, law.normal_force(r1, r2, overlap), history}).normal;
  };
  EXPECT_CLOSE_BECAUSE((energy(u + h) - energy(u - h)) / (2 * h), law.normal_force(r1, r2, u), 1e-8,
                       "central difference with a step of 1e-4");
  EXPECT_CLOSE_BECAUSE(law.stiffness(r1, r2, u).shear / law.stiffness(r1, r2, u).normal, 2 * 0.88 / 1.88, 1e-14,
                       "round-off");
  // of two grains under this pressure: fn = 4 R^2 p, modulus = kn/R
  const double p = 1e5;
  double below = 1e-12 * r1, above = r1;
  for (int k = 0; k < 200; ++k)
    {
      const double middle = std::sqrt(below * above);
      (law.normal_force(r1, r1, middle) < 4 * r1 * r1 * p ? below : above) = middle;
    }
  EXPECT_CLOSE_BECAUSE(law.modulus(p), law.normal_stiffness(r1, r1, below) / r1, 1e-13, "round-off of a bisection");
}

TEST_P(OfExponent, ClosedCycleGivesBackAsMuchLessAsTheContactIsSofter)
{
  law.friction = 1e3; // does not slide
  const double deep = 4e-7, shallow = 1e-7, slip = 1e-8;
  Bench bench(law, deep);
  const double held = bench.go(0, slip);
  const double work = held + bench.go(shallow - deep, 0) + bench.go(0, -slip);
  EXPECT_CLOSE_BECAUSE(work, (1 - std::pow(4, 1 - law.exponent)) * held, 1e-3, "kn ~ u^(n-1), and so the force");
}
} // namespace isostat
