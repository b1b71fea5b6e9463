// SPDX-License-Identifier: BSD-3-Clause
// The law with an exponent other than 3/2 in its loop, compiled once per instruction set and chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/contact/hertz_mindlin/asperity_loop.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include "dem/contact/hertz_mindlin/asperity_loop.hpp"
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/contact/rolling_resistance-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
/// kn = 2 E* s R* (u/(depth R*))^(n-1), fn = kn u/n
struct AsperitySprings
{
  struct Numbers : RollingResistanceNumbers
  {
    double factor, inverse_depth, power, inverse_exponent; ///< 2 E* s, 2/(kappa s^2), n - 1, 1/n
    Numbers(const HertzMindlin &law, double step)
        : RollingResistanceNumbers(law, step), factor(2 * law.contact_modulus() * law.asperity),
          inverse_depth(1 / law.asperity_depth()), power(law.exponent - 1), inverse_exponent(1 / law.exponent)
    {}
  };
  static constexpr bool varies = true;
  V kn, fn, compliance;

  HWY_INLINE AsperitySprings(const Numbers &k, const Pairs &p)
  {
    const D d;
    const V radius = hn::Mul(hn::Mul(p.r1, p.r2), inverse(p.reach));
    const V depth = hn::IfThenElse(p.touching, hn::Div(hn::Mul(p.overlap, hn::Set(d, k.inverse_depth)), radius),
                                   hn::Set(d, 1.0)); // the logarithm is that of positive numbers
    const V grown = hn::Exp(d, hn::Mul(hn::Set(d, k.power), hn::Log(d, depth)));
    const V stiffness = hn::Mul(hn::Mul(radius, hn::Set(d, k.factor)), grown);
    kn = closed(p, stiffness);
    fn = hn::Mul(kn, hn::Mul(p.overlap, hn::Set(d, k.inverse_exponent)));
    compliance = closed(p, hn::Div(hn::Set(d, 1.0), stiffness));
  }
};

void add_asperities(const HertzMindlin &law, const LoopView &view)
{
  run_rolling_resistance<AsperitySprings>(law.active(), view, {law, view.dt});
}
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isostat
{
HWY_EXPORT(add_asperities);

void add_asperity_forces(const HertzMindlin &law, const LoopView &view)
{
  HWY_DYNAMIC_DISPATCH(add_asperities)(law, view);
}
} // namespace isostat
#endif
