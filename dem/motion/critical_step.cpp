// SPDX-License-Identifier: BSD-3-Clause
#include "dem/motion/critical_step.hpp"

#include "dem/contact/dashpot.hpp"

#include <algorithm>
#include <cmath>

namespace isostat
{
namespace
{
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec6 = Eigen::Matrix<double, 6, 1>;
/// Of the radius: where a law whose stiffness grows with overlap is asked for that of grains which do not touch yet.
constexpr double overlap_expected = 0.01;

/// One closed contact as an elastic element.
struct ElasticContact
{
  std::uint32_t first, second;
  Vec3 normal;
  double radius1, radius2;
  ContactStiffness k;
};

std::vector<ElasticContact> closed_contacts(const ContactLaw &law, const Packing &packing, const ContactList &contacts)
{
  std::vector<ElasticContact> elements;
  elements.reserve(contacts.n_pairs());
  for (std::size_t p = 0; p < contacts.n_lanes(); ++p)
    {
      const std::uint32_t i = contacts.first()[p], j = contacts.second()[p];
      const Vec3 branch = contacts.branch(packing, p);
      const double r1 = packing.radius(i), r2 = packing.radius(j), distance = branch.norm();
      if (distance < r1 + r2)
        elements.push_back({i, j, branch / distance, r1, r2, law.stiffness(r1, r2, r1 + r2 - distance)});
    }
  return elements;
}

/// Stiffness block of one body: `sign` -1 for the first, +1 for the second grain of the contact.
Mat6 body_block(const ElasticContact &e, double radius, double sign)
{
  const Mat3 nn = e.normal * e.normal.transpose(), tangential = Mat3::Identity() - nn;
  const Mat3 coupling = sign * e.k.shear * radius * cross_matrix(e.normal);
  Mat6 block;
  block.topLeftCorner<3, 3>() = e.k.normal * nn + e.k.shear * tangential;
  block.topRightCorner<3, 3>() = coupling;
  block.bottomLeftCorner<3, 3>() = coupling.transpose();
  block.bottomRightCorner<3, 3>() = (e.k.shear * radius * radius + e.k.rolling) * tangential + e.k.twisting * nn;
  return block;
}

template <typename Visit>
void for_wall_contacts(const ContactLaw &law, const Packing &packing, const RigidBox *walls, const Visit &visit)
{
  for (std::size_t i = 0; walls && i < packing.n_grains(); ++i)
    for (int wall = 0; wall < 6; ++wall)
      if (const double overlap = -wall_gap(packing, *walls, i, wall); overlap > 0)
        visit(i, wall / 2, law.wall(packing.radius(i), overlap).stiffness);
}

/// Upper bound of the largest eigenvalue of a symmetric positive matrix: |B^8|_F^(1/8).
double eigenvalue_bound(const Mat6 &b)
{
  const double scale = b.trace();
  if (!(scale > 0))
    return 0;
  Mat6 power = b / scale;
  for (int k = 0; k < 3; ++k)
    power = (power * power).eval();
  return scale * std::pow(power.norm(), 0.125);
}

using Blocks = std::vector<Mat6, Eigen::aligned_allocator<Mat6>>;

/// M^-1/2 B M^-1/2
Mat6 scaled_block(const Packing &packing, std::size_t i, const Mat6 &block)
{
  Vec6 scale;
  scale.head<3>().setConstant(std::sqrt(packing.velocity[4 * i + 3]));
  scale.tail<3>().setConstant(std::sqrt(packing.spin[4 * i + 3]));
  return scale.asDiagonal() * block * scale.asDiagonal();
}

/// Two smallest grains that meet: what may come about before the next review, in a cloud or a liquid where little is
/// closed now.
struct SmallestPair
{
  SmallestPair(const ContactLaw &law, const Packing &packing)
      : radius(packing.min_radius()), mass(4.0 / 3.0 * M_PI * radius * radius * radius * packing.density),
        k(law.stiffness(radius, radius, overlap_expected * radius))
  {}

  /// Each is held by one more contact on the far side.
  double eigenvalue() const
  {
    const double inertia = 0.4 * mass * radius * radius;
    return 2 * std::max((2 * k.normal + 2 * k.shear) / mass,
                        (2 * (k.shear * radius * radius + k.rolling) + k.twisting) / inertia);
  }
  /// The same of their dashpots.
  double damping(double contact_damping) const
  {
    return 4 * dashpot_coefficient(contact_damping, k.normal, mass, mass) / mass;
  }

  double radius, mass;
  ContactStiffness k;
};

/// y = M^-1/2 K M^-1/2 x on 6 components per grain.
struct ScaledStiffness
{
  const Packing &packing;
  const std::vector<ElasticContact> &elements;
  const std::vector<Vec3> &wall_stiffness_of;

  void apply(const std::vector<Vec6> &x, std::vector<Vec6> &y) const
  {
    const std::size_t n = packing.n_grains();
    auto scaled = [&](std::size_t i, const Vec6 &v) {
      Vec6 s = v;
      s.head<3>() *= std::sqrt(packing.velocity[4 * i + 3]);
      s.tail<3>() *= std::sqrt(packing.spin[4 * i + 3]);
      return s;
    };
    std::vector<Vec6> u(n);
    for (std::size_t i = 0; i < n; ++i)
      {
        u[i] = scaled(i, x[i]);
        y[i].setZero();
        y[i].head<3>() = wall_stiffness_of[i].cwiseProduct(u[i].head<3>());
      }
    for (const ElasticContact &e : elements)
      {
        const Vec3 &n0 = e.normal;
        const Vec6 &a = u[e.first], &b = u[e.second];
        const Vec3 spin_arm = e.radius1 * a.tail<3>() + e.radius2 * b.tail<3>();
        const Vec3 slip = b.head<3>() - a.head<3>() - spin_arm.cross(n0);
        const Vec3 along = slip.dot(n0) * n0;
        const Vec3 force = e.k.normal * along + e.k.shear * (slip - along);
        const Vec3 spin = b.tail<3>() - a.tail<3>(), spin_along = spin.dot(n0) * n0;
        const Vec3 moment = e.k.rolling * (spin - spin_along) + e.k.twisting * spin_along;
        const Vec3 couple = n0.cross(force);
        y[e.first].head<3>() -= force;
        y[e.second].head<3>() += force;
        y[e.first].tail<3>() += -e.radius1 * couple - moment;
        y[e.second].tail<3>() += -e.radius2 * couple + moment;
      }
    for (std::size_t i = 0; i < n; ++i)
      y[i] = scaled(i, y[i]);
  }
};

/// Upper bound of the largest eigenvalue of M^-1/2 K M^-1/2, K of these elements and of what holds single grains.
/// @param minimum  the bound is never below it
double largest_eigenvalue(const Packing &packing, const std::vector<ElasticContact> &elements, const Blocks &held,
                          double minimum)
{
  Blocks alone = held;
  for (const ElasticContact &e : elements)
    {
      alone[e.first] += body_block(e, e.radius1, -1);
      alone[e.second] += body_block(e, e.radius2, +1);
    }
  std::vector<double> lambda(packing.n_grains());
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    lambda[i] = std::max(0.1 * minimum, eigenvalue_bound(scaled_block(packing, i, alone[i])));
  const double max_alone = *std::max_element(lambda.begin(), lambda.end());

  // only grains that could exceed the largest lambda with their neighbours' share are checked again
  std::vector<double> neighbour(packing.n_grains(), 0.0);
  for (const ElasticContact &e : elements)
    {
      neighbour[e.first] = std::max(neighbour[e.first], lambda[e.second]);
      neighbour[e.second] = std::max(neighbour[e.second], lambda[e.first]);
    }
  const auto matters = [&](std::size_t i) { return lambda[i] + neighbour[i] > max_alone; };
  Blocks weighted = held;
  for (const ElasticContact &e : elements)
    {
      if (matters(e.first))
        weighted[e.first] += (1 + lambda[e.second] / lambda[e.first]) * body_block(e, e.radius1, -1);
      if (matters(e.second))
        weighted[e.second] += (1 + lambda[e.first] / lambda[e.second]) * body_block(e, e.radius2, +1);
    }
  double maximum = std::max(max_alone, minimum);
  for (std::size_t i = 0; i < packing.n_grains(); ++i)
    if (matters(i))
      maximum = std::max(maximum, eigenvalue_bound(scaled_block(packing, i, weighted[i])));
  return maximum;
}

/// Rayleigh quotient of M^-1/2 K M^-1/2 after this many power iterations: its largest eigenvalue, from below.
double power_iteration(const Packing &packing, const std::vector<ElasticContact> &elements,
                       const std::vector<Vec3> &held, int iterations)
{
  const std::size_t n = packing.n_grains();
  const ScaledStiffness stiffness{packing, elements, held};
  std::vector<Vec6> x(n), y(n);
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < 6; ++c)
      x[i][c] = std::sin(1.0 + 12.9898 * (6 * i + c)); // no mode is orthogonal to this
  double eigenvalue = 0;
  for (int k = 0; k < iterations; ++k)
    {
      stiffness.apply(x, y);
      double xx = 0, xy = 0, yy = 0;
      for (std::size_t i = 0; i < n; ++i)
        {
          xx += x[i].squaredNorm();
          xy += x[i].dot(y[i]);
          yy += y[i].squaredNorm();
        }
      eigenvalue = xy / xx;
      for (std::size_t i = 0; i < n; ++i)
        x[i] = y[i] / std::sqrt(yy);
    }
  return eigenvalue;
}

/// The same contacts with dashpots in place of their springs.
std::vector<ElasticContact> dashpots(const Packing &packing, std::vector<ElasticContact> elements,
                                     double contact_damping)
{
  for (ElasticContact &e : elements)
    e.k = {dashpot_coefficient(contact_damping, e.k.normal, packing.mass(e.first), packing.mass(e.second)), 0, 0, 0};
  return elements;
}

/// dt with dt^2 omega2/4 + dt gamma/2 = 1
double stable_step(double omega2, double gamma) { return (std::sqrt(gamma * gamma + 4 * omega2) - gamma) / omega2; }
} // namespace

double critical_step_bound(const ContactLaw &law, const Packing &packing, const RigidBox *walls,
                           const ContactList &contacts, double contact_damping)
{
  const std::vector<ElasticContact> elements = closed_contacts(law, packing, contacts);
  Blocks held(packing.n_grains(), Mat6::Zero());
  for_wall_contacts(law, packing, walls, [&](std::size_t i, int axis, double k) { held[i](axis, axis) += k; });
  const double omega2 = largest_eigenvalue(packing, elements, held, SmallestPair(law, packing).eigenvalue());
  if (contact_damping <= 0)
    return 2 / std::sqrt(omega2);
  std::fill(held.begin(), held.end(), Mat6::Zero());
  return stable_step(omega2, largest_eigenvalue(packing, dashpots(packing, elements, contact_damping), held,
                                                SmallestPair(law, packing).damping(contact_damping)));
}

double critical_step_by_power_iteration(const ContactLaw &law, const Packing &packing, const RigidBox *walls,
                                        const ContactList &contacts, int iterations, double contact_damping)
{
  std::vector<Vec3> held(packing.n_grains(), Vec3::Zero());
  for_wall_contacts(law, packing, walls, [&](std::size_t i, int axis, double k) { held[i][axis] += k; });
  const std::vector<ElasticContact> elements = closed_contacts(law, packing, contacts);
  const double omega2 = power_iteration(packing, elements, held, iterations);
  if (contact_damping <= 0)
    return 2 / std::sqrt(omega2);
  std::fill(held.begin(), held.end(), Vec3::Zero());
  return stable_step(omega2, power_iteration(packing, dashpots(packing, elements, contact_damping), held, iterations));
}
} // namespace isostat
