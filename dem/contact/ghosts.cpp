// SPDX-License-Identifier: BSD-3-Clause
// What chunks leave in each other's ghosts, compiled once per instruction set and chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/contact/ghosts.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "dem/contact/loop.hpp"
#include "dem/contact/triple-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
/// Adds to each grain what its ghosts have, and clears them.
void add_ghosts(const Ghost *ghosts, std::size_t n, double *action)
{
  const D d;
  for (std::size_t g = 0; g < n; ++g)
    for (std::size_t c = 0; c < 8; c += hn::Lanes(d))
      {
        double *grain = action + 8 * std::size_t{ghosts[g].grain} + c,
               *ghost = action + 8 * std::size_t{ghosts[g].slot} + c;
        hn::Store(hn::Add(hn::Load(d, grain), hn::Load(d, ghost)), d, grain);
        hn::Store(hn::Zero(d), d, ghost);
      }
}
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isostat
{
HWY_EXPORT(add_ghosts);

void add_ghosts(const ContactList &list, std::size_t chunk, double *action)
{
  HWY_DYNAMIC_DISPATCH(add_ghosts)(list.ghosts(chunk).data(), list.ghosts(chunk).size(), action);
}
} // namespace isostat
#endif
