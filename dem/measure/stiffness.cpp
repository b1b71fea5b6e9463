// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/stiffness.hpp"

#include "base/error.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace isostat
{
namespace
{
constexpr double regularisation = 1e-10; ///< of the largest diagonal entry
/// Share of a limit by which contacts that continue to yield may be below it: that of forces in balance, BalanceSpec.
constexpr double near_limit = 0.01;

using Mat3x6 = Eigen::Matrix<double, 3, 6>;
using Mat6x12 = Eigen::Matrix<double, 6, 12>;
using Mat12x6 = Eigen::Matrix<double, 12, 6>;
using Mat12 = Eigen::Matrix<double, 12, 12>;
constexpr int most_factorised = 9000; // unknowns; fill-in grows fast in three periodic directions
using SparseMatrix = Eigen::SparseMatrix<double>;

/// One closed contact as an elastic element; its deformation is (v, w2 - w1).
struct Element
{
  std::uint32_t first, second;
  Vec3 normal;
  double radius1, radius2, branch; ///< m
  ContactStiffness k;              ///< alpha accounted for
  Vec3 sliding, rolling;           ///< fs/fn and mb/fn (m) of a contact that continues to yield; else 0

  double arm_ratio() const { return branch / (radius1 + radius2); }
  bool is_elastic() const { return sliding.isZero(0) && rolling.isZero(0); }
};

Element element(const Snapshot &snapshot, const Contact &c, Sliding sliding)
{
  const double r1 = snapshot.grains.radius(c.first), r2 = snapshot.grains.radius(c.second);
  ContactStiffness k = snapshot.law->stiffness(r1, r2, c.overlap);
  const double branch = r1 + r2 - c.overlap;
  k.shear *= (r1 + r2) / branch;
  Element e{c.first, c.second, c.history.normal, r1, r2, branch, k, Vec3::Zero(), Vec3::Zero()};
  if (sliding == Sliding::plastic)
    {
      const YieldState yield = snapshot.law->yield(snapshot.closed(c), near_limit);
      if (yield.sliding)
        e.sliding = c.history.shear_force / c.normal_force;
      if (yield.rolling)
        e.rolling = c.history.bending_moment / c.normal_force;
    }
  return e;
}

std::vector<Element> elements_of(const Snapshot &snapshot, Sliding sliding)
{
  if (!snapshot.wall_contacts.empty())
    throw RunFailure("elastic stiffness: the packing touches walls; it is defined for a periodic cell only");
  std::vector<Element> elements;
  elements.reserve(snapshot.contacts.size());
  for (const Contact &c : snapshot.contacts)
    elements.push_back(element(snapshot, c, sliding));
  return elements;
}

/// eps n as a function of (xx, yy, zz, yz, xz, xy), engineering shear.
Mat3x6 strain_along(const Vec3 &n)
{
  Mat3x6 m;
  m << n[0], 0, 0, 0, 0.5 * n[2], 0.5 * n[1], //
      0, n[1], 0, 0.5 * n[2], 0, 0.5 * n[0],  //
      0, 0, n[2], 0.5 * n[1], 0.5 * n[0], 0;
  return m;
}

/// Force and moment per deformation.
Mat6 rigidity(const Element &e)
{
  const Mat3 nn = e.normal * e.normal.transpose(), tangential = Mat3::Identity() - nn;
  Mat6 d = Mat6::Zero();
  d.topLeftCorner<3, 3>() = e.k.normal * nn + e.k.shear * tangential;
  d.bottomRightCorner<3, 3>() = e.k.rolling * tangential + e.k.twisting * nn;
  const auto yield = [&](int row, const Vec3 &limit, double k) {
    if (limit.isZero(0))
      return;
    const Vec3 along = limit.normalized();
    d.block<3, 3>(row, row) -= k * along * along.transpose();
    d.block<3, 3>(row, 0) += e.k.normal * limit * e.normal.transpose(); // dfn = -kn n.v
  };
  yield(0, e.sliding, e.k.shear);
  yield(3, e.rolling, e.k.rolling);
  return d;
}

/// Deformation per mean strain.
Mat6 imposed(const Element &e)
{
  Mat6 a = Mat6::Zero();
  a.topRows<3>() = e.branch * strain_along(e.normal);
  return a;
}

/// Deformation per (u1, R1 w1, u2, R2 w2).
Mat6x12 compatibility(const Element &e)
{
  const Mat3 one = Mat3::Identity(), slip = e.arm_ratio() * cross_matrix(e.normal);
  Mat6x12 b;
  b << -one, slip, one, slip, Mat3::Zero(), -one / e.radius1, Mat3::Zero(), one / e.radius2;
  return b;
}

void drop_unloaded(std::vector<Element> &elements, std::size_t n_grains)
{
  std::vector<std::uint32_t> degree(n_grains);
  do
    {
      std::fill(degree.begin(), degree.end(), 0);
      for (const Element &e : elements)
        {
          ++degree[e.first];
          ++degree[e.second];
        }
    }
  while (std::erase_if(elements, [&](const Element &e) { return std::min(degree[e.first], degree[e.second]) < 2; }));
}

/// For every grain the grain of its connected cluster that comes first in storage.
std::vector<std::uint32_t> clusters(const std::vector<Element> &elements, std::size_t n_grains)
{
  std::vector<std::uint32_t> parent(n_grains);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const Element &e : elements)
    {
      const std::uint32_t a = root(e.first), b = root(e.second);
      parent[std::max(a, b)] = std::min(a, b);
    }
  for (std::uint32_t i = 0; i < n_grains; ++i)
    parent[i] = root(i);
  return parent;
}

/// Numbers of the unknowns (u, R w) of the grains; -1: held or not there.
class Unknowns
{
public:
  Unknowns(const std::vector<Element> &elements, std::size_t n_grains, bool rotations)
      : translation_(n_grains, -1), rotation_(n_grains, -1)
  {
    const std::vector<std::uint32_t> cluster = clusters(elements, n_grains);
    std::vector<char> bears(n_grains, 0);
    for (const Element &e : elements)
      bears[e.first] = bears[e.second] = 1;
    for (std::uint32_t i = 0; i < n_grains; ++i)
      if (bears[i])
        {
          if (cluster[i] != i)
            translation_[i] = take_three();
          if (rotations)
            rotation_[i] = take_three();
        }
  }

  int count() const { return count_; }
  std::array<int, 12> of(const Element &e) const
  {
    std::array<int, 12> numbers;
    const int starts[] = {translation_[e.first], rotation_[e.first], translation_[e.second], rotation_[e.second]};
    for (int k = 0; k < 12; ++k)
      numbers[k] = starts[k / 3] < 0 ? -1 : starts[k / 3] + k % 3;
    return numbers;
  }

private:
  int take_three() { return (count_ += 3) - 3; }

  std::vector<int> translation_, rotation_;
  int count_ = 0;
};

/// K_uu, regularised, of elastic elements the lower triangle.
SparseMatrix network_stiffness(const std::vector<Element> &elements, const Unknowns &unknowns, Sliding sliding)
{
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(78 * elements.size() + unknowns.count());
  for (const Element &e : elements)
    {
      const Mat6x12 b = compatibility(e);
      const Mat12 k = b.transpose() * rigidity(e) * b;
      const std::array<int, 12> at = unknowns.of(e);
      for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j)
          if (at[j] >= 0 && at[i] >= (sliding == Sliding::elastic ? at[j] : 0))
            entries.emplace_back(at[i], at[j], k(i, j));
    }
  SparseMatrix matrix(unknowns.count(), unknowns.count());
  matrix.setFromTriplets(entries.begin(), entries.end());
  const double maximum = matrix.diagonal().maxCoeff();
  matrix.diagonal().array() += regularisation * maximum;
  return matrix;
}

template <typename Iteration, typename Factors>
Eigen::MatrixXd solved(const SparseMatrix &network, const Eigen::MatrixXd &load)
{
  if (network.rows() > most_factorised)
    {
      // elastic stiffness is evaluated as energy: what remains of the residual enters squared
      Iteration iteration(network);
      iteration.setTolerance(1e-8);
      Eigen::MatrixXd motion = iteration.solve(load);
      if (iteration.info() == Eigen::Success)
        return motion;
    }
  const Factors factors(network);
  if (factors.info() != Eigen::Success)
    throw RunFailure("stiffness: the stiffness matrix of the contact network cannot be factorised");
  return factors.solve(load);
}

/// The displacements and rotations per unit of each mean strain, -K_uu^-1 K_ue.
Eigen::MatrixXd fluctuations(const std::vector<Element> &elements, const Unknowns &unknowns, Sliding sliding)
{
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(unknowns.count(), 6);
  if (unknowns.count() == 0)
    return load;
  for (const Element &e : elements)
    {
      const Mat12x6 share = compatibility(e).transpose() * rigidity(e) * imposed(e);
      const std::array<int, 12> at = unknowns.of(e);
      for (int i = 0; i < 12; ++i)
        if (at[i] >= 0)
          load.row(at[i]) -= share.row(i);
    }
  const SparseMatrix network = network_stiffness(elements, unknowns, sliding);
  if (sliding == Sliding::elastic)
    return solved<Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower>,
                  Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower>>(network, load);
  return solved<Eigen::BiCGSTAB<SparseMatrix>, Eigen::SparseLU<SparseMatrix>>(network, load);
}

/// visit(branch, stiffness) for every touching pair.
template <typename Visit>
void for_stiffnesses(const LiveContacts &contacts, const Visit &visit)
{
  contacts.for_pairs([&](std::uint32_t i, std::uint32_t j, const Vec3 &branch, const Vec3 &) {
    const double r1 = contacts.packing.radius(i), r2 = contacts.packing.radius(j);
    visit(branch, contacts.law.stiffness(r1, r2, r1 + r2 - branch.norm()));
  });
}

/// Of its forces in a deformation, on a virtual one.
Mat6 work(const Element &e, const Mat6 &virtual_deformation, const Mat6 &deformation)
{
  return virtual_deformation.transpose() * rigidity(e) * deformation;
}

Mat6 checked(const Mat6 &sum, double volume, Sliding sliding)
{
  Mat6 stiffness = sum / volume;
  if (!stiffness.allFinite())
    throw RunFailure("elastic stiffness: not a number; look for such values in normals, overlaps and the cell");
  if (sliding == Sliding::plastic)
    return stiffness;
  return 0.5 * (stiffness + stiffness.transpose());
}
} // namespace

Mat6 condensed_stiffness(const Snapshot &snapshot, Sliding sliding)
{
  const std::size_t n_grains = snapshot.grains.n_grains();
  std::vector<Element> elements = elements_of(snapshot, sliding);
  drop_unloaded(elements, n_grains);
  if (elements.empty())
    return Mat6::Zero();
  if (std::ranges::all_of(elements, &Element::is_elastic))
    sliding = Sliding::elastic;
  const Unknowns unknowns(elements, n_grains, snapshot.law->friction > 0);
  const Eigen::MatrixXd motion = fluctuations(elements, unknowns, sliding);
  Mat6 sum = Mat6::Zero();
  for (const Element &e : elements)
    {
      const std::array<int, 12> at = unknowns.of(e);
      Mat12x6 own = Mat12x6::Zero();
      for (int i = 0; i < 12; ++i)
        if (at[i] >= 0)
          own.row(i) = motion.row(at[i]);
      const Mat6 mean = imposed(e), whole = mean + compatibility(e) * own;
      sum += work(e, sliding == Sliding::elastic ? whole : mean, whole);
    }
  return checked(sum, snapshot.volume(), sliding);
}

Mat6 affine_stiffness(const Snapshot &snapshot, Sliding sliding)
{
  const std::vector<Element> elements = elements_of(snapshot, sliding);
  if (elements.empty())
    return Mat6::Zero();
  Mat6 sum = Mat6::Zero();
  for (const Element &e : elements)
    sum += work(e, imposed(e), imposed(e));
  return checked(sum, snapshot.volume(), sliding);
}

Vec3 affine_moduli(const LiveContacts &contacts, double volume)
{
  Vec3 sum = Vec3::Zero();
  for_stiffnesses(contacts, [&](const Vec3 &branch, const ContactStiffness &k) {
    const Vec3 n2 = branch.cwiseAbs2() / branch.squaredNorm();
    const Vec3 along = n2.cwiseProduct(k.normal * n2 + k.shear * (Vec3::Ones() - n2));
    sum += branch.squaredNorm() * along;
  });
  return sum / volume;
}

double affine_modulus(const LiveContacts &contacts, double volume, const Mat3 &gradient)
{
  const Mat3 strain = 0.5 * (gradient + gradient.transpose());
  double sum = 0;
  for_stiffnesses(contacts, [&](const Vec3 &branch, const ContactStiffness &k) {
    const Vec3 n = branch / branch.norm(), motion = strain * branch;
    const double along = n.dot(motion);
    sum += k.normal * along * along + k.shear * (motion.squaredNorm() - along * along);
  });
  return sum / volume;
}
} // namespace isostat
