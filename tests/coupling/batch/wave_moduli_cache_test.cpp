// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/batch/wave_moduli_cache.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::ElementsAre;

Stress at(double pressure) { return {-pressure, -pressure, -pressure, 0, 0, 0}; }

/// Two elements whose moduli were computed at 100 kPa.
WaveModuliCache known(const RefreshRule &rule = {})
{
  WaveModuliCache cache(2, rule);
  for (std::size_t id : cache.due())
    cache.set(id, {3e8, 1e8}, at(100e3));
  return cache;
}
} // namespace

TEST(WaveModuliCache, AllAreDueAtFirst)
{
  WaveModuliCache cache(2);
  EXPECT_THAT(cache.due(), ElementsAre(0, 1));
  cache.set(1, {3e8, 1e8}, at(100e3));
  EXPECT_THAT(cache.due(), ElementsAre(0));
  cache.clear();
  EXPECT_THAT(cache.due(), ElementsAre(0, 1));
}

TEST(WaveModuliCache, ARiseOfPressureMakesThemDue)
{
  WaveModuliCache cache = known();
  cache.commit(std::vector{at(124e3), at(126e3)});
  EXPECT_THAT(cache.due(), ElementsAre(1));
  cache.commit(std::vector{at(20e3), at(100e3)}); // and it stays due
  EXPECT_THAT(cache.due(), ElementsAre(1));
}

TEST(WaveModuliCache, AgeMakesThemDueUnlessPressureHasFallen)
{
  WaveModuliCache cache = known({.interval = 3});
  for (int k = 0; k < 2; ++k)
    cache.commit(std::vector{at(99e3), at(100e3)});
  EXPECT_TRUE(cache.due().empty());
  cache.commit(std::vector{at(99e3), at(100e3)});
  EXPECT_THAT(cache.due(), ElementsAre(1));
}

// At zero pressure every pressure would be a rise.
TEST(WaveModuliCache, ALiquefiedElementIsNotComputedInEveryStep)
{
  WaveModuliCache cache = known();
  cache.set(0, {0, 0}, at(0));
  cache.commit(std::vector{at(1), at(100e3)});
  EXPECT_TRUE(cache.due().empty());
}

TEST(WaveModuliCache, BytesKeepAll)
{
  WaveModuliCache cache = known(), other(2);
  cache.commit(std::vector{at(126e3), at(100e3)});
  ByteWriter out;
  for (std::size_t id : {0, 1})
    cache.write(id, out);
  const auto bytes = out.take();
  ByteReader in(bytes, "test");
  for (std::size_t id : {0, 1})
    other.read(id, in);
  other.set_commits(cache.n_commits());
  EXPECT_THAT(other.due(), ElementsAre(0));
  EXPECT_EQ(other.moduli()[1].p, 3e8);
  other.commit(std::vector{at(100e3), at(126e3)});
  EXPECT_THAT(other.due(), ElementsAre(0, 1));
}

TEST(RefreshRule, IsChecked)
{
  EXPECT_THROW((RefreshRule{.rise = 0}.check()), InputError);
  EXPECT_THROW((RefreshRule{.interval = 0}.check()), InputError);
}
} // namespace isostat
