// SPDX-License-Identifier: BSD-3-Clause
// The law in its loop, compiled once per instruction set and chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/contact/linear_rolling/loop.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "dem/contact/linear_rolling/law.hpp"
#include "dem/contact/rolling_resistance-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
/// kn = 2 E R1 R2/(R1+R2), fn = kn u
struct LinearSprings
{
  struct Numbers : RollingResistanceNumbers
  {
    double twice_young;
    Numbers(const LinearRolling &law, double step) : RollingResistanceNumbers(law, step), twice_young(2 * law.young) {}
  };
  static constexpr bool varies = false;
  V kn, fn;

  HWY_INLINE LinearSprings(const Numbers &k, const Pairs &p)
      : kn(closed(p, hn::Mul(hn::Mul(p.r1, p.r2), hn::Mul(inverse(p.reach), hn::Set(D(), k.twice_young))))),
        fn(hn::Mul(kn, p.overlap))
  {}
  static V shear_stiffness_before(const Numbers &k, V rr, V reach)
  {
    const D d;
    return hn::Div(hn::Mul(rr, hn::Set(d, k.twice_young * k.stiffness_ratio)), hn::Max(reach, hn::Set(d, 1e-300)));
  }
};

void add_linear_rolling(const LinearRolling &law, const LoopView &view)
{
  run_rolling_resistance<LinearSprings>(law.active(), view, {law, view.dt});
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
