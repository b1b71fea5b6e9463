// SPDX-License-Identifier: BSD-3-Clause
// The law in its loop, compiled once per instruction set and chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/contact/hertz_mindlin/loop.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "dem/contact/hertz_mindlin/asperity_loop.hpp"
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/contact/rolling_resistance-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
/// kn = 2 E* sqrt(R* u), fn = 2/3 kn u
struct HertzSprings
{
  struct Numbers : RollingResistanceNumbers
  {
    double twice_modulus, inverse_modulus; ///< 2 E*, 1/(2 E*)
    Numbers(const HertzMindlin &law, double step)
        : RollingResistanceNumbers(law, step), twice_modulus(2 * law.contact_modulus()),
          inverse_modulus(1 / twice_modulus)
    {}
  };
  static constexpr bool varies = true;
  V kn, fn, compliance;

  HWY_INLINE HertzSprings(const Numbers &k, const Pairs &p)
  {
    const D d;
    const V area = hn::Mul(hn::Mul(hn::Mul(p.r1, p.r2), inverse(p.reach)), p.overlap); // squared radius of the contact
    const V inverse_radius = inverse_root(area);
    kn = closed(p, hn::Mul(root(area, inverse_radius), hn::Set(d, k.twice_modulus)));
    fn = hn::Mul(kn, hn::Mul(p.overlap, hn::Set(d, 2.0 / 3.0)));
    compliance = closed(p, hn::Mul(inverse_radius, hn::Set(d, k.inverse_modulus)));
  }
};

void add_hertz_mindlin(const HertzMindlin &law, const LoopView &view)
{
  run_rolling_resistance<HertzSprings>(law.active(), view, {law, view.dt});
}
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isostat
{
HWY_EXPORT(add_hertz_mindlin);

void HertzMindlin::add_forces(const LoopView &view) const
{
  if (!is_spherical())
    return add_asperity_forces(*this, view);
  HWY_DYNAMIC_DISPATCH(add_hertz_mindlin)(*this, view);
}
} // namespace isostat
#endif
