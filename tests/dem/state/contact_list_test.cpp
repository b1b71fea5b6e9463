// SPDX-License-Identifier: BSD-3-Clause
#include "dem/state/contact_list.hpp"

#include "dem/contact/linear_rolling/law.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
using Pair = ContactList::Pair;

HistoryLayout layout_of(LawFeatures on) { return LinearRolling().with(on).history(); }

/// A history that shows from which pair it is.
ContactHistory marked(const Pair &p)
{
  const double a = p.first + 1, b = p.second + 1;
  return {Vec3(a, b, 1).normalized(), Vec3(a, b, 2), Vec3(a, b, 3), Vec3(a, b, 4)};
}

void expect_equal(const ContactHistory &got, const ContactHistory &expected)
{
  EXPECT_EQ(got.normal, expected.normal);
  EXPECT_EQ(got.shear_force, expected.shear_force);
  EXPECT_EQ(got.bending_moment, expected.bending_moment);
  EXPECT_EQ(got.twisting_moment, expected.twisting_moment);
}

Pair pair_at(const ContactList &list, std::size_t p) { return {list.first()[p], list.second()[p]}; }

ContactList marked_list(LawFeatures on, const std::vector<Pair> &pairs, std::uint32_t n_grains)
{
  ContactList list(layout_of(on));
  list.replace_pairs(pairs, n_grains);
  for (std::size_t p = 0; p < pairs.size(); ++p)
    list.set_history(p, marked(pairs[p]));
  return list;
}

/// Every pair of n grains whose numbers pass `keep`.
template <typename Keep>
std::vector<Pair> pairs_of(std::uint32_t n, const Keep &keep)
{
  std::vector<Pair> pairs;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = i + 1; j < n; ++j)
      if (keep(i, j))
        pairs.emplace_back(i, j);
  return pairs;
}

constexpr LawFeatures full{true, true, true}, sliding{true, false, false}, rolling{true, true, false},
    twisting{true, false, true}, frictionless{false, false, false};
} // namespace

TEST(ContactList, KeepsWhatIsSetInEveryVariant)
{
  const std::vector<Pair> pairs = pairs_of(7, [](auto, auto) { return true; }); // 21: two blocks and a half
  for (const LawFeatures on : {full, sliding, rolling, twisting})
    {
      const ContactList list = marked_list(on, pairs, 7);
      ASSERT_EQ(list.n_pairs(), pairs.size());
      EXPECT_EQ(list.n_blocks(), 3u);
      for (std::size_t p = 0; p < pairs.size(); ++p)
        {
          ContactHistory expected = marked(pairs[p]);
          if (!on.rolling)
            expected.bending_moment.setZero();
          if (!on.twisting)
            expected.twisting_moment.setZero();
          EXPECT_EQ(pair_at(list, p), pairs[p]);
          expect_equal(list.history(p), expected);
        }
    }
}

TEST(ContactList, IdleLanesPointAtThePadding)
{
  const ContactList list = marked_list(full, {{0, 1}, {1, 2}}, 3);
  for (std::size_t lane = 2; lane < 8; ++lane)
    EXPECT_EQ(pair_at(list, lane), Pair(3, 4));
}

TEST(ContactList, HistoryGoesOverToPairsThatStay)
{
  const auto old_pairs = pairs_of(12, [](auto i, auto j) { return (i + j) % 3 != 0; });
  const auto new_pairs = pairs_of(12, [](auto i, auto j) { return (i * j) % 4 != 1; });
  ContactList list = marked_list(full, old_pairs, 12);
  list.replace_pairs(new_pairs, 12);
  ASSERT_EQ(list.n_pairs(), new_pairs.size());
  std::size_t stayed = 0, fresh = 0;
  for (std::size_t p = 0; p < new_pairs.size(); ++p)
    {
      const bool stays = std::find(old_pairs.begin(), old_pairs.end(), new_pairs[p]) != old_pairs.end();
      expect_equal(list.history(p), stays ? marked(new_pairs[p]) : ContactHistory{});
      ++(stays ? stayed : fresh);
    }
  EXPECT_GT(stayed, 10u);
  EXPECT_GT(fresh, 10u);
}

TEST(ContactList, ReplacingByTheSameAndByNothing)
{
  const auto pairs = pairs_of(6, [](auto, auto) { return true; });
  ContactList list = marked_list(full, pairs, 6);
  list.replace_pairs(pairs, 6);
  for (std::size_t p = 0; p < pairs.size(); ++p)
    expect_equal(list.history(p), marked(pairs[p]));
  list.replace_pairs({}, 6);
  EXPECT_EQ(list.n_pairs(), 0u);
  EXPECT_EQ(list.n_blocks(), 0u);
  list.replace_pairs(pairs, 6); // what was lost does not come back
  for (std::size_t p = 0; p < pairs.size(); ++p)
    expect_equal(list.history(p), {});
}

TEST(ContactList, SwitchingPartsOfTheLawKeepsWhatStays)
{
  const auto pairs = pairs_of(6, [](auto, auto) { return true; });
  for (const LawFeatures from : {full, sliding, rolling, twisting, frictionless})
    for (const LawFeatures to : {full, sliding, rolling, twisting, frictionless})
      {
        ContactList list = marked_list(from, pairs, 6);
        list.set_layout(layout_of(to));
        EXPECT_EQ(list.layout(), layout_of(to));
        for (std::size_t p = 0; p < pairs.size(); ++p)
          {
            ContactHistory expected;
            if (from.friction && to.friction)
              {
                expected = marked(pairs[p]);
                if (!(from.rolling && to.rolling))
                  expected.bending_moment.setZero();
                if (!(from.twisting && to.twisting))
                  expected.twisting_moment.setZero();
              }
            EXPECT_EQ(pair_at(list, p), pairs[p]);
            expect_equal(list.history(p), expected);
          }
      }
}

TEST(ContactList, ChunksHaveBlocksAndGhostsOfTheirOwn)
{
  const std::uint32_t n = 5000; // each grain with the next one and with one far away
  std::vector<Pair> pairs;
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j : {i + 1, i + 1000})
      if (j < n)
        pairs.emplace_back(i, j);
  ContactList list(layout_of(full));
  list.replace_pairs(pairs, n);
  const Partition &partition = list.partition();
  ASSERT_GE(partition.n_chunks, 4u);
  std::vector<std::uint32_t> grain_of(list.n_slots(), n); // of ghosts
  for (std::size_t chunk = 0; chunk < partition.n_chunks; ++chunk)
    for (const Ghost &g : list.ghosts(chunk))
      {
        EXPECT_EQ(partition.chunk_of(g.grain), chunk);
        ASSERT_EQ(grain_of.at(g.slot), n) << "one slot, one grain";
        grain_of[g.slot] = g.grain;
      }
  std::size_t seen = 0;
  for (std::size_t chunk = 0; chunk < partition.n_chunks; ++chunk)
    for (std::size_t lane = 8 * list.first_block(chunk); lane < 8 * list.first_block(chunk + 1); ++lane)
      {
        const std::uint32_t i = list.first()[lane], j = list.second()[lane], slot = list.target()[lane];
        if (i == n)
          continue;
        ASSERT_EQ(Pair(i, j), pairs[seen++]);
        EXPECT_EQ(partition.chunk_of(i), chunk);
        EXPECT_EQ(slot < n, partition.chunk_of(j) == chunk) << "another chunk's grain is reached through a ghost";
        EXPECT_EQ(slot < n ? slot : grain_of[slot], j);
      }
  EXPECT_EQ(seen, pairs.size());
}

TEST(ContactList, HistoryGoesOverInEveryChunkOnAnyNumberOfThreads)
{
  const std::uint32_t n = 5000;
  std::vector<Pair> old_pairs, new_pairs;
  for (std::uint32_t i = 0; i + 3 < n; ++i)
    {
      old_pairs.emplace_back(i, i + 1 + i % 2);
      new_pairs.emplace_back(i, i + 1 + i % 3);
    }
  for (int threads : {1, 2, 3})
    {
      ContactList list(layout_of(full));
      list.replace_pairs(old_pairs, n);
      for (std::size_t lane = 0; lane < list.n_lanes(); ++lane)
        if (list.first()[lane] < n)
          list.set_history(lane, marked(pair_at(list, lane)));
      list.replace_pairs(new_pairs, n, threads);
      for (std::size_t lane = 0; lane < list.n_lanes(); ++lane)
        if (const Pair p = pair_at(list, lane); p.first < n)
          expect_equal(list.history(lane), p.second - p.first == 1 + p.first % 2 ? marked(p) : ContactHistory{});
    }
}

TEST(ContactList, ImagesStayWithTheirPairsInEveryChunk)
{
  const std::uint32_t n = 5000;
  std::vector<Pair> pairs;
  std::vector<ImageCode> images;
  auto shift_of = [](const Pair &p) {
    return Eigen::Vector3i(static_cast<int>(p.first % 3) - 1, 0, static_cast<int>(p.second % 2));
  };
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j : {i + 1, i + 1000})
      if (j < n)
        {
          pairs.emplace_back(i, j);
          images.push_back(image_code(shift_of(pairs.back())));
        }
  const Packing packing = make_packing(std::vector<Vec3>(n, Vec3(1, 2, 3)), std::vector<double>(n, 0.1), 2650);
  Mat3 edges;
  edges << 2, 0.5, 0.25, 0, 3, -0.5, 0, 0.125, 4;
  ContactList list(layout_of(full));
  list.replace_pairs(pairs, n, 1, images);
  ASSERT_GE(list.partition().n_chunks, 4u);
  for (const LawFeatures on : {full, sliding})
    for (const double factor : {1.0, 2.0}) // the cell deforms, the pairs stay
      {
        list.set_layout(layout_of(on));
        list.set_cell(factor * edges);
        for (std::size_t lane = 0; lane < list.n_lanes(); ++lane)
          {
            const Pair p = pair_at(list, lane);
            Vec3 expected = Vec3::Zero();
            if (p.first < n)
              expected = factor * edges * shift_of(p).cast<double>();
            if (p.first < n)
              EXPECT_EQ(list.branch(packing, lane), expected);
            else
              EXPECT_EQ(list.image()[lane], 0u) << "idle lanes are not shifted";
          }
      }
  list.replace_pairs(pairs, n);
  EXPECT_EQ(list.image(), nullptr) << "a box has no images";
}

TEST(ContactList, SavedHistoryComesBackAndAllOtherPairsForget)
{
  const auto few = pairs_of(12, [](auto i, auto j) { return (i + j) % 3 != 0; }),
             all = pairs_of(12, [](auto, auto) { return true; });
  for (const LawFeatures on : {full, sliding, rolling, twisting})
    {
      ContactList list(layout_of(on));
      list.replace_pairs(few, 12);
      for (std::size_t p = 0; p < few.size(); p += 2)
        list.set_history(p, marked(few[p]));
      std::vector<Pair> pairs;
      std::vector<double> numbers;
      list.save_history(pairs, numbers);
      ASSERT_EQ(pairs.size(), (few.size() + 1) / 2);
      ASSERT_EQ(numbers.size(), pairs.size() * list.n_components());
      ContactList other = marked_list(on, all, 12);
      other.restore_history(pairs, numbers);
      for (std::size_t p = 0; p < all.size(); ++p)
        {
          const auto at = std::find(few.begin(), few.end(), all[p]);
          const bool saved = at != few.end() && (at - few.begin()) % 2 == 0;
          expect_equal(other.history(p), saved ? list.history(at - few.begin()) : ContactHistory{});
        }
      std::vector<Pair> pairs_again;
      std::vector<double> numbers_again;
      other.save_history(pairs_again, numbers_again);
      EXPECT_EQ(pairs_again, pairs);
      EXPECT_EQ(numbers_again, numbers);
    }
}
} // namespace isostat
