// SPDX-License-Identifier: BSD-3-Clause
// Order of the time integration in dt: against exact solutions where there are any, else from differences between runs
// at dt and dt/2, which fall by 2^order. All start from a state at t = 0 that has velocities and histories half a step
// and a step old, as leapfrog wants them: with v(0) in the place of v(-dt/2) every order would be 1.
#include "dem/assembly/assembly.hpp"
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/io/text_tables.hpp"
#include "tests/support/near.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <set>

namespace isostat
{
namespace
{
/// Errors at dt, dt/2, dt/4, ...
struct Series
{
  std::string name;
  std::vector<double> errors;

  double order(std::size_t level) const { return std::log2(errors[level] / errors[level + 1]); }
  /// Of the whole series, least squares: what remains where single orders scatter.
  double mean_order() const
  {
    const double middle = 0.5 * static_cast<double>(errors.size() - 1);
    double above = 0, below = 0;
    for (std::size_t k = 0; k < errors.size(); ++k)
      {
        const double x = static_cast<double>(k) - middle;
        above -= x * std::log2(errors[k]);
        below += x * x;
      }
    return above / below;
  }
};

/// The orders of the finer half of the series: further up, terms of higher order still count.
void expect_order(const Series &s, double minimum, double maximum)
{
  for (std::size_t level = s.errors.size() / 2 - 1; level + 1 < s.errors.size(); ++level)
    {
      EXPECT_GE(s.order(level), minimum) << s.name << " at level " << level;
      EXPECT_LE(s.order(level), maximum) << s.name << " at level " << level;
    }
}

void set_velocities(Packing &grains, const Packing &base, double share, const Packing &increment)
{
  for (std::size_t i = 0; i < grains.n_grains(); ++i)
    {
      grains.set_linear_velocity(i, base.linear_velocity(i) + share * increment.linear_velocity(i));
      grains.set_angular_velocity(i, base.angular_velocity(i) + share * increment.angular_velocity(i));
    }
}

/// What a run at this dt starts from, given everything at t = 0: velocities at -dt/2, histories at -dt.
Snapshot leapfrog_start(const Snapshot &at_zero, double time_step, double damping)
{
  Snapshot start = at_zero, resting = at_zero;
  set_velocities(resting.grains, at_zero.grains, -1, at_zero.grains);
  Assembly kick(resting);
  kick.settings.time_step = time_step;
  kick.settings.damping = damping;
  kick.compute_forces();
  kick.move(kick.box());
  set_velocities(start.grains, at_zero.grains, -0.5, kick.packing()); // v(0) - dt/2 A(0)

  Assembly forward(start);
  forward.settings.time_step = time_step;
  forward.compute_forces();
  std::map<std::pair<std::uint32_t, std::uint32_t>, ContactHistory> next;
  for (const Contact &c : forward.snapshot().contacts)
    next[{c.first, c.second}] = c.history;
  for (Contact &c : start.contacts)
    {
      const ContactHistory &h = next.at({c.first, c.second});
      c.history.shear_force = 2 * c.history.shear_force - h.shear_force;
      c.history.bending_moment = 2 * c.history.bending_moment - h.bending_moment;
      c.history.twisting_moment = 2 * c.history.twisting_moment - h.twisting_moment;
      c.history.normal = (start.grains.centre(c.second) - start.grains.centre(c.first) -
                          time_step * (start.grains.linear_velocity(c.second) - start.grains.linear_velocity(c.first)))
                             .normalized();
    }
  return start;
}

/// Box at time t; the end of the run.
struct Drive
{
  std::function<RigidBox(double)> box;
  double duration, damping;
};

/// The state with forces after `n_steps` steps that fill the duration.
Assembly run(const Snapshot &at_zero, const Drive &drive, int n_steps)
{
  const double dt = drive.duration / n_steps;
  Assembly a(leapfrog_start(at_zero, dt, drive.damping));
  a.settings.time_step = dt;
  a.settings.damping = drive.damping;
  for (int k = 1; k <= n_steps; ++k)
    {
      a.compute_forces();
      a.move(drive.box(k * dt));
    }
  a.compute_forces();
  return a;
}

// --- two grains between two walls --------------------------------------------------------------------------------

constexpr double radius = 1e-4, squeeze = 1e-8; // m; overlap at rest, of the grains and with the walls

/// The law without yielding.
LinearRolling elastic_law()
{
  LinearRolling law = test::paper_law();
  law.friction = 10;
  law.rolling_limit = 10;
  return law;
}

/// Equal grains in line along x, held by the walls x- and x+ (kn = E R for walls, too), in balance and at rest.
Snapshot squeezed_pair()
{
  Snapshot s;
  s.law = elastic_law();
  const double x = radius - 0.5 * squeeze;
  s.grains = make_packing({Vec3(-x, 0, 0), Vec3(x, 0, 0)}, {radius, radius}, 2650);
  const double wall = x + radius - squeeze;
  s.box = {Vec3(-wall, -1e-3, -1e-3), Vec3(wall, 1e-3, 1e-3)};
  s.contacts.push_back({0, 1, squeeze, 0, {Vec3::UnitX(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}});
  return s;
}

TEST(Convergence, NormalOscillationIsOfSecondOrder)
{
  // Both modes of the pair, out of phase and in phase: x = a cos(w1 t) and b cos(w2 t) with m w1^2 = 2 kn + kw and
  // m w2^2 = kw. Amplitudes stay below the overlap, so the contacts stay closed and the motion is linear.
  Snapshot s = squeezed_pair();
  const double kn = s.law->stiffness(radius, radius, 0).normal, kw = s.law->wall(radius, 0).stiffness;
  const double m = s.grains.mass(0), w1 = std::sqrt((2 * kn + kw) / m), w2 = std::sqrt(kw / m);
  const double a = 0.3 * squeeze, b = 0.2 * squeeze, duration = 1e-6;
  const double x0[] = {s.grains.centre(0)[0], s.grains.centre(1)[0]};
  const auto place = [&](int i, double t) {
    return x0[i] + (i == 0 ? -1 : 1) * a * std::cos(w1 * t) + b * std::cos(w2 * t);
  };
  const auto speed = [&](int i, double t) {
    return -(i == 0 ? -1 : 1) * a * w1 * std::sin(w1 * t) - b * w2 * std::sin(w2 * t);
  };
  Series positions{"position / overlap", {}}, velocities{"velocity / (w1 overlap)", {}};
  for (int n_steps = 50; n_steps <= 1600; n_steps *= 2)
    {
      const double dt = duration / n_steps;
      Snapshot start = s;
      for (int i : {0, 1})
        {
          start.grains.set_centre(i, Vec3(place(i, 0), 0, 0));
          start.grains.set_linear_velocity(i, Vec3(speed(i, -0.5 * dt), 0, 0));
        }
      Assembly pair(start);
      pair.settings.time_step = dt;
      pair.settings.damping = 0;
      for (int k = 0; k < n_steps; ++k)
        {
          pair.compute_forces();
          pair.move(pair.box());
        }
      double x_error = 0, v_error = 0;
      for (int i : {0, 1})
        {
          x_error = std::max(x_error, std::abs(pair.packing().centre(i)[0] - place(i, duration)));
          v_error = std::max(v_error, std::abs(pair.packing().linear_velocity(i)[0] - speed(i, duration - 0.5 * dt)));
        }
      positions.errors.push_back(x_error / squeeze);
      velocities.errors.push_back(v_error / (w1 * squeeze));
    }
  expect_order(positions, 1.95, 2.05);
  expect_order(velocities, 1.95, 2.05);
}

TEST(Convergence, ElasticShearRollingAndTwistingAreOfSecondOrder)
{
  // Increments v dt with the velocity of the half step are midpoint steps. What is of first order, the rotation of the
  // histories (below), does not show where contacts turn by 1e-4 only, as they do in a packing.
  Snapshot s = squeezed_pair();
  s.grains.set_linear_velocity(0, Vec3(0, 0.02, 0));
  s.grains.set_linear_velocity(1, Vec3(0.01, -0.02, 0.01));
  s.grains.set_angular_velocity(0, Vec3(200, 100, 100));
  s.grains.set_angular_velocity(1, Vec3(-100, 150, -200));
  const Drive drive{[&](double) { return s.box; }, 1e-6, 0};
  Series position{"position", {}}, shear{"shear force", {}}, bending{"bending", {}}, twisting{"twisting", {}};
  std::vector<Assembly> runs;
  for (int n_steps = 50; n_steps <= 3200; n_steps *= 2)
    runs.push_back(run(s, drive, n_steps));
  for (std::size_t k = 0; k + 1 < runs.size(); ++k)
    {
      const Packing &coarse = runs[k].packing(), &fine = runs[k + 1].packing();
      const ContactHistory c = runs[k].snapshot().contacts.at(0).history,
                           f = runs[k + 1].snapshot().contacts.at(0).history;
      position.errors.push_back((coarse.centre(1) - fine.centre(1)).norm() / squeeze);
      shear.errors.push_back((c.shear_force - f.shear_force).norm() / f.shear_force.norm());
      bending.errors.push_back((c.bending_moment - f.bending_moment).norm() / f.bending_moment.norm());
      twisting.errors.push_back((c.twisting_moment - f.twisting_moment).norm() / f.twisting_moment.norm());
    }
  for (const Series &series : {position, shear, bending, twisting})
    expect_order(series, 1.9, 2.1);
}

// --- history under large rotation --------------------------------------------------------------------------------

TEST(Convergence, RotationOfHistoryIsOfFirstOrder)
{
  // A pair turns as one rigid body, so fs, mb and mt must turn with it. Two errors of first order: the rotation by n' x
  // n and s is one, of relative size |w| dt/2 per radian; and slip is taken across the normal at the end of the step
  // but from the velocities of its middle, which leaves (R1 + R2) |w|^2 dt/2 of slip rate, in fs only.
  const LinearRolling law = elastic_law();
  const Vec3 spin = 1e3 * Vec3(1, 2, -0.5).normalized(), n0 = Vec3::UnitX();
  const double duration = 1e-3, distance = 2 * radius * (1 - 1e-2);
  const ContactHistory begin{n0, Vec3(0, 3, 4), 1e-4 * Vec3(0, -2, 1), 1e-4 * Vec3(2, 0, 0)};
  Series shear{"shear force", {}}, bending{"bending", {}}, twisting{"twisting", {}};
  for (int n_steps = 2000; n_steps <= 32000; n_steps *= 2)
    {
      const double dt = duration / n_steps;
      const auto turned = [&](const Vec3 &z, double t) {
        return Vec3(Eigen::AngleAxisd(spin.norm() * t, spin.normalized()) * z);
      };
      ContactHistory h = begin;
      for (int k = 1; k <= n_steps; ++k)
        {
          const Vec3 half_branch = 0.5 * distance * turned(n0, k * dt);
          const Vec3 half_velocity = spin.cross(0.5 * distance * turned(n0, (k - 0.5) * dt));
          contact_force(law, {-half_branch, -half_velocity, spin, half_branch, half_velocity, spin, radius, radius}, dt,
                        h);
        }
      shear.errors.push_back((h.shear_force - turned(begin.shear_force, duration)).norm() / begin.shear_force.norm());
      bending.errors.push_back((h.bending_moment - turned(begin.bending_moment, duration)).norm() /
                               begin.bending_moment.norm());
      twisting.errors.push_back((h.twisting_moment - turned(begin.twisting_moment, duration)).norm() /
                                begin.twisting_moment.norm());
    }
  for (const Series &series : {shear, bending, twisting})
    {
      expect_order(series, 0.9, 1.1);
      EXPECT_BELOW_BECAUSE(series.errors.back(), 1e-3,
                           "first order: the finest of the steps turns by less than 1e-3 rad");
    }
}

// --- a packing ---------------------------------------------------------------------------------------------------

/// The stored packing of 1,000 grains at 200 kPa, grains at rest at t = 0.
Snapshot packing_at_rest(const LinearRolling &law)
{
  Snapshot s = import_tables(ISOSTAT_SOURCE_DIR "/tests/reference/n1000/medium", law, 2650);
  set_velocities(s.grains, s.grains, -1, s.grains);
  return s;
}

double distance(const Packing &a, const Packing &b)
{
  double sum = 0;
  for (std::size_t i = 0; i < a.n_grains(); ++i)
    sum += (a.centre(i) - b.centre(i)).squaredNorm();
  return std::sqrt(sum);
}

struct PackingSeries
{
  Series position{"position", {}}, stress{"wall stress", {}};
  std::size_t opened = 0, closed = 0, sliding = 0; ///< contacts, start against end of the finest run
};

void compare_ends(const Snapshot &start, const Snapshot &end, PackingSeries &series)
{
  std::set<std::pair<std::uint32_t, std::uint32_t>> before, after;
  for (const Contact &c : start.contacts)
    before.insert({c.first, c.second});
  for (const Contact &c : end.contacts)
    {
      after.insert({c.first, c.second});
      series.closed += !before.contains({c.first, c.second});
      series.sliding += end.law->yield(end.closed(c), yield_round_off).sliding;
    }
  for (const auto &pair : before)
    series.opened += !after.contains(pair);
}

/// Constant-volume shear by `strain` sin^2(pi t/2T), T = 200 of the longest steps (a wave crosses the box in about 50);
/// differences between runs at dt and dt/2 over the way of the grains and the change of stress.
PackingSeries sheared_packing(const Snapshot &s, double strain, double damping)
{
  const double duration = 8e-6;
  const RigidBox reference = s.box;
  const auto box = [&](double t) {
    return reference.strained(isochoric(strain * std::pow(std::sin(0.5 * M_PI * t / duration), 2)));
  };
  std::vector<Assembly> runs;
  for (int n_steps = 200; n_steps <= 3200; n_steps *= 2)
    runs.push_back(run(s, {box, duration, damping}, n_steps));
  Assembly zero(s);
  zero.settings.time_step = 1e-8;
  zero.compute_forces();
  const double way = distance(runs.back().packing(), s.grains);
  const double change = (runs.back().wall_stress() - zero.wall_stress()).norm();
  PackingSeries series;
  for (std::size_t k = 0; k + 1 < runs.size(); ++k)
    {
      series.position.errors.push_back(distance(runs[k].packing(), runs[k + 1].packing()) / way);
      series.stress.errors.push_back((runs[k].wall_stress() - runs[k + 1].wall_stress()).norm() / change);
    }
  compare_ends(s, runs.back().snapshot(), series);
  return series;
}

TEST(Convergence, ElasticPackingIsOfSecondOrder)
{
  // A strain so small that no contact opens, closes or yields, and so large that the errors are above round-off
  // (1e-16 of positions is 1e-9 of the way of the grains).
  const PackingSeries s = sheared_packing(packing_at_rest(elastic_law()), 1e-7, 0);
  EXPECT_EQ(s.opened + s.closed + s.sliding, 0u);
  expect_order(s.position, 1.9, 2.1);
  expect_order(s.stress, 1.9, 2.1);
  EXPECT_BELOW_BECAUSE(s.position.errors[0], 2e-4, "second order at the longest step");
}

TEST(Convergence, YieldingPackingIsOfFirstOrder)
{
  // Contacts change at steps, not between them. The return to the friction limit is a backward Euler step in the
  // direction of slip; a contact that closes counts the slip of its whole first step; one that opens drops its twisting
  // moment, which has no limit, at a step. All are of first order, and each event has an error of its own: orders
  // scatter, their mean over the series is what is asked for.
  for (const double strain : {1e-5, 1e-4})
    {
      const PackingSeries s = sheared_packing(packing_at_rest(test::paper_law()), strain, 0);
      EXPECT_GT(s.sliding, 10u);
      EXPECT_GT(s.position.mean_order(), 0.7);
      EXPECT_LT(s.position.mean_order(), 1.7);
      EXPECT_GT(s.stress.mean_order(), 0.7);
      EXPECT_BELOW_BECAUSE(s.position.errors[0], 2e-3, "first order at the longest step: 1e-3 of the way");
    }
}

TEST(Convergence, LocalDampingIsOfFirstOrder)
{
  // Damping changes by 2 d |A| where a velocity passes zero, and does so at the next step: an error of the impulse of
  // up to d |A| dt each time.
  const PackingSeries elastic = sheared_packing(packing_at_rest(elastic_law()), 1e-7, 0.2);
  EXPECT_EQ(elastic.opened + elastic.closed + elastic.sliding, 0u);
  expect_order(elastic.position, 0.8, 1.3);
  EXPECT_GT(elastic.stress.mean_order(), 0.8);
  const PackingSeries s = sheared_packing(packing_at_rest(test::paper_law()), 1e-5, 0.2);
  EXPECT_GT(s.position.mean_order(), 0.7);
  EXPECT_LT(s.position.mean_order(), 1.7);
  EXPECT_BELOW_BECAUSE(s.position.errors[0], 2e-3, "first order at the longest step: 1e-3 of the way");
}
} // namespace
} // namespace isostat
