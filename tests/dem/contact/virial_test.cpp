// SPDX-License-Identifier: BSD-3-Clause
#include "dem/contact/virial.hpp"
#include "tests/support/near.hpp"
#include "tests/support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

namespace isostat
{
namespace
{
/// Force and branch vector of a contact, of any size up to that of a packing at 200 kPa.
struct Term
{
  Vec3 force, branch;
};

std::vector<Term> random_terms(std::size_t n, unsigned seed)
{
  test::Random random(seed);
  std::vector<Term> terms(n);
  for (Term &t : terms)
    {
      t.branch = 3e-4 * random.vector().normalized();
      t.force = 0.05 * std::exp(3 * random()) * (t.branch.normalized() + 0.2 * random.vector());
    }
  return terms;
}

constexpr double bound = 1e10 * 8e-9; // E V of a cell of 2 mm

/// Adds terms as the loop does, each to a chunk and a lane.
template <typename Place>
Mat3 summed(const std::vector<Term> &terms, std::size_t n_chunks, const Place &place)
{
  Virial virial;
  virial.start(n_chunks, bound);
  for (std::size_t t = 0; t < terms.size(); ++t)
    {
      const auto [chunk, lane] = place(t);
      double *sums = virial.data(chunk) + lane;
      const auto &[f, b] = terms[t];
      const std::array<std::pair<double, double>, 9> products{{{f[0], b[0]},
                                                               {f[1], b[1]},
                                                               {f[2], b[2]},
                                                               {f[1], b[2]},
                                                               {f[0], b[2]},
                                                               {f[0], b[1]},
                                                               {f[2], b[1]},
                                                               {f[2], b[0]},
                                                               {f[1], b[0]}}};
      for (std::size_t c = 0; c < 9; ++c)
        {
          double &to = sums[8 * (c < 6 ? c : c - 3)];
          to = std::fma(products[c].first, products[c].second, to);
        }
    }
  return virial.sum();
}
using Place = std::pair<std::size_t, std::size_t>;
Place one_lane(std::size_t) { return {0, 0}; }
} // namespace

TEST(Virial, OrderLanesAndChunksChangeNoBit)
{
  std::vector<Term> terms = random_terms(20'000, 1);
  const Mat3 expected = summed(terms, 1, one_lane);
  ASSERT_GT(expected.trace(), 0);
  std::mt19937_64 engine(2);
  double plain = 0, shuffled_plain = 0;
  for (const Term &t : terms)
    plain += t.force.dot(t.branch);
  for (int run = 0; run < 20; ++run)
    {
      std::shuffle(terms.begin(), terms.end(), engine);
      const std::size_t chunks = 1 + engine() % 7, lanes = std::size_t{1} << engine() % 4;
      EXPECT_EQ(summed(terms, chunks, [&](std::size_t) { return Place(engine() % chunks, engine() % lanes); }),
                expected);
    }
  for (const Term &t : terms)
    shuffled_plain += t.force.dot(t.branch);
  EXPECT_NE(plain, shuffled_plain) << "sums as they come do depend on the order";
}

TEST(Virial, TermsThatAreZeroChangeNoBit)
{
  std::vector<Term> terms = random_terms(1000, 3);
  const Mat3 expected = summed(terms, 1, one_lane);
  for (std::size_t t = 0; t < 1000; t += 3)
    terms.insert(terms.begin() + t, {Vec3::Zero(), Vec3(1e-4, -2e-4, 3e-4)});
  EXPECT_EQ(summed(terms, 3, [](std::size_t t) { return Place(t % 3, t % 8); }), expected);
}

TEST(Virial, IsTheSumToRoundOffOfEVAndSymmetric)
{
  const std::vector<Term> terms = random_terms(20'000, 4);
  long double exact[3][3] = {};
  for (const Term &t : terms)
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j)
        exact[i][j] +=
            (static_cast<long double>(t.force[i]) * t.branch[j] + static_cast<long double>(t.force[j]) * t.branch[i]) /
            2;
  const Mat3 sum = summed(terms, 2, [](std::size_t t) { return Place(t % 2, t % 8); });
  double error = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      {
        error = std::max(error, std::abs(static_cast<double>(sum(i, j) - exact[i][j])));
        EXPECT_EQ(sum(i, j), sum(j, i));
      }
  // each term is off by half the grid, 2^-52 of what is at most 2 E V; 20,000 such errors at random add up as sqrt(N)
  EXPECT_LE(error, 6 * std::sqrt(20'000 / 12.0) * 2 * bound * 0x1p-52);
  EXPECT_BELOW_BECAUSE(error, 1e-10 * sum.trace(), "the bound above, were E V not far above the trace");
}

TEST(Virial, ChunksWithoutContactsAreZeroAndASetSumIsGivenBack)
{
  Virial virial;
  EXPECT_EQ(virial.sum(), Mat3::Zero());
  virial.start(5, bound);
  EXPECT_EQ(virial.sum(), Mat3::Zero());
  Mat3 sum;
  sum << 1, 0.1, 0.7, 0.1, 3, -1e-17, 0.7, -1e-17, -1e9;
  virial.set(sum);
  EXPECT_EQ(virial.sum(), sum);
  virial.start(3, bound); // and starts again
  EXPECT_EQ(virial.sum(), Mat3::Zero());
}
} // namespace isostat
