// SPDX-License-Identifier: BSD-3-Clause
// The law in its loop, compiled once per instruction set and chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/contact/linear_rolling/loop.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "dem/contact/linear_rolling/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
void add_linear_rolling(const LinearRolling &law, const LoopView &view)
{
  const LawFeatures on = law.active();
  const LinearRollingNumbers numbers(law, view.dt);
  if (!on.friction)
    run_loop<LinearRollingLanes<false, false, false>>(view, numbers);
  else if (on.rolling && on.twisting)
    run_loop<LinearRollingLanes<true, true, true>>(view, numbers);
  else if (on.rolling)
    run_loop<LinearRollingLanes<true, true, false>>(view, numbers);
  else if (on.twisting)
    run_loop<LinearRollingLanes<true, false, true>>(view, numbers);
  else
    run_loop<LinearRollingLanes<true, false, false>>(view, numbers);
}
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isostat
{
HWY_EXPORT(add_linear_rolling);

void LinearRolling::add_forces(const LoopView &view) const { HWY_DYNAMIC_DISPATCH(add_linear_rolling)(*this, view); }
} // namespace isostat
#endif
