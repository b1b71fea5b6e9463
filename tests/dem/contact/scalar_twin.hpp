// SPDX-License-Identifier: BSD-3-Clause
// What the contact loop is tested against: contact_force() over all pairs of a random cloud, and the misfit of both.
#pragma once
#include "dem/contact/dashpot.hpp"
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/contact/loop.hpp"
#include "tests/dem/contact/random_cloud.hpp"

#include <gtest/gtest.h>

namespace isostat::test
{
inline constexpr double dt = 5e-8; // s

/// What one force evaluation leaves behind.
struct Outcome
{
  AlignedVector<double> action; ///< [F 0 T 0] per grain
  std::vector<ContactHistory> histories;
  DissipationPerPair loss;
};

/// History that the parts of the law which are off do not have.
inline ContactHistory masked(const ContactHistory &h, const RollingResistance &law)
{
  const LawFeatures on = law.active();
  const Vec3 zero = Vec3::Zero();
  if (!on.friction)
    return {};
  return {h.normal, h.shear_force, on.rolling ? h.bending_moment : zero, on.twisting ? h.twisting_moment : zero,
          law.stiffness_varies() ? h.own : std::vector<double>()};
}

inline double spring_energy(const Vec3 &force, double stiffness)
{
  return stiffness > 0 ? 0.5 * force.squaredNorm() / stiffness : 0;
}

/// What a spring loses when its stiffness changes from k0 to k while the force of the step before, f0, is kept
/// except for what a shrinking contact gives up.
inline double loss_of_change(const Vec3 &f0, double k0, double k)
{
  return f0.norm() > 0 ? spring_energy(f0, k0) - spring_energy(std::min(1.0, k / k0) * f0, k) : 0;
}

/// Losses of a pair from the scalar law alone: without limits it gives the trial state, which differs from the history
/// that has only turned by the increments.
template <typename Concrete>
void scalar_loss(const Concrete &law, const ContactPair &pair, const ContactHistory &past, const ContactHistory &now,
                 bool touching, std::size_t p, DissipationPerPair &loss)
{
  const Vec3 branch = pair.x2 - pair.x1, n = branch.normalized(), point = 0.5 * (branch + (pair.r1 - pair.r2) * n);
  const ContactStiffness k = law.stiffness(pair.r1, pair.r2, pair.r1 + pair.r2 - branch.norm());
  const double growth = past.own.empty() || past.own[0] == 0 ? 1 : past.own[0] * k.normal; // kn over that of before
  if (!touching)
    {
      const ContactStiffness unit = law.stiffness(pair.r1, pair.r2, pair.r1); // any overlap: ratios are the same
      const double before = past.own.empty() ? 1 : 1 / (past.own[0] * unit.normal);
      loss.released[p] = spring_energy(past.shear_force, before * unit.shear) +
                         spring_energy(past.bending_moment, before * unit.rolling) +
                         spring_energy(past.twisting_moment, before * unit.twisting);
      return;
    }
  Concrete unlimited = law;
  unlimited.friction = unlimited.rolling_limit = 1e30;
  ContactHistory trial = past;
  contact_force(unlimited, pair, dt, trial);
  const Vec3 law_slip =
      (pair.r1 + pair.r2) / branch.norm() * (pair.v2 - pair.v1) - (pair.r2 * pair.w2 + pair.r1 * pair.w1).cross(n);
  const Vec3 dw = pair.w2 - pair.w1;
  const Vec3 turned_force = trial.shear_force + k.shear * dt * (law_slip - n * n.dot(law_slip));
  const Vec3 turned_moment = trial.bending_moment + k.rolling * dt * (dw - n * n.dot(dw));
  const Vec3 turned_twist = trial.twisting_moment + k.twisting * dt * n * n.dot(dw);
  const auto change = [&](const Vec3 &turned, double stiffness) { // turned has shrunk already
    return growth == 1 ? 0 : loss_of_change(turned / std::min(1.0, growth), stiffness / growth, stiffness);
  };

  const Vec3 mid_force = 0.5 * (turned_force + now.shear_force);
  loss.sliding[p] = mid_force.dot(trial.shear_force - now.shear_force) / k.shear + change(turned_force, k.shear);
  // the law measures slip with arms R1, R2; its force acts at the contact point
  const Vec3 true_slip = pair.v2 - pair.v1 + pair.w2.cross(point - branch) - pair.w1.cross(point);
  loss.created[p] = dt * mid_force.dot(true_slip - law_slip);
  if (k.rolling > 0)
    loss.rolling[p] =
        0.5 * (turned_moment + now.bending_moment).dot(trial.bending_moment - now.bending_moment) / k.rolling +
        change(turned_moment, k.rolling);
  if (k.twisting > 0)
    loss.rolling[p] += change(turned_twist, k.twisting);
}

/// Force that the dashpot of a touching pair adds, on the second grain; what it dissipates goes to loss.viscous.
inline Vec3 scalar_dashpot(const RollingResistance &law, const ContactPair &pair, double m1, double m2,
                           const ContactForce &f, double beta, double &loss)
{
  const Vec3 n = (pair.x2 - pair.x1).normalized();
  const double speed = n.dot(pair.v2 - pair.v1), kn = law.normal_stiffness(pair.r1, pair.r2, f.overlap);
  const double drag = dashpot_force(beta, kn, m1, m2, f.normal_force, speed);
  loss = dt * drag * speed;
  return -drag * n;
}

/// The same by the scalar law, pair after pair; `see(p)` gives pair p as the law sees it.
template <typename Concrete, typename See>
Outcome scalar_outcome(const Concrete &law, const Cloud &cloud, const See &see, double beta = 0)
{
  Outcome out;
  const Packing &g = cloud.packing;
  out.action.assign(8 * (g.n_grains() + Packing::n_padding), 0.0);
  out.loss.resize(cloud.pairs.size());
  for (std::size_t p = 0; p < cloud.pairs.size(); ++p)
    {
      const auto [i, j] = cloud.pairs[p];
      const ContactPair pair = see(p);
      const ContactHistory past = masked(cloud.histories[p], law);
      ContactHistory now = past;
      ContactForce f = contact_force(law, pair, dt, now);
      if (f.touching && beta > 0)
        f.force += scalar_dashpot(law, pair, g.mass(i), g.mass(j), f, beta, out.loss.viscous[p]);
      for (int k = 0; k < 3; ++k)
        {
          out.action[8 * i + k] -= f.force[k];
          out.action[8 * j + k] += f.force[k];
          out.action[8 * i + 4 + k] += f.torque1[k];
          out.action[8 * j + 4 + k] += f.torque2[k];
        }
      out.histories.push_back(masked(now, law));
      if (law.active().friction)
        scalar_loss(law, pair, past, now, f.touching, p, out.loss);
    }
  return out;
}

/// Pair p as it is, without periodic images.
inline ContactPair pair_in_box(const Cloud &cloud, std::size_t p)
{
  const Packing &g = cloud.packing;
  const auto [i, j] = cloud.pairs[p];
  return {g.centre(i),          g.linear_velocity(i),  g.angular_velocity(i), g.centre(j),
          g.linear_velocity(j), g.angular_velocity(j), g.radius(i),           g.radius(j)};
}

/// Largest |a - b| over largest |b|; `pick` gives a vector of an element.
template <typename Container, typename Pick>
double misfit(const Container &a, const Container &b, std::size_t n, const Pick &pick)
{
  double error = 0, scale = 0;
  for (std::size_t i = 0; i < n; ++i)
    {
      error = std::max(error, (pick(a, i) - pick(b, i)).norm());
      scale = std::max(scale, pick(b, i).norm());
    }
  return scale > 0 ? error / scale : error;
}

/// Worst misfit of everything that a force evaluation leaves behind.
inline double misfit(const Outcome &a, const Outcome &b, bool with_energy)
{
  using Histories = std::vector<ContactHistory>;
  using Numbers = AlignedVector<double>;
  const std::size_t n = b.histories.size(), grains = b.action.size() / 8;
  auto record = [](std::size_t offset) {
    return [=](const Numbers &v, std::size_t i) { return Vec3(&v[8 * i + offset]); };
  };
  auto member = [](auto m) { return [=](const Histories &h, std::size_t i) { return h[i].*m; }; };
  auto number = [](const Numbers &v, std::size_t i) { return Vec3(v[i], 0, 0); };
  double worst = std::max(misfit(a.action, b.action, grains, record(0)), misfit(a.action, b.action, grains, record(4)));
  for (auto m : {&ContactHistory::normal, &ContactHistory::shear_force, &ContactHistory::bending_moment,
                 &ContactHistory::twisting_moment})
    worst = std::max(worst, misfit(a.histories, b.histories, n, member(m)));
  const auto own = [](const Histories &h, std::size_t i) { // kn^2, in proportion to the overlap, as its round-off is
    return h[i].own.empty() || h[i].own[0] == 0 ? Vec3(0, 0, 0) : Vec3(std::pow(h[i].own[0], -2), 0, 0);
  };
  worst = std::max(worst, misfit(a.histories, b.histories, n, own));
  if (with_energy && !a.loss.sliding.empty())
    for (auto m : {&DissipationPerPair::sliding, &DissipationPerPair::rolling, &DissipationPerPair::released,
                   &DissipationPerPair::created, &DissipationPerPair::viscous})
      worst = std::max(worst, misfit(a.loss.*m, b.loss.*m, n, number));
  return worst;
}

struct Variant
{
  const char *name;
  bool friction, rolling, twisting;
};
inline constexpr Variant variants[] = {{"frictionless", false, false, false},
                                       {"sliding", true, false, false},
                                       {"rolling", true, true, false},
                                       {"twisting", true, false, true},
                                       {"full", true, true, true}};

template <typename Concrete = LinearRolling>
Concrete law_of(const Variant &v)
{
  Concrete law;
  law.twisting_stiffness = 0.7; // other than alpha_r: a mix-up would show
  return law.with({v.friction, v.rolling, v.twisting});
}

/// Runs test(law) for all laws with these parts.
template <typename Test>
void for_each_law(const Variant &v, const Test &test)
{
  const auto run = [&](const auto &law) {
    SCOPED_TRACE(std::string(law.name()) + ", " + v.name);
    test(law);
  };
  run(law_of<LinearRolling>(v));
  run(law_of<HertzMindlin>(v));
  HertzMindlin pointed = law_of<HertzMindlin>(v);
  pointed.exponent = 1.8, pointed.asperity = 0.3; // forces of the size of the other laws in these clouds
  run(pointed);
}
} // namespace isostat::test
